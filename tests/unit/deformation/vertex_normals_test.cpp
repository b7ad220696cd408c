// SPDX-License-Identifier: MIT
#include "support/check.hpp"

#include <palpate/deformation/vertex_normals.hpp>
#include <palpate/surface/cylinder.hpp>
#include <palpate/surface/ellipsoid.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

using namespace palpate;
using palpate::test::ulps;

namespace {

// Coordinate by coordinate, with the room behind them that VertexNormals reads.
template <Real S>
struct Places {
  std::vector<S> x, y, z;
  std::size_t size = 0;
  explicit Places(std::size_t count) : x(count + VertexNormals<S>::padding), y(x.size()), z(x.size()) {}
  void push_back(const Vec3<S>& v) { x[size] = v.x(), y[size] = v.y(), z[size] = v.z(), ++size; }
  Vec3<S> operator[](std::size_t i) const { return Vec3<S>(x[i], y[i], z[i]); }
};

template <Real S>
std::vector<Vec3<S>> areas_of(const VertexNormals<S>& normals, const Places<S>& places) {
  constexpr std::size_t lanes = VertexNormals<S>::lanes;
  std::vector<Vec3<S>> areas;
  for (const auto& run : normals.runs()) {
    S x[lanes], y[lanes], z[lanes];
    normals.area(run, 0, places.x.data(), places.y.data(), places.z.data(), x, y, z);
    for (std::size_t i = 0; i < run.count; ++i) areas.emplace_back(x[i], y[i], z[i]);
  }
  return areas;
}

}  // namespace

TEST_CASE_TEMPLATE("area of a vertex's ring equals the sum over its triangles, on displaced meshes", S, float,
                   double) {
  const Cylinder<S> body(typename Cylinder<S>::Params{});  // rings of 3 to 8 neighbours
  const auto mesh = body.mesh(500);
  const VertexNormals<S> normals(mesh.triangles, mesh.vertices.size());
  std::mt19937_64 random(3);
  INFO("seed 3");
  std::uniform_real_distribution<double> unit(-1e-3, 1e-3);
  Places<S> places(mesh.vertices.size());
  for (const auto& v : mesh.vertices)
    places.push_back(Vec3<S>(v.x() + S(unit(random)), v.y() + S(unit(random)), v.z() + S(unit(random))));
  using L = Eigen::Matrix<long double, 3, 1>;
  std::vector<L> exact(mesh.vertices.size(), L::Zero());
  for (const auto& t : mesh.triangles) {
    const auto point = [&](std::size_t k) -> L { return places[t[k]].template cast<long double>(); };
    const L area = (point(1) - point(0)).cross(point(2) - point(0));
    for (const std::uint32_t v : t) exact[v] += area;
  }
  const auto areas = areas_of(normals, places);
  // Differences of places of 0.03 over edges of 0.003: 10 ulp each, a few of them.
  for (std::size_t v = 0; v < exact.size(); ++v)
    CHECK((areas[v].template cast<long double>() - exact[v]).norm() <= ulps<S>(100) * exact[v].norm());
}

TEST_CASE("normals of a fine mesh are the surface's, and outward") {
  const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.02}});
  const auto mesh = body.mesh(5000);
  const VertexNormals<double> normals(mesh.triangles, mesh.vertices.size());
  Places<double> places(mesh.vertices.size());
  for (const auto& v : mesh.vertices) places.push_back(v);
  const auto areas = areas_of(normals, places);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    CHECK(areas[v].normalized().dot(body.closest(mesh.vertices[v]).normal) > 0.999);
}

TEST_CASE("runs: every vertex once, in order, none over a start; a mesh without rows has the same normals") {
  const Ellipsoid<float> body({.axes = {0.03F, 0.02F, 0.02F}});
  auto mesh = body.mesh(2000);
  const std::size_t n = mesh.vertices.size();
  const std::vector<std::size_t> starts{0, 101, 102, 777};
  const VertexNormals<float> normals(mesh.triangles, n, starts);
  std::uint32_t next = 0;
  for (const auto& run : normals.runs()) {
    CHECK(run.first == next);
    CHECK(run.count >= 1);
    CHECK(run.count <= VertexNormals<float>::lanes);
    for (const std::size_t start : starts) CHECK(!(run.first < start && start < run.first + run.count));
    next = run.first + run.count;
  }
  CHECK(next == n);
  CHECK(normals.runs().size() < n / 2);  // rows of a dozen and more

  Places<float> places(n), shuffled(n);
  for (const auto& v : mesh.vertices) places.push_back(v);
  const auto areas = areas_of(normals, places);
  std::vector<std::uint32_t> to(n);
  for (std::uint32_t i = 0; i < n; ++i) to[i] = i;
  std::shuffle(to.begin(), to.end(), std::mt19937_64(5));
  auto other = mesh;
  for (std::size_t i = 0; i < n; ++i) other.vertices[to[i]] = mesh.vertices[i];
  for (auto& t : other.triangles) {
    for (auto& v : t) v = to[v];
  }
  for (const auto& v : other.vertices) shuffled.push_back(v);
  const auto others = areas_of(VertexNormals<float>(other.triangles, n), shuffled);
  // The ring begins at another neighbour: edges of 0.0015 between places of 0.03, 20 ulp each, a few of them.
  for (std::size_t i = 0; i < n; ++i)
    CHECK((areas[i] - others[to[i]]).norm() <= ulps<float>(200) * areas[i].norm());
}

TEST_CASE("set-up refuses a mesh that does not close, or names a vertex that does not exist") {
  const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.02}});
  auto mesh = body.mesh(50);
  auto open = mesh.triangles;
  open.pop_back();
  CHECK_THROWS_AS(VertexNormals<double>(open, mesh.vertices.size()), SetupError);
  auto bad = mesh.triangles;
  bad[3][1] = 1000;
  CHECK_THROWS_WITH(VertexNormals<double>(bad, mesh.vertices.size()),
                    "VertexNormals: vertex does not exist, at triangle 3, got 1000");
  auto flipped = mesh.triangles;
  std::swap(flipped[5][0], flipped[5][1]);
  CHECK_THROWS_AS(VertexNormals<double>(flipped, mesh.vertices.size()), SetupError);
}
