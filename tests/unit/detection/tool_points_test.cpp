// SPDX-License-Identifier: MIT

#include <palpate/detection/candidates.hpp>
#include <palpate/detection/detail/proximity_graph.hpp>
#include <palpate/detection/tool_points.hpp>

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>
#include <support/check.hpp>
#include <support/counting.hpp>
#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <random>
#include <string>

using namespace palpate;

namespace {

constexpr std::uint64_t seed = 20240607;

template <Real S>
Vec3<S> random_vector(std::mt19937_64& random, S size) {
  std::uniform_real_distribution<S> coordinate(-size, size);
  const S x = coordinate(random), y = coordinate(random), z = coordinate(random);
  return Vec3<S>(x, y, z);
}

template <Real S>
Mat3<S> random_rotation(std::mt19937_64& random) {
  std::normal_distribution<S> normal;
  const S w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaternion<S>(w, x, y, z).normalized().toRotationMatrix();
}

template <Real S>
std::vector<Vec3<S>> random_points(std::size_t count, S size) {
  std::mt19937_64 random(seed);
  std::vector<Vec3<S>> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(random_vector<S>(random, size));
  return points;
}

// Visits in ascending order, at most once, every point that is inside; returns the number of visits.
template <Real S, class B>
std::size_t check_walk(const ToolPoints<S>& tool, const Pose<S>& X, const B& body) {
  std::vector<std::uint32_t> visited;
  for_each_candidate(tool, X, body, [&](std::uint32_t i, const Vec3<S>& x) {
    CHECK((visited.empty() || visited.back() < i));
    // Three products and three sums, in another order than Eigen's.
    const S size = tool.point(i).norm() + X.translation.norm();
    CHECK((x - X * tool.point(i)).norm() <= 8 * std::numeric_limits<S>::epsilon() * size);
    visited.push_back(i);
  });
  for (std::uint32_t i = 0; i < tool.size(); ++i) {
    if (!(body.penetration(X * tool.point(i)).depth > S(0))) continue;
    if (!std::binary_search(visited.begin(), visited.end(), i))
      FAIL("point ", i, " is inside and was not visited");
  }
  return visited.size();
}

#if PALPATE_HAS_EXCEPTIONS
template <class Make>
std::string refusal(const Make& make) {
  try {
    make();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}
#endif

}  // namespace

TEST_CASE_TEMPLATE("tool points: the walk finds what brute force finds", S, float, double) {
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  const Sphere<S> sphere({.radius = S(0.03)});
  const Ellipsoid<S> ellipsoid({.axes = Vec3<S>(S(0.06), S(0.02), S(0.01))});
  const Box<S> box({.half = Vec3<S>(S(0.03), S(0.02), S(0.01))});
  const TriangleMesh<S> ball(Sphere<S>({.radius = S(0.015)}).mesh(2000));
  const ToolPoints<S> cloud(random_points<S>(777, S(0.02)), std::vector<S>(777, S(1e-6)),
                            {.contact_area = S(1e-4)});
  std::size_t visits = 0;
  for (const ToolPoints<S>& tool : {cloud, ToolPoints<S>(ball, {.contact_area = S(1e-4)})}) {
    for (int i = 0; i < 300; ++i) {
      const Pose<S> X{random_rotation<S>(random), random_vector<S>(random, S(0.07))};
      visits += check_walk(tool, X, sphere) + check_walk(tool, X, ellipsoid) + check_walk(tool, X, box);
    }
  }
  CHECK(visits > 10000);  // the poses must be ones where something happens
}

TEST_CASE_TEMPLATE("tool points: a pose that is_usable() just lets pass loses no point", S, float, double) {
  std::mt19937_64 random(seed);
  const Sphere<S> body({.radius = S(0.03)});
  const ToolPoints<S> tool(random_points<S>(500, S(0.02)), std::vector<S>(500, S(1e-6)),
                           {.contact_area = S(1e-4)});
  int tried = 0;
  for (int i = 0; i < 4000 && tried < 300; ++i) {
    Pose<S> X{random_rotation<S>(random), random_vector<S>(random, S(0.05))};
    // Two axes too long and leaning to each other, by nearly the tolerance of 1e-3.
    const Vec3<S> x = X.rotation.col(0), y = X.rotation.col(1);
    X.rotation.col(0) = (x + S(4.5e-4L) * y).normalized() * S(1.0004L);
    X.rotation.col(1) = (y + S(4.5e-4L) * x).normalized() * S(1.0004L);
    if (!is_usable(X)) continue;
    ++tried;
    (void)check_walk(tool, X, body);
  }
  CHECK(tried == 300);
}

TEST_CASE("tool points: 100,000 points cost what touches") {
  using V = Vec3<double>;
  const TriangleMesh<double> ball(Sphere<double>({.radius = 0.03}).mesh(100000));
  const ToolPoints<double> tool(ball, {.contact_area = 1e-4});
  REQUIRE(tool.size() > 99000);
  std::size_t asked = 0;
  const test::Counting<Sphere<double>> body{Sphere<double>({.radius = 0.05}), &asked};
  for (const double depth : {-0.1, -1e-4, 1e-5, 1e-4, 1e-3}) {
    CAPTURE(depth);
    Pose<double> X;
    X.translation = V(0, 0.08 - depth, 0);
    asked = 0;
    std::size_t visited = 0, touching = 0;
    const test::HeapCount heap;
    for_each_candidate(tool, X, body, [&](std::uint32_t, const V& x) {
      ++visited;
      touching += body.penetration(x).depth > 0;
    });
    CHECK(heap.allocations() == 0);
    if (depth < -0.05) CHECK(asked == 1);
    if (depth < 0) CHECK(touching == 0);
    // A leaf's ball of 16 points stands out by its radius, 0.6 mm here, so a patch of that depth's width is
    // visited even at the first touch: about 900 points; with more depth the share of those that touch grows.
    const double n = static_cast<double>(touching);
    CHECK(static_cast<double>(visited) <= 1.2 * n + 1100);
    CHECK(static_cast<double>(asked) <= 0.5 * n + 600);
    MESSAGE("depth ", depth, " m: ", touching, " touching, ", visited, " visited, ", asked, " balls tested");
  }
}

TEST_CASE_TEMPLATE("tool points: every ball holds its points and its children's ranges", S, float, double) {
  const std::vector<Vec3<S>> points = random_points<S>(1234, S(0.5));
  std::vector<S> areas;
  for (std::size_t i = 0; i < points.size(); ++i) areas.push_back(static_cast<S>(i + 1));
  const ToolPoints<S> tool(points, areas, {.contact_area = S(1)});
  for (std::uint32_t i = 0; i < tool.size(); ++i) {
    CHECK(tool.point(i) == points[tool.original(i)]);
    CHECK(tool.area(i) == areas[tool.original(i)]);
  }
  const auto nodes = tool.nodes();
  CHECK(nodes[0].begin == 0);
  CHECK(nodes[0].end == points.size());
  CHECK(nodes[0].skip == nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (std::uint32_t i = nodes[n].begin; i < nodes[n].end; ++i)
      CHECK((tool.point(i) - nodes[n].centre).norm() <= nodes[n].radius);
    if (nodes[n].skip == n + 1) {
      CHECK(nodes[n].end - nodes[n].begin <= batch_size);
    } else {
      const auto &left = nodes[n + 1], &right = nodes[left.skip];
      CHECK(left.begin == nodes[n].begin);
      CHECK(left.end == right.begin);
      CHECK(right.end == nodes[n].end);
      CHECK(right.skip == nodes[n].skip);
    }
  }
}

TEST_CASE_TEMPLATE("tool points: one point, and many at one position", S, float, double) {
  const Sphere<S> body({.radius = S(0.03)});
  for (const std::size_t n : {1u, 8u, 9u, 100u}) {
    const ToolPoints<S> tool(std::vector<Vec3<S>>(n, Vec3<S>::UnitX()), std::vector<S>(n, S(1)),
                             {.contact_area = S(1)});
    Pose<S> X;
    X.translation = Vec3<S>(S(-1), S(0.01), S(0));
    CHECK(check_walk(tool, X, body) == n);
    X.translation.y() = S(0.04);
    CHECK(check_walk(tool, X, body) == 0);
  }
}

TEST_CASE_TEMPLATE("tool points: resampling keeps the area and the spacing", S, float, double) {
  const S spacing = S(1e-3);
  const TriangleMesh<S> box(Box<S>({.half = Vec3<S>(S(0.01), S(0.006), S(0.01))}).mesh(8));
  const TriangleMesh<S> needle(Box<S>({.half = Vec3<S>(S(0.05), S(0.0002), S(0.0002))}).mesh(8));
  const TriangleMesh<S> fine(Sphere<S>({.radius = S(0.006)}).mesh(20000));
  for (const TriangleMesh<S>* mesh : {&box, &needle, &fine}) {
    const SurfaceSamples<S> samples = resample(*mesh, spacing);
    const std::size_t n = samples.points.size();
    REQUIRE(samples.areas.size() == n);
    long double sum = 0;
    for (const S a : samples.areas) {
      CHECK(a > S(0));
      sum += static_cast<long double>(a);
    }
    CHECK_RELATIVE(sum, mesh->area(),
                   test::ulps<S>(100));  // areas of small triangles, each rounded; errors average out
    const ToolPoints<S> tool(samples, {.contact_area = S(1e-4)});
    for (std::size_t i = 0; i < n; ++i) {
      S nearest = S(1);
      for (std::size_t j = 0; j < n; ++j)
        if (j != i) nearest = (std::min)(nearest, (tool.point(i) - tool.point(j)).norm());
      if (!(nearest >= S(0.7499L) * spacing && nearest <= S(1.501L) * spacing))
        FAIL("nearest ", nearest, " at ", i);
    }
    // No point of the surface is further than 1.5 spacings from a point: looked for at the mesh's own
    // vertices.
    for (const Vec3<S>& v : mesh->vertices()) {
      S nearest = S(1);
      for (const Vec3<S>& p : samples.points) nearest = (std::min)(nearest, (v - p).norm());
      CHECK(nearest <= S(1.5L) * spacing);
    }
    MESSAGE(mesh->vertices().size(), " vertices to ", n, " points, area per point / spacing^2 = ",
            static_cast<double>(mesh->area() / static_cast<S>(n) / spacing / spacing));
  }
  // A box's corners touch first: they are points.
  const SurfaceSamples<S> samples = resample(box, spacing);
  for (const Vec3<S>& v : box.vertices())
    CHECK(std::count(samples.points.begin(), samples.points.end(), v) == 1);
  // Same input, same bits.
  CHECK(resample(box, spacing).points == samples.points);
  // Coarser than the body: one point carries it all.
  const SurfaceSamples<S> one = resample(box, S(1));
  REQUIRE(one.points.size() == 1);
  CHECK_RELATIVE(one.areas[0], box.area(), test::ulps<S>(8));
}

TEST_CASE("tool points: resampled points push like the mesh's area") {
  // Pressure integrated over a ball pressed into a half space of depth h: area of the cap below = 2 pi R h.
  const TriangleMesh<double> ball(Sphere<double>({.radius = 0.006}).mesh(10000));
  const SurfaceSamples<double> samples = resample(ball, 0.3e-3);
  for (const double h : {0.001, 0.002, 0.004}) {
    double area = 0;
    for (std::size_t i = 0; i < samples.points.size(); ++i)
      if (samples.points[i].y() < -0.006 + h) area += samples.areas[i];
    // About 5000 points; the rim of the cap crosses some hundred of them, which count whole or not: 4 %.
    CHECK_RELATIVE(area, 2 * 3.14159265 * 0.006 * h, 0.04);
  }
}

TEST_CASE_TEMPLATE("proximity graph: equals brute force", S, float, double) {
  const std::size_t n = 600;
  const ToolPoints<S> tool(random_points<S>(n, S(0.02)), std::vector<S>(n, S(1e-6)),
                           {.contact_area = S(1e-4)});
  for (const S r : {S(1e-9), S(1e-3), S(4e-3), S(8e-3)}) {
    const ProximityGraph<S> graph(tool, r);
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      std::vector<std::uint32_t> expected;
      for (std::uint32_t j = 0; j < n; ++j)
        if (j != i && (tool.point(i) - tool.point(j)).squaredNorm() < r * r) expected.push_back(j);
      wrong += !std::equal(expected.begin(), expected.end(), graph.neighbours(i).begin(),
                           graph.neighbours(i).end());
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("proximity graph: the tie |x_i - x_j| = r does not join") {
  using V = Vec3<double>;
  const ToolPoints<double> tool({V(0, 0, 0), V(1, 0, 0), V(2.5, 0, 0)}, {1, 1, 1}, {.contact_area = 1});
  CHECK(ProximityGraph<double>(tool, 1.0).neighbours(0).empty());
  CHECK(ProximityGraph<double>(tool, 1.25).neighbours(0).size() == 1);
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("tool points: refusals name what, where and the value") {
  using V = Vec3<double>;
  using Tool = ToolPoints<double>;
  const std::vector<V> points{V(0, 0, 0), V(1, 0, 0)};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal([&] { Tool(points, {1, 1}, {}); }) == "ToolPoints: contact_area [m^2] must be > 0, got 0");
  CHECK(refusal([&] {
          Tool(points, {1, 1}, {.contact_area = 1, .centre_of_mass = V(0, nan, 0)});
        }) == "ToolPoints: centre_of_mass [m] must be finite, got nan");
  CHECK(refusal([&] { Tool({}, {}, {.contact_area = 1}); }) == "ToolPoints: needs at least one point");
  CHECK(refusal([&] { Tool(points, {1}, {.contact_area = 1}); }) ==
        "ToolPoints: needs one area for each point, points minus areas must be 0, got 1");
  CHECK(refusal([&] {
          Tool({V(0, 0, 0), V(1, 2e6, 0)}, {1, 1}, {.contact_area = 1});
        }) == "ToolPoints: coordinates [m] must be finite and below 1e6, at point 1, got 2000000");
  CHECK(refusal([&] {
          Tool(points, {1, -2}, {.contact_area = 1});
        }) == "ToolPoints: area [m^2] must be > 0, at point 1, got -2");
  const TriangleMesh<double> box(Box<double>({}).mesh(8));
  CHECK(refusal([&] { Tool(box, {.contact_area = 1}, 0); }) == "ToolPoints: spacing [m] must be > 0, got 0");
  CHECK(refusal([&] { Tool(box, {.contact_area = 1}, 1e-7); }) ==
        "ToolPoints: spacing [m] asks for more than 10 million points, got 1e-07");
  const Tool crowd(std::vector<V>(100, V::Zero()), std::vector<double>(100, 1), {.contact_area = 1});
  CHECK(refusal([&] { ProximityGraph<double>(crowd, 0.5); }) ==
        "ProximityGraph: distance r [m] joins more than 64 points to each on average; take a smaller r or "
        "points further "
        "apart, got 0.5");
  CHECK(refusal([&] { ProximityGraph<double>(crowd, -1); }) ==
        "ProximityGraph: distance r [m] must be > 0, got -1");
}
#endif
