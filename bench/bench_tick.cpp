// SPDX-License-Identifier: MIT

/// @file One force tick per composition: detection on an exact surface, regions, force, friction, wrench.
/// Each row also prints what it computed (`touching` points, `F` in newtons), so that two builds can be seen
/// to do the same work.

#include "scenes.hpp"

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <vector>

namespace {

using namespace palpate;
using bench::duffing;
using bench::ellipsoid;
using bench::fibre;

/// Distance of the face's points [m]: all of them are to touch.
double spacing(int side) { return side > 10 ? 0.3e-3 : 1e-3; }

/// A flat square face of `side` x `side` points, 2 mm deep in the ellipsoid's top at its middle.
template <Real S>
ToolPoints<S> face(int side) {
  std::vector<Vec3<S>> points;
  std::vector<S> areas;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const S step = S(spacing(side));
      points.emplace_back(step * (S(i) - S(side - 1) / 2), S(0), step * (S(j) - S(side - 1) / 2));
      areas.push_back(step * step);
    }
  }
  return ToolPoints<S>(std::move(points), std::move(areas), {.contact_area = S(1e-4)});
}

/// Poses of a tool that slides to and fro over the top, in contact all the time.
template <Real S>
std::vector<Pose<S>> sliding(S depth) {
  std::vector<Pose<S>> poses(256);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double phi = 2 * 3.14159265358979323846 * static_cast<double>(i) / 256;
    const S x = S(2e-3 * std::sin(phi)), z = S(1e-3 * std::sin(2 * phi));
    poses[i].translation =
        Vec3<S>(x, S(0.04) * std::sqrt(S(1) - x * x / S(0.0036) - z * z / S(0.0016)) - depth, z);
  }
  return poses;
}

template <class Solver>
void run(benchmark::State& state, Solver solver, const std::vector<Pose<typename Solver::Scalar>>& poses) {
  std::size_t i = 0;
  double force = 0;
  for (auto _ : state) {
    const auto result = solver.tick(poses[i]);
    benchmark::DoNotOptimize(result);
    i = (i + 1) % poses.size();
  }
  double touching = 0;
  for (const auto& pose : poses) {  // the same poses once more, outside the clock, for the check
    force += static_cast<double>(solver.tick(pose).wrench.force.norm()) / static_cast<double>(poses.size());
    for (const auto& contact : solver.contacts())
      touching += contact.points / static_cast<double>(poses.size());
  }
  state.counters["F"] = force;
  state.counters["touching"] = touching;
}

template <Real S>
void point_frictionless(benchmark::State& state) {
  using Solver = ContactSolver<Ellipsoid<S>, DuffingForce<S>>;
  run(state, Solver({ellipsoid<S>(), {}, duffing<S>(), {}, {}}), sliding<S>(S(2e-3)));
}
template <Real S>
void point_out_of_reach(benchmark::State& state) {
  using Solver = ContactSolver<Ellipsoid<S>, DuffingForce<S>>;
  run(state, Solver({ellipsoid<S>(), {}, duffing<S>(), {}, {}}), sliding<S>(S(-20e-3)));
}
template <Real S>
void point_friction(benchmark::State& state) {
  using Solver = ContactSolver<Ellipsoid<S>, DuffingForce<S>, PowerLawFriction<S>>;
  run(state, Solver({ellipsoid<S>(), {}, duffing<S>(), fibre<S>(), {}}), sliding<S>(S(2e-3)));
}
template <Real S>
void region_friction(benchmark::State& state) {
  using Solver = ContactSolver<Ellipsoid<S>, DuffingForce<S>, PowerLawFriction<S>, SingleRegion<AreaSharing>>;
  run(state, Solver({ellipsoid<S>(), face<S>(int(state.range(0))), duffing<S>(), fibre<S>(), {}}),
      sliding<S>(S(2e-3)));
}
template <Real S>
void regions_friction(benchmark::State& state) {
  using Solver = ContactSolver<Ellipsoid<S>, DuffingForce<S>, PowerLawFriction<S>, Regions<8, AreaSharing>>;
  const int side = int(state.range(0));
  run(state, Solver({ellipsoid<S>(), face<S>(side), duffing<S>(), fibre<S>(), {1.5 * spacing(side)}}),
      sliding<S>(S(2e-3)));
}
template <Real S>
void regions_out_of_reach(benchmark::State& state) {
  using Solver = ContactSolver<Ellipsoid<S>, DuffingForce<S>, PowerLawFriction<S>, Regions<8, AreaSharing>>;
  const int side = int(state.range(0));
  run(state, Solver({ellipsoid<S>(), face<S>(side), duffing<S>(), fibre<S>(), {1.5 * spacing(side)}}),
      sliding<S>(S(-20e-3)));
}

BENCHMARK(point_out_of_reach<double>);
BENCHMARK(point_frictionless<double>);
BENCHMARK(point_frictionless<float>);
BENCHMARK(point_friction<double>);
BENCHMARK(point_friction<float>);
// 1, 9, 100 and 1,024 points of a flat face.
BENCHMARK(region_friction<double>)->Arg(1)->Arg(3)->Arg(10)->Arg(32);
BENCHMARK(region_friction<float>)->Arg(1)->Arg(3)->Arg(10)->Arg(32);
BENCHMARK(regions_friction<double>)->Arg(1)->Arg(3)->Arg(10)->Arg(32);
BENCHMARK(regions_out_of_reach<double>)->Arg(32);

}  // namespace

BENCHMARK_MAIN();
