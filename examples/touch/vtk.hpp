// SPDX-License-Identifier: MIT
#pragma once

/// @file Frames as files that ParaView opens: one PolyData (.vtp) per frame, and a collection (.pvd) that has
/// their times.

#include <cstdio>
#include <memory>
#include <string>

#include "felt.hpp"

namespace touch {

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// For writing; a file that cannot be opened is reported.
inline File open_file(const std::string& name) {
  File file(std::fopen(name.c_str(), "w"));
  if (!file) palpate::fail("cannot write", name.c_str());
  return file;
}

/// "name_007.ext"
inline std::string numbered(const std::string& name, std::size_t number, const char* extension) {
  char text[32];
  std::snprintf(text, sizeof text, "_%03zu", number);
  return name + text + extension;
}

/// One kept moment.
struct Frame {
  double t;  ///< [s]
  Felt felt;
  std::vector<V> position, normal;  ///< of the display mesh's vertices [m], [-]

  /// All that the tool feels [N].
  [[nodiscard]] V force() const { return felt.wrench.force; }
};

/// Deformed surface with its displacement; lengths in metres.
inline void write_vtp(const std::string& name, const palpate::MeshData<S>& rest, const Frame& frame) {
  const File file = open_file(name);
  std::FILE* const out = file.get();
  const std::size_t n = rest.vertices.size(), m = rest.triangles.size();
  const auto vectors = [&](const char* what, const auto& vector) {
    std::fprintf(out, "<DataArray type=\"Float32\" Name=\"%s\" NumberOfComponents=\"3\" format=\"ascii\">\n",
                 what);
    for (std::size_t i = 0; i < n; ++i) {
      const V v = vector(i);
      std::fprintf(out, "%.6g %.6g %.6g\n", v.x(), v.y(), v.z());
    }
    std::fputs("</DataArray>\n", out);
  };
  const auto displacement = [&](std::size_t i) -> V { return frame.position[i] - rest.vertices[i]; };

  std::fputs(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<PolyData>\n",
      out);
  std::fprintf(out, "<Piece NumberOfPoints=\"%zu\" NumberOfPolys=\"%zu\">\n", n, m);
  std::fputs("<PointData Vectors=\"displacement_m\" Scalars=\"displacement_magnitude_m\">\n", out);
  vectors("displacement_m", displacement);
  std::fputs("<DataArray type=\"Float32\" Name=\"displacement_magnitude_m\" format=\"ascii\">\n", out);
  for (std::size_t i = 0; i < n; ++i) std::fprintf(out, "%.6g\n", displacement(i).norm());
  std::fputs("</DataArray>\n</PointData>\n<Points>\n", out);
  vectors("Points", [&](std::size_t i) { return frame.position[i]; });
  std::fputs("</Points>\n<Polys>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n", out);
  for (const auto& t : rest.triangles) std::fprintf(out, "%u %u %u\n", t[0], t[1], t[2]);
  std::fputs("</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n", out);
  for (std::size_t i = 1; i <= m; ++i) std::fprintf(out, "%zu\n", 3 * i);
  std::fputs("</DataArray>\n</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n", out);
}

/// folder/name.pvd and folder/name_NNN.vtp.
inline void write_series(const std::string& folder, const std::string& name, const palpate::MeshData<S>& rest,
                         const std::vector<Frame>& frames) {
  const File file = open_file(folder + "/" + name + ".pvd");
  std::fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
             file.get());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string part = numbered(name, i, ".vtp");
    std::fprintf(file.get(), "<DataSet timestep=\"%.4f\" file=\"%s\"/>\n", frames[i].t, part.c_str());
    write_vtp(folder + "/" + part, rest, frames[i]);
  }
  std::fputs("</Collection>\n</VTKFile>\n", file.get());
}

}  // namespace touch
