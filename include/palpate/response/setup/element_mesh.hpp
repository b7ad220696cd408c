// SPDX-License-Identifier: MIT
#pragma once

/// @file The boundary element mesh of a response field, and how fine it is. make_element_mesh.hpp makes it.

#include <palpate/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace palpate {

/// What the remesher aims at.
struct RemeshParams {
  double vertices = 600;   ///< wanted number of vertices [-]; slender parts get up to as many on top
  double rim_ratio = 0.3;  ///< r: edge length at the rim over that of the body [-]
  double growth = 0.35;    ///< g: edge length gained per distance from the rim, a crease or a thin part [-]
};

/// The boundary element mesh. Lengths [m].
struct ElementMesh {
  struct Node {
    std::uint32_t vertex;
    Vec3<double> normal;  ///< outward, unit
    Vec3<double> source;  ///< where a load of this node acts: the vertex, drawn inwards from a crease
    double size;          ///< mean length of the edges around
    bool crease;          ///< the vertex has other nodes
  };
  std::vector<Vec3<double>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 3>> nodes_of;  ///< per triangle corner
  std::vector<std::array<Vec3<double>, 3>> middle;     ///< point at the middle of edge (c, c + 1)
  std::vector<Node> nodes;
  std::vector<std::uint8_t> fixed_vertex, fixed_triangle;
  double length = 0;  ///< edge length away from the rim
};

namespace detail {

/// Quadratic triangle of the boundary element mesh: three corners, three middles of edges.
struct Element {
  Vec3<double> corner[3], middle[3];
  Vec3<double> centre;
  double edge = 0;  ///< longest [m]

  Element(const ElementMesh& mesh, std::size_t t) {
    for (std::size_t c = 0; c < 3; ++c) {
      corner[c] = mesh.vertices[mesh.triangles[t][c]];
      middle[c] = mesh.middle[t][c];
    }
    for (int c = 0; c < 3; ++c) edge = (std::max)(edge, (corner[c] - corner[(c + 1) % 3]).norm());
    centre = at(Vec3<double>::Constant(1.0 / 3));
  }
  [[nodiscard]] Vec3<double> at(const Vec3<double>& l) const noexcept {
    Vec3<double> x = Vec3<double>::Zero();
    for (int c = 0; c < 3; ++c)
      x += l[c] * (2 * l[c] - 1) * corner[c] + 4 * l[c] * l[(c + 1) % 3] * middle[c];
    return x;
  }
  /// Area vector: outward normal times 2 x area of the flat triangle, varying over a curved one.
  [[nodiscard]] Vec3<double> normal(const Vec3<double>& l) const noexcept {
    Vec3<double> d[3];
    for (int c = 0; c < 3; ++c)
      d[c] = (4 * l[c] - 1) * corner[c] +
             4 * (l[(c + 1) % 3] * middle[c] + l[(c + 2) % 3] * middle[(c + 2) % 3]);
    return (d[1] - d[0]).cross(d[2] - d[0]);
  }
};

}  // namespace detail

/// True where the elastic object is fixed. Called with points of the surface.
using FixedRegion = std::function<bool(const Vec3<double>&)>;

}  // namespace palpate
