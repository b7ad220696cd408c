// SPDX-License-Identifier: MIT
#pragma once

/// @file Computes a contact case by finite elements and writes its files.

#include "truth/contact_mesh.hpp"
#include "truth/rubber.hpp"

#include <memory>

namespace bench {

class ContactReference {
 public:
  /// `stiffness`: of the penalty, in E over the shortest edge. `strides`: how many times as short they are.
  ContactReference(const ContactCase& c, const std::string& folder, double fineness, double stiffness = 30,
                   double strides = 1)
      : case_(c),
        folder_(folder),
        fine_(c, folder, fineness),
        mesh_(fine_.mesh()),
        surface_(fine_.surface()),
        half_{c.body.half_x, false, c.body.half_z},
        contact_(c.tools, free_faces()),
        rubber_(mesh_, c.E, c.nu, [this](int node, int axis) { return given(node, axis); }) {
    contact_.friction = c.friction;
    contact_.penalty = stiffness * c.E / fine_.edge();
    rubber_.touch(contact_);
    if (c.linear) rubber_.linearize();
    longest_ = (c.stride > 0 ? c.stride : (c.friction > 0 ? 0.12 : 0.5) * fine_.width()) / strides;
    std::printf("%s: %zu nodes, %zu elements, %d equations, edges from %.3f mm, half width %.3f mm\n",
                folder.c_str(), mesh_.nodes.size(), mesh_.elements.size(), rubber_.equations(), fine_.edge(),
                fine_.width());
    std::fflush(stdout);
  }
  ContactReference(const ContactReference&) = delete;  // the body refers to mesh and contact
  ContactReference& operator=(const ContactReference&) = delete;

  /// Goes from step to step and writes each; returns the tools' loads by step, as many as were reached.
  std::vector<std::vector<ToolLoad>> make() {
    write_surface();
    choose_samples();
    const File loads(
        folder_ + "/load.csv",
        "step,tool,Fx_N,Fy_N,Fz_N,Tx_Nmm,Ty_Nmm,Tz_Nmm,area_mm2,stuck_mm2,highest_pressure_MPa\n"),
        shape(folder_ + "/displacement.csv", "step,vertex,ux,uy,uz\n"),
        traction(folder_ + "/traction.csv", "step,vertex,pressure_Pa,tx_Pa,ty_Pa,tz_Pa\n");
    std::vector<std::vector<ToolLoad>> all;
    contact_.poses = case_.poses[0];
    rubber_.settle(rubber_.state(), tolerance());
    contact_.commit();
    for (std::size_t step = 1; step < case_.poses.size() && go(step); ++step) {
      all.push_back(whole_loads());
      write(step, all.back(), loads, shape, traction);
      for (std::size_t s = 0; s < samples_.size(); ++s)
        shapes_[s].push_back(rubber_.state().segment<3>(3 * surface_.node[samples_[s]]));
      write_samples(all.size());
      for (const File* file : {&loads, &shape, &traction}) std::fflush(file->file);
    }
    return all;
  }

 private:
  double fixed_height() const {
    return (case_.body.stands() ? 0 : case_.body.fixed_height) + 1e-6 * case_.body.size.maxCoeff();
  }
  bool fixed(int node) const {
    return fine_.surface().outer[node] != 0 && fine_.mesh().nodes[node].y() <= fixed_height();
  }
  bool given(int node, int axis) const {
    return fixed(node) ||
           (half_[axis] && std::abs(mesh_.nodes[node][axis]) < 1e-6 * case_.body.size.maxCoeff());
  }
  std::vector<std::array<int, 6>> free_faces() const {
    auto faces = fine_.touchable();
    std::erase_if(faces, [this](const auto& f) {
      return std::all_of(f.begin(), f.end(), [this](int n) { return fixed(n); });
    });
    return faces;
  }
  double tolerance() const { return 1e-6 * fine_.width(); }

  // Moves the tools to a step's poses. False where there is no equilibrium on the way.
  bool go(std::size_t step) {
    double travel = 0;
    for (std::size_t t = 0; t < case_.tools.size(); ++t) {
      const Pose &a = case_.poses[step - 1][t], &b = case_.poses[step][t];
      travel = (std::max)(travel, (b.origin - a.origin).norm() +
                                      a.rotation.angularDistance(b.rotation) * 0.5 * case_.tools[t].extent());
    }
    const double longest = 1 / std::ceil((std::max)(travel / longest_, 1.0) - 1e-9);
    double at = 0, stride = longest, smallest = longest / 100;
    Eigen::VectorXd speed = Eigen::VectorXd::Zero(rubber_.state().size());
    while (at < 1) {
      const double by = at + stride > 1 - 1e-9 ? 1 - at : stride;
      for (std::size_t t = 0; t < case_.tools.size(); ++t) contact_.poses[t] = fine_.pose(step, t, at + by);
      const Eigen::VectorXd before = rubber_.state();
      if (rubber_.settle(before + by * speed, tolerance())) {
        contact_.commit();
        speed = (rubber_.state() - before) / by;
        at = by == 1 - at ? 1 : at + by;
        stride = (std::min)(longest, 1.5 * stride);
        std::printf("  step %.3f, least J %.3f, |F| %.4f N, %d of Newton's steps\n", double(step) - 1 + at,
                    rubber_.least_volume_ratio(), contact_.loads()[0].force.norm(), rubber_.newton_steps());
      } else {
        stride = by / 2;
        std::printf("  step %.3f: no equilibrium\n", double(step) - 1 + at + by);
        if (stride < smallest) return false;
      }
      std::fflush(stdout);
    }
    return true;
  }

  // Of the mirrored parts, too.
  std::vector<ToolLoad> whole_loads() const {
    std::vector<ToolLoad> out = contact_.loads();
    for (ToolLoad& l : out)
      for (int k = 0; k < 3; ++k)
        if (half_[k]) {
          l.force *= 2;
          l.force[k] = 0;
          l.torque = 2 * l.torque[k] * V::Unit(k);
          l.area *= 2;
          l.stuck *= 2;
        }
    return out;
  }
  void write_surface() const {
    const File obj(folder_ + "/surface.obj", ""),
        vertices(folder_ + "/vertices.csv", "vertex,x,y,z,area_m2,fixed\n");
    for (std::size_t v = 0; v < surface_.node.size(); ++v) {
      const V p = surface_.position[v] / 1e3;
      std::fprintf(obj.file, "v %.10g %.10g %.10g\n", p.x(), p.y(), p.z());
      std::fprintf(vertices.file, "%zu,%.10g,%.10g,%.10g,%.6g,%d\n", v, p.x(), p.y(), p.z(),
                   surface_.area[v] / 1e6, fixed(surface_.node[v]));
    }
    for (const auto& t : surface_.triangles)
      std::fprintf(obj.file, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  void write(std::size_t step, const std::vector<ToolLoad>& all, const File& loads, const File& shape,
             const File& traction) const {
    std::vector<V> force(mesh_.nodes.size(), V::Zero());
    std::vector<double> pressure(mesh_.nodes.size(), 0);
    for (std::size_t t = 0; t < all.size(); ++t) {
      const ToolLoad& l = all[t];
      double highest = 0;
      contact_.tractions(t, mesh_.nodes, [&](std::size_t n, const V& by, double p) {
        force[n] += 1e6 * by;
        pressure[n] += 1e6 * p;
        highest = (std::max)(highest, p);
      });
      std::fprintf(loads.file, "%zu,%zu,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", step, t + 1,
                   l.force.x(), l.force.y(), l.force.z(), l.torque.x(), l.torque.y(), l.torque.z(), l.area,
                   l.stuck, highest);
    }
    for (std::size_t v = 0; v < surface_.node.size(); ++v) {
      const int n = surface_.node[v];
      const V u = rubber_.state().segment<3>(3 * n).cwiseProduct(surface_.sign[v]) / 1e3,
              t = force[n].cwiseProduct(surface_.sign[v]);
      std::fprintf(shape.file, "%zu,%zu,%.9g,%.9g,%.9g\n", step, v, u.x(), u.y(), u.z());
      if (pressure[n] > 0)
        std::fprintf(traction.file, "%zu,%zu,%.6g,%.6g,%.6g,%.6g\n", step, v, pressure[n], t.x(), t.y(),
                     t.z());
    }
  }

  // Vertices of the meshed part, spread out, closer where tools are; each with the area of all that are
  // nearest to it.
  void choose_samples() {
    std::vector<double> spacing(surface_.node.size()), nearest(surface_.node.size(), 1e300);
    std::vector<std::size_t> owner(surface_.node.size(), 0);
    for (std::size_t v = 0; v < spacing.size(); ++v) {
      double away = 1e300;
      for (std::size_t step = 1; step < case_.poses.size(); ++step)
        for (std::size_t t = 0; t < case_.tools.size(); ++t)
          away = (std::min)(away, fine_.at(t, case_.poses[step][t], surface_.position[v]).value);
      spacing[v] = surface_.sign[v] == V::Ones() ? fine_.width() / 3 + 0.3 * (std::max)(away, 0.0) : 1e300;
    }
    for (std::size_t next = 0, count = 0; count < 300; ++count) {
      samples_.push_back(next);
      std::size_t farthest = 0;
      for (std::size_t v = 0; v < spacing.size(); ++v) {
        const double d = (surface_.position[v] - surface_.position[next]).norm();
        if (d < nearest[v]) nearest[v] = d, owner[v] = count;
        if (nearest[v] / spacing[v] > nearest[farthest] / spacing[farthest]) farthest = v;
      }
      next = farthest;
    }
    sample_area_.assign(samples_.size(), 0);
    shapes_.resize(samples_.size());
    for (std::size_t v = 0; v < spacing.size(); ++v)
      if (spacing[v] < 1e300) sample_area_[owner[v]] += surface_.area[v];
  }
  void write_samples(std::size_t steps) const {
    const File file(folder_ + "/shape.csv", "x_mm,y_mm,z_mm,area_mm2");
    for (std::size_t k = 1; k <= steps; ++k) std::fprintf(file.file, ",ux_%zu,uy_%zu,uz_%zu", k, k, k);
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      const V& p = surface_.position[samples_[s]];
      std::fprintf(file.file, "\n%.4f,%.4f,%.4f,%.4g", p.x(), p.y(), p.z(), sample_area_[s]);
      for (const V& u : shapes_[s]) std::fprintf(file.file, ",%.4f,%.4f,%.4f", u.x(), u.y(), u.z());
    }
    std::fputs("\n", file.file);
  }

  const ContactCase& case_;
  std::string folder_;
  ContactMesh fine_;
  const Tetrahedra& mesh_;
  const Surface& surface_;
  std::array<bool, 3> half_;
  Contact contact_;
  Rubber rubber_;
  double longest_ = 0;
  std::vector<std::size_t> samples_;
  std::vector<double> sample_area_;
  std::vector<std::vector<V>> shapes_;
};

}  // namespace bench
