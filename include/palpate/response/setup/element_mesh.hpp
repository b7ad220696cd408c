// SPDX-License-Identifier: MIT
#pragma once

/// @file The boundary element mesh of a response field, and how fine it is. make_element_mesh.hpp makes it.

#include <palpate/core/vector.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace palpate {

/// What the remesher aims at.
struct RemeshParams {
  double vertices = 600;   ///< wanted number of vertices [-]
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

/// True where the elastic object is fixed. Called with points of the surface.
using FixedRegion = std::function<bool(const Vec3<double>&)>;

}  // namespace palpate
