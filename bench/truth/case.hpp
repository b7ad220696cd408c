// SPDX-License-Identifier: MIT
#pragma once

/// @file  Reads a reference case: a folder with meta.json, surface.obj(.gz) and force.csv.

#include <palpate/geometry/triangle_mesh.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace bench {

using V = palpate::Vec3<double>;

/// The file's text; gzip does the unpacking.
inline std::string read_text(const std::string& path) {
  std::ifstream plain(path);
  if (plain) {
    std::ostringstream all;
    all << plain.rdbuf();
    return all.str();
  }
  std::string text;
  FILE* pipe = popen(("gzip -dc '" + path + ".gz'").c_str(), "r");
  if (pipe == nullptr) return text;
  char buffer[65536];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
  pclose(pipe);
  return text;
}

/// The numbers of a file of comma-separated values, its heading left out. Throws std::runtime_error where
/// there are none.
inline std::vector<std::vector<double>> csv_rows(const std::string& path) {
  std::istringstream in(read_text(path));
  std::string line;
  if (!std::getline(in, line)) throw std::runtime_error("nothing in " + path);
  std::vector<std::vector<double>> out;
  while (std::getline(in, line)) {
    out.emplace_back();
    for (const char* p = line.c_str(); *p != '\0'; p += *p == ',') {
      char* end = nullptr;
      out.back().push_back(std::strtod(p, &end));
      if (end == p) throw std::runtime_error("no number in " + path + ": " + line);
      p = end;
    }
  }
  return out;
}

/// The numbers after the next `key` from `from`: enough JSON for these files.
inline std::vector<double> numbers(const std::string& json, const char* key, std::size_t from = 0,
                                   std::size_t to = std::string::npos) {
  std::vector<double> out;
  const std::size_t at = json.find('"' + std::string(key) + '"', from);
  if (at == std::string::npos || at > to) return out;
  const char* p = json.c_str() + json.find(':', at) + 1;
  int depth = 0;
  for (; *p != '\0'; ++p) {
    if (*p == '[')
      ++depth;
    else if (*p == ']') {
      if (--depth <= 0) break;
    } else if (std::strchr("-0123456789", *p) != nullptr) {
      char* end = nullptr;
      out.push_back(std::strtod(p, &end));
      p = end - 1;
      if (depth == 0) break;
    } else if (depth == 0 && (*p == ',' || *p == '}' || *p == '{'))
      break;
  }
  return out;
}
inline V vector(const std::vector<double>& v) { return {v.at(0), v.at(1), v.at(2)}; }

inline palpate::MeshData<double> read_obj(const std::string& text) {
  palpate::MeshData<double> mesh;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string head, word;
    words >> head;
    if (head == "v") {
      V p;
      words >> p.x() >> p.y() >> p.z();
      mesh.vertices.push_back(p);
    } else if (head == "f") {
      std::array<std::uint32_t, 3> t{};
      for (auto& c : t) {
        words >> word;
        c = static_cast<std::uint32_t>(std::strtoul(word.c_str(), nullptr, 10) - 1);
      }
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

/// A patch of the surface that is moved by depth * factor * direction, and rotated about its position by
/// depth
/// * turn.
struct Patch {
  V position, normal, direction;  ///< normal: outward
  double radius, factor;          ///< [m], -
  V turn = V::Zero();             ///< [rad/m]
};
inline std::vector<Patch> read_patches(const std::string& meta) {
  std::vector<Patch> patches;
  std::size_t at = meta.find("\"patches\"");
  while (at != std::string::npos && (at = meta.find("\"centre_m\"", at + 1)) != std::string::npos) {
    const auto turn = numbers(meta, "turn_per_m", at, meta.find('}', at));
    patches.push_back({vector(numbers(meta, "centre_m", at)), -vector(numbers(meta, "inward_normal", at)),
                       vector(numbers(meta, "direction", at)), numbers(meta, "radius_m", at).at(0),
                       numbers(meta, "depth_factor", at).at(0), turn.empty() ? V(V::Zero()) : vector(turn)});
  }
  return patches;
}

}  // namespace bench
