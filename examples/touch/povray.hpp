// SPDX-License-Identifier: MIT
#pragma once

/// @file Frames as scenes for POV-Ray (lengths in mm), and what the legend around the picture needs.
/// render.sh makes the pictures.

#include <cstdlib>
#include <filesystem>

#include "vtk.hpp"

namespace touch {

/// From where a scene is seen.
struct View {
  V from, at;              ///< [mm]
  double angle = 28;       ///< horizontal field of view [degrees]
  double per_newton = 25;  ///< length of the force arrow [mm/N]
};

/// Colours of the displacement from none to most; for POV-Ray and for the legend.
inline constexpr double palette[][4] = {{0, 0.90, 0.91, 0.92},
                                        {0.2, 0.99, 0.89, 0.62},
                                        {0.45, 0.98, 0.62, 0.30},
                                        {0.7, 0.84, 0.19, 0.18},
                                        {1, 0.38, 0.03, 0.25}};

class Pictures {
 public:
  /// Files go into `folder`, which is made anew.
  Pictures(std::string folder, const View& view, const palpate::MeshData<S>& rest, const Tool& tool)
      : folder_(std::move(folder)), view_(view), rest_(rest), tool_(tool) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }

  void write(const std::string& title, const std::vector<Frame>& frames) const {
    const double most = scale_end(frames);
    write_common(most);
    const File list = open_file(folder_ + "/frames.csv");
    std::fputs("frame,t_s,F_N,regions,displacement_mm\n", list.get());
    std::size_t key = 0;
    double key_rank = -1;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      write_frame(numbered(folder_ + "/frame", i, ".pov"), frames[i], most);
      const double u = largest(frames[i]);
      std::fprintf(list.get(), "%03zu,%.3f,%.4f,%u,%.4f\n", i, frames[i].t, frames[i].force().norm(),
                   frames[i].felt.regions, u);
      // The one that stands for all: most regions, then most force.
      const double rank = frames[i].force().norm() + 1e3 * frames[i].felt.regions;
      if (rank > key_rank) key_rank = rank, key = i;
    }
    const File legend = open_file(folder_ + "/legend.gp");
    std::fprintf(
        legend.get(),
        "title = '%s'\nmost = %g\nper_newton = %g\nkey = '%03zu'\nkey_number = %zu\nset palette defined (",
        title.c_str(), most, view_.per_newton, key, key);
    const char* comma = "";
    for (const auto& c : palette) {
      std::fprintf(legend.get(), "%s%g %.2f %.2f %.2f", comma, c[0], c[1], c[2], c[3]);
      comma = ", ";
    }
    std::fputs(")\n", legend.get());
  }

 private:
  [[nodiscard]] double largest(const Frame& frame) const {
    double square = 0;
    for (std::size_t i = 0; i < rest_.vertices.size(); ++i)
      square = (std::max)(square, (frame.position[i] - rest_.vertices[i]).squaredNorm());
    return 1e3 * std::sqrt(square);
  }
  /// The next multiple of 0.5 mm.
  [[nodiscard]] double scale_end(const std::vector<Frame>& frames) const {
    double most = 0.1;
    for (const Frame& frame : frames) most = (std::max)(most, largest(frame));
    return std::ceil(2 * most) / 2;
  }

  static void vector(std::FILE* out, const V& v) {
    std::fprintf(out, "<%.4f,%.4f,%.4f>", v.x(), v.y(), v.z());
  }
  static void rod(std::FILE* out, const Rod& r) {
    std::fputs("cylinder{", out);
    vector(out, 1e3 * r.from);
    std::fputs(",", out);
    vector(out, 1e3 * r.to);
    std::fprintf(out, ",%.4f}\n", 1e3 * r.radius);
  }
  template <class Triangles>
  static void faces(std::FILE* out, const Triangles& triangles) {
    std::fprintf(out, "face_indices{%zu", triangles.size());
    for (const auto& t : triangles) std::fprintf(out, ",\n<%u,%u,%u>", t[0], t[1], t[2]);
    std::fputs("}\n", out);
  }
  template <class Vectors>
  static void vectors(std::FILE* out, const char* what, const Vectors& all, double scale) {
    std::fprintf(out, "%s{%zu", what, all.size());
    for (const V& v : all) {
      std::fputs(",\n", out);
      vector(out, scale * v);
    }
    std::fputs("}\n", out);
  }

  /// Camera, light, colours, tool and triangles: the same in all frames.
  void write_common(double most) const {
    const File file = open_file(folder_ + "/common.inc");
    std::FILE* const out = file.get();
    std::fputs(
        "#version 3.7;\nglobal_settings{assumed_gamma 1}\nbackground{rgb 1}\n"
        "// POV-Ray's axes are left-handed; a negative `right` makes them the scene's.\ncamera{location ",
        out);
    vector(out, view_.from);
    std::fputs(" sky y right -x*image_width/image_height up y look_at ", out);
    vector(out, view_.at);
    std::fprintf(out, " angle %g}\n", view_.angle);
    const V to_eye = view_.from - view_.at, right = V::UnitY().cross(to_eye).normalized();
    const double d = to_eye.norm();
    std::fputs("light_source{", out);
    vector(out, view_.at + 0.6 * to_eye - 0.7 * d * right + 0.9 * d * V::UnitY());
    std::fputs(" rgb 0.85 area_light 60*x,60*z,3,3 adaptive 1 jitter}\nlight_source{", out);
    vector(out, view_.at + to_eye + 0.8 * d * right);
    std::fputs(" rgb 0.25 shadowless}\n", out);
    std::fputs("#declare Body=texture{uv_mapping pigment{gradient x color_map{", out);
    for (const auto& c : palette) std::fprintf(out, "[%g srgb <%g,%g,%g>]", c[0], c[1], c[2], c[3]);
    std::fputs("}} finish{ambient 0.3 diffuse 0.65 specular 0.08 roughness 0.03}}\n", out);
    std::fprintf(out, "// colour: displacement magnitude, 0 to %g mm\n", most);
    std::fputs(
        "// What touches is glass, so that the contact is seen; the rest is steel.\n"
        "#declare Glass=texture{pigment{srgbt <0.35,0.45,0.55,0.45>} finish{ambient 0.25 diffuse 0.6}}\n"
        "#declare Steel=texture{pigment{srgb <0.45,0.5,0.56>} finish{ambient 0.25 diffuse 0.6}}\n"
        "#declare Force=texture{pigment{srgb <0.05,0.45,0.2>} finish{ambient 0.5 diffuse 0.5}}\n",
        out);
    std::fputs("#macro BodyFaces() ", out);
    faces(out, rest_.triangles);
    std::fputs("#end\n#declare Tool=union{mesh2{\n", out);
    vectors(out, "vertex_vectors", tool_.mesh.vertices, 1e3);
    faces(out, tool_.mesh.triangles);
    std::fputs("texture{Glass}}\n", out);
    for (const Rod& r : tool_.rods) rod(out, r);
    std::fputs("texture{Steel} no_shadow}\n", out);
  }

  void write_frame(const std::string& name, const Frame& frame, double most) const {
    const File file = open_file(name);
    std::FILE* const out = file.get();
    std::fputs("#include \"common.inc\"\nmesh2{\n", out);
    vectors(out, "vertex_vectors", frame.position, 1e3);
    vectors(out, "normal_vectors", frame.normal, 1);
    std::fprintf(out, "uv_vectors{%zu", frame.position.size());
    for (std::size_t i = 0; i < frame.position.size(); ++i) {
      const double u = 1e3 * (frame.position[i] - rest_.vertices[i]).norm() / most;
      std::fprintf(out, ",\n<%.4f,0>", std::clamp(u, 0.0001, 0.9999));  // the gradient repeats at 1
    }
    std::fputs("}\nBodyFaces()\ntexture{Body} no_shadow}\nobject{Tool matrix", out);
    const palpate::Mat3<S>& R = frame.felt.pose.rotation;
    const V p = 1e3 * frame.felt.pose.translation;
    std::fprintf(out, "<%.6f,%.6f,%.6f, %.6f,%.6f,%.6f, %.6f,%.6f,%.6f, %.4f,%.4f,%.4f>}\n", R(0, 0), R(1, 0),
                 R(2, 0), R(0, 1), R(1, 1), R(2, 1), R(0, 2), R(1, 2), R(2, 2), p.x(), p.y(), p.z());
    for (std::size_t j = 0; j < frame.felt.contacts.size(); ++j) {
      const palpate::ContactState<S>& contact = frame.felt.contacts[j];
      write_arrow(out, 1e3 * contact.centre, view_.per_newton * contact.force);
    }
  }

  /// The force on the tool.
  static void write_arrow(std::FILE* out, const V& from, const V& arrow) {
    const double length = arrow.norm();
    if (!(length > 1)) return;
    const double head = (std::min)(7.0, 0.4 * length);  // [mm]
    const V neck = from + arrow * (1 - head / length), tip = from + arrow;
    std::fputs("union{cylinder{", out);
    vector(out, from);
    std::fputs(",", out);
    vector(out, neck);
    std::fprintf(out, ",%.3f} cone{", 0.16 * head);
    vector(out, neck);
    std::fprintf(out, ",%.3f,", 0.4 * head);
    vector(out, tip);
    std::fputs(",0} texture{Force} no_shadow}\n", out);
  }

  std::string folder_;
  View view_;
  const palpate::MeshData<S>& rest_;
  const Tool& tool_;
};

}  // namespace touch
