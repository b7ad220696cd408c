// SPDX-License-Identifier: MIT
// The turn of a contact that friction holds: placed half way back, drawn where it was.
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/detail/contact_turn.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/resolved/response_load_deformation.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/on_half_space.hpp>
#include <support/paths.hpp>
#include <support/response_fields.hpp>

#include <algorithm>
#include <memory>

using namespace palpate;
using namespace palpate::test;

namespace {

using V = Vec3<double>;
using detail::ContactTurn;
using detail::SimdVec3;

V of(const SimdVec3<double>& v) { return {v.x, v.y, v.z}; }
SimdVec3<double> of(const V& v) { return {v.x(), v.y(), v.z()}; }

/// Two rings of points about `middle`, turned about m by `angle` and moved by `shift`.
struct Rings {
  static constexpr double small = 2e-3, large = 4e-3;  // [m]
  V m = V(1, 2, -2) / 3, middle = V(3e-3, -1e-3, 2e-3), shift;
  double angle;
  ContactTurn turn;

  Rings(double by, const V& moved) : shift(moved), angle(by) {
    for (int i = 0; i < 24; ++i)
      turn.add(half_way(i).cast<float>(), i < 12 ? 2.f : 1.f,
               (shift + at(i, angle / 2) - at(i, -angle / 2)).cast<float>(), m.cast<float>());
    turn.build();
  }
  [[nodiscard]] V at(int i, double turned) const {
    return rotation_about<double>(m, turned) * (rotation_about<double>(m, 0.5236 * i) * arm(i));
  }
  [[nodiscard]] V arm(int i) const { return (i < 12 ? small : large) * m.unitOrthogonal(); }
  [[nodiscard]] V half_way(int i) const { return middle + at(i, 0); }
};

auto sticking(const MeshData<double>& tool, const auto& body) {
  return on_half_space(tool, 0.0012, CoulombFriction<double>({.mu_static = 10, .mu_dynamic = 10}), body);
}
Pose<double> turned(double height, double angle) {
  Pose<double> X;
  X.rotation = rotation_about<double>(V::UnitY(), angle);
  X.translation = V(0, height, 0);
  return X;
}

}  // namespace

TEST_CASE("a contact that has moved and turned goes half way back, and all the way to where it was") {
  for (const double angle : {0.0, 1e-3, 0.4, -1.0}) {
    CAPTURE(angle);
    const Rings rings(angle, V(1e-3, -2e-3, 1e-3));
    for (const int i : {0, 5, 14, 23}) {
      // Sums in float over 4 mm: some 1e-9.
      const V now = rings.middle + rings.shift + rings.at(i, angle / 2),
              half = now + of(rings.turn.from_now(of(now))) - rings.shift;
      CHECK((half - rings.half_way(i)).norm() <= 1e-8);
      const V before = half + of(rings.turn.from_half_way(of(half)));
      CHECK((before - rings.middle - rings.at(i, -angle / 2)).norm() <= 1e-8);
      CHECK((before - half).norm() <= rings.turn.most() + 1e-9);
      // Beside the turn all have moved by `shift`.
      const V moved = of(rings.turn.beside(of(half), of(V(now - before))));
      CHECK((moved - rings.shift).norm() <= 1e-8);
    }
  }
}

TEST_CASE("beyond a contact its turn fades, and nothing is turned by more than 60 degrees") {
  const Rings rings(3, V::Zero());
  // R^2 = 3 (24 4e-6 + 12 16e-6)/36 = 24e-6; to rounding of float, and of 0.5236 for pi/6.
  const double R = std::sqrt(24.) * 1e-3;
  const auto length = [&](double r) {
    return of(rings.turn.from_half_way(of(V(rings.middle + r * rings.m.unitOrthogonal())))).norm();
  };
  CHECK_RELATIVE(length(0.9 * R), 2 * std::sin(0.5236 / 2) * 0.9 * R, 1e-5);
  CHECK_RELATIVE(length(4 * R), 2 * std::sin(std::asin(0.5 / 16) / 2) * 4 * R, 1e-5);
  CHECK(length(R) <= rings.turn.most());
}

TEST_CASE("a tool that sticks and is turned presses on as hard, on a flat body and on a ball") {
  // Measured, of the force: 2e-4 and 4e-4. From where the points are now a turn would seem to stretch the
  // surface, by theta^2/2: 8e-3 and 1e-2.
  const MeshData<double> ball = Sphere<double>({.radius = 0.015}).mesh(2000);
  const auto check = [&](auto solver, double top) {
    double pressed = 0;
    for (int i = 1; i <= 100; ++i) pressed = solver.tick(turned(top - 1e-5 * i, 0)).wrench.force.y();
    for (int i = 1; i <= 200; ++i) {
      const auto felt = solver.tick(turned(top - 1e-3, 0.5 * i / 200)).wrench;
      CHECK_RELATIVE(felt.force.y(), pressed, 1e-3);
    }
  };
  check(sticking(ball, ground()), 0.015);
  check(sticking(ball, Sphere<double>({.radius = 0.02})), 0.035);
}

TEST_CASE("what sticks to a tool that turns is drawn where that takes it") {
  // A ball of 15 mm, 4 mm deep, mu = 5: vertices 1 to 3 mm from the middle, of a contact of 6 mm.
  constexpr double angle = 0.5, R = 0.015, depth = 0.004;
  const V axes(0.06, 0.04, 0.04);
  MeshData<double> mesh;
  for (int i = 0; i < 100; ++i) {
    const double r = 0.001 + 2e-5 * i, phi = 2.399963 * i, x = r * std::cos(phi), z = r * std::sin(phi);
    mesh.vertices.emplace_back(
        x, axes.y() * std::sqrt(1 - x * x / (axes.x() * axes.x()) - z * z / (axes.z() * axes.z())), z);
  }
  const auto field = std::make_shared<const ResponseField>(ellipsoid_field(0.49, 400));
  using Elastic = ElasticContact<double, ResponseCompliance>;
  using Shape = ResponseLoadDeformation<double>;
  ContactSolver<Ellipsoid<double>, Elastic, CoulombFriction<double>, ContactPoints<256>, Shape> solver(
      {.object = Ellipsoid<double>({.axes = axes}),
       .tool = ToolPoints<double>(
           contact_samples(TriangleMesh<double>(Sphere<double>({.radius = R}).mesh(2000)), 0.00125),
           {.contact_area = 1e-4}),
       .force = Elastic({.compliance = ResponseCompliance(field)}),
       .friction = CoulombFriction<double>({.mu_static = 5, .mu_dynamic = 5}),
       .deformation = Shape(field, mesh, false)});
  for (int i = 1; i <= 100; ++i) (void)solver.tick(turned(axes.y() + R - depth * i / 100, 0), 1e-3);
  for (int i = 1; i <= 100; ++i) (void)solver.tick(turned(axes.y() + R - depth, angle * i / 100), 1e-3);
  std::vector<V> drawn = mesh.vertices;
  VertexBuffer<double> buffer;
  buffer.positions = drawn.front().data();
  FixedVector<SurfaceLoad<double>, 256> loads;
  solver.state().loads(loads);
  (void)solver.draw({loads.begin(), loads.size()}, buffer);
  // Where a linear field has it: the tractions are turned beside where they act now, and nu = 1/2 is twice as
  // stiff to what points outward as to what goes round. Measured: 1.6 % and 8.7 % of the distance from the
  // middle; if the loads were drawn half way back 12 % too far out.
  const Mat3<double> turn = rotation_about<double>(V::UnitY(), angle);
  for (std::size_t v = 0; v < drawn.size(); ++v) {
    const V wanted = turn * mesh.vertices[v], out = V(wanted.x(), 0, wanted.z()),
            off = (drawn[v] - wanted) / out.norm();
    CHECK(std::abs(off.dot(V::UnitY().cross(out.normalized()))) <= 0.02);
    CHECK(std::abs(off.dot(out.normalized())) <= 0.1);
  }
}
