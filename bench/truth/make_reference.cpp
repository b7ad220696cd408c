// SPDX-License-Identifier: MIT

/// @file Makes a reference case by finite elements: the bodies of docs/accuracy.md. `references.sh` calls it.
///
///     make_reference NAME CASE_DIR fineness     without arguments: the names
///
/// Bonded flat punches on rubber, pressed by their depth and rotated, or a frictionless ball. Needs gmsh as a
/// command. Writes what truth_cases reads into CASE_DIR: meta.json, surface.obj, vertices.csv,
/// displacement.csv, displacement_linear.csv (small strain), force.csv, force_linear.csv, with the torques
/// about the patches' middles, where they have moved to. Vertices: the elements' nodes on the surface.
/// fineness: patch radius over edges at its rim. Of a ball there is nothing linear.

#include "truth/rubber.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace {

using namespace bench;

struct Case {
  const char* name;
  Body body;
  double E, nu;  // [MPa], -
  std::vector<Patch> patches;
  std::vector<double> depths;  // [mm]
  bool ball = false;           // a frictionless ball of the patch's radius instead
};

// `lean` degrees off the normal, towards `aside`.
V leaning(const V& normal, const V& aside, double lean) {
  const double angle = lean * std::acos(-1.0) / 180;
  return -std::cos(angle) * normal + std::sin(angle) * aside;
}
Patch on_top(double x, double y, double z, double radius, double lean = 0) {
  return {{x, y, z}, V::UnitY(), leaning(V::UnitY(), V::UnitX(), lean), radius, 1};
}
// Tilted about the axis z by `turn` [rad] with each mm of depth, and pressed by `factor` of it.
Patch turned(Patch p, double turn, double factor = 1) {
  p.turn = turn * V::UnitZ();
  p.factor = factor;
  return p;
}
// About its inward normal, not pressed.
Patch twisted(Patch p, double turn) {
  p.turn = -turn * p.normal;
  p.factor = 0;
  return p;
}
// On an ellipsoid, `angle` degrees (of its parameter) from the top towards x.
Patch on_flank(const V& axes, double angle, double radius, double lean = 0) {
  const double t = angle * std::acos(-1.0) / 180;
  const V position(axes.x() * std::sin(t), axes.y() * std::cos(t), 0);
  const V normal = position.cwiseQuotient(axes.cwiseProduct(axes)).normalized();
  return {position, normal, leaning(normal, V(normal.y(), -normal.x(), 0), lean), radius, 1};
}

std::vector<Case> cases() {
  const auto box = [](double x, double y, double z, bool half_x = false, bool half_z = true) {
    return Body{Body::box, {x, y, z}, 0, half_x, half_z};
  };
  const Body ellipsoid{Body::ellipsoid, {60, 40, 40}, -36, true, true},
      a{Body::ellipsoid, {50, 35, 30}, -28, false, true}, A{Body::ellipsoid, {50, 45, 35}, -42, false, true};
  const Body large = box(200, 100, 200, true), block = box(80, 50, 60);
  const V pushed = -V::UnitX();
  return {
      {"half_space",
       box(300, 150, 300, true),
       1,
       0.49,
       {on_top(0, 150, 0, 5)},
       {0.5, 1, 2, 3, 4, 5, 6, 8, 10}},
      {"half_space_askew", box(300, 150, 300), 1, 0.49, {on_top(0, 150, 0, 5, 35)}, {0.5, 1, 2, 3, 4, 5}},
      {"ellipsoid_top", ellipsoid, 1.5, 0.49, {on_top(0, 40, 0, 5)}, {1, 2, 4, 6, 8, 10}},
      {"cube", box(100, 100, 100, true), 1, 0.49, {on_top(0, 100, 0, 10)}, {1, 2, 4, 8, 12}},
      {"ellipsoid_askew", a, 1, 0.49, {on_flank(a.size, 40, 4, 25)}, {1, 2, 4, 6}},
      {"block_head", box(80, 50, 60), 1, 0.49, {on_top(8, 50, 0, 20)}, {1, 2, 4, 7, 10}},
      {"block_edge", box(80, 50, 60), 1, 0.49, {on_top(28, 50, 0, 6)}, {1, 2, 4, 6, 9}},
      {"block_askew", box(80, 50, 60), 1, 0.49, {on_top(0, 50, 0, 6, 30)}, {1, 2, 4, 6}},
      {"slab", box(120, 30, 100, true), 1, 0.49, {on_top(0, 30, 0, 8)}, {1, 2, 4, 6, 9}},
      {"block_askew_nu3", box(80, 50, 60), 1, 0.3, {on_top(0, 50, 0, 6, 30)}, {1, 2, 3}},
      {"cylinder_rim",
       {Body::cylinder, {30, 50, 30}, 0, false, true},
       1,
       0.49,
       {on_top(19, 50, 0, 6)},
       {1, 2, 4, 6, 9}},
      {"cylinder_head",
       {Body::cylinder, {30, 45, 30}, 0, false, true},
       1,
       0.49,
       {on_top(4, 45, 0, 15)},
       {1, 2, 4, 6, 9}},
      {"flat_block_edge", box(100, 40, 80), 1, 0.49, {on_top(40, 40, 0, 5)}, {1, 2, 4, 6}},
      {"wall", box(20, 60, 80), 1, 0.49, {{{10, 40, 0}, V::UnitX(), pushed, 5, 1}}, {1, 2, 4, 6}},
      {"ellipsoid_top_nu3", ellipsoid, 1.5, 0.3, {on_top(0, 40, 0, 5)}, {1, 2, 3, 4}},
      {"block_edge_askew", box(90, 45, 70), 1, 0.49, {on_top(30, 45, 0, 6, 20)}, {1, 2, 4, 7}},
      {"block_near_edge", box(110, 55, 76), 1, 0.49, {on_top(46.5, 55, 0, 4.5)}, {1, 2, 3.5, 5}},
      {"thin_slab", box(90, 28, 100, true), 1, 0.49, {on_top(0, 28, 0, 5)}, {1, 2, 4, 6}},
      {"ellipsoid_held_low", A, 1, 0.49, {on_flank(A.size, 50, 6, 30)}, {1, 2, 4, 6, 9}},
      {"block_two",
       box(100, 60, 80),
       1,
       0.49,
       {on_top(-20, 60, 0, 6), on_top(22, 60, 0, 8)},
       {1, 2, 4, 6, 9}},
      {"tilt", block, 1, 0.49, {turned(on_top(0, 50, 0, 6), 0.1, 0)}, {0.5, 1, 2, 3}},
      {"tilt_nu3", block, 1, 0.3, {turned(on_top(0, 50, 0, 6), 0.1, 0)}, {0.5, 1, 2, 3}},
      {"tilt_edge", block, 1, 0.49, {turned(on_top(28, 50, 0, 6), 0.1, 0)}, {0.5, 1, 2, 3}},
      {"tilt_pressed",
       box(200, 100, 200),
       1,
       0.49,
       {turned(on_top(0, 100, 0, 5), 0.06)},
       {0.5, 1, 2, 3, 4, 5}},
      {"tilt_pressed_nu3",
       box(200, 100, 200),
       1,
       0.3,
       {turned(on_top(0, 100, 0, 5), 0.06)},
       {0.5, 1, 1.5, 2, 2.5, 3}},
      {"tilt_askew",
       box(200, 100, 200),
       1,
       0.49,
       {turned(on_top(0, 100, 0, 5, 35), 0.06)},
       {0.5, 1, 2, 3, 4, 5}},
      {"tilt_pressed_edge", block, 1, 0.49, {turned(on_top(28, 50, 0, 6), -0.04)}, {1, 2, 4, 6}},
      {"tilt_flank", a, 1, 0.49, {turned(on_flank(a.size, 40, 4, 25), 0.06)}, {1, 2, 4}},
      {"twist",
       {Body::ellipsoid, a.size, a.fixed_height},
       1,
       0.49,
       {twisted(on_flank(a.size, 40, 6), 0.1)},
       {0.5, 1, 2, 3}},
      {"ball_ellipsoid", ellipsoid, 1.5, 0.49, {on_top(0, 40, 0, 15)}, {0.5, 1, 2, 4, 8, 12}, true},
      {"ball_half_space", large, 1, 0.49, {on_top(0, 100, 0, 10)}, {0.5, 1, 2, 3, 4, 5}, true},
      {"ball_half_space_nu3", large, 1, 0.3, {on_top(0, 100, 0, 10)}, {0.5, 1, 2, 3, 4, 5}, true},
      {"ball_block", box(80, 50, 60, true), 1, 0.49, {on_top(0, 50, 0, 12)}, {0.5, 1, 2, 4, 8}, true},
      {"ball_edge", box(80, 50, 60), 1, 0.49, {on_top(28, 50, 0, 10)}, {0.5, 1, 2, 4, 6}, true},
      {"ball_slab", box(120, 30, 100, true), 1, 0.49, {on_top(0, 30, 0, 15)}, {0.5, 1, 2, 4, 7}, true},
      {"ball_flank", a, 1, 0.49, {on_flank(a.size, 40, 10)}, {0.5, 1, 2, 4, 7}, true},
  };
}

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
Surface surface_of(const Tetrahedra& mesh, const Body& body) {
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

// 0 free, -1 fixed, k on patch k; by node.
std::vector<int> regions(const Case& c, const Tetrahedra& mesh, const Surface& surface) {
  const double fixed_height =
      (c.body.kind == Body::ellipsoid ? c.body.fixed_height : 0) + 1e-6 * c.body.size.maxCoeff();
  std::vector<int> region(mesh.nodes.size(), 0);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (!surface.outer[n]) continue;
    if (mesh.nodes[n].y() <= fixed_height) region[n] = -1;
    for (std::size_t p = 0; p < c.patches.size() && !c.ball; ++p)
      if ((mesh.nodes[n] - c.patches[p].position).norm() <= c.patches[p].radius * (1 + 1e-4))
        region[n] = static_cast<int>(p) + 1;
  }
  return region;
}

void write_surface(const Case& c, const Surface& surface, const std::vector<int>& region,
                   const std::string& folder) {
  File obj(folder + "/surface.obj", ""),
      vertices(folder + "/vertices.csv", "vertex,x,y,z,area_m2,region,r_over_a\n");
  for (std::size_t v = 0; v < surface.node.size(); ++v) {
    const V p = surface.position[v] / 1e3;
    double ratio = 1e300;
    for (const Patch& patch : c.patches)
      ratio = (std::min)(ratio, (surface.position[v] - patch.position).norm() / patch.radius);
    std::fprintf(obj.file, "v %.10g %.10g %.10g\n", p.x(), p.y(), p.z());
    std::fprintf(vertices.file, "%zu,%.10g,%.10g,%.10g,%.6g,%d,%.6g\n", v, p.x(), p.y(), p.z(),
                 surface.area[v] / 1e6, region[surface.node[v]], ratio);
  }
  for (const auto& t : surface.triangles)
    std::fprintf(obj.file, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
}

void write_meta(const Case& c, const std::vector<double>& reached, const std::string& folder) {
  File meta(folder + "/meta.json", "{\n");
  const auto list = [](const V& v) { return text('[', v.x(), ", ", v.y(), ", ", v.z(), ']'); };
  std::string patches, depths;
  for (const Patch& p : c.patches)
    patches += text(patches.empty() ? "" : ",\n", "{\"centre_m\": ", list(p.position / 1e3),
                    ", \"radius_m\": ", p.radius / 1e3, ", \"direction\": ", list(p.direction),
                    ", \"inward_normal\": ", list(-p.normal), ", \"depth_factor\": ", p.factor,
                    ", \"turn_per_m\": ", list(p.turn * 1e3), '}');
  const Patch& first = c.patches[0];
  const std::string ball = text("\"indenter\": {\"radius_m\": ", first.radius / 1e3,
                                ", \"first_touch_point_m\": ", list(first.position / 1e3),
                                ", \"inward_normal\": ", list(-first.normal), "},\n");
  for (double depth : reached) depths += text(depths.empty() ? "" : ", ", depth / 1e3);
  std::string fixed;
  if (c.body.kind == Body::ellipsoid)
    fixed = text("\"fixed\": {\"y_max_m\": ", c.body.fixed_height / 1e3,
                 "},\n\"semi_axes_m\": ", list(c.body.size / 1e3), ",\n");
  std::fputs(
      text("\"material\": {\"E_Pa\": ", c.E * 1e6, ", \"nu\": ", c.nu, "},\n", fixed,
           c.ball ? ball : text("\"patches\": [\n", patches, "],\n"), "\"depths_m\": [", depths, "]\n}\n")
          .c_str(),
      meta.file);
}

// One case: its mesh, the body, and the files of its folder.
class Reference {
 public:
  Reference(const Case& c, const std::string& folder, double fineness)
      : case_(c),
        folder_(folder),
        mesh_(meshed(c, folder, fineness)),
        surface_(surface_of(mesh_, c.body)),
        region_(regions(c, mesh_, surface_)),
        half_{c.body.half_x, false, c.body.half_z},
        rubber_(mesh_, c.E, c.nu, [this](int node, int axis) {
          const double near = 1e-6 * case_.body.size.maxCoeff();
          return region_[node] != 0 || (half_[axis] && std::abs(mesh_.nodes[node][axis]) < near);
        }) {
    std::printf("%s: %zu nodes, %zu elements, %d equations, %zu vertices on the surface\n", c.name,
                mesh_.nodes.size(), mesh_.elements.size(), rubber_.equations(), surface_.node.size());
    std::fflush(stdout);
  }
  Reference(const Reference&) = delete;  // the body refers to the mesh
  Reference& operator=(const Reference&) = delete;

  void make() {
    write_surface(case_, surface_, region_, folder_);
    write_meta(case_, case_.ball ? press_ball() : press_patches(), folder_);
  }

 private:
  struct Load {
    V force, torque;  // [N], [N mm]
  };
  struct Strides {
    double longest, smallest,
        growth;  // growth: of a stride over the last one that found equilibrium; 0: stays
  };
  struct Tables {
    Tables(const std::string& folder, const char* which)
        : shape(folder + "/displacement" + which + ".csv", "depth_m,vertex,ux,uy,uz\n"),
          force(folder + "/force" + which + ".csv", "depth_m,patch,Fx,Fy,Fz,Tx,Ty,Tz\n") {}
    File shape, force;
  };

  static Tetrahedra meshed(const Case& c, const std::string& folder, double fineness) {
    std::filesystem::create_directories(folder);
    const std::string geo = folder + "/body.geo", msh = folder + "/body.msh";
    { File script(geo, GmshScript(c.body, c.patches, c.ball, fineness)().c_str()); }
    if (std::system(("gmsh -3 -v 2 '" + geo + "' -o '" + msh + "'").c_str()) != 0)
      throw std::runtime_error("gmsh failed on " + geo);
    return read_msh(msh);
  }

  // The depths that were reached.
  std::vector<double> press_patches() {
    const Eigen::VectorXd rest = rubber_.state();
    rubber_.step(
        motion([](const Patch& p, const V& r) { return V(p.factor * p.direction + p.turn.cross(r)); }), true);
    {
      const Tables linear(folder_, "_linear");
      for (double depth : case_.depths)
        write(linear, depth, depth, [this](std::size_t patch) { return patch_load(patch, 0); });
    }
    rubber_.reset(rest);
    const double a = case_.patches[0].radius;
    double reached = 0;
    return follow(
        {a / 4, a / 50, 0},
        [&](double from, double by) {
          if (!rubber_.step(motion(
                  [=](const Patch& p, const V& r) { return V(moved(p, r, from + by) - moved(p, r, from)); })))
            return false;
          reached = from + by;
          return true;
        },
        [&](std::size_t patch) { return patch_load(patch, reached); });
  }

  std::vector<double> press_ball() {
    const Patch& first = case_.patches[0];
    RigidSphere sphere{V::Zero(), first.radius, 100 * case_.E, {}};
    for (const auto& face : surface_.faces)
      if (std::all_of(face.begin(), face.end(), [&](int n) {
            return region_[n] == 0 && (mesh_.nodes[n] - first.position).norm() < 1.3 * sphere.radius;
          }))
        sphere.faces.push_back(face);
    Eigen::VectorXd speed = Eigen::VectorXd::Zero(rubber_.state().size());  // by depth, of the last step
    const auto press = [&](double from, double by) {
      const Eigen::VectorXd before = rubber_.state();
      sphere.centre = first.position + (sphere.radius - from - by) * first.normal;
      if (!rubber_.settle(sphere, before + by * speed)) return false;
      speed = (rubber_.state() - before) / by;
      return true;
    };
    return follow({sphere.radius / 12, sphere.radius / 2000, 1.5}, press, [this](std::size_t) {
      return Load{rubber_.sphere_force(), V::Zero()};
    });
  }

  // press(from, by): moves the tool on, false where there is no equilibrium; load(patch): of the part that is
  // meshed.
  template <class Press, class LoadOf>
  std::vector<double> follow(const Strides& strides, Press press, LoadOf load) {
    const Tables tables(folder_, "");
    double at = 0, stride = strides.longest;
    std::vector<double> reached;
    for (double depth : case_.depths) {
      while (at < depth && stride > strides.smallest) {
        const double d = (std::min)(stride, depth - at);
        if (press(at, d)) {
          if (strides.growth > 0)
            stride = (std::min)(strides.longest, strides.growth * d + strides.longest / 8);
          at = depth - at - d < 1e-9 ? depth : at + d;
          std::printf("  %.3f mm, least J %.3f\n", at, rubber_.least_volume_ratio());
        } else {
          stride = d / 2;
        }
        std::fflush(stdout);
      }
      if (at < depth) {
        std::printf("  %.3f mm not reached\n", depth);
        break;
      }
      write(tables, depth, 1, load);
      reached.push_back(depth);
    }
    return reached;
  }

  // How far a point of a patch, at r from its middle, has gone at `depth`.
  static V moved(const Patch& p, const V& r, double depth) {
    const double angle = depth * p.turn.norm();
    return depth * p.factor * p.direction +
           (angle > 0 ? V(Eigen::AngleAxisd(angle, p.turn.normalized()) * r - r) : V(V::Zero()));
  }
  // by(patch, r): of the patches' nodes.
  template <class By>
  Eigen::VectorXd motion(By by) const {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(rubber_.state().size());
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      if (region_[n] <= 0) continue;
      const Patch& p = case_.patches[static_cast<std::size_t>(region_[n] - 1)];
      const V u = by(p, V(mesh_.nodes[n] - p.position));
      for (int k = 0; k < 3; ++k)
        if (!half_[k]) d[3 * static_cast<Eigen::Index>(n) + k] = u[k];
    }
    return d;
  }
  Load patch_load(std::size_t patch, double depth) const {
    Load out{V::Zero(), V::Zero()};
    const Patch& p = case_.patches[patch];
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
      if (region_[n] != static_cast<int>(patch) + 1) continue;
      const V f = rubber_.forces().segment<3>(3 * static_cast<Eigen::Index>(n)),
              r = mesh_.nodes[n] - p.position;
      out.force += f;
      out.torque += (r + moved(p, r, depth) - moved(p, V::Zero(), depth)).cross(f);
    }
    return out;
  }

  template <class LoadOf>
  void write(const Tables& tables, double depth, double scale, LoadOf load) const {
    for (std::size_t v = 0; v < surface_.node.size(); ++v) {
      const V u =
          scale * rubber_.state().segment<3>(3 * surface_.node[v]).cwiseProduct(surface_.sign[v]) / 1e3;
      std::fprintf(tables.shape.file, "%.9g,%zu,%.9g,%.9g,%.9g\n", depth / 1e3, v, u.x(), u.y(), u.z());
    }
    for (std::size_t p = 0; p < case_.patches.size(); ++p) {
      auto [F, T] = load(p);
      F *= scale;
      T *= scale / 1e3;
      for (int k = 0; k < 3;
           ++k)  // of the mirrored parts, too: there the torque keeps what is along the mirror's normal
        if (half_[k]) {
          F *= 2;
          F[k] = 0;
          T = 2 * T[k] * V::Unit(k);
        }
      std::fprintf(tables.force.file, "%.9g,%zu,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", depth / 1e3, p + 1, F.x(),
                   F.y(), F.z(), T.x(), T.y(), T.z());
    }
  }

  const Case& case_;
  std::string folder_;
  Tetrahedra mesh_;
  Surface surface_;
  std::vector<int> region_;  // by node
  std::array<bool, 3> half_;
  Rubber rubber_;
};

}  // namespace

int main(int argc, char** argv) try {
  for (const Case& c : cases()) {
    if (argc < 4)
      std::printf("%s\n", c.name);
    else if (argv[1] == std::string(c.name)) {
      Reference(c, argv[2], std::atof(argv[3])).make();
      return 0;
    }
  }
  return argc < 4 ? 0 : (std::fprintf(stderr, "no case %s\n", argv[1]), 1);
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_reference: %s\n", error.what());
  return 1;
}
