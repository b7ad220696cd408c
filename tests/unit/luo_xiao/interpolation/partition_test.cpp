// SPDX-License-Identifier: MIT
#include "contract/interpolation.hpp"

#include <palpate/luo_xiao/interpolation/detail/face_weights.hpp>
#include <palpate/luo_xiao/interpolation/detail/hull.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>

#include <doctest/doctest.h>

using namespace palpate;
using palpate::test::ulps;

namespace {

constexpr std::uint64_t seed = 63;

Vec3<double> random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> gauss;
  return Vec3<double>(gauss(random), gauss(random), gauss(random)).normalized();
}

/// All weights at every slot, the contact's last: rows of extremal points + 1.
template <Real S>
std::vector<std::vector<S>> all_weights(const FacePartition<S>& part, const PointWeights<S>& at) {
  std::vector<std::vector<S>> result(part.size(), std::vector<S>(part.points().size() + 1, S(0)));
  for (std::size_t f = 0; f < part.faces().size(); ++f) {
    const Face<S>& face = part.faces()[f];
    detail::with_weights(part, at, f, 0, [&](const auto& weights) {
      using V = detail::simd_group<S>;
      for (std::size_t i = 0; i < face.count; i += V::size()) {
        weights.at(i).each_term([&](std::size_t k, const V& weight) {
          const std::size_t column = k < face.corners ? face.corner[k] : part.points().size();
          for (std::size_t j = 0; j < V::size() && i + j < face.count; ++j)
            result[face.first + i + j][column] = weight[j];
        });
      }
    });
  }
  return result;
}

template <class Body>
void check_unity(const Body& body) {
  using S = typename Body::Scalar;
  const auto part = make_partition(body, body.mesh(1000));
  std::mt19937_64 random(seed);
  INFO("seed ", seed);
  const Vec3<S> middle = (body.lower() + body.upper()) / S(2);
  double lowest = 0, off = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const auto at = part.locate(body.raycast(middle, random_direction(random).template cast<S>()).position);
    REQUIRE(at.valid);
    for (const auto& w : all_weights(part, at)) {
      long double sum = 0;
      for (const S value : w) {
        lowest = std::min(lowest, static_cast<double>(value));
        sum += static_cast<long double>(value);
      }
      off = std::max(off, static_cast<double>(std::fabs(sum - 1)));
    }
  }
  CHECK(lowest >= 0.0);
  CHECK(off <= static_cast<double>(ulps<S>(8)));  // at most nine weights are added and divided by their sum
}

const Ellipsoid<double> ellipsoid({.axes = {0.03, 0.02, 0.015}});

/// Barycentric coordinates of the ray towards v in the cone of a, b, c.
std::array<long double, 3> reference(const Vec3<double>& v, const Vec3<double>& a, const Vec3<double>& b,
                                     const Vec3<double>& c) {
  using L = Eigen::Matrix<long double, 3, 1>;
  const L x = v.cast<long double>(), p = a.cast<long double>(), q = b.cast<long double>(),
          r = c.cast<long double>();
  const long double A = x.dot(q.cross(r)), B = x.dot(r.cross(p)), C = x.dot(p.cross(q));
  return {A / (A + B + C), B / (A + B + C), C / (A + B + C)};
}

}  // namespace

TEST_CASE("hull: a corner within the tolerance of a facet's plane belongs to it, beyond it not") {
  const double tolerance = 1e-3;
  const auto facets = [&](double out) {
    std::vector<Vec3<double>> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back(Vec3<double>(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1) / std::sqrt(3.0));
    corners[7].z() += out;
    return detail::hull_facets(corners, tolerance, "hull").size();
  };
  CHECK(facets(0.9 * tolerance) == 6);
  CHECK(facets(-0.9 * tolerance) == 6);
  CHECK(facets(1.1 * tolerance) == 7);  // two triangles for the square
}

TEST_CASE_TEMPLATE("weights are >= 0 and sum to 1, with and without a contact", S, float, double) {
  check_unity(Ellipsoid<S>({.axes = {S(0.03), S(0.02), S(0.015)}}));
  check_unity(Box<S>({.half = {S(0.03), S(0.02), S(0.015)}}));
  check_unity(Cylinder<S>(typename Cylinder<S>::Params{}));
  check_unity(Superellipsoid<S>(typename Superellipsoid<S>::Params{}));
}

TEST_CASE("faces: an octahedron of triangles, six quadrilaterals on a box, caps of a cylinder") {
  CHECK(make_partition(ellipsoid, ellipsoid.mesh(100)).faces().size() == 8);
  const Box<float> box(Box<float>::Params{});
  const auto part = make_partition(box, box.mesh(100));
  REQUIRE(part.faces().size() == 6);
  for (const auto& face : part.faces()) CHECK(face.corners == 4);
  const Cylinder<double> cylinder(Cylinder<double>::Params{});
  CHECK(make_partition(cylinder, cylinder.mesh(100)).faces().size() == 6);
  std::size_t vertices = 0;
  for (const auto& face : part.faces()) vertices += face.count;
  CHECK(vertices == part.size());
}

TEST_CASE("faces: 64 random points on a sphere give a closed triangulation") {
  std::mt19937_64 random(seed);
  std::vector<ExtremalPoint<double>> points;
  for (int i = 0; i < 64; ++i) {
    const auto d = random_direction(random);
    points.push_back({0.03 * d, d});
  }
  const Sphere<double> sphere({.radius = 0.03});
  const auto mesh = sphere.mesh(500);
  std::vector<Vec3<double>> normals;
  for (const auto& v : mesh.vertices) normals.push_back(v.normalized());
  const FacePartition<double> part(mesh, normals, points, Vec3<double>::Zero());
  CHECK(part.faces().size() == 2 * 64 - 4);  // Euler
}

TEST_CASE("base weights of a triangle: barycentric coordinates of the ray's point, against long double") {
  const auto mesh = ellipsoid.mesh(500);
  const auto part = make_partition(ellipsoid, mesh);
  for (std::size_t slot = 0; slot < part.size(); ++slot) {
    const Vec3<double>& v = mesh.vertices[part.order()[slot]];
    const auto at = part.locate(v);
    const Face<double>& face = part.faces()[at.face];
    const auto exact =
        reference(v, part.points()[face.corner[0]].position, part.points()[face.corner[1]].position,
                  part.points()[face.corner[2]].position);
    // Three determinants whose terms do not cancel: the centre is the origin.
    for (std::size_t k = 0; k < 3; ++k) CHECK_ABSOLUTE(at.weight[face.corner[k]], exact[k], ulps<double>(8));
  }
}

TEST_CASE("box: weights are bilinear on each face") {
  const Box<double> box({.half = {0.02, 0.02, 0.02}});
  const auto part = make_partition(box, box.mesh(400));
  const auto at = part.locate(Vec3<double>(0.01, 0.02, -0.004));
  const double s = 0.75, t = 0.4;  // along x and z
  for (unsigned i = 0; i < 8; ++i) {
    const double exact = (i & 2u) == 0 ? 0.0 : ((i & 1u) ? s : 1 - s) * ((i & 4u) ? t : 1 - t);
    CHECK_ABSOLUTE(at.weight[i], exact, ulps<double>(8));
  }
}

TEST_CASE(
    "contact well inside a face: exactly the split of that face into three triangles, others untouched") {
  const auto mesh = ellipsoid.mesh(800);
  const auto part = make_partition(ellipsoid, mesh);
  const Vec3<double> p = ellipsoid.raycast(Vec3<double>::Zero(), Vec3<double>(0.01, 0.008, 0.006)).position;
  const auto at = part.locate(p);
  const Face<double>& face = part.faces()[at.face];
  const auto weights = all_weights(part, at);
  std::array<Vec3<double>, 3> corner;
  Vec3<double> flat_p = Vec3<double>::Zero();  // the contact in the plane of its face
  for (std::size_t k = 0; k < 3; ++k) {
    REQUIRE(at.weight[face.corner[k]] >= part.params().fade);
    corner[k] = part.points()[face.corner[k]].position;
    flat_p += at.weight[face.corner[k]] * corner[k];
  }
  for (std::size_t slot = 0; slot < part.size(); ++slot) {
    const bool inside = slot >= face.first && slot < face.first + face.count;
    if (!inside) {
      CHECK(weights[slot].back() == 0.0);
      continue;
    }
    // The sub-triangle that contains the vertex is the one with no negative coordinate.
    const Vec3<double>& v = mesh.vertices[part.order()[slot]];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto exact = reference(v, flat_p, corner[k], corner[(k + 1) % 3]);
      if (exact[0] < -1e-15L || exact[1] < -1e-15L || exact[2] < -1e-15L) continue;
      // The split divides by weights of at least 0.1.
      CHECK_ABSOLUTE(weights[slot].back(), exact[0], ulps<double>(64));
      CHECK_ABSOLUTE(weights[slot][face.corner[k]], exact[1], ulps<double>(64));
      CHECK_ABSOLUTE(weights[slot][face.corner[(k + 1) % 3]], exact[2], ulps<double>(64));
    }
  }
}

TEST_CASE("contact on an edge or a corner: the same weights from every side") {
  const auto part = make_partition(ellipsoid, ellipsoid.mesh(800));
  const auto position = [](const Vec3<double>& d) {
    return ellipsoid.raycast(Vec3<double>::Zero(), d).position;
  };
  for (const Vec3<double>& d :
       {Vec3<double>(0.03, 0.02, 0), Vec3<double>(0, 0.001, 0.015), Vec3<double>(0.03, 0, 0)}) {
    const auto middle = all_weights(part, part.locate(position(d)));
    for (int side = 0; side < 8; ++side) {
      const Vec3<double> off((side & 1) ? 1e-9 : -1e-9, (side & 2) ? 1e-9 : -1e-9, (side & 4) ? 1e-9 : -1e-9);
      const auto near = all_weights(part, part.locate(position(d + off)));
      double worst = 0;
      for (std::size_t slot = 0; slot < part.size(); ++slot) {
        for (std::size_t i = 0; i < middle[slot].size(); ++i)
          worst = std::max(worst, std::fabs(near[slot][i] - middle[slot][i]));
      }
      CHECK(worst <= 1e-5);  // 1e-9 of 0.015, times a slope of at most 40
    }
  }
}

TEST_CASE(
    "continuous across faces: neighbours in the mesh have nearly the same weights, and nearer as it is "
    "refined") {
  double coarse = 0;
  for (const std::size_t vertices : {2400u, 9600u, 38400u}) {
    const auto mesh = ellipsoid.mesh(vertices);
    const auto part = make_partition(ellipsoid, mesh);
    std::vector<std::size_t> slot_of(part.size());
    for (std::size_t slot = 0; slot < part.size(); ++slot) slot_of[part.order()[slot]] = slot;
    std::mt19937_64 random(seed);
    double worst = 0, longest = 0;
    for (int trial = 0; trial < 10; ++trial) {
      const auto w = all_weights(part, part.locate(random_direction(random)));
      for (const auto& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
          const auto &a = w[slot_of[t[k]]], &b = w[slot_of[t[(k + 1) % 3]]];
          longest = std::max(longest, (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm());
          for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::fabs(a[i] - b[i]));
        }
      }
    }
    CHECK(worst <= 40 * longest / 0.03);           // slope 1/fade, times the weights' own
    if (coarse > 0) CHECK(worst <= 0.7 * coarse);  // first order: half, on an irregular mesh
    coarse = worst;
  }
}

TEST_CASE("a mesh sorted by face: the same triangles in space, and slots in the mesh's order") {
  const auto mesh = ellipsoid.mesh(200);
  const auto sorted = sorted_by_face(mesh, make_partition(ellipsoid, mesh));
  const auto part = make_partition(ellipsoid, sorted);
  for (std::size_t slot = 0; slot < part.size(); ++slot) CHECK(part.order()[slot] == slot);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(sorted.vertices[sorted.triangles[t][k]] == mesh.vertices[mesh.triangles[t][k]]);
  }
}

TEST_CASE("positions that are not finite are not located") {
  const auto part = make_partition(ellipsoid, ellipsoid.mesh(100));
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  CHECK(!part.locate(Vec3<double>(nan, 0, 0)).valid);
  CHECK(!part.locate(Vec3<double>(0, infinity, 0)).valid);
  CHECK(!part.locate(Vec3<double>::Zero()).valid);
  CHECK(part.locate(Vec3<double>(1e300, 1, 1)).valid);  // far away still has a direction
}

TEST_CASE("set-up refuses what cannot be cut into faces") {
  const auto mesh = ellipsoid.mesh(50);
  std::vector<Vec3<double>> normals(mesh.vertices.size(), Vec3<double>::UnitX());
  using Points = std::vector<ExtremalPoint<double>>;
  const auto make = [&](const Points& points) {
    (void)FacePartition<double>(mesh, normals, points, Vec3<double>::Zero());
  };
  Points points = extremal_points(ellipsoid);
  CHECK_NOTHROW(make(points));
  CHECK_THROWS_WITH(make(Points(points.begin(), points.begin() + 3)),
                    "FacePartition: needs at least 4 extremal points, got 3");
  // One side open, and a pair of equal points.
  CHECK_THROWS_AS(make(Points(points.begin(), points.begin() + 5)), SetupError);
  Points doubled = points;
  doubled.push_back(points[0]);
  CHECK_THROWS_AS(make(doubled), SetupError);
  points[2].position.y() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(make(points), "FacePartition: position and normal must be finite, at extremal point 2");
  normals.pop_back();
  CHECK_THROWS_AS(make(extremal_points(ellipsoid)), SetupError);
  CHECK_THROWS_AS((void)make_partition(ellipsoid, mesh, {.fade = 0.2}), SetupError);
}
