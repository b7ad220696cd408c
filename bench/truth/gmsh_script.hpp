// SPDX-License-Identifier: MIT
#pragma once

/// @file A script that has gmsh mesh a body, finest where it is touched and at the fixed region's rim.

#include "truth/tetrahedra.hpp"

namespace bench {

/// A script for gmsh. Edges: at a patch's rim radius / fineness, growing by a third of the distance, at most
/// a seventh of the body. A ball's contact grows: at a seventh of its radius from the middle 0.56 radius /
/// fineness, growing by a ninth.
class GmshScript {
 public:
  GmshScript(const Body& body, const std::vector<Patch>& patches, bool ball, double fineness)
      : GmshScript(body) {
    cut(ball ? std::vector<Patch>{} : patches);
    for (Patch p : patches) {
      const double least = (ball ? 0.56 : 1) * p.radius / fineness;
      if (ball) p.radius /= 7;
      add_size(least, to_rim(p), ball ? 0.115 : 0.33);
    }
    finish();
  }
  /// Edges of a length [mm] at each of its points, growing by 0.4 of the distance.
  GmshScript(const Body& body, const std::map<double, std::vector<V>>& points) : GmshScript(body) {
    rim_ = 12;
    cut({});
    int tag = 1000000;
    for (const auto& [length, positions] : points) {
      std::string list_of;
      for (const V& p : positions) {
        script_ += text("Point(", ++tag, ") = {", list(p), "};\n");
        list_of += text(list_of.empty() ? "" : ", ", tag);
      }
      ++fields_;
      script_ +=
          text("Field[", fields_, "] = Distance;\nField[", fields_, "].PointsList = {", list_of, "};\n");
      add_size(length, text('F', fields_), 0.4);
    }
    finish();
  }
  const std::string& operator()() const { return script_; }

 private:
  explicit GmshScript(const Body& body) : body_(body), far_(10 * body.size.maxCoeff()) {
    script_ = "SetFactory(\"OpenCASCADE\");\n";
    add_body();
  }
  void finish() {
    add_sizes_of_body();
    script_ +=
        text("Background Field = ", fields_, ";\n",
             "Mesh.CharacteristicLengthExtendFromBoundary = 0;\nMesh.CharacteristicLengthFromPoints = 0;\n"
             "Mesh.Algorithm3D = 1;\nMesh.Optimize = 1;\nMesh.ElementOrder = 2;\nMesh.SaveAll = 1;\n"
             "Mesh.MshFileVersion = 2.2;\n");
  }
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
        break;
      case Body::rod:
        script_ += text("Cylinder(1) = {0, 0, ", -s.z(), ", 0, 0, ", 2 * s.z(), ", ", s.x(), "};\n");
        break;
      case Body::bean:
        script_ += text("Torus(4) = {0, 0, 0, ", s.x(), ", ", s.y(), ", ", 2 * body_.bend,
                        "};\nRotate{{0, 0, 1}, {0, 0, 0}, ", -std::acos(0.0) - body_.bend,
                        "} {Volume{4};}\nTranslate{0, ", s.x(), ", 0} {Volume{4};}\n");
        for (int end : {-1, 1})
          script_ += text("Sphere(", 6 + end, ") = {", end * s.x() * std::sin(body_.bend), ", ",
                          s.x() * (1 - std::cos(body_.bend)), ", 0, ", s.y(), "};\n");
        script_ += "BooleanUnion(1) = {Volume{4}; Delete;}{Volume{5}; Volume{7}; Delete;};\n";
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
    if (!body_.stands())
      add(text("Box(", tag, ") = {", list(V::Constant(-far_)), ", ",
               list(V(2 * far_, far_ + body_.fixed_height, 2 * far_)), "};\n"));
    if (!tools.empty())
      script_ += "BooleanFragments{Volume{body()}; Delete;}{Volume{" + tools + "}; Delete;}\n";
  }
  void add_size(double least, const std::string& distance, double growth = 0.33) {
    ++fields_;
    sizes_ += text(sizes_.empty() ? "" : ", ", fields_);
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
    const double rim = body_.smallest() / rim_;
    switch (body_.kind) {
      case Body::box:
        for (const auto& [axis, half] : {std::pair{'x', s.x() / 2}, {'z', s.z() / 2}})
          add_size(rim, text("sqrt(y^2 + (abs(", axis, ") - ", half, ")^2)"));
        break;
      case Body::cylinder:
        add_size(rim, text("sqrt(y^2 + (sqrt(x^2 + z^2) - ", s.x(), ")^2)"));
        break;
      case Body::rod:
        add_size(rim, text("sqrt((y - (", body_.fixed_height, "))^2 + (abs(x) - ",
                           std::sqrt(s.x() * s.x() - body_.fixed_height * body_.fixed_height), ")^2)"));
        break;
      case Body::bean:
        add_size(1.2 * rim, text("abs(y - (", body_.fixed_height, "))"));
        break;
      case Body::ellipsoid: {
        const double share = std::sqrt(1 - std::pow(body_.fixed_height / s.y(), 2));
        add_size(rim / 2, text("sqrt((y - (", body_.fixed_height, "))^2 + ((sqrt((x / ", s.x(), ")^2 + (z / ",
                               s.z(), ")^2) - ", share, ") * ", (std::min)(s.x(), s.z()), ")^2)"));
      }
    }
    // A bean rocks on its narrow base: with a seventh, and three rims, its ends move by 5 to 9 % too little.
    const double largest = body_.smallest() / (body_.kind == Body::bean ? 14 : 7);
    ++fields_;
    script_ += text("Field[", fields_, "] = MathEval;\nField[", fields_, "].F = \"", largest, "\";\n");
    sizes_ += text(", ", fields_);
    ++fields_;
    script_ += text("Field[", fields_, "] = Min;\nField[", fields_, "].FieldsList = {", sizes_, "};\n");
  }
  static std::string list(const V& v) { return text(v.x(), ", ", v.y(), ", ", v.z()); }

  Body body_;
  double far_;
  int fields_ = 0;
  double rim_ = 30;  // of the body's least extent by edges at the fixed region's rim
  std::string script_, sizes_;
};

}  // namespace bench
