// SPDX-License-Identifier: MIT
#pragma once

/// @file  Closed meshes for tests, and a slow, independent answer to what is closest and what is inside.

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sphere.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace palpate::test {

/// Ring of `around` x `across` vertices about the y axis, radii R and r.
template <Real S>
[[nodiscard]] inline MeshData<S> torus(S R, S r, std::uint32_t around, std::uint32_t across) {
  MeshData<S> mesh;
  const S turn = S(6.28318530717958647692528676655900577L);
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const S u = turn * static_cast<S>(i) / static_cast<S>(around),
              v = turn * static_cast<S>(j) / static_cast<S>(across);
      const S rho = R + r * std::cos(v);
      mesh.vertices.emplace_back(rho * std::cos(u), r * std::sin(v), rho * std::sin(u));
      const auto at = [&](std::uint32_t a, std::uint32_t b) {
        return (i + a) % around * across + (j + b) % across;
      };
      mesh.triangles.push_back({at(0, 0), at(0, 1), at(1, 1)});
      mesh.triangles.push_back({at(0, 0), at(1, 1), at(1, 0)});
    }
  }
  return mesh;
}

/// A body with dents and knobs: a sphere whose radius varies by a third.
template <Real S>
[[nodiscard]] inline MeshData<S> blob(std::size_t vertices) {
  MeshData<S> mesh = Sphere<S>({.radius = S(1)}).mesh(vertices);
  for (Vec3<S>& v : mesh.vertices) {
    const Vec3<S> n = v.normalized();
    v *= S(0.03) * (S(1) + S(0.33) * std::sin(S(4) * n.x()) * std::cos(S(3) * n.y() + S(1)) + S(0.1) * n.z());
  }
  return mesh;
}

/// The five: sphere, ellipsoid, box, torus, blob.
template <Real S>
[[nodiscard]] inline std::vector<std::pair<const char*, MeshData<S>>> five_meshes(std::size_t vertices) {
  const auto side = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(vertices)));
  return {{"sphere", Sphere<S>({.radius = S(0.03)}).mesh(vertices)},
          {"ellipsoid", Ellipsoid<S>({.axes = Vec3<S>(S(0.06), S(0.02), S(0.01))}).mesh(vertices)},
          {"box", Box<S>({.half = Vec3<S>(S(0.03), S(0.02), S(0.01))}).mesh(vertices)},
          {"torus", torus<S>(S(0.03), S(0.01), side, side)},
          {"blob", blob<S>(vertices)}};
}

/// Is it a closed, oriented mesh with volume? Independent of inspect(): every directed edge once, its reverse
/// once, every vertex used and finite, every triangle with an area, and the right sign of the volume, all in
/// long double.
template <Real S>
[[nodiscard]] inline bool is_sound(const MeshData<S>& mesh) {
  using V = Vec3<long double>;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::vector<bool> used(mesh.vertices.size(), false);
  long double volume = 0;
  for (const auto& t : mesh.triangles) {
    std::array<V, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[k] >= mesh.vertices.size() || !edges.insert({t[k], t[(k + 1) % 3]}).second) return false;
      used[t[k]] = true;
      p[k] = mesh.vertices[t[k]].template cast<long double>();
      if (!is_finite(mesh.vertices[t[k]])) return false;
    }
    if (!((p[1] - p[0]).cross(p[2] - p[0]).norm() > 0)) return false;
    volume += p[0].dot(p[1].cross(p[2]));
  }
  for (const auto& [a, b] : edges)
    if (a == b || edges.count({b, a}) == 0) return false;
  return volume > 0 && !mesh.triangles.empty() && std::find(used.begin(), used.end(), false) == used.end();
}

/// Distance from x to the triangle (a, b, c), in long double: plane where the foot is inside, else the three
/// edges.
[[nodiscard]] inline long double triangle_distance(const Vec3<long double>& x, const Vec3<long double>& a,
                                                   const Vec3<long double>& b, const Vec3<long double>& c) {
  using V = Vec3<long double>;
  const V n = (b - a).cross(c - a);
  const auto left = [&](const V& p, const V& q) { return (q - p).cross(x - p).dot(n) >= 0; };
  if (left(a, b) && left(b, c) && left(c, a)) return std::fabs((x - a).dot(n)) / n.norm();
  const auto edge = [&](const V& p, const V& q) {
    long double t = (x - p).dot(q - p) / (q - p).squaredNorm();
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return (x - p - t * (q - p)).norm();
  };
  return (std::min)({edge(a, b), edge(b, c), edge(c, a)});
}

/// Signed distance by brute force: the least distance, and the winding number (1 inside, 0 outside) for the
/// sign.
template <Real S>
[[nodiscard]] inline long double brute_force_distance(const MeshData<S>& mesh, const Vec3<S>& x) {
  using V = Vec3<long double>;
  long double least = 1e30L;
  double angle = 0;
  for (const auto& t : mesh.triangles) {
    const V a = mesh.vertices[t[0]].template cast<long double>(),
            b = mesh.vertices[t[1]].template cast<long double>(),
            c = mesh.vertices[t[2]].template cast<long double>(), at = x.template cast<long double>();
    least = (std::min)(least, triangle_distance(at, a, b, c));
    const Vec3<double> p = (a - at).template cast<double>(), q = (b - at).template cast<double>(),
                       r = (c - at).template cast<double>();
    const double l = p.norm(), m = q.norm(), n = r.norm();
    angle += std::atan2(p.dot(q.cross(r)), l * m * n + p.dot(q) * n + q.dot(r) * l + r.dot(p) * m);
  }
  return angle > 3.14159265358979 ? -least : least;
}

/// A random position in the mesh's box grown by half; every fourth on the surface or within 1e-3 of the size
/// of it.
template <Real S>
[[nodiscard]] inline Vec3<S> random_position(const MeshData<S>& mesh, std::mt19937_64& random) {
  std::uniform_real_distribution<S> unit(S(0), S(1));
  Vec3<S> low = mesh.vertices[0], high = low;
  for (const Vec3<S>& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const S a = unit(random), b = unit(random), c = unit(random);
  if (random() % 4 != 0)
    return low + (Vec3<S>(a, b, c) * S(1.5) - Vec3<S>::Constant(S(0.25))).cwiseProduct(high - low);
  const auto& t = mesh.triangles[random() % mesh.triangles.size()];
  const S u = a < b ? a : b, v = a < b ? b - a : a - b;  // even on the triangle
  const Vec3<S> on = u * mesh.vertices[t[0]] + v * mesh.vertices[t[1]] + (S(1) - u - v) * mesh.vertices[t[2]];
  const S away = random() % 2 == 0 ? S(0) : S(1e-3) * (high - low).maxCoeff();
  return on + away * (Vec3<S>(c, a, b) * S(2) - Vec3<S>::Ones());
}

}  // namespace palpate::test
