// SPDX-License-Identifier: MIT
#pragma once

/// @file A body meshed by gmsh for finite elements: curved ten-node tetrahedra.
///
/// Lengths in mm. A body with a plane of symmetry is meshed on its positive side only.

#include "truth/case.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace bench {

/// Box and cylinder stand on y = 0, about the axis y, and are fixed there; the others are fixed at y <=
/// fixed_height. Ellipsoid and rod, a cylinder along z, are centred. The bean, a bent rod with round ends,
/// has the middle of its axis at the origin and the middle of its axis' circle above it.
struct Body {
  enum { box, cylinder, ellipsoid, rod, bean } kind;
  V size;  ///< box: edges; cylinder: radius, height, radius; ellipsoid: semi-axes; rod: radius, radius, half
           ///< its length; bean: the circle's radius, the rod's, again [mm]
  double fixed_height = 0;              ///< height up to which the surface is fixed [mm]
  bool half_x = false, half_z = false;  ///< x = 0, z = 0 is a plane of symmetry
  double bend = 0;                      ///< bean: angle from its middle to the axis' ends [rad]

  /// Does it stand on y = 0?
  bool stands() const { return kind == box || kind == cylinder; }
  /// Its least extent [mm].
  double smallest() const {
    return kind == cylinder ? (std::min)(2 * size.x(), size.y()) : (kind == box ? 1 : 2) * size.minCoeff();
  }
};

/// Ten-node tetrahedra: corners, then the middles of edges 01, 12, 20, 03, 23, 13.
struct Tetrahedra {
  std::vector<V> nodes;
  std::vector<std::array<int, 10>> elements;
};

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  out.precision(12);
  (out << ... << parts);
  return out.str();
}

/// Reads version 2.2 of gmsh's format. Throws std::runtime_error when the file holds no ten-node tetrahedra.
inline Tetrahedra read_msh(const std::string& path) {
  std::istringstream in(read_text(path));
  Tetrahedra mesh;
  std::map<long, V> position;
  std::map<long, int> number;
  for (std::string word; in >> word;) {
    long count = 0;
    if (word == "$Nodes") {
      in >> count;
      for (long i = 0, id; i < count; ++i) {
        in >> id;
        V& p = position[id];
        in >> p.x() >> p.y() >> p.z();
      }
    } else if (word == "$Elements") {
      in >> count;
      std::string line;
      std::getline(in, line);
      for (long i = 0; i < count && std::getline(in, line); ++i) {
        std::istringstream words(line);
        long id, type, tags;
        words >> id >> type >> tags;
        if (type != 11) continue;
        for (long t = 0; t < tags; ++t) words >> id;
        std::array<int, 10> element{};
        for (int& node : element) {
          words >> id;
          const auto [at, fresh] = number.try_emplace(id, static_cast<int>(mesh.nodes.size()));
          if (fresh) mesh.nodes.push_back(position.at(id));
          node = at->second;
        }
        mesh.elements.push_back(element);
      }
    }
  }
  if (mesh.elements.empty()) throw std::runtime_error("no ten-node tetrahedra in " + path);
  return mesh;
}

}  // namespace bench
