// SPDX-License-Identifier: MIT

/// @file What the library computes, as hashes: wrenches of every shipped body and topology in float and
/// double, shapes of every deformation model, a response field, its tick and its bytes.
///
/// A change that must not change a result leaves every row as it was. Rows are FNV-1a over the bits of all
/// that was computed along a path; `sum` is a plain sum of the same numbers, to see how large a difference
/// is. Compiled for any x86-64: rows depend on the compiler, its flags and the C library, not on the
/// processor.

#include "response/path.hpp"
#include "shape_scene.hpp"

#include <palpate/elasticity/half_space.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>
#include <palpate/luo_xiao/interpolation/smooth.hpp>
#include <palpate/response/deformation.hpp>
#include <palpate/response/save.hpp>

namespace {

using namespace bench;

struct Row {
  const char* unit;
  Hash hash = {};
  double sum = 0;

  void add(double x) {
    hash.add(x);
    sum += x;
  }
  template <Real S>
  void add(const Vec3<S>& v) {
    for (int i = 0; i < 3; ++i) add(double(v[i]));
  }
};

void print(const Output& out, const std::string& name, const char* scalar, const Row& row) {
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(row.hash.value()));
  out.row(name + "," + scalar + "," + hash, row.unit, row.sum);
}

/// Poses of a tool that comes down, rocks, turns, slides to and fro and leaves.
template <Real S>
std::vector<Pose<S>> path(double top) {
  std::vector<Pose<S>> poses(300);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double t = double(i) / 300, phase = 2 * std::numbers::pi * t;
    const double depth = 2.5e-3 * std::sin(std::numbers::pi * t) - 2e-4;
    poses[i].translation =
        Vec3<S>(S(3e-3 * std::sin(3 * phase)), S(top - depth), S(2e-3 * std::sin(2 * phase)));
    const Eigen::AngleAxis<S> rock(S(0.1 * std::sin(4 * phase)), Vec3<S>(S(0.6), S(0), S(0.8))),
        spin(S(0.3 * std::sin(phase)), Vec3<S>::UnitY());
    poses[i].rotation = (spin * rock).toRotationMatrix();
  }
  return poses;
}

template <class Solver>
void wrenches(const Output& out, const std::string& name, double top, typename Solver::Parts parts) {
  using S = typename Solver::Scalar;
  Solver solver(std::move(parts));
  Row row{"N"};
  for (const Pose<S>& X : path<S>(top)) {
    const auto felt = solver.tick(X, S(1e-3));
    row.add(felt.wrench.force);
    row.add(felt.wrench.torque);
    row.add(double(static_cast<unsigned>(felt.status)));
    for (const auto& contact : solver.contacts()) row.add(contact.displacement);
  }
  print(out, name, scalar_name<S>, row);
}

template <Real S, class Body>
void body(const Output& out, const std::string& name, const Body& surface, double top) {
  using Law = DuffingForce<S>;
  using Fibre = PowerLawFriction<S>;
  wrenches<ContactSolver<Body, Law, Fibre>>(out, name + " point", top,
                                            {surface, {}, duffing<S>(), fibre<S>(), {}});
  wrenches<ContactSolver<Body, Law, Fibre, SingleRegion<AreaSharing>>>(
      out, name + " region", top, {surface, face<S>(100, 1), duffing<S>(), fibre<S>(), {}});
  wrenches<ContactSolver<Body, Law, Fibre, Regions<4, AreaSharing>>>(
      out, name + " regions", top, {surface, face<S>(100, 4), duffing<S>(), fibre<S>(), {joining}});
}

template <Real S>
void bodies(const Output& out) {
  const Vec3<S> axes(S(0.06), S(0.04), S(0.04));
  body<S>(out, "sphere", Sphere<S>({.radius = S(0.05)}), 0.05);
  body<S>(out, "ellipsoid", ellipsoid<S>(), 0.04);
  body<S>(out, "box", Box<S>({.half = axes}), 0.04);
  body<S>(out, "cylinder", Cylinder<S>({.radius = S(0.05), .half_height = S(0.04)}), 0.04);
  const Superellipsoid<S> pill({.axes = axes, .e1 = S(0.5), .e2 = S(0.5)});
  body<S>(out, "superellipsoid", pill, 0.04);
  body<S>(out, "superellipsoid of broken powers",
          Superellipsoid<S>({.axes = axes, .e1 = S(0.3), .e2 = S(0.7)}), 0.04);
  body<S>(out, "superellipsoid sampled", SampledSurface<Superellipsoid<S>>(pill, {.spacing = S(2e-3)}), 0.04);
  body<S>(out, "mesh", MeshSurface<S>(TriangleMesh<S>(ellipsoid<S>().mesh(2000))), 0.04);

  const DuffingForce<S> law = duffing<S>();
  std::vector<typename TabulatedForce<S, 32>::Sample> samples;
  for (int i = 0; i < 32; ++i) samples.push_back({S(2e-4) * S(i), law.force(S(2e-4) * S(i))});
  const CoulombFriction<S> coulomb({.mu_static = S(0.5), .mu_dynamic = S(0.3)});
  wrenches<ContactSolver<Ellipsoid<S>, TabulatedForce<S, 32>, CoulombFriction<S>, Regions<4, AreaSharing>>>(
      out, "tabulated law Coulomb", 0.04,
      {ellipsoid<S>(), face<S>(100, 4), TabulatedForce<S, 32>(samples), coulomb, {joining}});
  wrenches<ContactSolver<Ellipsoid<S>, HertzForce<S>, CoulombFriction<S>>>(
      out, "Hertz law Coulomb", 0.04,
      {ellipsoid<S>(), {}, HertzForce<S>({.k = S(1e5), .compliance = S(1e-3)}), coulomb, {}});
  wrenches<ContactSolver<Ellipsoid<S>, DampedForce<SaturatedForce<DuffingForce<S>>, Viscous>, Frictionless<S>,
                         SingleRegion<EqualSharing>, NoDeformation<S>, AtMassCentre>>(
      out, "damped saturated law at the mass centre", 0.04,
      {ellipsoid<S>(),
       face<S>(100, 1),
       DampedForce<SaturatedForce<DuffingForce<S>>, Viscous>(
           SaturatedForce<DuffingForce<S>>(law, {.limit = S(2)}), {.damping = S(0.5)}),
       {},
       {}});
  using Coupling = RegionSkeletons<Skeleton<S>>;
  std::vector<Vec3<S>> ends;
  for (const auto& end : extremal_points(ellipsoid<S>())) ends.push_back(end.position);
  wrenches<ContactSolver<Ellipsoid<S>, DuffingForce<S>, PowerLawFriction<S>, Regions<4, AreaSharing>,
                         NoDeformation<S>, AtContact, Coupling>>(
      out, "coupled regions", 0.04,
      {ellipsoid<S>(),
       face<S>(100, 4),
       law,
       fibre<S>(),
       {joining},
       {},
       Coupling(Skeleton<S>(ends, EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e5, .nu = 0.5})),
                            VolumePreserving<double>({.volume = ellipsoid<double>().volume()})))});
}

/// The shape under two contacts that move along bench/response's path.
template <class Model, Real T>
void shape(const Output& out, const std::string& name, Model& model, const MeshData<T>& mesh) {
  std::vector<float> positions(3 * mesh.vertices.size()), normals(positions.size());
  const VertexBuffer<float> buffer{.positions = positions.data(), .normals = normals.data()};
  model.write_rest(buffer);
  Row row{"m"};
  for (std::size_t k = 0; k < 20; ++k) {
    std::array<ContactState<double>, 2> contacts{contact_on_path(k, 20).state,
                                                 contact_on_path(k + 10, 20).state};
    for (ContactState<double>& c : contacts) {
      c.force = 500 * c.normal;
      c.normal_force = 0.5;
      c.points = 20;
    }
    model.write(std::span<const ContactState<double>>(contacts.data(), 1 + k % 2), buffer);
    for (const float x : positions) row.add(x);
    for (const float x : normals) row.add(x);
  }
  print(out, name, "float", row);
}

template <class I>
void skeleton_shape(const Output& out, const std::string& name, const MeshData<float>& mesh) {
  BeamSkeletonDeformation<Beams, I> model(beams(), I(make_partition(ellipsoid<float>(), mesh)),
                                          AreaNeighbourhood<float>({}), mesh, {.fixed = bottom});
  shape(out, name, model, mesh);
}

void shapes(const Output& out) {
  const MeshData<float> mesh = ellipsoid<float>().mesh(3000);
  skeleton_shape<PhongInterpolation<float>>(out, "skeleton Phong", mesh);
  skeleton_shape<LinearInterpolation<float>>(out, "skeleton linear", mesh);
  skeleton_shape<SmoothInterpolation<float>>(out, "skeleton smooth", mesh);
  const MeshData<double> body = ellipsoid<double>().mesh(3000);
  const auto fixed = [](const auto& p) { return p.y() <= -0.036; };
  HalfSpaceDeformation<double> half_space(body, fixed, {.nu = 0.49});
  shape(out, "half-space", half_space, body);

  for (const double nu : {0.5, 0.3}) {
    const std::string of = nu < 0.5 ? " nu 0.3" : " nu 0.5";
    const auto field = std::make_shared<const ResponseField>(
        ellipsoid<double>().mesh(2000), fixed,
        ResponseField::Params{.E = 1.5e6, .nu = nu, .mesh = {.vertices = 160}, .threads = 1});
    Row saved{"bytes"};
    for (const std::byte b : save_response_field(*field)) saved.add(double(std::to_integer<int>(b)));
    print(out, "response field" + of, "float", saved);

    ResponseTick<4> tick(*field);
    Row forces{"N"};
    for (std::size_t k = 0; k < 60; ++k) {
      const PathContact at = contact_on_path(k, 60);
      std::array<Vec3<double>, 2> force, torque;
      forces.add(
          double(static_cast<unsigned>(tick.solve(at.patches.data(), 2, force.data(), torque.data()))));
      for (std::size_t c = 0; c < 2; ++c) forces.add(force[c]), forces.add(torque[c]);
      tick.solve(&at.turned, 1, force.data(), torque.data());
      forces.add(force[0]), forces.add(torque[0]);
      forces.add(tick.solve(at.ball).force);
    }
    print(out, "response tick" + of, "double", forces);
    ResponseFieldDeformation<double> model(field, mesh);
    shape(out, "response shape" + of, model, mesh);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(argc, argv, "result,scalar,hash");
  bodies<double>(out);
  bodies<float>(out);
  shapes(out);
}
