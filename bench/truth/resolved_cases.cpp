// SPDX-License-Identifier: MIT

/// @file Judges contact that is resolved at the tool's points (docs/resolved.md) by contact references:
/// forces and torques of the public solver, the tool as a mesh, beside those of finite elements.
///
///     resolved_cases CASE_DIR...      e.g. bench/truth/data/contact/*
///
/// CASE_DIR holds case.txt and load.csv. Bodies: ellipsoids and boxes; several tools as far as they keep
/// their places to each other. Prints each step: loads, displacements at 300 places; and the root mean
/// square of the force's error as a vector.

#include "truth/case_file.hpp"

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/resolved/response_load_deformation.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/joined.hpp>

#include <cstdio>
#include <memory>

using namespace bench;

namespace {

constexpr double mm = 1e-3;

struct Load {
  V force = V::Zero(), torque = V::Zero();  // on the body [N], [N mm]
  double area = 0;                          // [mm^2]
};

/// row(words) for each line of a table but its first; numbers by operator>>.
template <class Row>
void each_row(const std::string& path, const Row& row) {
  std::istringstream in(read_text(path));
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    row(words);
  }
}

/// Of all tools together, by step; torques about the first tool's origin.
std::vector<Load> loads(const std::string& path, const ContactCase& c) {
  std::vector<Load> out;
  each_row(path, [&](std::istream& words) {
    std::size_t step = 0, tool = 0;
    Load l;
    words >> step >> tool >> l.force.x() >> l.force.y() >> l.force.z() >> l.torque.x() >> l.torque.y() >>
        l.torque.z() >> l.area;
    if (step > out.size()) out.emplace_back();
    const auto& poses = c.poses.at(step);
    l.torque += (poses.at(tool - 1).origin - poses.front().origin).cross(l.force);
    out[step - 1].force += l.force;
    out[step - 1].torque += l.torque;
    out[step - 1].area += l.area;
  });
  return out;
}

/// Displacements [m] of places on the surface, by step.
struct Shapes {
  palpate::MeshData<double> at;  // vertices alone
  std::vector<double> area;
  std::vector<std::vector<V>> u;
};
Shapes shapes(const std::string& path) {
  Shapes out;
  each_row(path, [&out](std::istream& words) {
    V x, u;
    double area = 0;
    words >> x.x() >> x.y() >> x.z() >> area;
    out.at.vertices.push_back(mm * x);
    out.area.push_back(area);
    out.u.emplace_back();
    while (words >> u.x() >> u.y() >> u.z()) out.u.back().push_back(mm * u);
  });
  return out;
}

/// The tool's surface [m]: a fine box around it, each vertex moved to the tool by the exact distance.
palpate::MeshData<double> mesh_of(const RigidTool& tool) {
  V half = tool.size;
  if (tool.kind == RigidTool::ball) half = V::Constant(tool.size.x());
  if (tool.kind == RigidTool::capsule)
    half = V(tool.size.x() + tool.size.y() / 2, tool.size.x(), tool.size.x());
  if (tool.kind == RigidTool::box) half = tool.size / 2;
  if (tool.kind == RigidTool::cylinder) half = V(tool.size.x(), tool.size.y() / 2, tool.size.x());
  if (tool.kind == RigidTool::mesh) throw std::runtime_error("mesh tools are not covered");
  palpate::MeshData<double> mesh = palpate::Box<double>({.half = half}).mesh(8000);
  for (V& p : mesh.vertices) {
    const Distance d = tool.distance(p);
    p = mm * (p - d.value * d.gradient);
  }
  return mesh;
}

template <class Object, class Friction>
void judge(const std::string& name, const ContactCase& c, const Object& object,
           const std::shared_ptr<const palpate::ResponseField>& field,
           const palpate::ToolPoints<double>& tool, const Friction& friction, const std::vector<Load>& truth,
           const Shapes& shapes) {
  using Elastic = palpate::ElasticContact<double, palpate::ResponseCompliance>;
  using Shape = palpate::ResponseLoadDeformation<double, 512>;
  palpate::ContactSolver<Object, Elastic, Friction, palpate::ContactPoints<512>, Shape> solver(
      {.object = object,
       .tool = tool,
       .force = Elastic({.compliance = palpate::ResponseCompliance(field)}),
       .friction = friction,
       .deformation = Shape(field, shapes.at, false)});
  std::vector<V> deformed(shapes.at.vertices.size());
  const palpate::VertexBuffer<double> buffer{.positions = deformed.front().data()};
  palpate::FixedVector<palpate::SurfaceLoad<double>, 512> loads;
  double sum = 0;
  std::size_t steps = 0;
  for (std::size_t k = 1; k < c.poses.size() && k <= truth.size(); ++k) {
    palpate::TickResult<double> result{};
    for (int i = 1; i <= 100; ++i) {
      const Pose p = between(c.poses[k - 1][0], c.poses[k][0], i / 100.);
      result = solver.tick({p.rotation.toRotationMatrix(), mm * p.origin});
    }
    const double area = solver.contacts().empty() ? 0 : solver.contacts()[0].area / (mm * mm);
    const Load& t = truth[k - 1];
    const V force = -result.wrench.force, torque = -result.wrench.torque / mm;
    const double error = (force - t.force).norm() / t.force.norm();
    sum += error * error;
    ++steps;
    std::printf("%s step %zu: F %.3f %.3f %.3f N, reference %.3f %.3f %.3f: %.1f %%; ", name.c_str(), k,
                force.x(), force.y(), force.z(), t.force.x(), t.force.y(), t.force.z(), 100 * error);
    std::printf("T %.1f %.1f %.1f N mm, reference %.1f %.1f %.1f; area %+.0f %%; %zu points\n", torque.x(),
                torque.y(), torque.z(), t.torque.x(), t.torque.y(), t.torque.z(), 100 * (area / t.area - 1),
                solver.state().points().size());
    solver.state().loads(loads);
    (void)solver.draw({loads.begin(), loads.size()}, buffer);
    double off = 0, area_of_all = 0, largest = 0, deepest = 0, there = 0;
    for (std::size_t v = 0; v < deformed.size(); ++v) {
      const V u = shapes.u[v][k - 1];
      const double wrong = (deformed[v] - shapes.at.vertices[v] - u).norm();
      off += shapes.area[v] * wrong;
      area_of_all += shapes.area[v];
      largest = (std::max)(largest, wrong);
      if (u.norm() > deepest) deepest = u.norm(), there = wrong;
    }
    std::printf(
        "%s step %zu: displacement off by %.2f %% of the deepest in the mean, %.1f %% there, %.1f %% at "
        "most\n",
        name.c_str(), k, 100 * off / area_of_all / deepest, 100 * there / deepest, 100 * largest / deepest);
  }
  std::printf("%s force, rms: %.1f %%\n", name.c_str(), 100 * std::sqrt(sum / static_cast<double>(steps)));
}

template <class Object>
void judge(const std::string& name, const ContactCase& c, const Object& object, std::vector<Load> truth,
           const Shapes& shapes) {
  // All tools as one, in the frame of the first, as long as they keep their places.
  std::size_t together = c.poses.size();
  palpate::MeshData<double> all;
  for (std::size_t k = 0; k < c.tools.size(); ++k) {
    const V offset = mm * (c.poses[0][k].origin - c.poses[0][0].origin);
    for (std::size_t i = 0; i < together; ++i)
      if ((c.poses[i][k].origin - c.poses[i][0].origin - offset / mm).norm() > 1e-9) together = i;
    palpate::test::append(all, mesh_of(c.tools[k]), offset);
  }
  truth.resize((std::min)(truth.size(), together - 1));
  const RigidTool& t = c.tools[0];
  const bool is_round = t.kind == RigidTool::ball || t.kind == RigidTool::ellipsoid;
  const double spacing =
      mm * (is_round ? 0.12 : 0.2) * (t.kind == RigidTool::box ? t.size.minCoeff() : t.size.x());
  const palpate::ToolPoints<double> tool(
      palpate::contact_samples(palpate::TriangleMesh<double>(all), spacing),
      {.contact_area = spacing * spacing});
  const bool stands = c.body.stands();
  const double fixed = mm * c.body.fixed_height;
  const auto field = std::make_shared<const palpate::ResponseField>(
      object.mesh(5000), [=](const V& x) { return stands ? x.y() <= 1e-6 : x.y() <= fixed; },
      palpate::ResponseField::Params{.E = 1e6 * c.E, .nu = c.nu, .mesh = {.vertices = 600}});
  if (c.friction > 0)
    judge(name, c, object, field, tool,
          palpate::CoulombFriction<double>({.mu_static = c.friction, .mu_dynamic = c.friction}), truth,
          shapes);
  else
    judge(name, c, object, field, tool, palpate::Frictionless<double>{}, truth, shapes);
}

void judge(const std::string& folder) {
  const ContactCase c = CaseFile::read(folder + "/case.txt");
  const std::vector<Load> truth = loads(folder + "/load.csv", c);
  if (truth.empty()) throw std::runtime_error("no step was reached");
  const Shapes moved = shapes(folder + "/shape.csv");
  const std::string name = folder.substr(folder.find_last_of('/') + 1);
  if (c.body.kind == Body::ellipsoid)
    judge(name, c, palpate::Ellipsoid<double>({.axes = mm * c.body.size}), truth, moved);
  else if (c.body.kind == Body::box)
    judge(name, c,
          palpate::Box<double>({.half = mm / 2 * c.body.size, .centre = V(0, mm / 2 * c.body.size.y(), 0)}),
          truth, moved);
  else
    throw std::runtime_error("of bodies ellipsoids and boxes are covered");
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    try {
      judge(argv[i]);
    } catch (const std::exception& e) {
      std::printf("%s: %s\n", argv[i], e.what());
    }
  }
}
