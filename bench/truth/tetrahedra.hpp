// SPDX-License-Identifier: MIT
#pragma once

/// @file A body meshed by gmsh for finite elements: curved ten-node tetrahedra, finest at the patches' edges
/// and the fixed region's rim.
///
/// Lengths in mm. A body with a plane of symmetry is meshed on its positive side only.

#include "truth/case.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace bench {

/// Box and cylinder stand on y = 0, about the axis y, and are fixed there; the ellipsoid is centred, fixed at
/// y <= fixed_height.
struct Body {
  enum { box, cylinder, ellipsoid } kind;
  V size;                   ///< box: edges; cylinder: radius, height, radius; ellipsoid: semi-axes [mm]
  double fixed_height = 0;  ///< height up to which the surface is fixed [mm]
  bool half_x = false, half_z = false;  ///< x = 0, z = 0 is a plane of symmetry

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

/// A script for gmsh. Edges: at a patch's rim radius / fineness, growing by a third of the distance, at most
/// a seventh of the body. A ball's contact grows: at a seventh of its radius from the middle 0.56 radius /
/// fineness, growing by a ninth.
class GmshScript {
 public:
  GmshScript(const Body& body, const std::vector<Patch>& patches, bool ball, double fineness)
      : body_(body), far_(10 * body.size.maxCoeff()) {
    script_ = "SetFactory(\"OpenCASCADE\");\n";
    add_body();
    cut(ball ? std::vector<Patch>{} : patches);
    for (Patch p : patches) {
      const double least = (ball ? 0.56 : 1) * p.radius / fineness;
      if (ball) p.radius /= 7;
      add_size(least, to_rim(p), ball ? 0.115 : 0.33);
    }
    add_sizes_of_body();
    script_ +=
        text("Background Field = ", fields_, ";\n",
             "Mesh.CharacteristicLengthExtendFromBoundary = 0;\nMesh.CharacteristicLengthFromPoints = 0;\n"
             "Mesh.Algorithm3D = 1;\nMesh.Optimize = 1;\nMesh.ElementOrder = 2;\nMesh.SaveAll = 1;\n"
             "Mesh.MshFileVersion = 2.2;\n");
  }
  const std::string& operator()() const { return script_; }

 private:
  void add_body() {
    const V& s = body_.size;
    switch (body_.kind) {
      case Body::box:
        script_ += text("Box(1) = {", -s.x() / 2, ", 0, ", -s.z() / 2, ", ", list(s), "};\n");
        break;
      case Body::cylinder:
        script_ += text("Cylinder(1) = {0, 0, 0, 0, ", s.y(), ", 0, ", s.x(), "};\n");
        break;
      case Body::ellipsoid:
        script_ += text("Sphere(1) = {0, 0, 0, 1};\nDilate{{0, 0, 0}, {", list(s), "}} {Volume{1};}\n");
    }
    if (!body_.half_x && !body_.half_z) return;
    const V low(body_.half_x ? 0 : -far_, -far_, body_.half_z ? 0 : -far_);
    script_ += text("Box(2) = {", list(low), ", ", list(V::Constant(2 * far_)), "};\n",
                    "BooleanIntersection(3) = {Volume{1}; Delete;}{Volume{2}; Delete;};\n");
  }
  // So that the mesh follows the edges of patches and of the fixed region, balls and a slab cut the body.
  void cut(const std::vector<Patch>& patches) {
    script_ += "body() = Volume{:};\n";
    int tag = 10;
    std::string tools;
    const auto add = [&](const std::string& tool) {
      script_ +=
          text(tool, "BooleanIntersection(", tag + 1, ") = {Volume{", tag, "}; Delete;}{Volume{body()};};\n");
      tools += text(tools.empty() ? "" : ", ", tag + 1);
      tag += 2;
    };
    for (const Patch& p : patches)
      add(text("Sphere(", tag, ") = {", list(p.position), ", ", p.radius, "};\n"));
    if (body_.kind == Body::ellipsoid)
      add(text("Box(", tag, ") = {", list(V::Constant(-far_)), ", ",
               list(V(2 * far_, far_ + body_.fixed_height, 2 * far_)), "};\n"));
    if (!tools.empty())
      script_ += "BooleanFragments{Volume{body()}; Delete;}{Volume{" + tools + "}; Delete;}\n";
  }
  void add_size(double least, const std::string& distance, double growth = 0.33) {
    ++fields_;
    script_ += text("Field[", fields_, "] = MathEval;\nField[", fields_, "].F = \"", least, " + ", growth,
                    " * ", distance, "\";\n");
  }
  // The distance from the circle around a patch, in its tangent plane.
  static std::string to_rim(const Patch& p) {
    const auto off = [](char axis, double c) { return text('(', axis, " - (", c, "))"); };
    const std::string x = off('x', p.position.x()), y = off('y', p.position.y()),
                      z = off('z', p.position.z());
    const V& n = p.normal;
    const std::string h =
        text("((", n.x(), ") * ", x, " + (", n.y(), ") * ", y, " + (", n.z(), ") * ", z, ')');
    const std::string along = text("sqrt(abs(", x, "^2 + ", y, "^2 + ", z, "^2 - ", h, "^2))");
    return text("sqrt((", along, " - ", p.radius, ")^2 + ", h, "^2)");
  }
  // Fine at the rim of the fixed region; then the least of all sizes.
  void add_sizes_of_body() {
    const V& s = body_.size;
    const double rim = body_.smallest() / 30;
    switch (body_.kind) {
      case Body::box:
        for (const auto& [axis, half] : {std::pair{'x', s.x() / 2}, {'z', s.z() / 2}})
          add_size(rim, text("sqrt(y^2 + (abs(", axis, ") - ", half, ")^2)"));
        break;
      case Body::cylinder:
        add_size(rim, text("sqrt(y^2 + (sqrt(x^2 + z^2) - ", s.x(), ")^2)"));
        break;
      case Body::ellipsoid: {
        const double share = std::sqrt(1 - std::pow(body_.fixed_height / s.y(), 2));
        add_size(rim / 2, text("sqrt((y - (", body_.fixed_height, "))^2 + ((sqrt((x / ", s.x(), ")^2 + (z / ",
                               s.z(), ")^2) - ", share, ") * ", (std::min)(s.x(), s.z()), ")^2)"));
      }
    }
    ++fields_;
    script_ +=
        text("Field[", fields_, "] = MathEval;\nField[", fields_, "].F = \"", body_.smallest() / 7, "\";\n");
    std::string all = "1";
    for (int f = 2; f <= fields_; ++f) all += text(", ", f);
    ++fields_;
    script_ += text("Field[", fields_, "] = Min;\nField[", fields_, "].FieldsList = {", all, "};\n");
  }
  static std::string list(const V& v) { return text(v.x(), ", ", v.y(), ", ", v.z()); }

  Body body_;
  double far_;
  int fields_ = 0;
  std::string script_;
};

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
