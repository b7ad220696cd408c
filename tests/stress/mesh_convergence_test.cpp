// SPDX-License-Identifier: MIT

/// @file An ellipsoid as a mesh of 1,000 to 100,000 vertices against the exact one: the force of a tool
/// pressed into it converges, and so do the extremal points and the skeleton's shape; and how much the force
/// clicks over a coarse mesh's edges with flat, interpolated and blended normals.

#include <palpate/geometry/mesh_extremal_points.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/palpate.hpp>

#include <support/check.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <random>

using namespace palpate;

namespace {

using V = Vec3<double>;
const Ellipsoid<double> egg({.axes = V(0.06, 0.04, 0.03)});

// Forces at the same 60 poses: a ball of 200 points, 1 to 4 mm deep.
template <class Object>
std::vector<V> forces(const Object& object) {
  const ToolPoints<double> tool(TriangleMesh<double>(Sphere<double>({.radius = 0.01}).mesh(200)),
                                {.contact_area = 1e-4});
  ContactSolver<Object, DuffingForce<double>, Frictionless<double>, SingleRegion<AreaSharing>> solver(
      {object, tool, DuffingForce<double>({.c1 = 40, .c3 = 3e8}), {}, {}, {}});
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  std::vector<V> result;
  for (int i = 0; i < 60; ++i) {
    const double a = normal(random), b = normal(random), c = normal(random);
    const V on = egg.params().axes.cwiseProduct(V(a, b, c).normalized());
    Pose<double> X;
    X.translation = on + (0.01 - 1e-3 - 3e-3 * unit(random)) * egg.normal(on);
    result.push_back(solver.tick(X).wrench.force);
  }
  return result;
}

std::vector<V> ends_of(const auto& body) {
  std::vector<V> ends;
  for (const auto& point : extremal_points(body)) ends.push_back(point.position);
  return ends;
}

// Displacement of the mesh's vertices by one contact, worked out with the extremal points and faces of
// `body`.
template <class Body>
std::vector<V> drawn(const Body& body, const MeshData<double>& mesh) {
  using Beams = RegionSkeletons<Skeleton<double>>;
  const Beams beams(Skeleton<double>(
      ends_of(body), EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e5, .nu = 0.5})),
      VolumePreserving<double>({.volume = egg.volume()})));
  BeamSkeletonDeformation<Beams, PhongInterpolation<double>> model(
      beams, PhongInterpolation<double>(make_partition(body, mesh)), AreaNeighbourhood<double>({}), mesh,
      {.fixed = V(0, -0.04, 0)});
  std::vector<V> now(mesh.vertices.size());
  const VertexBuffer<double> buffer{.positions = now[0].data(), .position_stride = sizeof(V)};
  model.write_rest(buffer);
  const auto at = egg.closest(V(0.02, 0.04, 0.008));
  ContactState<double> contact{};
  contact.id = contact.points = 1;
  contact.mode = ContactMode::sticking;
  contact.centre = at.position - 0.003 * at.normal;
  contact.normal = at.normal;
  contact.displacement = -0.003 * at.normal;
  contact.force = 2 * at.normal;
  contact.friction = V::Zero();
  contact.normal_force = 2;
  contact.area = 1e-5;
  (void)model.write(std::span<const ContactState<double>>(&contact, 1), buffer);
  for (std::size_t v = 0; v < now.size(); ++v) now[v] -= mesh.vertices[v];
  return now;
}

double error(const std::vector<V>& found, const std::vector<V>& expected) {
  double off = 0, all = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    off += (found[i] - expected[i]).squaredNorm();
    all += expected[i].squaredNorm();
  }
  return std::sqrt(off / all);
}

}  // namespace

TEST_CASE("stress: the force on an ellipsoid's mesh converges to the exact one with order 2") {
  const std::vector<V> exact = forces(egg);
  double first = 0, first_edge = 0, last = 0, last_edge = 0;
  std::printf("vertices, mean edge [mm], error of the force, order; on samples 1 mm apart: error\n");
  double before = 0, edge_before = 0;
  for (const std::size_t n : {1000u, 3000u, 10000u, 30000u, 100000u}) {
    const TriangleMesh<double> mesh(egg.mesh(n));
    const double edge = detail::mean_edge(mesh.area(), mesh.triangles().size());
    const MeshSurface<double> body(mesh);
    const double off = error(forces(body), exact);
    // Sampling is slow below a deep body: one size shows that its error does not add to the mesh's.
    const double sampled =
        n == 10000 ? error(forces(SampledSurface<MeshSurface<double>>(body, {.spacing = 1e-3})), exact) : 0;
    const double order = before > 0 ? std::log(before / off) / std::log(edge_before / edge) : 0;
    std::printf("%7zu, %.3f, %.2e, %.2f", mesh.vertices().size(), 1e3 * edge, off, order);
    if (sampled > 0) {
      std::printf("; %.2e", sampled);
      CHECK(sampled < 2 * off);
    }
    std::printf("\n");
    if (first == 0) first = off, first_edge = edge;
    last = off, last_edge = edge;
    before = off, edge_before = edge;
  }
  // Depth lies chords below the surface, edge^2 / (8 R): order 2. Which points touch changes with the depth,
  // so one step scatters; over the whole range, 100 times the vertices, the order is to within a tenth.
  CHECK_RELATIVE(std::log(first / last) / std::log(first_edge / last_edge), 2, 0.1);
  // At the last size chords are up to 0.517^2 / (8 * 15) mm = 2e-6 m high, on depths of 1 to 4 mm.
  CHECK(last < 2e-3);
}

TEST_CASE(
    "stress: extremal points and the skeleton's shape on an ellipsoid's mesh converge to the exact ones") {
  const std::vector<V> exact = ends_of(egg);
  std::printf("vertices: farthest extremal point [mm], shape's relative error\n");
  double first_far = 0, first = 0, far = 0, last = 0;
  for (const std::size_t n : {1000u, 4000u, 16000u, 100000u}) {
    const MeshData<double> mesh = egg.mesh(n);
    const MeshSurface<double> body{TriangleMesh<double>(mesh)};
    const std::vector<V> found = ends_of(body);
    far = 0;
    for (const V& end : exact) {
      double nearest = 1;
      for (const V& other : found) nearest = (std::min)(nearest, (end - other).norm());
      far = (std::max)(far, nearest);
    }
    last = error(drawn(body, mesh), drawn(egg, mesh));
    std::printf("%6zu: %.2f %.4f\n", mesh.vertices.size(), 1e3 * far, last);
    if (first == 0) first_far = far, first = last;
  }
  // Edges shrink by ten. A point is found to a part of an edge, which part depends on how the vertices lie:
  // half of order 1 is asked for.
  CHECK(far < first_far / 3);
  CHECK(last < first / 3);
}

TEST_CASE("stress: clicks of a point's force over the edges of coarse meshes") {
  std::printf(
      "vertices, depth [mm]: largest change of the force per step of 1 um, over k times the step: flat, "
      "interpolated, blended, samples 2 mm apart\n");
  for (const std::size_t n : {100u, 500u, 5000u}) {
    const MeshSurface<double> body{TriangleMesh<double>(egg.mesh(n))};
    const SampledSurface<MeshSurface<double>> samples(body, {.spacing = 2e-3});
    for (const double depth : {0.5e-3, 2e-3, 5e-3}) {
      std::mt19937_64 random(6);
      std::normal_distribution<double> normal;
      std::array<double, 4> worst{};
      for (int path = 0; path < 8; ++path) {
        const double ax = normal(random), ay = normal(random), az = normal(random), bx = normal(random),
                     by = normal(random), bz = normal(random);
        const V a = V(ax, ay, az).normalized(), b = tangential(V(bx, by, bz), a).normalized();
        std::array<V, 4> last{V::Zero(), V::Zero(), V::Zero(), V::Zero()};
        V at = V::Zero();
        for (int i = 0; i < (n < 200 ? 20000 : 5000); ++i) {  // over some edges
          const double t = 1e-6 / 0.06 * i;
          const V on = egg.params().axes.cwiseProduct(std::cos(t) * a + std::sin(t) * b);
          const V x = on - depth * egg.normal(on);
          const auto in = body.penetration(x), from_samples = samples.penetration(x);
          const auto foot = body.closest(x);
          const double d = (std::max)(-foot.distance, 0.0);
          const std::array<V, 4> f{d * (foot.position - x).normalized(), d * foot.normal,
                                   in.depth * in.gradient, from_samples.depth * from_samples.gradient};
          for (std::size_t k = 0; k < 4 && i > 0; ++k)
            worst[k] = (std::max)(worst[k], (f[k] - last[k]).norm() / (x - at).norm());
          last = f;
          at = x;
        }
      }
      std::printf("%5zu, %.1f: %8.1f %8.1f %6.2f %6.2f\n", body.bvh().vertices().size(), 1e3 * depth,
                  worst[0], worst[1], worst[2], worst[3]);
      // On the exact body the force changes by 1 (with depth) and by depth times curvature (turning), at most
      // 1 + 5 / 7.5 here; faces of a coarse mesh lean by as much again.
      CHECK(worst[2] < 4);
      CHECK(worst[3] < 4);
    }
  }
}
