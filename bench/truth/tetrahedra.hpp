// SPDX-License-Identifier: MIT
#pragma once

/// @file  A body meshed by gmsh for finite elements: curved ten-node tetrahedra, finest at the patches' edges and the held rim.
///
/// Lengths in mm. A body with a plane of symmetry is meshed on its positive side only.

#include "truth/case.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace bench {

/// Box and cylinder stand on y = 0, about the axis y, and are held there; the ellipsoid is centred, held at y <= held.
struct Body {
  enum { box, cylinder, ellipsoid } kind;
  V size;           ///< box: edges; cylinder: radius, height, radius; ellipsoid: semi-axes [mm]
  double held = 0;  ///< height up to which the surface is held [mm]
  bool half_x = false, half_z = false;  ///< x = 0, z = 0 is a plane of symmetry

  double top() const { return size.y(); }
  double low() const { return kind == ellipsoid ? -size.y() : 0; }
  double smallest() const {
    return kind == cylinder ? (std::min)(2 * size.x(), size.y()) : (kind == box ? 1 : 2) * size.minCoeff();
  }
};

/// Ten-node tetrahedra: corners, then the middles of edges 01, 12, 20, 03, 23, 13.
struct Tetrahedra {
  std::vector<V> nodes;
  std::vector<std::array<int, 10>> elements;
};

/// A script for gmsh. Edges: at a patch's rim radius / fineness, growing by a third of the distance, at most a seventh of the body.
inline std::string gmsh_script(const Body& body, const std::vector<Patch>& patches, double fineness) {
  std::ostringstream geo;
  geo.precision(12);
  const double far = 10 * body.size.maxCoeff();
  geo << "SetFactory(\"OpenCASCADE\");\n";
  const V& s = body.size;
  switch (body.kind) {
    case Body::box:
      geo << "Box(1) = {" << -s.x() / 2 << ", 0, " << -s.z() / 2 << ", " << s.x() << ", " << s.y() << ", "
          << s.z() << "};\n";
      break;
    case Body::cylinder:
      geo << "Cylinder(1) = {0, 0, 0, 0, " << s.y() << ", 0, " << s.x() << "};\n";
      break;
    case Body::ellipsoid:
      geo << "Sphere(1) = {0, 0, 0, 1};\nDilate{{0, 0, 0}, {" << s.x() << ", " << s.y() << ", " << s.z()
          << "}} {Volume{1};}\n";
  }
  if (body.half_x || body.half_z) {
    geo << "Box(2) = {" << (body.half_x ? 0 : -far) << ", " << -far << ", " << (body.half_z ? 0 : -far)
        << ", " << 2 * far << ", " << 2 * far << ", " << 2 * far << "};\n";
    geo << "BooleanIntersection(3) = {Volume{1}; Delete;}{Volume{2}; Delete;};\n";
  }
  // So that the mesh follows the edges of patches and of what is held, balls and a slab cut the body.
  geo << "body() = Volume{:};\n";
  int tag = 10;
  std::string tools;
  for (const Patch& p : patches) {
    geo << "Sphere(" << tag << ") = {" << p.place.x() << ", " << p.place.y() << ", " << p.place.z() << ", "
        << p.radius << "};\n"
        << "BooleanIntersection(" << tag + 1 << ") = {Volume{" << tag << "}; Delete;}{Volume{body()};};\n";
    tools += (tools.empty() ? "" : ", ") + std::to_string(tag + 1);
    tag += 2;
  }
  if (body.kind == Body::ellipsoid) {
    geo << "Box(" << tag << ") = {" << -far << ", " << -far << ", " << -far << ", " << 2 * far << ", "
        << far + body.held << ", " << 2 * far << "};\nBooleanIntersection(" << tag + 1 << ") = {Volume{"
        << tag << "}; Delete;}{Volume{body()};};\n";
    tools += ", " + std::to_string(tag + 1);
  }
  geo << "BooleanFragments{Volume{body()}; Delete;}{Volume{" << tools << "}; Delete;}\n";
  int field = 0;
  const auto size = [&](double least, const std::string& distance) {
    ++field;
    geo << "Field[" << field << "] = MathEval;\nField[" << field << "].F = \"" << least << " + 0.33 * "
        << distance << "\";\n";
  };
  for (const Patch& p : patches) {
    std::ostringstream h, r2;
    h.precision(12);
    r2.precision(12);
    const auto off = [](char axis, double c) {
      std::ostringstream text;
      text.precision(12);
      text << '(' << axis << " - (" << c << "))";
      return text.str();
    };
    const std::string x = off('x', p.place.x()), y = off('y', p.place.y()), z = off('z', p.place.z());
    h << "((" << p.normal.x() << ") * " << x << " + (" << p.normal.y() << ") * " << y << " + ("
      << p.normal.z() << ") * " << z << ')';
    r2 << "(abs(" << x << "^2 + " << y << "^2 + " << z << "^2 - " << h.str() << "^2))";
    size(p.radius / fineness,
         "sqrt((sqrt" + r2.str() + " - " + std::to_string(p.radius) + ")^2 + " + h.str() + "^2)");
  }
  const double rim = body.smallest() / 30;
  std::ostringstream text;
  text.precision(12);
  if (body.kind == Body::box) {
    size(rim, "sqrt(y^2 + (abs(x) - " + std::to_string(s.x() / 2) + ")^2)");
    size(rim, "sqrt(y^2 + (abs(z) - " + std::to_string(s.z() / 2) + ")^2)");
  } else if (body.kind == Body::cylinder) {
    size(rim, "sqrt(y^2 + (sqrt(x^2 + z^2) - " + std::to_string(s.x()) + ")^2)");
  } else {
    const double share = std::sqrt(1 - std::pow(body.held / s.y(), 2));
    text << "sqrt((y - (" << body.held << "))^2 + ((sqrt((x / " << s.x() << ")^2 + (z / " << s.z()
         << ")^2) - " << share << ") * " << (std::min)(s.x(), s.z()) << ")^2)";
    size(rim / 2, text.str());
  }
  ++field;
  geo << "Field[" << field << "] = MathEval;\nField[" << field << "].F = \"" << body.smallest() / 7
      << "\";\n";
  geo << "Field[" << field + 1 << "] = Min;\nField[" << field + 1 << "].FieldsList = {";
  for (int f = 1; f <= field; ++f) geo << (f == 1 ? "" : ", ") << f;
  geo << "};\nBackground Field = " << field + 1
      << ";\nMesh.CharacteristicLengthExtendFromBoundary = 0;\nMesh.CharacteristicLengthFromPoints = 0;\n"
         "Mesh.Algorithm3D = 1;\nMesh.Optimize = 1;\n\nMesh.ElementOrder = 2;\nMesh.SaveAll = "
         "1;\nMesh.MshFileVersion = 2.2;\n";
  return geo.str();
}

/// Reads version 2.2 of gmsh's format. Throws std::runtime_error when the file holds no ten-node tetrahedra.
inline Tetrahedra read_msh(const std::string& path) {
  std::istringstream in(read_text(path));
  Tetrahedra mesh;
  std::map<long, V> place;
  std::map<long, int> number;
  for (std::string word; in >> word;) {
    long count = 0;
    if (word == "$Nodes") {
      in >> count;
      for (long i = 0, id; i < count; ++i) {
        in >> id;
        V& p = place[id];
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
          if (fresh) mesh.nodes.push_back(place.at(id));
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
