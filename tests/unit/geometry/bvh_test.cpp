// SPDX-License-Identifier: MIT

#include <palpate/geometry/bvh.hpp>

#include <support/check.hpp>
#include <support/meshes.hpp>
#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace palpate;

namespace {

constexpr std::uint64_t seed = 20240701;

template <Real S>
S size_of(const MeshData<S>& mesh) {
  S size = 0;
  for (const Vec3<S>& v : mesh.vertices) size = (std::max)(size, v.cwiseAbs().maxCoeff());
  return size;
}

// The boxes of `tree` are what a fresh look at its triangles gives.
template <Real S>
void check_boxes(const TriangleBvh<S>& tree) {
  const auto nodes = tree.nodes();
  std::size_t wrong = 0;
  for (const auto& node : nodes) {
    for (std::size_t i = 0; i < node.count; ++i) {
      for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        if (node.leaf == 0) {
          const auto& child = nodes[node.child[i]];
          float from = child.low[axis][0], to = child.high[axis][0];
          for (std::size_t j = 1; j < child.count; ++j) {
            from = (std::min)(from, child.low[axis][j]);
            to = (std::max)(to, child.high[axis][j]);
          }
          wrong += node.low[axis][i] != from || node.high[axis][i] != to;
          continue;
        }
        S from = (std::numeric_limits<S>::max)(), to = -from;
        for (const std::uint32_t v : tree.triangles()[node.child[i]]) {
          from = (std::min)(from, tree.vertices()[v][k] - tree.origin()[k]);
          to = (std::max)(to, tree.vertices()[v][k] - tree.origin()[k]);
        }
        wrong +=
            node.low[axis][i] != static_cast<float>(from) || node.high[axis][i] != static_cast<float>(to);
      }
    }
  }
  CHECK(wrong == 0);
}

}  // namespace

TEST_CASE_TEMPLATE("bvh: closest point and ball equal brute force", S, float, double) {
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  for (const auto& [name, mesh] : test::five_meshes<S>(300)) {
    INFO(std::string(name));
    const TriangleBvh<S> tree(mesh);
    const S size = size_of(mesh);
    // Coordinates are rounded to epsilon of the size; the distance is a few such operations.
    const auto rounding = test::ulps<S>(8) * static_cast<long double>(size);
    for (int i = 0; i < 400; ++i) {
      const Vec3<S> x = test::random_position(mesh, random);
      const auto found = tree.closest(x, static_cast<std::uint32_t>(random() % mesh.triangles.size()));
      CHECK_ABSOLUTE(std::sqrt(found.distance2), std::fabs(test::brute_force_distance(mesh, x)), rounding);
      CHECK_ABSOLUTE((found.position - x).norm(), std::sqrt(found.distance2), rounding);
      CHECK(found.weight.minCoeff() >= -S(4) * std::numeric_limits<S>::epsilon());
      CHECK_ABSOLUTE(found.weight.sum(), 1, test::ulps<S>(4));

      const auto close = tree.near(x, 0, S(0.25));
      CHECK(close.distance2 <= S(1.5626L) * found.distance2);

      const S radius = S(0.2) * size;
      std::vector<std::uint32_t> ball, expected;
      tree.overlap(x, radius, [&](const auto& n) { ball.push_back(n.triangle); });
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (tree.on_triangle(x, t).distance2 < radius * radius) expected.push_back(t);
      std::sort(ball.begin(), ball.end());
      CHECK(ball == expected);
    }
  }
}

TEST_CASE_TEMPLATE("bvh: the ray's first hit equals brute force", S, float, double) {
  std::mt19937_64 random(seed);
  for (const auto& [name, mesh] : test::five_meshes<S>(300)) {
    INFO(std::string(name));
    const TriangleBvh<S> tree(mesh);
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
      const Vec3<S> origin = test::random_position(mesh, random);
      const Vec3<S> d = (test::random_position(mesh, random) - origin) * S(100);
      const auto found = tree.raycast(origin, d);
      if (i < 20) {  // few, because it is slow: every triangle for itself, in a tree of its own
        S first = (std::numeric_limits<S>::max)();
        for (const auto& t : mesh.triangles) {
          const TriangleBvh<S> one({mesh.vertices, {t}});
          first = (std::min)(first, one.raycast(origin, d).t);
        }
        CHECK(found.t == first);
      }
      if (found.triangle == tree.none) continue;
      ++hits;
      const Vec3<S> on = origin + found.t * d;
      // The hit lies on its triangle: rounding of coordinates, of t d, and of the shear of a slanted ray.
      CHECK_ABSOLUTE(std::sqrt(tree.on_triangle(on, found.triangle).distance2), 0,
                     test::ulps<S>(64) * static_cast<long double>(size_of(mesh)));
    }
    CHECK(hits > 100);
  }
}

TEST_CASE_TEMPLATE("bvh: no ray from inside escapes through an edge or a vertex", S, float, double) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<S> unit(S(0), S(1));
  for (const auto& [name, mesh] : test::five_meshes<S>(300)) {
    if (std::string(name) == "torus") continue;  // its centre is outside
    const TriangleBvh<S> tree(mesh);
    int lost = 0;
    for (const auto& t : mesh.triangles) {
      const Vec3<S> a = mesh.vertices[t[0]], b = mesh.vertices[t[1]];
      const Vec3<S> origin = Vec3<S>(unit(random), unit(random), unit(random)) * S(1e-3);
      for (const S s : {S(0), S(0.5), unit(random)}) {
        const Vec3<S> d = a + s * (b - a) - origin;
        lost += tree.raycast(origin, d).triangle == tree.none;
      }
    }
    CHECK(lost == 0);
  }
}

TEST_CASE_TEMPLATE("bvh: refit equals rebuild", S, float, double) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<S> shift(S(-0.004), S(0.004));
  for (auto [name, mesh] : test::five_meshes<S>(400)) {
    INFO(std::string(name));
    TriangleBvh<S> tree(mesh), whole(mesh);
    for (int step = 0; step < 20; ++step) {
      std::vector<std::uint32_t> which;
      std::vector<Vec3<S>> position;
      const std::size_t first = random() % mesh.vertices.size(), count = 1 + random() % 40;
      for (std::size_t v = first; v < (std::min)(first + count, mesh.vertices.size()); ++v) {
        const Vec3<S> by(shift(random), shift(random), shift(random));
        mesh.vertices[v] += by;
        which.push_back(static_cast<std::uint32_t>(v));
        position.push_back(mesh.vertices[v]);
      }
      const test::HeapCount heap;
      tree.move(which, position);
      whole.move_all(mesh.vertices);
      CHECK(heap.allocations() == 0);
      check_boxes(tree);
      const TriangleBvh<S> fresh(mesh);
      for (int i = 0; i < 50; ++i) {
        const Vec3<S> x = test::random_position(mesh, random);
        // The least of the same numbers, whatever the order. A triangle's distance is worked out at two
        // positions, and rounds differently where products are contracted in one of them only.
        const S distance = std::sqrt(fresh.closest(x).distance2);
        const auto size = static_cast<long double>(size_of(mesh));
        CHECK_ABSOLUTE(std::sqrt(tree.closest(x).distance2), distance, test::ulps<S>(8) * size);
        CHECK_ABSOLUTE(std::sqrt(whole.closest(x).distance2), distance, test::ulps<S>(8) * size);
        CHECK(tree.raycast(x, Vec3<S>::UnitX()).t == fresh.raycast(x, Vec3<S>::UnitX()).t);
      }
    }
    check_boxes(whole);
  }
}

TEST_CASE_TEMPLATE("bvh: queries and moves that are not finite", S, float, double) {
  const S nan = std::numeric_limits<S>::quiet_NaN(), inf = std::numeric_limits<S>::infinity();
  const MeshData<S> mesh = Sphere<S>({.radius = S(0.03)}).mesh(100);
  TriangleBvh<S> tree(mesh);
  for (const Vec3<S>& bad : {Vec3<S>(nan, S(0), S(0)), Vec3<S>(S(0), inf, S(0)), Vec3<S>(S(0), S(0), -nan)}) {
    CHECK(tree.closest(bad, 7).triangle == 7);
    CHECK(tree.raycast(bad, Vec3<S>::UnitX()).triangle == tree.none);
    CHECK(tree.raycast(Vec3<S>::Zero(), bad).triangle == tree.none);
    tree.overlap(bad, S(1), [](const auto&) { FAIL("visited"); });
    const std::uint32_t v = 3;
    tree.move({&v, 1}, {&bad, 1});
    CHECK(tree.vertices()[v] == mesh.vertices[v]);
  }
  tree.overlap(Vec3<S>::Zero(), nan, [](const auto&) { FAIL("visited"); });
  CHECK(tree.raycast(Vec3<S>::Zero(), Vec3<S>::Zero()).triangle == tree.none);
  const Vec3<S> away = Vec3<S>::Constant((std::numeric_limits<S>::max)());
  CHECK(tree.closest(away).triangle < mesh.triangles.size());
}

TEST_CASE("bvh: many triangles at one position do not deepen the tree") {
  MeshData<double> mesh;
  mesh.vertices = {Vec3<double>(0, 0, 0), Vec3<double>(1, 0, 0), Vec3<double>(0, 1, 0)};
  mesh.triangles.assign(3000, {0, 1, 2});
  // And a row of triangles whose distances grow by a factor: the worst case for the heuristic.
  double x = 1e-4;
  for (int i = 0; i < 300; ++i, x *= 1.07) {
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const double dy : {0.0, 1e-6, 2e-6}) mesh.vertices.emplace_back(x, dy, dy * dy);
    mesh.triangles.push_back({n, n + 1, n + 2});
  }
  const TriangleBvh<double> tree(mesh);
  std::vector<int> depth(tree.nodes().size(), 0);
  for (std::size_t n = 0; n < depth.size(); ++n) {
    const auto& node = tree.nodes()[n];
    CHECK(node.count <= node.width);
    for (std::size_t i = 0; i < node.count && node.leaf == 0; ++i) depth[node.child[i]] = depth[n] + 1;
  }
  CHECK(*std::max_element(depth.begin(), depth.end()) <= 62);
  CHECK(tree.closest(Vec3<double>(0.1, 0.1, 3)).distance2 == 9);
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("bvh: refusals name what, where and the value") {
  using V = Vec3<double>;
  const auto refusal = [](const MeshData<double>& mesh) -> std::string {
    try {
      const TriangleBvh<double> tree(mesh);
    } catch (const SetupError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::vector<V> vertices{V(0, 0, 0), V(1, 0, 0), V(0, 1, 0)};
  CHECK(refusal({vertices, {}}) == "TriangleBvh: needs at least one triangle");
  CHECK(refusal({vertices, {{0, 1, 2}, {0, 1, 3}}}) ==
        "TriangleBvh: vertex does not exist, at triangle 1, got 3");
  CHECK(refusal({{V(0, 0, 0), V(1, 2e6, 0), V(0, 1, 0)}, {{0, 1, 2}}}) ==
        "TriangleBvh: position must be finite and below 1e6 m, at vertex 1");
}
#endif
