// SPDX-License-Identifier: MIT
#include "support/check.hpp"

#include <palpate/display/vertex_normals.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/ellipsoid.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <set>
#include <type_traits>
#include <vector>

using namespace palpate;
using palpate::test::ulps;

namespace {

template <Real S>
void put(VertexPositions& positions, const MeshData<S>& mesh, std::size_t from, std::size_t count) {
  std::array<std::vector<S>, 3> axis;
  for (std::size_t v = from; v < from + count; ++v)
    for (std::size_t k = 0; k < 3; ++k) axis[k].push_back(mesh.vertices[v][static_cast<int>(k)]);
  positions.set_row(0, count, axis[0].data(), axis[1].data(), axis[2].data());
}
template <Real S>
VertexPositions positions_of(const MeshData<S>& mesh) {
  const std::size_t n = mesh.vertices.size();
  VertexPositions positions(std::array{VertexRun{0, n}}, std::vector<std::uint8_t>(n, 1));
  put(positions, mesh, 0, n);
  positions.pack(0);
  return positions;
}

constexpr float nowhere = 7;
Packed3 at_rest(std::size_t) { return {0, 0, 2}; }
auto into(std::vector<Vec3<float>>& out) {
  return [&out](const auto& vertex, const auto& x, const auto& y, const auto& z) {
    for (std::uint32_t k = 0; k < x.size(); ++k) out[vertex(k)] = Vec3<float>(x[k], y[k], z[k]);
  };
}
std::vector<Vec3<float>> unit_normals(const VertexNormals& normals, const VertexNormals::Group& group,
                                      const VertexPositions& positions, std::size_t count) {
  std::vector<Vec3<float>> out(count, Vec3<float>::Constant(nowhere));
  normals.each_unit(group, positions, at_rest, into(out));
  return out;
}
std::vector<Vec3<float>> unit_normals(const MeshData<float>& mesh) {
  const VertexNormals normals(VertexRings(mesh.triangles, mesh.vertices.size()));
  return unit_normals(normals, normals.all(), positions_of(mesh), mesh.vertices.size());
}

}  // namespace

TEST_CASE("normal of a vertex is the sum over its triangles, on displaced meshes") {
  const Cylinder<float> body(Cylinder<float>::Params{});
  auto mesh = body.mesh(500);
  std::set<std::size_t> sizes;
  const VertexRings rings(mesh.triangles, mesh.vertices.size());
  for (std::size_t v = 0; v < rings.size(); ++v) sizes.insert(rings[v].size());
  CHECK(sizes == std::set<std::size_t>{4, 6, 8});
  std::mt19937_64 random(3);
  INFO("seed 3");
  std::uniform_real_distribution<double> unit(-1e-3, 1e-3);
  for (auto& v : mesh.vertices)
    v += Vec3<float>(float(unit(random)), float(unit(random)), float(unit(random)));
  using L = Eigen::Matrix<long double, 3, 1>;
  std::vector<L> exact(mesh.vertices.size(), L::Zero());
  for (const auto& t : mesh.triangles) {
    const auto point = [&](std::size_t k) -> L { return mesh.vertices[t[k]].template cast<long double>(); };
    const L area = (point(1) - point(0)).cross(point(2) - point(0));
    for (const std::uint32_t v : t) exact[v] += area;
  }
  const auto normals = unit_normals(mesh);
  // Differences of positions of 0.03 over edges of 0.003: 10 ulp each, a few of them.
  for (std::size_t v = 0; v < exact.size(); ++v)
    CHECK((normals[v].template cast<long double>() - exact[v].normalized()).norm() <= ulps<float>(100));
}

TEST_CASE("normals of a fine mesh are the surface's, and outward") {
  const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.02}});
  const auto mesh = body.mesh(5000);
  const VertexNormals normals(VertexRings(mesh.triangles, mesh.vertices.size()));
  const auto all = unit_normals(normals, normals.all(), positions_of(mesh), mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    CHECK(all[v].cast<double>().dot(body.closest(mesh.vertices[v]).normal) > 0.999);
}

TEST_CASE("a group has its own vertices and no others; numbering does not matter") {
  const Ellipsoid<float> body({.axes = {0.03F, 0.02F, 0.02F}});
  const auto mesh = body.mesh(2000);
  const std::size_t n = mesh.vertices.size();
  const auto positions = positions_of(mesh);
  const VertexRings rings(mesh.triangles, n);
  VertexNormals normals(rings);
  const auto everything = normals.all();
  CHECK(4 * everything.four_end < n / 2);  // rows and gathered vertices are both there
  CHECK(everything.four_end > 0);
  const auto whole = unit_normals(normals, everything, positions, n);
  for (const std::size_t count : {0u, 1u, 3u, 4u, 101u}) {
    std::vector<std::uint32_t> some;
    for (std::uint32_t v = 0; v < count; ++v) some.push_back(17 * v + 5);
    const auto part = unit_normals(normals, normals.add(rings, some), positions, n);
    for (std::uint32_t v = 0; v < n; ++v) {
      if (std::find(some.begin(), some.end(), v) != some.end())
        CHECK((part[v] - whole[v]).norm() <= ulps<float>(10));  // in a row or not: other roundings
      else
        CHECK(part[v] == Vec3<float>::Constant(nowhere));
    }
  }

  std::vector<std::uint32_t> to(n);
  for (std::uint32_t i = 0; i < n; ++i) to[i] = i;
  std::shuffle(to.begin(), to.end(), std::mt19937_64(5));
  auto other = mesh;
  for (std::size_t i = 0; i < n; ++i) other.vertices[to[i]] = mesh.vertices[i];
  for (auto& t : other.triangles) {
    for (auto& v : t) v = to[v];
  }
  const auto others = unit_normals(other);
  // Edges of 0.0015 between positions of 0.03, 20 ulp each, a few of them.
  for (std::size_t i = 0; i < n; ++i) CHECK((whole[i] - others[to[i]]).norm() <= ulps<float>(200));
}

TEST_CASE(
    "a mesh in two runs, one after the other, has the normals of the whole; what is not read is not packed") {
  const Ellipsoid<float> body({.axes = {0.03F, 0.02F, 0.02F}});
  const auto mesh = body.mesh(2000);
  const std::size_t n = mesh.vertices.size(), half = n / 2 + 3;
  const VertexRings rings(mesh.triangles, n);
  const VertexNormals one(rings);
  const auto whole = unit_normals(one, one.all(), positions_of(mesh), n);
  VertexNormals normals;
  const std::array<VertexRun, 2> runs{{{0, half}, {half, n - half}}};
  std::array<VertexNormals::Group, 2> groups;
  for (std::size_t r = 0; r < 2; ++r) {
    std::vector<std::uint32_t> vertices(runs[r].count);
    std::iota(vertices.begin(), vertices.end(), static_cast<std::uint32_t>(runs[r].first));
    groups[r] = normals.add(rings, vertices, runs[r]);
    CHECK(groups[r].row_end > groups[r].row_begin);
  }
  const auto reads = normals.packed_reads(n);
  CHECK(std::count(reads.begin(), reads.end(), 0) > std::ptrdiff_t(n) / 4);
  VertexPositions positions(runs, reads);
  std::vector<Vec3<float>> parts(n, Vec3<float>::Constant(nowhere));
  for (std::size_t r = 0; r < 2; ++r) {
    put(positions, mesh, runs[r].first, runs[r].count);
    positions.pack(r);
    normals.each_in_row(groups[r], positions, at_rest, into(parts));
  }
  for (std::size_t r = 0; r < 2; ++r) normals.each_apart(groups[r], positions, at_rest, into(parts));
  for (std::size_t v = 0; v < n; ++v)
    CHECK((parts[v] - whole[v]).norm() <= ulps<float>(10));  // other roundings
}

TEST_CASE("a vertex whose ring has collapsed has its normal at rest, its neighbours their own") {
  const Ellipsoid<float> body({.axes = {0.03F, 0.02F, 0.02F}});
  const auto mesh = body.mesh(200);
  const std::size_t n = mesh.vertices.size();
  const VertexRings rings(mesh.triangles, n);
  const VertexNormals normals(rings);
  const auto before = unit_normals(normals, normals.all(), positions_of(mesh), n);
  auto collapsed = mesh;
  for (const std::uint32_t v : rings[7]) collapsed.vertices[v] = mesh.vertices[7];
  const auto after = unit_normals(normals, normals.all(), positions_of(collapsed), n);
  CHECK(after[7] == Vec3<float>(0, 0, 2));
  const auto moved = rings[7];
  for (std::uint32_t v = 0; v < n; ++v) {
    if (v == 7 ||
        std::find_first_of(rings[v].begin(), rings[v].end(), moved.begin(), moved.end()) != rings[v].end())
      continue;
    CHECK(after[v] == before[v]);
  }
}

TEST_CASE("positions are the same whether set in a row or anywhere") {
  const std::array<std::uint32_t, 8> order{5, 0, 3, 7, 6, 1, 2, 4};
  const auto x = [](std::uint32_t v) { return 0.1F * float(v); };
  const std::vector<std::uint8_t> all(7, 1);
  const std::array runs{VertexRun{0, 7}};
  VertexPositions row(runs, all), anywhere(runs, all);
  double at[3][7];
  for (std::uint32_t v = 0; v < 7; ++v)
    for (std::uint32_t axis = 0; axis < 3; ++axis) at[axis][v] = double(x(v) + float(axis));
  row.set_row(0, 7, at[0], at[1], at[2]);
  row.pack(0);
  for (std::uint32_t first : {0u, 4u}) {
    detail::Simd4 mixed[3]{};
    for (std::uint32_t k = 0; k < 4; ++k)
      for (std::uint32_t axis = 0; axis < 3; ++axis) mixed[axis].set(k, x(order[first + k]) + float(axis));
    anywhere.set_four(&order[first], mixed[0], mixed[1], mixed[2]);
  }
  std::size_t rows = 0;
  anywhere.complete(true, [&](std::size_t first, const auto& px, const auto& py, const auto& pz) {
    CHECK(first == 4 * rows++);
    for (std::uint32_t v = std::uint32_t(first); v < std::min<std::size_t>(first + 4, 7); ++v) {
      CHECK(px[v - first] == x(v));
      CHECK(py[v - first] == x(v) + 1);
      CHECK(pz[v - first] == x(v) + 2);
    }
  });
  CHECK(rows == 2);
  for (const auto* positions : {&row, &anywhere})
    for (std::uint32_t v = 0; v < 7; ++v) {
      CHECK(positions->packed()[v].x == x(v));
      CHECK(positions->packed()[v].y == x(v) + 1);
      CHECK(positions->packed()[v].z == x(v) + 2);
      for (std::uint32_t axis = 0; axis < 3; ++axis) CHECK(positions->axis(axis)[v] == x(v) + float(axis));
    }
}

TEST_CASE("set-up refuses a mesh that does not close, or names a vertex that does not exist") {
  const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.02}});
  auto mesh = body.mesh(50);
  auto open = mesh.triangles;
  open.pop_back();
  CHECK_THROWS_AS(VertexRings(open, mesh.vertices.size()), SetupError);
  auto bad = mesh.triangles;
  bad[3][1] = 1000;
  CHECK_THROWS_WITH(VertexRings(bad, mesh.vertices.size()),
                    "VertexNormals: vertex does not exist, at triangle 3, got 1000");
  auto flipped = mesh.triangles;
  std::swap(flipped[5][0], flipped[5][1]);
  CHECK_THROWS_AS(VertexRings(flipped, mesh.vertices.size()), SetupError);
}
