// SPDX-License-Identifier: MIT
#pragma once

/// @file Closed triangle meshes from files of any format that Assimp reads. Needs Assimp 5; set-up only.

#include <palpate/core/error.hpp>
#include <palpate/geometry/mesh_report.hpp>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace palpate {

struct ReadMeshParams {
  double scale = 1;  ///< metres per unit of the file, > 0
  char up = 'y';     ///< the file's axis that becomes y: 'x', 'y' or 'z'
};

namespace detail {
/// The vertex that stands for the position of a defect; none: past the last.
[[nodiscard]] inline std::size_t vertex_of(const MeshReport::Entry& e, MeshDefect d,
                                           const MeshData<double>& mesh) noexcept {
  using enum MeshDefect;
  if (d == empty || d == too_large || d == bad_index) return mesh.vertices.size();
  if (d == bad_vertex || d == duplicate_vertex || d == unused_vertex || d == non_manifold_vertex)
    return e.first;
  if (d == open_edge || d == non_manifold_edge || d == inconsistent_orientation) return e.a;
  return mesh.triangles[e.first][0];
}
}  // namespace detail

/// The file's triangles in metres, y up: all its parts with their transformations, polygons cut up, points
/// and lines left out, vertices of one position made one (OBJ and STL do not say which are meant to be the
/// same), and triangles that this leaves without three corners dropped.
///
/// Reports a file that cannot be read, and a mesh that is not closed and oriented: the first defect of
/// mesh_report.hpp, with a position in the file's units. Nothing is mended by guessing. Coordinates have
/// float's digits, as Assimp has them. Do not give it files from strangers: damaged ones, PLY most of all,
/// make some versions of Assimp abort or hang.
[[nodiscard]] inline MeshData<double> read_mesh(const std::string& name, const ReadMeshParams& params = {}) {
  static constexpr const char* where = "read_mesh";
  const auto refuse = [&name](const char* why) {
    char text[230];
    std::snprintf(text, sizeof text, "%.60s: %s", name.c_str(), why);
    fail(where, text);
  };
  require_positive(params.scale, where, "scale [m] must be > 0");
  if (params.up != 'x' && params.up != 'y' && params.up != 'z') fail(where, "up must be 'x', 'y' or 'z'");

  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* const scene =
      importer.ReadFile(name, aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType);
  if (scene == nullptr) refuse(importer.GetErrorString());

  MeshData<double> mesh;
  std::vector<aiVector3D> in_file;                       // the vertices as the file has them
  std::map<std::array<float, 3>, std::uint32_t> number;  // of each position
  const auto vertex = [&](const aiVector3D& v) {
    const auto [found, is_new] = number.try_emplace({v.x + 0.0f, v.y + 0.0f, v.z + 0.0f},  // -0 is 0
                                                    static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      in_file.push_back(v);
      const Vec3<double> x = params.scale * Vec3<double>(double(v.x), double(v.y), double(v.z));
      mesh.vertices.push_back(params.up == 'y'   ? x
                              : params.up == 'z' ? Vec3<double>(x.x(), x.z(), -x.y())
                                                 : Vec3<double>(-x.y(), x.x(), x.z()));
    }
    return found->second;
  };
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;
      std::array<std::uint32_t, 3> t{};
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= part.mNumVertices) refuse("a face names a vertex that does not exist");
        t[k] = vertex(part.mVertices[face.mIndices[k]]);
      }
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
    }
  }
  const MeshReport report = inspect(mesh);
  for (std::size_t i = 0; i < mesh_defect_count; ++i) {
    const auto d = static_cast<MeshDefect>(i);
    if (report[d].count == 0) continue;
    char text[230];
    const int length = std::snprintf(text, sizeof text, "%s", describe(report, d).text);
    if (const std::size_t v = detail::vertex_of(report[d], d, mesh); v < in_file.size())
      std::snprintf(text + length, sizeof text - static_cast<std::size_t>(length),
                    "; near (%.4g, %.4g, %.4g)", double(in_file[v].x), double(in_file[v].y),
                    double(in_file[v].z));
    refuse(text);
  }
  return mesh;
}

}  // namespace palpate
