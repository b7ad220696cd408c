// SPDX-License-Identifier: MIT
#pragma once

/// @file Reads a contact case: a body of rubber, rigid tools, and where they go.
///
/// A text file, a keyword and its values per line, in any order; `#` starts a comment. Lengths in mm, E in
/// MPa, angles in rad; y points up.
///
///     body ellipsoid A B C         semi-axes, about the origin
///     body rod RADIUS LENGTH       a cylinder along z, its middle at the origin
///     body bean CIRCLE RADIUS BEND a bent rod with round ends, concave above: its axis' circle's radius,
///                                  its own, angle from its middle, at the origin, to its axis' ends
///     body box X Y Z               stands on y = 0, about the axis y, fixed there; slab and block, too
///     body cylinder RADIUS HEIGHT  likewise
///     fixed Y                      ellipsoid, rod, bean: the surface at y <= Y is fixed
///     material E NU
///     linear                       small strain (optional); the tools' overlap is still exact
///     symmetry x|z|xz              body and each tool, in all poses, are their own mirror image in x = 0,
///                                  z = 0 (optional): a half or quarter is meshed
///     friction MU                  Coulomb, 0 if left out
///     tool ball RADIUS
///     tool capsule RADIUS LENGTH   its axis lies along x, LENGTH without the round ends
///     tool box X Y Z ROUNDING      edges, the rounding of radius ROUNDING included
///     tool cylinder RADIUS HEIGHT ROUNDING  its axis along y, rounded rims included
///     tool ellipsoid A B C         semi-axes
///     tool mesh FILE.obj ROUNDING  triangles [mm], and all that is within ROUNDING of them
///     start POSE [POSE...]         one pose per tool, in the tools' order: pressing nothing
///     step POSE [POSE...]          next poses, results are written there; several
///     stride S                     the longest motion between two equilibria (optional)
///     size A                       half the width of the contact, for the mesh (optional: from the overlap)
///
/// A pose is X Y Z RX RY RZ: the tool's origin (its middle) and its rotation vector, from the frame above.
/// Between poses the origin moves along a line and the tool turns about a fixed axis. Several tools: all have
/// a pose in each line.

#include "truth/rigid_tool.hpp"
#include "truth/tetrahedra.hpp"

#include <sstream>
#include <stdexcept>
#include <string>

namespace bench {

struct ContactCase {
  Body body{};
  double E = 1, nu = 0.49, friction = 0;
  bool linear = false;
  double stride = 0, size = 0;  ///< 0: to be chosen
  std::vector<RigidTool> tools;
  std::vector<std::vector<Pose>> poses;  ///< the start's, then each step's: one per tool
};

/// Throws std::runtime_error, with the line, where a file cannot be understood.
class CaseFile {
 public:
  static ContactCase read(const std::string& path) {
    CaseFile file;
    file.folder_ = path.substr(0, path.find_last_of('/') + 1);
    std::istringstream in(read_text(path));
    for (std::string line; std::getline(in, line);) {
      std::istringstream words(line.substr(0, line.find('#')));
      std::string keyword;
      if (!(words >> keyword)) continue;
      if (!file.take(keyword, words)) throw std::runtime_error(path + ": cannot be read: " + line);
    }
    const ContactCase& c = file.case_;
    if (!file.start_.empty()) file.case_.poses.insert(file.case_.poses.begin(), file.start_);
    if (c.body.size.isZero() || c.tools.empty() || file.start_.empty() || c.poses.size() < 2)
      throw std::runtime_error(path + ": body, tool, start or step is missing");
    for (const auto& poses : c.poses)
      if (poses.size() != c.tools.size()) throw std::runtime_error(path + ": not one pose per tool");
    return c;
  }

 private:
  bool take(const std::string& keyword, std::istringstream& words) {
    std::string kind;
    if (keyword == "body") return words >> kind && body(kind, words);
    if (keyword == "tool") return words >> kind && tool(kind, words);
    if (keyword == "fixed") return values(words, {&case_.body.fixed_height});
    if (keyword == "material") return values(words, {&case_.E, &case_.nu});
    if (keyword == "friction") return values(words, {&case_.friction});
    if (keyword == "stride") return values(words, {&case_.stride});
    if (keyword == "size") return values(words, {&case_.size});
    if (keyword == "linear") return case_.linear = true;
    if (keyword == "start") return poses(words, start_);
    if (keyword == "step") return poses(words, case_.poses.emplace_back());
    if (keyword != "symmetry" || !(words >> kind)) return false;
    case_.body.half_x = kind.find('x') != std::string::npos;
    case_.body.half_z = kind.find('z') != std::string::npos;
    return kind == "x" || kind == "z" || kind == "xz";
  }
  bool body(const std::string& kind, std::istringstream& words) {
    Body& b = case_.body;
    V& s = b.size;
    if (kind == "ellipsoid" || kind == "box") {
      b.kind = kind == "box" ? Body::box : Body::ellipsoid;
      return values(words, {&s.x(), &s.y(), &s.z()});
    }
    double first = 0, second = 0;
    if (!values(words, {&first, &second})) return false;
    if (kind == "cylinder") {
      b.kind = Body::cylinder;
      s = V(first, second, first);
    } else if (kind == "rod") {
      b.kind = Body::rod;
      s = V(first, first, second / 2);
    } else if (kind == "bean") {
      b.kind = Body::bean;
      s = V(first, second, second);
      return values(words, {&b.bend});
    } else {
      return false;
    }
    return true;
  }
  bool tool(const std::string& kind, std::istringstream& words) {
    RigidTool& t = case_.tools.emplace_back();
    V& s = t.size;
    if (kind == "ball") return t.kind = RigidTool::ball, values(words, {&s.x()});
    if (kind == "capsule") return t.kind = RigidTool::capsule, values(words, {&s.x(), &s.y()});
    if (kind == "ellipsoid") return t.kind = RigidTool::ellipsoid, values(words, {&s.x(), &s.y(), &s.z()});
    if (kind == "cylinder") return t.kind = RigidTool::cylinder, values(words, {&s.x(), &s.y(), &t.rounding});
    if (kind == "box") return t.kind = RigidTool::box, values(words, {&s.x(), &s.y(), &s.z(), &t.rounding});
    t.kind = RigidTool::mesh;
    std::string file;
    if (kind != "mesh" || !(words >> file)) return false;
    t.triangles = read_obj(read_text(folder_ + file));
    return values(words, {&t.rounding}) && !t.triangles.triangles.empty();
  }
  static bool values(std::istringstream& words, std::initializer_list<double*> into) {
    for (double* value : into)
      if (!(words >> *value)) return false;
    return true;
  }
  static bool poses(std::istringstream& words, std::vector<Pose>& out) {
    for (double x = 0; words >> x;) {
      Pose p;
      V turn;
      p.origin.x() = x;
      if (!values(words, {&p.origin.y(), &p.origin.z(), &turn.x(), &turn.y(), &turn.z()})) return false;
      if (turn.norm() > 0) p.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
      out.push_back(p);
    }
    return words.eof();
  }

  ContactCase case_;
  std::vector<Pose> start_;
  std::string folder_;
};

}  // namespace bench
