// SPDX-License-Identifier: MIT
#include <palpate/response/deformation.hpp>

#include "support/check.hpp"
#include "support/no_heap.hpp"
#include "support/response_meshes.hpp"

namespace {
using namespace palpate;
using V = Vec3<double>;
using Model = ResponseFieldDeformation<double, 2>;
static_assert(DeformationModel<Model> && DeformationModel<ResponseFieldDeformation<float>>);

std::shared_ptr<const ResponseField> small_field() {
  static const auto field = std::make_shared<const ResponseField>(
      test::ellipsoid_mesh(V(0.06, 0.04, 0.04), 8), [](const V& p) { return p.y() <= -0.03; },
      ResponseField::Params{.E = 1e5, .nu = 0.5, .mesh = {.vertices = 60}, .threads = 1});
  return field;
}
ContactState<double> push(const V& position, const V& normal, double depth, double area) {
  ContactState<double> c{};
  c.id = 1;
  c.points = 1;
  c.normal = normal;
  c.displacement = -depth * normal;
  c.centre = position + c.displacement;
  c.area = area;
  return c;
}
}  // namespace

TEST_CASE("response field as a deformation model: rest, patch, normals, box, nothing new") {
  const MeshData<double> mesh = test::ellipsoid_mesh(V(0.06, 0.04, 0.04), 16);
  const std::size_t n = mesh.vertices.size();
  Model model(small_field(), mesh);
  std::vector<float> p(4 * n, 7.f), q(3 * n);
  const VertexBuffer<float> out{p.data(), 4 * sizeof(float), q.data()};
  model.write_rest(out);
  for (std::size_t v = 0; v < n; ++v) {
    CHECK(p[4 * v] == static_cast<float>(mesh.vertices[v].x()));
    CHECK(p[4 * v + 3] == 7.f);  // the stride's gap is the caller's
    const V normal(mesh.vertices[v].x() / 0.0036, mesh.vertices[v].y() / 0.0016,
                   mesh.vertices[v].z() / 0.0016);
    CHECK(normal.normalized().dot(V(double(q[3 * v]), double(q[3 * v + 1]), double(q[3 * v + 2]))) >
          0.98);  // 16 squares per side: 10 degrees apart
  }
  const double area = std::numbers::pi * 0.008 * 0.008;
  const ContactState<double> one = push(V(0, 0.04, 0), V::UnitY(), 0.004, area);
  Moved<double> moved;
  const test::HeapCount heap;
  moved = model.write(std::span(&one, 1), out);
  CHECK(heap.allocations() == 0);
  CHECK(moved.vertices == n);
  CHECK(moved.status == Status::ok);
  Eigen::Vector3f low = Eigen::Vector3f::Constant(9), high = -low;
  double shown = 0;
  for (std::size_t v = 0; v < n; ++v) {
    const Eigen::Vector3f at(p[4 * v], p[4 * v + 1], p[4 * v + 2]);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
    if ((mesh.vertices[v] - V(0, 0.04, 0)).norm() < 0.0079) {
      CHECK_ABSOLUTE(double(at.y()), mesh.vertices[v].y() - 0.004, 1e-8);  // float's rounding
      ++shown;
    }
    if (mesh.vertices[v].y() < -0.036)
      CHECK_ABSOLUTE(double(at.y()), mesh.vertices[v].y(), 1e-3 * 0.004);  // fixed
  }
  CHECK(shown > 3);
  CHECK(low.cast<double>() == moved.lower);
  CHECK(high.cast<double>() == moved.upper);
  CHECK(model.forces()[0].y() < 0);  // on the object
  p[0] = 3.f;
  CHECK(model.write(std::span(&one, 1), out).vertices == 0);  // the same: not touched
  CHECK(p[0] == 3.f);
  model.write_rest(out);
  const std::vector<float> rest = p;
  CHECK(model.write(std::span(&one, 1), out).vertices == n);
  CHECK(p != rest);
  // Letting go gives the rest shape back.
  CHECK(model.write(std::span<const ContactState<double>>(), out).vertices == n);
  for (std::size_t v = 0; v < n; ++v) CHECK(p[4 * v + 1] == static_cast<float>(mesh.vertices[v].y()));
}

TEST_CASE("response field as a deformation model: surplus and bad contacts, point contacts, both buffers") {
  const MeshData<double> mesh = test::ellipsoid_mesh(V(0.06, 0.04, 0.04), 10);
  const std::size_t n = mesh.vertices.size();
  Model model(small_field(), mesh, {.normals = false});
  std::vector<double> p(3 * n);
  const VertexBuffer<double> out{p.data()};
  model.write_rest(out);
  const ContactState<double> good = push(V(0, 0.04, 0), V::UnitY(), 0.004, 0);
  CHECK(model.write(std::span(&good, 1), out).vertices == n);
  for (double x : p) CHECK(is_finite(x));
  ContactState<double> many[4] = {push(V(0.06, 0, 0), V::UnitX(), 0.002, 1e-4), good,
                                  push(V(0, 0, 0.04), V::UnitZ(), 0.001, 1e-4), good};
  many[0].displacement.x() = std::numeric_limits<double>::quiet_NaN();
  const Moved<double> moved = model.write(std::span<const ContactState<double>>(many), out);
  CHECK(has(moved.status, Status::invalid_pose));
  CHECK(has(moved.status, Status::region_overflow));
  CHECK(moved.vertices == n);
  for (double x : p) CHECK(is_finite(x));
  CHECK_THROWS_AS(Model(small_field(), mesh, {.least_radius = -1}), SetupError);
}
