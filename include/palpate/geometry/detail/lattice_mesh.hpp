// SPDX-License-Identifier: MIT
#pragma once

/// @file Closed triangle meshes of a body that is the image of a cube: one construction for every exact
/// surface.
///
/// The lattice points on the surface of the cube [-1, 1]^3, nx x ny x nz cells, are mapped to the body and
/// every cell's face is cut along its shorter diagonal. There are 2 (nx ny + ny nz + nz nx) + 2 vertices. No
/// poles, so no clustering; edges and corners of the cube are always vertices.

#include <palpate/core/error.hpp>
#include <palpate/geometry/concept.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace palpate::detail {

using Cells = std::array<std::size_t, 3>;

[[nodiscard]] inline std::size_t lattice_vertices(const Cells& n) noexcept {
  return 2 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]) + 2;
}

inline void require_vertices(std::size_t vertices, const char* where) {
  if (vertices < 8) fail(where, "mesh needs at least 8 vertices", static_cast<double>(vertices));
  if (vertices > 1000000000u) fail(where, "mesh takes at most 1e9 vertices", static_cast<double>(vertices));
}

/// Finest equal division with at most `vertices` vertices.
[[nodiscard]] inline Cells equal_cells(std::size_t vertices) noexcept {
  std::size_t n = 1;
  while (6 * (n + 1) * (n + 1) + 2 <= vertices) ++n;
  return {n, n, n};
}

/// Finest division with cells of about one size on a cuboid with the given edge lengths, and at most
/// `vertices` vertices. Needles and plates have one cell across until the others are as small.
[[nodiscard]] inline Cells even_cells(std::size_t vertices, const std::array<double, 3>& edges) noexcept {
  const auto cells = [&](double spacing) {
    Cells n{};
    for (std::size_t i = 0; i < 3; ++i)
      n[i] = static_cast<std::size_t>((std::max)(1.0, std::floor(edges[i] / spacing + 0.5)));
    return n;
  };
  const double area = 2 * (edges[0] * edges[1] + edges[1] * edges[2] + edges[2] * edges[0]);
  // Cells of size h give about area / h^2 vertices: a quarter of the wanted size gives too many.
  double fine = 0.25 * std::sqrt(area / static_cast<double>(vertices));
  double coarse = 2 * (std::max)({edges[0], edges[1], edges[2]});  // one cell: 8 vertices
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(fine * coarse);
    (lattice_vertices(cells(middle)) <= vertices ? coarse : fine) = middle;
  }
  return cells(coarse);
}

/// Vertex numbers of the lattice points on the cube's surface: full bottom layer, rings, full top layer.
struct Lattice {
  Cells n;
  [[nodiscard]] std::uint32_t index(std::size_t i, std::size_t j, std::size_t k) const noexcept {
    const auto [nx, ny, nz] = n;
    const std::size_t layer = (nx + 1) * (ny + 1), ring = 2 * (nx + ny);
    if (k == 0) return static_cast<std::uint32_t>(j * (nx + 1) + i);
    const std::size_t base = layer + (k - 1) * ring;
    if (k == nz) return static_cast<std::uint32_t>(base + j * (nx + 1) + i);
    if (j == 0) return static_cast<std::uint32_t>(base + i);
    if (i == nx) return static_cast<std::uint32_t>(base + nx + j);
    if (j == ny) return static_cast<std::uint32_t>(base + nx + ny + (nx - i));
    return static_cast<std::uint32_t>(base + 2 * nx + ny + (ny - j));
  }
};

/// The lattice points by number: exactly +-1 at the ends and exactly symmetric.
template <Real S>
[[nodiscard]] std::vector<Vec3<S>> lattice_points(const Lattice& lattice) {
  const auto [nx, ny, nz] = lattice.n;
  const auto coordinate = [](std::size_t i, std::size_t cells) {
    return (S(2) * static_cast<S>(i) - static_cast<S>(cells)) / static_cast<S>(cells);
  };
  std::vector<Vec3<S>> points(lattice_vertices(lattice.n));
  for (std::size_t k = 0; k <= nz; ++k) {
    for (std::size_t j = 0; j <= ny; ++j) {
      const bool full = k == 0 || k == nz || j == 0 || j == ny;
      for (std::size_t i = 0; i <= nx; i += full ? 1 : nx)
        points[lattice.index(i, j, k)] = Vec3<S>(coordinate(i, nx), coordinate(j, ny), coordinate(k, nz));
    }
  }
  return points;
}

/// Two triangles for every cell's face, by the shorter diagonal between the vertices p.
template <Real S>
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> lattice_triangles(const Lattice& lattice,
                                                                          const std::vector<Vec3<S>>& p) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(2 * (p.size() - 2));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const std::size_t level : {std::size_t{0}, lattice.n[axis]}) {
      for (std::size_t b = 0; b < lattice.n[v]; ++b) {
        for (std::size_t a = 0; a < lattice.n[u]; ++a) {
          const auto corner = [&](std::size_t da, std::size_t db) {
            Cells at{};
            at[axis] = level, at[u] = a + da, at[v] = b + db;
            return lattice.index(at[0], at[1], at[2]);
          };
          std::array<std::uint32_t, 4> q{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
          if (level == 0) std::swap(q[1], q[3]);
          const bool first = (p[q[0]] - p[q[2]]).squaredNorm() <= (p[q[1]] - p[q[3]]).squaredNorm();
          triangles.push_back({q[0], q[1], first ? q[2] : q[3]});
          triangles.push_back({first ? q[0] : q[1], q[2], q[3]});
        }
      }
    }
  }
  return triangles;
}

/// Mesh of the image of the cube's surface under `map`, a homeomorphism that keeps orientation.
template <Real S, class Map>
[[nodiscard]] MeshData<S> lattice_mesh(const Cells& n, Map map) {
  const Lattice lattice{n};
  MeshData<S> mesh;
  mesh.vertices = lattice_points<S>(lattice);
  for (Vec3<S>& x : mesh.vertices) x = map(x);
  mesh.triangles = lattice_triangles(lattice, mesh.vertices);
  return mesh;
}

/// A point of the cube's surface sent to the unit sphere, lattice lines at equal angles: cells differ in area
/// by less than sqrt(2) where plain normalisation gives 5.2.
template <Real S>
[[nodiscard]] inline Vec3<S> cube_to_sphere(const Vec3<S>& c) noexcept {
  constexpr S quarter = S(0.785398163397448309615660845819875721L);
  // tan(pi/4) rounds to slightly off 1 and would part the shared edges of two faces from the symmetric grid.
  const auto warp = [](S s) { return s == S(1) || s == S(-1) ? s : std::tan(quarter * s); };
  return Vec3<S>(warp(c.x()), warp(c.y()), warp(c.z())).normalized();
}

}  // namespace palpate::detail
