// SPDX-License-Identifier: MIT
#pragma once

/// @file Makes the files of a case of bonded_cases.hpp.

#include "truth/bonded_cases.hpp"
#include "truth/gmsh_script.hpp"
#include "truth/rubber.hpp"
#include "truth/surface.hpp"

#include <filesystem>

namespace bench {

// 0 free, -1 fixed, k on patch k; by node.
inline std::vector<int> regions(const Case& c, const Tetrahedra& mesh, const Surface& surface) {
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

inline void write_surface(const Case& c, const Surface& surface, const std::vector<int>& region,
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

inline void write_meta(const Case& c, const std::vector<double>& reached, const std::string& folder) {
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
    std::vector<std::array<int, 6>> faces;
    for (const auto& face : surface_.faces)
      if (std::all_of(face.begin(), face.end(), [&](int n) {
            return region_[n] == 0 && (mesh_.nodes[n] - first.position).norm() < 1.3 * first.radius;
          }))
        faces.push_back(face);
    Contact contact({{RigidTool::ball, first.radius * V::UnitX(), 0, {}}}, faces);
    contact.penalty = 100 * case_.E;
    rubber_.touch(contact);
    Eigen::VectorXd speed = Eigen::VectorXd::Zero(rubber_.state().size());  // by depth, of the last step
    const auto press = [&](double from, double by) {
      const Eigen::VectorXd before = rubber_.state();
      contact.poses[0].origin = first.position + (first.radius - from - by) * first.normal;
      if (!rubber_.settle(before + by * speed, 1e-7 * first.radius)) return false;
      speed = (rubber_.state() - before) / by;
      return true;
    };
    return follow({first.radius / 12, first.radius / 2000, 1.5}, press, [&](std::size_t) {
      return Load{contact.loads()[0].force, V::Zero()};
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

}  // namespace bench
