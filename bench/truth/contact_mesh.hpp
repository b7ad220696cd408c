// SPDX-License-Identifier: MIT
#pragma once

/// @file Meshes the body of a contact case: first roughly, to see where the tools will overlap it, then
/// finely there.
///
/// Edges: half the width of the overlap at a step times 0.7 / fineness, in all of that overlap, and at the
/// tool's edges at most 4 radii of the edge / fineness.

#include "truth/case_file.hpp"
#include "truth/contact.hpp"
#include "truth/gmsh_script.hpp"
#include "truth/surface.hpp"

#include <Eigen/Eigenvalues>

#include <filesystem>
#include <set>

namespace bench {

class ContactMesh {
 public:
  ContactMesh(const ContactCase& c, const std::string& folder, double fineness) : case_(c) {
    std::filesystem::create_directories(folder);
    mesh_ = meshed({}, folder);
    surface_ = surface_of(mesh_, c.body);
    std::vector<Wish> wishes;
    for (std::size_t step = 1; step < c.poses.size(); ++step)
      for (std::size_t tool = 0; tool < c.tools.size(); ++tool) add_overlap(step, tool, fineness, wishes);
    if (wishes.empty()) throw std::runtime_error("no tool touches the body at any step");
    mesh_ = meshed(levels(wishes), folder);
    surface_ = surface_of(mesh_, c.body);
  }
  const Tetrahedra& mesh() const { return mesh_; }
  const Surface& surface() const { return surface_; }
  /// Half the width of the narrowest overlap at a step; the shortest edge asked for [mm].
  double width() const { return width_; }
  double edge() const { return edge_; }
  /// Where a tool of a step stands a share of the way from the step before.
  Pose pose(std::size_t step, std::size_t tool, double share) const {
    return between(case_.poses[step - 1][tool], case_.poses[step][tool], share);
  }
  /// Faces that a tool comes near.
  std::vector<std::array<int, 6>> touchable() const {
    const double margin = depth_ + 0.5 * width_;
    std::vector<char> near(mesh_.nodes.size(), 0);
    for (std::size_t step = 1; step < case_.poses.size(); ++step)
      for (std::size_t tool = 0; tool < case_.tools.size(); ++tool)
        for (double share : {0.25, 0.5, 0.75, 1.0}) {
          const Pose p = pose(step, tool, share);
          for (std::size_t n = 0; n < mesh_.nodes.size(); ++n)
            if (surface_.outer[n] && !near[n]) near[n] = at(tool, p, mesh_.nodes[n]).value < margin;
        }
    std::vector<std::array<int, 6>> faces;
    for (const auto& f : surface_.faces)
      if (std::any_of(f.begin(), f.end(), [&](int n) { return near[n] != 0; })) faces.push_back(f);
    return faces;
  }
  /// Distance of a tool in a pose, gradient in the tool's frame.
  Distance at(std::size_t tool, const Pose& pose, const V& x) const {
    return case_.tools[tool].distance(pose.rotation.conjugate() * (x - pose.origin));
  }

 private:
  struct Wish {
    V position;
    double edge;
  };

  Tetrahedra meshed(const std::map<double, std::vector<V>>& points, const std::string& folder) const {
    const std::string geo = folder + "/body.geo", msh = folder + "/body.msh";
    { File script(geo, GmshScript(case_.body, points)().c_str()); }
    if (std::system(("gmsh -3 -v 2 '" + geo + "' -o '" + msh + "'").c_str()) != 0)
      throw std::runtime_error("gmsh failed on " + geo);
    return read_msh(msh);
  }

  // Places of the surface within a tool, `spacing` apart.
  std::vector<V> overlap(std::size_t tool, const Pose& pose, double spacing) const {
    std::vector<V> out;
    for (const auto& face : surface_.faces)
      divide(face, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, tool, pose, spacing, out);
    return out;
  }
  V on_face(const std::array<int, 6>& face, const V& l) const {
    V position = V::Zero();
    for (int i = 0; i < 3; ++i)
      position +=
          l[i] * (2 * l[i] - 1) * mesh_.nodes[face[i]] + 4 * l[i] * l[(i + 1) % 3] * mesh_.nodes[face[i + 3]];
    return position;
  }
  void divide(const std::array<int, 6>& face, const V& a, const V& b, const V& c, std::size_t tool,
              const Pose& pose, double spacing, std::vector<V>& out) const {
    const V middle = on_face(face, (a + b + c) / 3);
    double reach = 0;
    for (const V& corner : {a, b, c}) reach = (std::max)(reach, (on_face(face, corner) - middle).norm());
    const double distance = at(tool, pose, middle).value;
    if (distance > 1.5 * reach) return;
    if (reach < spacing) {
      if (distance < 0) out.push_back(middle);
      return;
    }
    const V ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    divide(face, a, ab, ca, tool, pose, spacing, out);
    divide(face, b, bc, ab, tool, pose, spacing, out);
    divide(face, c, ca, bc, tool, pose, spacing, out);
    divide(face, ab, bc, ca, tool, pose, spacing, out);
  }
  // Twice the spread across the narrower way: a disc's radius.
  double half_width(const std::vector<V>& positions) const {
    V mean = V::Zero();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    const bool mirrored[3] = {case_.body.half_x, false, case_.body.half_z};
    for (const V& p : positions) mean += p / double(positions.size());
    for (int k = 0; k < 3; ++k)
      if (mirrored[k]) mean[k] = 0;
    for (const V& p : positions) spread += (p - mean) * (p - mean).transpose() / double(positions.size());
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        if (k != l && (mirrored[k] || mirrored[l])) spread(k, l) = 0;
    return 2 * std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues()[1]);
  }
  void add_overlap(std::size_t step, std::size_t tool, double fineness, std::vector<Wish>& wishes) {
    const RigidTool& t = case_.tools[tool];
    std::vector<V> positions;
    double spacing = t.extent() / 8;
    for (int i = 0; i < 8 && positions.size() < 400; ++i, spacing /= 2)
      positions = overlap(tool, case_.poses[step][tool], spacing);
    if (positions.empty()) return;
    const double width = case_.size > 0 ? case_.size : half_width(positions);
    width_ = (std::min)(width_, width);
    const double edge = 0.7 * width / fineness;
    for (double share : {0.5, 0.75, 1.0}) {
      const Pose p = pose(step, tool, share);
      for (const V& x : overlap(tool, p, (std::min)(spacing, 0.5 * edge))) {
        const V y = p.rotation.conjugate() * (x - p.origin);
        const auto [distance, n] = t.distance(y);
        depth_ = (std::max)(depth_, -distance);
        const double curvature = t.curvature(y - distance * n).norm();
        wishes.push_back({x, (std::min)(edge, 4 / ((std::max)(curvature, 1e-9) * fineness))});
        edge_ = (std::min)(edge_, wishes.back().edge);
      }
    }
  }
  // Wishes by steps of a quarter in length, one per cube of that edge.
  std::map<double, std::vector<V>> levels(const std::vector<Wish>& wishes) const {
    std::map<double, std::vector<V>> out;
    std::map<double, std::set<std::array<long, 3>>> taken;
    for (const Wish& w : wishes) {
      const double edge =
          edge_ * std::pow(1.25, std::floor(std::log(w.edge / edge_) / std::log(1.25) + 1e-9));
      std::array<long, 3> cube;
      for (int k = 0; k < 3; ++k) cube[k] = std::lround(w.position[k] / edge);
      if (taken[edge].insert(cube).second) out[edge].push_back(w.position);
    }
    return out;
  }

  const ContactCase& case_;
  Tetrahedra mesh_;
  Surface surface_;
  double width_ = 1e300, edge_ = 1e300, depth_ = 0;
};

}  // namespace bench
