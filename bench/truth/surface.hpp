// SPDX-License-Identifier: MIT
#pragma once

/// @file The outer surface of a meshed body, and files to write.

#include "truth/tetrahedra.hpp"

#include <cstdio>
#include <map>
#include <stdexcept>

namespace bench {

// The surface: nodes of the elements' outer faces, four triangles to a face, mirrored to the whole body.
struct Surface {
  std::vector<int> node;    // of each vertex
  std::vector<V> sign;      // mirrored along an axis: -1
  std::vector<V> position;  // [mm]
  std::vector<std::array<int, 3>> triangles;
  std::vector<double> area;               // [mm^2]
  std::vector<char> outer;                // by node: is it on the surface, mirrors aside?
  std::vector<std::array<int, 6>> faces;  // the elements', not mirrored
};
inline Surface surface_of(const Tetrahedra& mesh, const Body& body) {
  constexpr int faces[4][6] = {
      {0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {1, 2, 3, 5, 8, 9}, {0, 3, 2, 7, 8, 6}};
  std::map<std::array<int, 3>, std::pair<int, std::array<int, 6>>> seen;
  for (const auto& e : mesh.elements)
    for (const auto& face : faces) {
      std::array<int, 6> nodes;
      for (int i = 0; i < 6; ++i) nodes[i] = e[face[i]];
      std::array<int, 3> key{nodes[0], nodes[1], nodes[2]};
      std::sort(key.begin(), key.end());
      auto& entry = seen[key];
      ++entry.first;
      entry.second = nodes;
    }
  const double near = 1e-7 * body.size.maxCoeff();
  Surface s;
  s.outer.assign(mesh.nodes.size(), 0);
  std::map<std::array<int, 3>, int> number;  // node, mirrored along x, along z
  for (const auto& [key, entry] : seen) {
    if (entry.first != 1) continue;
    const auto& n = entry.second;
    const auto on_mirror = [&](int axis) {
      return std::all_of(n.begin(), n.end(), [&](int i) { return std::abs(mesh.nodes[i][axis]) < near; });
    };
    if ((body.half_x && on_mirror(0)) || (body.half_z && on_mirror(2))) continue;
    for (int i : n) s.outer[i] = 1;
    s.faces.push_back(n);
    for (int mx = 0; mx <= body.half_x; ++mx)
      for (int mz = 0; mz <= body.half_z; ++mz) {
        std::array<int, 6> vertex;
        for (int i = 0; i < 6; ++i) {
          const V& p = mesh.nodes[n[i]];
          const int kx = mx && std::abs(p.x()) > near, kz = mz && std::abs(p.z()) > near;
          const auto [at, fresh] = number.try_emplace({n[i], kx, kz}, static_cast<int>(s.node.size()));
          if (fresh) {
            s.node.push_back(n[i]);
            s.sign.push_back(V(kx ? -1 : 1, 1, kz ? -1 : 1));
            s.position.push_back(p.cwiseProduct(s.sign.back()));
          }
          vertex[i] = at->second;
        }
        constexpr int parts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
        for (const auto& part : parts) {
          std::array<int, 3> t{vertex[part[0]], vertex[part[1]], vertex[part[2]]};
          if (mx != mz) std::swap(t[1], t[2]);
          s.triangles.push_back(t);
        }
      }
  }
  s.area.assign(s.node.size(), 0);
  for (const auto& t : s.triangles)
    for (int c : t)
      s.area[c] +=
          (s.position[t[1]] - s.position[t[0]]).cross(s.position[t[2]] - s.position[t[0]]).norm() / 6;
  return s;
}

struct File {
  File(const std::string& path, const char* head) : file(std::fopen(path.c_str(), "w")) {
    if (file == nullptr) throw std::runtime_error("cannot write " + path);
    std::fputs(head, file);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { std::fclose(file); }
  FILE* file;
};

}  // namespace bench
