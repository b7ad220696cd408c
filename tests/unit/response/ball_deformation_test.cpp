// SPDX-License-Identifier: MIT
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/response/ball_deformation.hpp>

#include "support/check.hpp"
#include "support/no_heap.hpp"
#include "support/response_meshes.hpp"

#include <memory>
#include <vector>

namespace {
using namespace palpate;
using V = Vec3<double>;
using Model = ResponseBallDeformation<double, Ellipsoid<double>>;
static_assert(DeformationModel<Model>);

const V axes(0.06, 0.04, 0.04);
const double R = 0.012;

std::shared_ptr<const ResponseField> small_field() {
  static const auto field = std::make_shared<const ResponseField>(
      test::ellipsoid_mesh(axes, 8), [](const V& p) { return p.y() <= -0.03; },
      ResponseField::Params{.E = 1e5, .nu = 0.5, .mesh = {.vertices = 60}, .threads = 1});
  return field;
}
/// Of the ball's centre with the body grown by R, `depth` in and dragged by `across`.
ContactState<double> press(double depth, const V& across) {
  ContactState<double> c{};
  c.normal = V::UnitY();
  c.displacement = across - depth * c.normal;
  c.centre = V(0, 0.04 + R, 0) + c.displacement;
  return c;
}
}  // namespace

TEST_CASE("ball deformation: the field of the pressed sphere, and of the drag on top") {
  const MeshData<double> mesh = test::ellipsoid_mesh(axes, 10);
  const std::size_t n = mesh.vertices.size();
  const Ellipsoid<double> body({.axes = axes});
  Model model(small_field(), mesh, body, {.radius = R});
  const ResponseDisplay display(*small_field(), mesh.vertices);
  ResponseTick<1> tick(*small_field());
  std::vector<double> p(3 * n), q(3 * n), pressed(3 * n), dragged(3 * n);
  const VertexBuffer<double> out{.positions = p.data(), .normals = q.data()};
  model.write_rest(out);
  for (std::size_t v = 0; v < n; ++v) CHECK_ABSOLUTE(p[3 * v + 1], mesh.vertices[v].y(), 3e-9);  // float
  const double depth = 0.004;
  const Curvature<double> k = body.curvature(V(0, 0.04, 0));
  const PressedSphere asked =
      tick.solve(SphereContact<double>{V(0, 0.04, 0), V::UnitY(), R, k.k1 + k.k2, depth});
  tick.displace(display, pressed.data(), 3);
  const ResponseContact<double> patch{.position = V(0, 0.04, 0),
                                      .normal = V::UnitY(),
                                      .radius = asked.radius,
                                      .displacement = V(0.001, 0, 0)};
  V force;
  tick.solve(&patch, 1, &force);
  tick.displace(display, dragged.data(), 3);
  const auto worst = [&](double drag) {
    double most = 0;
    for (std::size_t v = 0; v < n; ++v)
      for (std::size_t i = 0; i < 3; ++i)
        most = (std::max)(most, std::abs(p[3 * v + i] - mesh.vertices[v][Eigen::Index(i)] -
                                         pressed[3 * v + i] - drag * dragged[3 * v + i]));
    return most;
  };
  const ContactState<double> straight = press(depth, V::Zero()), askew = press(depth, V(0.001, 0, 0));
  const test::HeapCount heap;
  CHECK(model.write(std::span(&straight, 1), out).vertices == n);
  CHECK(worst(0) < 1e-8);  // float's rounding of 0.06 m
  CHECK(model.pressed().force == asked.force);
  CHECK(model.write(std::span(&straight, 1), out).vertices == 0);  // the same: not touched
  CHECK(model.write(std::span(&askew, 1), out).vertices == n);
  CHECK(worst(1) < 1e-8);
  CHECK(model.write(std::span<const ContactState<double>>(), out).vertices == n);
  CHECK(heap.allocations() == 0);
  for (std::size_t v = 0; v < n; ++v) CHECK_ABSOLUTE(p[3 * v + 1], mesh.vertices[v].y(), 3e-9);
}

TEST_CASE("ball deformation: surplus and bad contacts, bad parameters") {
  const MeshData<double> mesh = test::ellipsoid_mesh(axes, 6);
  Model model(small_field(), mesh, Ellipsoid<double>({.axes = axes}), {.radius = R, .normals = false});
  std::vector<float> p(3 * mesh.vertices.size());
  const VertexBuffer<float> out{.positions = p.data()};
  model.write_rest(out);
  const std::vector<float> rest = p;
  ContactState<double> two[2] = {press(0.002, V::Zero()), press(0.001, V::Zero())};
  CHECK(has(model.write(std::span<const ContactState<double>>(two), out).status, Status::region_overflow));
  CHECK(p != rest);
  two[0].normal.x() = std::numeric_limits<double>::quiet_NaN();
  CHECK(has(model.write(std::span<const ContactState<double>>(two, 1), out).status, Status::invalid_pose));
  CHECK(p == rest);
  // A contact that does not press, as one that an adhesive law might give, draws nothing.
  const ContactState<double> away = press(-0.001, V::Zero());
  CHECK(model.write(std::span(&away, 1), out).status == Status::ok);
  CHECK(p == rest);
  CHECK_THROWS_AS(Model(small_field(), mesh, Ellipsoid<double>({.axes = axes}), {.radius = 0}), SetupError);
}
