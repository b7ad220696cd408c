// SPDX-License-Identifier: MIT

/// @file Run time against error of the deformed shape, against nonlinear finite elements (truth/data): what
/// the library ships ("palpate ...") and baselines that a user might pick instead.
///
/// A bonded patch goes straight down, 20 ticks per millimetre, to 8 mm. time_us is the mean tick's processor
/// time (so that others on the machine count little), display included (1,792 and 1,954 vertices); vertices
/// are those that the model computes with. Errors are relative, means over depths of 1, 2, 4 and 8 mm;
/// force_error_rms is over the same depths.
///
/// In the baselines' favour: the finite elements and the springs know the contact's position at set-up, their
/// meshes are fitted to the patch, and the springs' stiffness is fitted to the first depth's force. Their
/// display vertices within the patch take the tool's displacement.

#include "scenes.hpp"
#include "work_precision_shape/finite_elements.hpp"
#include "work_precision_shape/particles.hpp"

#include <palpate/elasticity/half_space.hpp>
#include <palpate/response/response_contact.hpp>
#include <palpate/response/response_display.hpp>

#include <functional>
#include <optional>

namespace {

using namespace bench;

constexpr double tick_depth = 5e-5;  // [m]

struct Table {
  const Output& out;
  const Truth& truth;

  /// `tick(depth)` moves on to a depth and returns the force [N]; `shape()` is the displacement of the
  /// display vertices.
  void row(const std::string& model, const char* scalar, std::size_t vertices, double setup_ms,
           const std::function<double(double)>& tick, const std::function<const std::vector<V>&()>& shape,
           const std::function<void()>& reset, double bound = 0, int repeats = 3,
           bool fit_force = false) const {
    ShapeError mean;
    double time = 1e300, square = 0, factor = 1;
    for (int r = 0; r < repeats; ++r) {
      reset();
      std::int64_t spent = 0;
      std::size_t ticks = 0;
      for (std::size_t d = 0; d < truth.depth.size(); ++d) {
        const auto last = static_cast<std::size_t>(std::lround(truth.depth[d] / tick_depth));
        double force = 0;
        const std::int64_t begin = processor_ns();
        for (; ticks < last; ++ticks) force = tick(tick_depth * double(ticks + 1));
        spent += processor_ns() - begin;
        if (r > 0) continue;
        const ShapeError e = judge(truth, d, shape());
        const double n = double(truth.depth.size());
        mean.l2 += e.l2 / n, mean.far_l2 += e.far_l2 / n, mean.most += e.most / n;
        if (fit_force && d == 0) factor = truth.force[0] / force;
        square += (factor * force / truth.force[d] - 1) * (factor * force / truth.force[d] - 1) / n;
      }
      time = (std::min)(time, double(spent) / double(ticks));
    }
    for (double* e : {&mean.l2, &mean.far_l2, &mean.most, &square})
      if (!is_finite(*e) || *e > 1e6) *e = std::numeric_limits<double>::infinity();  // diverged
    char text[320];
    std::snprintf(text, sizeof text, "%s,%s,%s,%zu,%.4g,%.4g,%.4f,%.4f,%.4f,%.4f", truth.name.c_str(),
                  model.c_str(), scalar, vertices, setup_ms, 1e-3 * time, mean.l2, mean.far_l2, mean.most,
                  std::sqrt(square));
    out.row(text, "error_l2", mean.l2);
    if (bound > 0) out.require_below(truth.name + " " + model, mean.l2, bound);
  }
};

template <class F>
double timed_ms(const F& f) {
  const auto begin = Clock::now();
  f();
  return 1e-6 * double(nanoseconds(begin, Clock::now()));
}

/// The calibrated law: least squares through the reference's own force.
DuffingForce<double> fitted_law(const Truth& t) {
  double a11 = 0, a12 = 0, a22 = 0, b1 = 0, b2 = 0;
  for (std::size_t i = 0; i < t.depth.size(); ++i) {
    const double d = t.depth[i], d3 = d * d * d, w = 1 / (t.force[i] * t.force[i]);
    a11 += w * d * d, a12 += w * d * d3, a22 += w * d3 * d3, b1 += w * d * t.force[i],
        b2 += w * d3 * t.force[i];
  }
  const double det = a11 * a22 - a12 * a12;
  return DuffingForce<double>({.c1 = (b1 * a22 - b2 * a12) / det, .c3 = (a11 * b2 - a12 * b1) / det});
}

void no_deformation(const Table& table) {
  const DuffingForce<double> law = fitted_law(table.truth);
  const std::vector<V> still(table.truth.rest.size(), V::Zero());
  // Nothing is drawn, so all of the displacement is missing.
  table.row(
      "palpate NoDeformation", "double", still.size(), 0, [&](double d) { return law.force(d); },
      [&]() -> const std::vector<V>& { return still; }, [] {}, 1.0 + 1e-12);
}

// The row of a deformation model that writes D; its force is that of the fitted law.
template <class D, class Model>
void drawn(const Table& table, const std::string& name, double setup, Model& model, double bound) {
  const Truth& t = table.truth;
  const DuffingForce<double> law = fitted_law(t);
  std::vector<D> rest(3 * t.rest.size()), now(rest.size());
  model.write_rest(VertexBuffer<D>{.positions = rest.data()});
  const VertexBuffer<D> buffer{.positions = now.data()};
  std::vector<V> u(t.rest.size());
  table.row(
      name, scalar_name<D>, t.rest.size(), setup,
      [&](double d) {
        const double F = law.force(d);
        const ContactState<double> contact = pressed(t, d, F);
        (void)model.write(std::span<const ContactState<double>>(&contact, 1), buffer);
        return F;
      },
      [&]() -> const std::vector<V>& {
        for (std::size_t v = 0; v < u.size(); ++v)
          for (int i = 0; i < 3; ++i)
            u[v][i] = double(now[3 * v + std::size_t(i)] - rest[3 * v + std::size_t(i)]);
        return u;
      },
      [&] { model.write_rest(buffer); }, bound);
}

template <template <class> class Field, class D, class Body>
void skeleton(const Table& table, const char* name, const Body& body, const V& bottom, double volume,
              double bound) {
  const Truth& t = table.truth;
  using Beams = Skeleton<double>;
  using Model = BeamSkeletonDeformation<RegionSkeletons<Beams>, Field<D>>;
  MeshData<D> mesh;
  for (const V& x : t.rest) mesh.vertices.push_back(x.cast<D>());
  std::optional<Model> model;
  const double setup = timed_ms([&] {
    std::vector<V> ends;
    for (const auto& end : extremal_points(body)) ends.push_back(end.position.template cast<double>());
    model.emplace(RegionSkeletons<Beams>(
                      Beams(ends, EulerBernoulli<double>(IsotropicElasticity<double>({.E = t.E, .nu = t.nu})),
                            VolumePreserving<double>({.volume = volume}))),
                  Field<D>(make_partition(body, mesh)),
                  AreaNeighbourhood<D>({.reference_area = D(4 * t.patch * t.patch)}), mesh,
                  typename Model::Params{.fixed = bottom, .normals = false});
  });
  drawn<D>(table, std::string("palpate BeamSkeleton ") + name, setup, *model, bound);
}

void half_space(const Table& table, double bound) {
  const Truth& t = table.truth;
  std::optional<HalfSpaceDeformation<double>> model;
  const double setup = timed_ms([&] {
    model.emplace(
        MeshData<double>{t.rest, t.triangles}, [&](const V& p) { return p.y() <= t.fixed_height(); },
        HalfSpaceDeformation<double>::Params{.nu = t.nu, .smallest_radius = t.patch, .normals = false});
  });
  drawn<double>(table, "palpate HalfSpace", setup, *model, bound);
}

void response(const Table& table, double vertices, double bound) {
  const Truth& t = table.truth;
  const MeshData<double> mesh{t.rest, t.triangles};
  std::optional<ResponseField> field;
  const double setup = timed_ms([&] {
    field.emplace(
        mesh, [&](const V& p) { return p.y() <= t.fixed_height(); },
        ResponseField::Params{.E = t.E, .nu = t.nu, .mesh = {.vertices = vertices}});
  });
  const ResponseDisplay display(*field, t.rest);
  std::vector<float> now(3 * t.rest.size(), 0.f);
  std::vector<V> u(t.rest.size());
  for (const bool second_order : {false, true}) {
    ResponseTick<1> model(*field, {.second_order = second_order});
    table.row(
        "palpate ResponseField " + std::to_string(int(vertices)) +
            (second_order ? " second order" : " linear"),
        "float", field->mesh().vertices.size(), setup,
        [&](double d) {
          const ResponseContact<double> contact{
              .position = t.top, .normal = V::UnitY(), .radius = t.patch, .displacement = -d * V::UnitY()};
          V force;
          (void)model.solve(&contact, 1, &force);
          model.displace(display, now.data(), 3);
          return -force.y();
        },
        [&]() -> const std::vector<V>& {
          for (std::size_t v = 0; v < u.size(); ++v)
            u[v] = V(double(now[3 * v]), double(now[3 * v + 1]), double(now[3 * v + 2]));
          return u;
        },
        [] {}, second_order ? bound : 0);
  }
}

void finite_elements(const Table& table, int cells, int order, double nu,
                     const std::vector<int>& corotational_steps) {
  const Truth& t = table.truth;
  std::optional<FiniteElements> model;
  std::optional<Embedding> embedding;
  const double setup = timed_ms([&] {
    model.emplace(make_tetrahedra(t, cells, order), t.E, nu);
    embedding.emplace(model->mesh(), t);
  });
  if (!(model->least_volume > 0)) {
    std::fprintf(stderr, "work_precision_shape: a tetrahedron is turned inside out\n");
    std::exit(2);
  }
  std::vector<V> u(t.rest.size());
  char kind[48];
  std::snprintf(kind, sizeof kind, "%s tetrahedra nu %.2f", order == 1 ? "linear" : "quadratic", nu);
  const auto shape = [&]() -> const std::vector<V>& { return u; };
  table.row(
      "linear FE " + std::string(kind), "double", model->mesh().node.size(), setup,
      [&](double d) {
        const V force = model->linear(-d * V::UnitY());
        embedding->write(model->displacement(), -d * V::UnitY(), u);
        return -force.y();
      },
      shape, [&] { model->reset(); }, 0, 1);
  for (const int steps : corotational_steps)
    table.row(
        "co-rotational FE " + std::string(kind) + " " + std::to_string(steps) + " steps", "double",
        model->mesh().node.size(), setup,
        [&](double d) {
          const V force = model->corotational(-d * V::UnitY(), steps);
          embedding->write(model->displacement(), -d * V::UnitY(), u);
          return -force.y();
        },
        shape, [&] { model->reset(); }, 0, 1);
}

void particles(const Table& table, int cells, const std::vector<int>& spring_steps,
               const std::vector<PositionBased::Settings>& settings, double nu) {
  const Truth& t = table.truth;
  const Tetrahedra mesh = make_tetrahedra(t, cells, 1);
  const Embedding embedding(mesh, t);
  std::vector<V> u(t.rest.size()), moved(mesh.node.size());
  const auto shape = [&]() -> const std::vector<V>& { return u; };
  const auto draw = [&](const std::vector<V>& position, double d) {
    for (std::size_t v = 0; v < moved.size(); ++v) moved[v] = position[v] - mesh.node[v];
    embedding.write(moved, -d * V::UnitY(), u);
  };
  std::optional<MassSpring> springs;
  const double setup = timed_ms([&] { springs.emplace(mesh, t.E); });
  for (const int steps : spring_steps)
    table.row(
        "mass-spring " + std::to_string(steps) + " steps", "double", mesh.node.size(), setup,
        [&](double d) {
          const V force = springs->tick(-d * V::UnitY(), steps);
          draw(springs->position(), d);
          return -force.y();
        },
        shape, [&] { springs->reset(); }, 0, 1, true);
  std::optional<PositionBased> body;
  const double body_setup = timed_ms([&] { body.emplace(mesh, t.E, nu); });
  for (const auto& s : settings) {
    char name[80];
    std::snprintf(name, sizeof name, "XPBD edges and volumes nu %.2f %d x %d sweeps", nu, s.steps,
                  s.iterations);
    table.row(
        name, "double", mesh.node.size(), body_setup,
        [&](double d) {
          const V force = body->tick(-d * V::UnitY(), s);
          draw(body->position(), d);
          return -force.y();
        },
        shape, [&] { body->reset(); }, 0, 1);
  }
}

void all(const Output& out, const Truth& truth) {
  const Table table{out, truth};
  no_deformation(table);
  // The skeleton is known to be no better than drawing nothing; the bound keeps it from becoming worse.
  const double worst = 2;
  if (truth.is_cube()) {
    const auto body = [](auto zero) {
      using S = decltype(zero);
      return Box<S>({.half = Vec3<S>(S(0.05), S(0.05), S(0.05)), .centre = Vec3<S>(S(0), S(0.05), S(0))});
    };
    skeleton<LinearInterpolation, double>(table, "linear", body(0.0), V::Zero(), 1e-3, worst);
    skeleton<PhongInterpolation, double>(table, "Phong", body(0.0), V::Zero(), 1e-3, worst);
    skeleton<PhongInterpolation, float>(table, "Phong", body(0.f), V::Zero(), 1e-3, worst);
    skeleton<SmoothInterpolation, double>(table, "smooth", body(0.0), V::Zero(), 1e-3, worst);
  } else {
    const auto body = [](auto zero) {
      using S = decltype(zero);
      return ellipsoid<S>();
    };
    const double volume = ellipsoid<double>().volume();
    const V bottom(0, -0.04, 0);
    skeleton<LinearInterpolation, double>(table, "linear", body(0.0), bottom, volume, worst);
    skeleton<PhongInterpolation, double>(table, "Phong", body(0.0), bottom, volume, worst);
    skeleton<PhongInterpolation, float>(table, "Phong", body(0.f), bottom, volume, worst);
    skeleton<SmoothInterpolation, double>(table, "smooth", body(0.0), bottom, volume, worst);
  }
  // 0.12 and 0.18 on these bodies: its sides are not free of traction.
  half_space(table, 0.23);
  // Below 600 vertices the error goes with one over their number; there it is 2 to 3 %, the reference's own
  // included.
  if (out.quick) {
    response(table, 150, 0.1);
    finite_elements(table, 8, 1, 0.45, {2});
    particles(table, 8, {1}, {{2e-4, 1, 4}}, 0.45);
    return;
  }
  for (const double n : {75.0, 150.0, 300.0, 600.0}) response(table, n, n >= 600 ? 0.04 : n >= 150 ? 0.1 : 0);
  finite_elements(table, 8, 1, 0.45, {1, 2, 8});
  finite_elements(table, 16, 1, 0.45, {2});
  finite_elements(table, 8, 2, truth.nu, {});
  finite_elements(table, 8, 2, 0.45, {2});
  // The steps' length is the best of 0.1 to 10 ms.
  for (const int cells : {8, 16})
    particles(table, cells, {1, 4, 16}, {{2e-4, 1, 1}, {2e-4, 1, 4}, {2e-4, 1, 16}}, 0.45);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: %s OUTPUT.csv FOLDER_OF_TRUTH [--quick]\n", argv[0]);
    return 2;
  }
  const std::string folder = argv[2];
  std::vector<char*> arguments(argv, argv + argc);
  arguments.erase(arguments.begin() + 2);
  const Output out(
      argc - 1, arguments.data(),
      "case,model,scalar,vertices,setup_ms,time_us,error_l2,error_far_l2,error_max,force_error_rms");
  for (const char* body : {"ellipsoid", "cube"}) all(out, read_truth(folder, body));
  return out.failures == 0 ? 0 : 1;
}
