// SPDX-License-Identifier: MIT
#include "support/check.hpp"
#include "support/no_heap.hpp"

#include <palpate/luo_xiao/beam_skeleton.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>

#include <doctest/doctest.h>

using namespace palpate;

namespace {

const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.02}});
const Vec3<double> bottom(0, -0.02, 0);

template <template <class> class I, class D>
struct Scene {
  using Beams = Skeleton<double>;
  using Model = BeamSkeletonDeformation<RegionSkeletons<Beams>, I<D>>;
  static_assert(DeformationModel<Model>);

  MeshData<D> mesh;
  Model model;

  explicit Scene(std::size_t vertices)
      : mesh(display().mesh(vertices)),
        model(RegionSkeletons<Beams>(Beams(
                  positions(), EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e5, .nu = 0.5})),
                  VolumePreserving<double>({.volume = body.volume()}))),
              I<D>(make_partition(display(), mesh)), AreaNeighbourhood<D>({}), mesh, {.fixed = bottom}) {}

  static Ellipsoid<D> display() { return Ellipsoid<D>({.axes = {D(0.03), D(0.02), D(0.02)}}); }
  static std::vector<Vec3<double>> positions() {
    std::vector<Vec3<double>> result;
    for (const auto& point : extremal_points(display()))
      result.push_back(point.position.template cast<double>());
    return result;
  }
};

ContactState<double> pressed(const Vec3<double>& position, double depth, double force) {
  const Vec3<double> n = body.closest(position).normal;
  ContactState<double> c{};
  c.points = 1;
  c.normal = n;
  c.displacement = -depth * n;
  c.centre = position + c.displacement;
  c.force = force * n;
  c.normal_force = force;
  return c;
}

}  // namespace

TEST_CASE("pressed body: the contact vertex moves by D, the bottom centre stays, zero force moves nothing") {
  Scene<PhongInterpolation, double> scene(400);
  auto& mesh = scene.mesh;
  std::size_t top = 0, low = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (mesh.vertices[i].y() > mesh.vertices[top].y()) top = i;
    if (mesh.vertices[i].y() < mesh.vertices[low].y()) low = i;
  }
  std::vector<double> positions(3 * mesh.vertices.size());
  const VertexBuffer<double> out{.positions = positions.data()};
  scene.model.write_rest(out);
  const auto at = [&](std::size_t i) {
    return Vec3<double>(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
  };
  const std::vector<ContactState<double>> idle{pressed({0, 0.02, 0}, 0, 0)};
  CHECK(scene.model.write(idle, out).vertices == 0);
  const std::vector<ContactState<double>> contacts{pressed({0, 0.02, 0}, 2e-3, 0.5)};
  const auto moved = scene.model.write(contacts, out);
  CHECK(moved.vertices > mesh.vertices.size() / 2);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (at(i) != mesh.vertices[i]) {
      CHECK((at(i).array() >= moved.lower.array()).all());
      CHECK((at(i).array() <= moved.upper.array()).all());
    }
  // Mesh vertices lie on the axis ends to 1e-9 m.
  CHECK((at(top) - mesh.vertices[top] - Vec3<double>(0, -2e-3, 0)).norm() <= 1e-8);
  CHECK((at(low) - mesh.vertices[low]).norm() <= 1e-9);
  CHECK(scene.model.write(contacts, out).vertices == 0);
  const std::vector<double> drawn = positions;
  scene.model.write_rest(out);
  CHECK(scene.model.write(std::vector<ContactState<double>>{}, out).vertices == 0);
  CHECK(scene.model.write(contacts, VertexBuffer<double>{}).vertices == 0);  // no buffer: not taken as drawn
  CHECK(scene.model.write(contacts, out).vertices == moved.vertices);
  CHECK(positions == drawn);
}

TEST_CASE("a second contact that appears with no force changes nothing") {
  Scene<LinearInterpolation, double> one(300), two(300);
  std::vector<double> a(3 * one.mesh.vertices.size()), b(a.size());
  one.model.write_rest(VertexBuffer<double>{.positions = a.data()});
  two.model.write_rest(VertexBuffer<double>{.positions = b.data()});
  const auto first = pressed(body.closest({0.015, 0.02, 0.003}).position, 2e-3, 0.5);
  const auto second = pressed(body.closest({-0.015, 0.02, 0.003}).position, 0, 0);
  one.model.write(std::vector{first}, VertexBuffer<double>{.positions = a.data()});
  two.model.write(std::vector{first, second}, VertexBuffer<double>{.positions = b.data()});
  for (std::size_t i = 0; i < a.size(); ++i)
    CHECK_ABSOLUTE(a[i], b[i], 1e-15);  // another solve, 50 ulp of 0.03
}

TEST_CASE("display in float beside a scene in double; more contacts than the skeleton takes; no heap") {
  Scene<PhongInterpolation, float> scene(300);
  Scene<PhongInterpolation, double> exact(300);
  std::vector<float> positions(3 * scene.mesh.vertices.size());
  std::vector<double> reference(positions.size());
  const VertexBuffer<float> out{.positions = positions.data()};
  scene.model.write_rest(out);
  exact.model.write_rest(VertexBuffer<double>{.positions = reference.data()});
  std::vector<ContactState<double>> contacts(9,
                                             pressed(body.closest({0.01, 0.02, 0.006}).position, 1e-3, 0.5));
  contacts.resize(9);
  CHECK(has(scene.model.write(contacts, out).status, Status::region_overflow));
  contacts.resize(1);
  const test::HeapCount heap;
  scene.model.write(contacts, out);
  CHECK(heap.allocations() == 0);
  exact.model.write(contacts, VertexBuffer<double>{.positions = reference.data()});
  for (std::size_t i = 0; i < positions.size(); ++i)
    CHECK_ABSOLUTE(positions[i], reference[i], 1e-7);  // 30 ulp of 0.03
}

TEST_CASE("set-up refuses a skeleton over other points") {
  using S = Scene<LinearInterpolation, double>;
  auto positions = S::positions();
  std::swap(positions[0], positions[1]);
  const auto mesh = body.mesh(100);
  const auto make = [&] {
    return S::Model(RegionSkeletons<S::Beams>(S::Beams(
                        positions, EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e5, .nu = 0.5})),
                        VolumePreserving<double>({.volume = body.volume()}))),
                    LinearInterpolation<double>(make_partition(body, mesh)), AreaNeighbourhood<double>({}),
                    mesh, {.fixed = bottom});
  };
  CHECK_THROWS_WITH(
      make(),
      "BeamSkeletonDeformation: skeleton and partition must have the same position, at extremal point 0");
  positions.pop_back();
  CHECK_THROWS_AS(make(), SetupError);
}

TEST_CASE("a further corner of the partition is the fixed point, and stays; another point is refused") {
  using S = Scene<LinearInterpolation, double>;
  auto mesh = body.mesh(100);
  const Vec3<double> fixed = body.closest({0.01, -0.02, 0.003}).position;
  mesh.vertices.push_back(fixed);
  const auto make = [&](const Vec3<double>& further) {
    return S::Model(
        RegionSkeletons<S::Beams>(S::Beams(
            S::positions(), EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e4, .nu = 0.5})),
            VolumePreserving<double>({.volume = body.volume()}))),
        LinearInterpolation<double>(make_partition(body, mesh, further)), AreaNeighbourhood<double>({}), mesh,
        {.fixed = fixed, .normals = false});
  };
  auto model = make(fixed);
  CHECK(model.field().partition().points().size() == 7);
  std::vector<double> x(3 * mesh.vertices.size());
  model.write_rest(VertexBuffer<double>{.positions = x.data()});
  const std::vector contacts{pressed(body.closest({-0.02, -0.02, 0.003}).position, 2e-3, 0.5)};
  CHECK(model.write(contacts, VertexBuffer<double>{.positions = x.data()}).vertices > 0);
  const auto at = [&](std::size_t i) { return Vec3<double>(x[3 * i], x[3 * i + 1], x[3 * i + 2]); };
  const std::size_t last = mesh.vertices.size() - 1;
  CHECK((at(last) - fixed).norm() <= 1e-9 * 0.03);  // projected to its face along its ray: to rounding
  const Vec3<double> elsewhere = body.closest({-0.01, -0.02, 0.003}).position;
  CHECK_THROWS_WITH(make(elsewhere),
                    "BeamSkeletonDeformation: the partition's further corner must be at fixed");
}
