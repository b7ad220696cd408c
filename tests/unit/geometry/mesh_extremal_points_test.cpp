// SPDX-License-Identifier: MIT

#include <palpate/geometry/mesh_extremal_points.hpp>
#include <palpate/luo_xiao/interpolation/partition.hpp>

#include <support/check.hpp>
#include <support/meshes.hpp>

#include <doctest/doctest.h>

#include <string>

using namespace palpate;

namespace {

using V = Vec3<double>;
using Points = std::vector<ExtremalPoint<double>>;

const Ellipsoid<double> egg({.axes = V(0.06, 0.045, 0.03)});

// Its mesh, each vertex moved along its normal by up to `noise` mean edges; `turned`: cut into triangles
// another way.
TriangleMesh<double> egg_mesh(std::size_t vertices, double noise, bool turned) {
  MeshData<double> mesh = Sphere<double>({.radius = 1}).mesh(vertices);
  const Mat3<double> R =
      Eigen::AngleAxis<double>(turned ? 0.7 : 0.0, V(1, 2, 3).normalized()).toRotationMatrix();
  for (V& v : mesh.vertices) v = egg.params().axes.cwiseProduct(R * v);
  const TriangleMesh<double> smooth(mesh);
  const double edge = detail::mean_edge(smooth.area(), mesh.triangles.size());
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    mesh.vertices[v] += noise * edge * unit(random) * smooth.vertex_normals()[v];
  return TriangleMesh<double>(mesh);
}

double farthest(const Points& expected, const Points& found) {
  double worst = 0;
  for (const auto& e : expected) {
    double nearest = 1;
    for (const auto& f : found) nearest = (std::min)(nearest, (e.position - f.position).norm());
    worst = (std::max)(worst, nearest);
  }
  return worst;
}

static_assert(HasExtremalPoints<MeshSurface<double>> && HasExtremalPoints<MeshSurface<float>>);

}  // namespace

TEST_CASE("mesh curvature: a sphere's is 1 / R at every resolution, also with noise") {
  for (const std::size_t n : {500u, 8000u}) {
    const TriangleMesh<double> ball(Sphere<double>({.radius = 0.05}).mesh(n));
    for (const double h : mean_curvature(ball, 0.017))
      CHECK_RELATIVE(h, 20, 0.02);  // (edge / R)^2 / 4 of chords, < 2 %
  }
  // A cylinder's side has half of 1 / R.
  const Cylinder<double> rod({.radius = 0.02, .half_height = 0.06});
  const TriangleMesh<double> mesh(rod.mesh(6000));
  const auto H = mean_curvature(mesh, 0.01);
  for (std::size_t v = 0; v < H.size(); ++v)
    if (std::abs(mesh.vertices()[v].y()) < 0.04) CHECK_RELATIVE(H[v], 25, 0.03);
}

TEST_CASE(
    "mesh extremal points: the ends of an ellipsoid's axes, at every resolution, triangulation and with "
    "noise") {
  const Points ends = extremal_points(egg);
  for (const std::size_t n : {500u, 2000u, 8000u}) {
    for (const bool turned : {false, true}) {
      for (const double noise : {0.0, 0.1}) {
        const TriangleMesh<double> mesh = egg_mesh(n, noise, turned);
        const Points points = extremal_points(mesh);
        const double rho = 0.1 * (mesh.upper() - mesh.lower()).norm();
        CHECK(points.size() == 6);
        const double worst = farthest(ends, points);
        MESSAGE(n, " vertices, noise ", noise, ", turned ", turned, ": farthest ", worst, " m, rho ", rho);
        // Without noise to an edge, with it to half of the radius of the average: measured 0.4 at most.
        CHECK(worst < (noise > 0 ? rho / 2 : 1.2 * detail::mean_edge(mesh.area(), mesh.triangles().size())));
        for (const auto& p : points) {
          CHECK_ABSOLUTE(p.normal.norm(), 1, test::ulps<double>(8));
          // A vertex moved by 0.1 edges tilts the triangles around it by up to about 0.3 rad.
          CHECK(p.normal.dot(egg.normal(p.position)) > (noise > 0 ? 0.9 : 0.97));
        }
      }
    }
  }
}

TEST_CASE("mesh extremal points: a sphere has the six ends of the coordinate axes") {
  const TriangleMesh<double> ball(Sphere<double>({.radius = 0.05}).mesh(3000));
  const Points points = extremal_points(ball);
  CHECK(points.size() == 6);
  CHECK(farthest(extremal_points(Sphere<double>({.radius = 0.05})), points) <
        1e-3);  // half of a chord's height aside
}

TEST_CASE("mesh extremal points: the corners of a box, however fine its mesh") {
  const Box<double> box({.half = V(0.05, 0.04, 0.03)});
  for (const std::size_t n : {400u, 4000u}) {
    const Points points = extremal_points(TriangleMesh<double>(box.mesh(n)));
    // The average moves a corner inwards by less than its radius, 0.014 m.
    CHECK(farthest(extremal_points(box), points) < 0.014);
  }
}

TEST_CASE("mesh extremal points: at most as many as asked for, spread out, and they make a partition") {
  for (const auto& [name, mesh] : test::five_meshes<double>(3000)) {
    INFO(std::string(name));
    const TriangleMesh<double> checked(mesh);
    const double rho = 0.1 * (checked.upper() - checked.lower()).norm();
    for (const std::size_t most : {6u, 10u, 16u, 40u}) {
      const Points points = extremal_points(checked, {.at_most = most});
      CHECK(points.size() <= most);
      CHECK(points.size() >= 4);
      for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          CHECK(((points[i].position - points[j].position).norm() >= 2 * rho * (1 - 1e-12) ||
                 points[i].normal.dot(points[j].normal) <= 0.5));
    }
    if (std::string(name) == "torus") continue;  // not star-shaped
    const FacePartition<double> partition(mesh, checked.vertex_normals(), extremal_points(checked));
    CHECK(partition.faces().size() >= 4);
    CHECK(partition.size() == mesh.vertices.size());
  }
}

TEST_CASE_TEMPLATE("mesh extremal points: a surface gives its mesh's, and the same every time", S, float,
                   double) {
  const TriangleMesh<S> mesh(test::blob<S>(800));
  const auto a = extremal_points(mesh), b = extremal_points(MeshSurface<S>(mesh));
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i].position == b[i].position);
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("mesh extremal points: parameters that are refused") {
  const TriangleMesh<double> ball(Sphere<double>({}).mesh(100));
  const auto refusal = [&](const MeshExtremalParams<double>& params) -> std::string {
    try {
      (void)extremal_points(ball, params);
    } catch (const SetupError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(refusal({.at_most = 5}) == "extremal_points: at_most must be in 6 .. 64, got 5");
  CHECK(refusal({.radius = 0.6}) ==
        "extremal_points: radius must be in [0.01, 0.5] of the box's diagonal, got 0.6");
  CHECK(refusal({.prominence = 0}) == "extremal_points: prominence must be in (0, 1], got 0");
  CHECK_THROWS_AS((void)mean_curvature(ball, -1.0), SetupError);
}
#endif
