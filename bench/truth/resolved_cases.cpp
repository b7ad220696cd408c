// SPDX-License-Identifier: MIT

/// @file Judges contact that is resolved at the tool's points (docs/resolved.md) by contact references:
/// forces and torques of the public solver, the tool as a mesh, beside those of finite elements.
///
///     resolved_cases CASE_DIR...      e.g. bench/truth/data/contact/*
///
/// CASE_DIR holds case.txt and load.csv. Several tools are solved in turn, each under the loads of the
/// others. Prints each step: each tool's load, displacements at 300 positions; and the root mean square of
/// the force's error as a vector, of all tools over all tools' forces.

#include "truth/case_file.hpp"

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/shared_surface.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/resolved/response_load_deformation.hpp>
#include <palpate/solver/contact_solver.hpp>
#include <palpate/touch/elastic_body.hpp>

#include <cstdio>
#include <memory>
#include <span>

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

/// By step and tool; torques about the tool's origin.
std::vector<std::vector<Load>> loads(const std::string& path) {
  std::vector<std::vector<Load>> out;
  each_row(path, [&](std::istream& words) {
    std::size_t step = 0, tool = 0;
    Load l;
    words >> step >> tool >> l.force.x() >> l.force.y() >> l.force.z() >> l.torque.x() >> l.torque.y() >>
        l.torque.z() >> l.area;
    if (step > out.size()) out.emplace_back();
    out.back().push_back(l);
  });
  return out;
}

/// Displacements [m] of positions on the surface, by step.
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

/// Around the tool, in its frame [mm].
Eigen::AlignedBox3d bounds(const RigidTool& tool) {
  V half = tool.size;
  if (tool.kind == RigidTool::ball) half = V::Constant(tool.size.x());
  if (tool.kind == RigidTool::capsule)
    half = V(tool.size.x() + tool.size.y() / 2, tool.size.x(), tool.size.x());
  if (tool.kind == RigidTool::box) half = tool.size / 2;
  if (tool.kind == RigidTool::cylinder) half = V(tool.size.x(), tool.size.y() / 2, tool.size.x());
  Eigen::AlignedBox3d around(-half, half);
  if (tool.kind == RigidTool::mesh) {
    around.setEmpty();
    for (const V& p : tool.triangles.vertices) around.extend(p);
    around = {around.min() - V::Constant(tool.rounding), around.max() + V::Constant(tool.rounding)};
  }
  return around;
}

/// The tool's surface [m]: a fine box around it, each vertex moved to the tool by the exact distance. A mesh
/// with hollows is covered where they can be seen from the box.
palpate::MeshData<double> mesh_of(const RigidTool& tool) {
  const Eigen::AlignedBox3d around = bounds(tool);
  palpate::MeshData<double> mesh =
      palpate::Box<double>({.half = around.sizes() / 2, .centre = around.center()}).mesh(8000);
  for (V& p : mesh.vertices) {
    const Distance d = tool.distance(p);
    p = mm * (p - d.value * d.gradient);
  }
  return mesh;
}

/// A body of circles around an axis, as rings of vertices [m].
palpate::MeshData<double> mesh_of(const Body& body) {
  constexpr int along = 48, end = 12;
  constexpr std::uint32_t around = 64;
  struct Ring {
    V centre, axis;
    double radius;
  };
  std::vector<Ring> rings;
  if (body.kind == Body::bean) {
    const auto middle = [&body](double angle) {
      return V(body.size.x() * std::sin(angle), body.size.x() * (1 - std::cos(angle)), 0);
    };
    const auto cap = [&](int side) {
      const V axis(std::cos(body.bend), side * std::sin(body.bend), 0);
      for (int i = side < 0 ? 0 : 1; i <= (side < 0 ? end - 1 : end); ++i) {
        const double angle = std::acos(0.) * (side < 0 ? i - end : i) / end;  // from the end's circle on
        rings.push_back({middle(side * body.bend) + body.size.y() * std::sin(angle) * axis, axis,
                         body.size.y() * std::cos(angle)});
      }
    };
    cap(-1);
    for (int i = -along; i <= along; i += 2) {
      const double angle = body.bend * i / along;
      rings.push_back({middle(angle), V(std::cos(angle), std::sin(angle), 0), body.size.y()});
    }
    cap(1);
  } else {
    const bool lies = body.kind == Body::rod;
    const V axis = lies ? V::UnitZ() : V::UnitY();
    const double low = lies ? -body.size.z() : 0, high = lies ? body.size.z() : body.size.y();
    for (int i = 0; i <= end; ++i) rings.push_back({low * axis, axis, body.size.x() * i / end});
    for (int i = 1; i < along; ++i)
      rings.push_back({(low + (high - low) * i / along) * axis, axis, body.size.x()});
    for (int i = end; i >= 0; --i) rings.push_back({high * axis, axis, body.size.x() * i / end});
  }
  palpate::MeshData<double> mesh;
  mesh.vertices.push_back(mm * rings.front().centre);
  for (std::size_t r = 1; r + 1 < rings.size(); ++r) {
    const V across = rings[r].axis.z() > 0.5 ? V::UnitX() : V::UnitZ();
    const V third = rings[r].axis.cross(across);
    for (std::uint32_t k = 0; k < around; ++k) {
      const double angle = 4 * std::acos(0.) * k / around;
      mesh.vertices.push_back(
          mm * (rings[r].centre + rings[r].radius * (std::cos(angle) * across + std::sin(angle) * third)));
    }
  }
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(mm * rings.back().centre);
  for (std::uint32_t k = 0; k < around; ++k) {
    const std::uint32_t next = (k + 1) % around;
    mesh.triangles.push_back({0, 1 + next, 1 + k});
    mesh.triangles.push_back({last, last - around + k, last - around + next});
    for (std::uint32_t r = 1; r + around < last; r += around) {
      mesh.triangles.push_back({r + k, r + next, r + around + k});
      mesh.triangles.push_back({r + next, r + around + next, r + around + k});
    }
  }
  return mesh;
}

palpate::ToolPoints<double> points_of(const RigidTool& tool) {
  double share = 0.2, size = tool.size.x();
  if (tool.kind == RigidTool::ball || tool.kind == RigidTool::ellipsoid) share = 0.12;
  if (tool.kind == RigidTool::box) size = bounds(tool).sizes().minCoeff();
  if (tool.kind == RigidTool::mesh) share = 0.5, size = tool.rounding;  // it touches with its edges
  const double spacing = mm * share * size;
  return {palpate::contact_samples(palpate::TriangleMesh<double>(mesh_of(tool)), spacing),
          {.contact_area = spacing * spacing}};
}

template <class Object, class Friction>
void judge(const std::string& name, const ContactCase& c, const Object& object,
           const std::shared_ptr<const palpate::ResponseField>& field, const Friction& friction,
           const std::vector<std::vector<Load>>& truth, const Shapes& shapes) {
  using Elastic = palpate::ElasticContact<double, palpate::ResponseCompliance>;
  using Solver = palpate::ContactSolver<Object, Elastic, Friction, palpate::ContactPoints<512, 512>>;
  using Loads = palpate::FixedVector<palpate::SurfaceLoad<double>, 512>;
  std::vector<Solver> tools;
  for (const RigidTool& tool : c.tools)
    tools.push_back(Solver({.object = object,
                            .tool = points_of(tool),
                            .force = Elastic({.compliance = palpate::ResponseCompliance(field)}),
                            .friction = friction}));
  palpate::ResponseLoadDeformation<double, 512> shape(field, shapes.at, false);
  std::vector<V> deformed(shapes.at.vertices.size());
  const palpate::VertexBuffer<double> buffer{.positions = deformed.front().data()};
  const auto loads_without = [&tools](std::size_t left_out) {
    Loads all;
    for (std::size_t t = 0; t < tools.size(); ++t) {
      Loads loads;
      if (t != left_out) tools[t].state().loads(loads);
      for (const auto& load : loads)
        if (!all.full()) all.push_back(load);
    }
    return all;
  };
  double sum = 0;
  std::size_t steps = 0;
  for (std::size_t k = 1; k < c.poses.size() && k <= truth.size(); ++k) {
    std::vector<Load> felt(tools.size());
    const int rest = tools.size() > 1 ? 5 : 0;  // rounds in which the tools come to agree
    for (int i = 1; i <= 100 + rest; ++i) {
      for (std::size_t t = 0; t < tools.size(); ++t) {
        const Pose p = between(c.poses[k - 1][t], c.poses[k][t], (std::min)(i, 100) / 100.);
        const Loads beside = loads_without(t);
        tools[t].set_beside(std::span(beside.begin(), beside.size()));
        const auto wrench = tools[t].tick({p.rotation.toRotationMatrix(), mm * p.origin}, 1e-3).wrench;
        felt[t] = {-wrench.force, -wrench.torque / mm,
                   tools[t].contacts().empty() ? 0 : tools[t].contacts()[0].area / (mm * mm)};
      }
    }
    double wrong2 = 0, whole2 = 0;
    for (std::size_t t = 0; t < tools.size(); ++t) {
      const Load &at = felt[t], &wanted = truth[k - 1].at(t);
      const V wrong = at.force - wanted.force;
      wrong2 += wrong.squaredNorm(), whole2 += wanted.force.squaredNorm();
      std::printf("%s step %zu tool %zu: F %.3f %.3f %.3f N, reference %.3f %.3f %.3f: %.1f %%; ",
                  name.c_str(), k, t + 1, at.force.x(), at.force.y(), at.force.z(), wanted.force.x(),
                  wanted.force.y(), wanted.force.z(), 100 * wrong.norm() / wanted.force.norm());
      std::printf("T %.1f %.1f %.1f N mm, reference %.1f %.1f %.1f; area %+.0f %%; %zu points\n",
                  at.torque.x(), at.torque.y(), at.torque.z(), wanted.torque.x(), wanted.torque.y(),
                  wanted.torque.z(), 100 * (at.area / wanted.area - 1), tools[t].state().points().size());
    }
    sum += wrong2 / whole2;
    ++steps;
    const Loads all = loads_without(tools.size());
    (void)shape.write({all.begin(), all.size()}, buffer);
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
void judge(const std::string& name, const ContactCase& c, const Object& object,
           const std::shared_ptr<const palpate::ResponseField>& field,
           const std::vector<std::vector<Load>>& truth, const Shapes& shapes) {
  if (c.friction > 0)
    judge(name, c, object, field,
          palpate::CoulombFriction<double>({.mu_static = c.friction, .mu_dynamic = c.friction}), truth,
          shapes);
  else
    judge(name, c, object, field, palpate::Frictionless<double>{}, truth, shapes);
}

void judge(const std::string& folder) {
  const ContactCase c = CaseFile::read(folder + "/case.txt");
  const std::vector<std::vector<Load>> truth = loads(folder + "/load.csv");
  if (truth.empty()) throw std::runtime_error("no step was reached");
  const Shapes moved = shapes(folder + "/shape.csv");
  const std::string name = folder.substr(folder.find_last_of('/') + 1);
  const double fixed = c.body.stands() ? 1e-9 : mm * c.body.fixed_height;
  const auto field_of = [&](const palpate::MeshData<double>& mesh) {
    return std::make_shared<const palpate::ResponseField>(
        mesh, palpate::below(fixed),
        palpate::ResponseField::Params{.E = 1e6 * c.E, .nu = c.nu, .mesh = {.vertices = 600}});
  };
  if (c.body.kind == Body::ellipsoid) {
    const palpate::Ellipsoid<double> body({.axes = mm * c.body.size});
    judge(name, c, body, field_of(body.mesh(5000)), truth, moved);
  } else if (c.body.kind == Body::box) {
    const palpate::Box<double> body(
        {.half = mm / 2 * c.body.size, .centre = V(0, mm / 2 * c.body.size.y(), 0)});
    judge(name, c, body, field_of(body.mesh(5000)), truth, moved);
  } else {
    const palpate::ElasticBody body(
        mesh_of(c.body), {.E = 1e6 * c.E, .nu = c.nu, .fixed = palpate::below(fixed), .vertices = 600});
    judge(name, c, palpate::SharedSurface(body.surface()), body.field(), truth, moved);
  }
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
