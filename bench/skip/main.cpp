// SPDX-License-Identifier: MIT

/// @file  What an absent policy and an idle phase save: `bench_skip COMPOSITION PHASE TICKS` runs that many ticks and
/// prints scene, composition, bytes of the solver, heap allocations and a checksum of the forces. bench/skip/run counts its instructions
/// with callgrind, exactly, as the difference between two numbers of ticks.

#include <palpate/palpate.hpp>

#include "support/no_heap.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace {

using namespace palpate;
using S = double;

const DuffingForce<S> law({.c1 = 40, .c3 = 3e8});
const PowerLawFriction<S> fibre({.K = 0.562, .beta = 0.75, .mu_dynamic = 0.3});
const Ellipsoid<S> body({.axes = Vec3<S>(0.06, 0.04, 0.04)});

ToolPoints<S> face() {  // 10 x 10 points 1 mm apart
  std::vector<Vec3<S>> points;
  for (int i = 0; i < 100; ++i) points.emplace_back(1e-3 * (i % 10 - 4.5), 0, 1e-3 * (i / 10 - 4.5));
  return ToolPoints<S>(points, std::vector<S>(100, 1e-6), {.contact_area = 1e-4});
}

template <class Solver>
int run(const char* composition, const char* phase, long ticks, Solver solver) {
  const bool contact = std::strcmp(phase, "contact") == 0;
  const bool resting = std::strcmp(phase, "nothing_moved") == 0;
  if (!contact && !resting && std::strcmp(phase, "out_of_reach") != 0) return 2;
  double sum = 0;
  const palpate::test::HeapCount heap;
  Pose<S> X;
  for (long i = 0; i < ticks; ++i) {
    const S x = resting ? 0 : 1e-5 * static_cast<S>(i % 100);
    X.translation = Vec3<S>(x, contact || resting ? 0.038 : 0.2, 0);
    sum += solver.tick(X).wrench.force.y();
  }
  std::printf("%s,%s,%zu,%zu,%.12g\n", phase, composition, sizeof(Solver), heap.allocations(), sum);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: bench_skip point|point_friction|region|region_friction|regions_friction "
                         "contact|nothing_moved|out_of_reach TICKS\n");
    return 2;
  }
  const char* composition = argv[1];
  const char* phase = argv[2];
  const long ticks = std::atol(argv[3]);
  const auto is = [&](const char* name) { return std::strcmp(composition, name) == 0; };
  using Body = Ellipsoid<S>;
  using Law = DuffingForce<S>;
  using Fibre = PowerLawFriction<S>;
  if (is("point")) return run(composition, phase, ticks, ContactSolver<Body, Law>({body, {}, law, {}, {}}));
  if (is("point_friction")) return run(composition, phase, ticks, ContactSolver<Body, Law, Fibre>({body, {}, law, fibre, {}}));
  if (is("region"))
    return run(composition, phase, ticks,
               ContactSolver<Body, Law, Frictionless<S>, SingleRegion<>>({body, face(), law, {}, {}}));
  if (is("region_friction"))
    return run(composition, phase, ticks, ContactSolver<Body, Law, Fibre, SingleRegion<>>({body, face(), law, fibre, {}}));
  if (is("regions_friction"))
    return run(composition, phase, ticks, ContactSolver<Body, Law, Fibre, Regions<8>>({body, face(), law, fibre, {1.5e-3}}));
  return 2;
}
