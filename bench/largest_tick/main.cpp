// SPDX-License-Identifier: MIT

/// @file The longest tick of a tool that is altogether inside the object, with all of its points and with as
/// many as a budget of half a millisecond has time for (docs/solver.md, "A budget of time"). Processor time;
/// at each of eight poses within the object the least of three ticks from a state without contact, and the
/// largest of those. predicted_us is what largest_work() says at set-up of the tool with all its points.

#include "scenes.hpp"

#include <palpate/detection/coarse_tool.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/solver/largest_work.hpp>

#include <Eigen/Geometry>

namespace {

using namespace bench;

constexpr double budget = 0.5e-3;  // [s]: half of a period at 1 kHz

struct Longest {
  double us = 0;
  Vec3<double> force = Vec3<double>::Zero();  // of all poses
};

template <class Solver>
Longest longest(const Solver& solver) {
  const auto fresh = solver.initial_state();
  auto state = fresh;
  Longest most;
  for (int k = 0; k < 8; ++k) {
    Pose<double> X;
    X.rotation = Eigen::AngleAxis<double>(0.8 * k, Vec3<double>(2, 1, 2) / 3).toRotationMatrix();
    X.translation = Vec3<double>(2e-3 * k, 0.012 - 1e-3 * k, 5e-4 * k);
    std::int64_t least = 1000000000000;
    for (int again = 0; again < 3; ++again) {
      state = fresh;
      const std::int64_t begin = processor_ns();
      most.force += solver.evaluate(X, 1e-3, state).wrench.force;
      least = (std::min)(least, processor_ns() - begin);
    }
    most.us = (std::max)(most.us, 1e-3 * static_cast<double>(least));
  }
  return most;
}

template <class Contacts, class Object>
void compare(const Output& out, const char* name, const Object& object, const ToolPoints<double>& fine,
             const Contacts& contacts = {}) {
  using All = ContactSolver<Object, DuffingForce<double>, PowerLawFriction<double>, Contacts>;
  using Fewer = ContactSolver<Object, DuffingForce<double>, PowerLawFriction<double>, Coarse<Contacts>>;
  const All all({.object = object,
                 .tool = fine,
                 .force = duffing<double>(),
                 .friction = fibre<double>(),
                 .contacts = contacts});
  const LargestWork work = largest_work(all, Pose<double>{});
  const Fewer fewer({.object = object,
                     .tool = CoarseTool<double>(fine, work.points_within(budget)),
                     .force = duffing<double>(),
                     .friction = fibre<double>(),
                     .contacts = Coarse<Contacts>{contacts}});
  const Longest a = longest(all), b = longest(fewer);
  char row[256];
  std::snprintf(row, sizeof row, "%s,%zu,%.4g,%.4g,%.0f,%zu,%.4g", name, fine.size(), a.us, 1e6 * work.time(),
                1e6 * budget, fewer.tool().size(), b.us);
  out.row(row, "force_changed_by", (a.force - b.force).norm() / a.force.norm());
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(argc, argv,
                   "scene,points,longest_us,predicted_us,budget_us,points_within,longest_within_us");
  const Box<double> block({.half = Vec3<double>(0.06, 0.04, 0.04)});
  const ToolPoints<double> tool(TriangleMesh<double>(Sphere<double>({.radius = 0.015}).mesh(101614)),
                                {.contact_area = 1e-4});
  const MeshSurface<double> mesh(TriangleMesh<double>(ellipsoid<double>().mesh(2000)));
  compare<SingleRegion<>>(out, "box", block, tool);
  compare<SingleRegion<>>(out, "ellipsoid", ellipsoid<double>(), tool);
  compare<Regions<8>>(out, "ellipsoid, 8 regions", ellipsoid<double>(), tool, {joining});
  compare<SingleRegion<>>(out, "its samples 2 mm apart",
                          SampledSurface<MeshSurface<double>>(mesh, {.spacing = 2e-3}), tool);
  compare<SingleRegion<>>(out, "mesh of 2000 vertices", mesh, tool);
}
