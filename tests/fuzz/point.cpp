// SPDX-License-Identifier: MIT

/// @file Ticks of tools of one point: laws of every kind on bodies of every kind.

#include "ticks.hpp"

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/superellipsoid.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/hertz.hpp>
#include <palpate/law/force/plastic.hpp>
#include <palpate/law/force/relaxing.hpp>
#include <palpate/law/force/saturated.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>

namespace {
using namespace palpate;
using fuzz::Bytes;

constexpr double unlimited = std::numeric_limits<double>::infinity();
const Vec3<double> axes(0.03, 0.02, 0.01);

template <Real S>
using Bounded = SaturatedForce<DuffingForce<S>>;
template <Real S>
Bounded<S> bounded() {
  return {DuffingForce<S>({.c1 = S(300), .c3 = S(1e6)}), {.limit = S(5)}};
}
template <Real S>
PowerLawFriction<S> fibre() {
  return PowerLawFriction<S>({.K = S(0.56), .beta = S(0.75), .mu_dynamic = S(0.3)});
}

void softening(Bytes& in) {
  static ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>> solver(
      {Ellipsoid<double>({.axes = axes}),
       {},
       DuffingForce<double>({.c1 = 300, .c3 = -1e6}),
       CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.3})});
  fuzz::walk(solver, {0.03, solver.force_law().force(1)}, in);
}
void damped(Bytes& in) {
  static ContactSolver<Box<float>, DampedForce<Bounded<float>>, PowerLawFriction<float>> solver(
      {Box<float>({.half = axes.cast<float>()}),
       {.tip = {0.01f, 0, 0}, .centre_of_mass = {0, 0.1f, 0}},
       DampedForce<Bounded<float>>(bounded<float>(), {.damping = 2}),
       fibre<float>()});
  fuzz::walk(solver, {0.03, unlimited}, in);
}
void plastic(Bytes& in) {
  using Disc = CoulombFriction<double, ReturnMapping, BondedDisc<double>>;
  static ContactSolver<Superellipsoid<double>, PlasticForce<HertzForce<double>>, Disc> solver(
      {Superellipsoid<double>({.axes = axes}),
       {},
       PlasticForce<HertzForce<double>>(HertzForce<double>({.k = 1e5}), {.yield_force = 2, .extent = 2e-3}),
       Disc({.mu_static = 0.5, .mu_dynamic = 0.3, .skew = BondedDisc<double>({.nu = 0.45})})});
  fuzz::walk(solver, {0.03, HertzForce<double>({.k = 1e5}).force(1)}, in);
}
void relaxing(Bytes& in) {
  using Law = RelaxingForce<Bounded<double>, 2>;
  static ContactSolver<MeshSurface<double>, Law, PowerLawFriction<double>> solver(
      {MeshSurface<double>(TriangleMesh<double>(Box<double>({.half = axes}).mesh(26))),
       {},
       Law(bounded<double>(), {.terms = {{{0.3, 0.1}, {0.2, 2}}}, .extent = 2e-3}),
       fibre<double>()});
  fuzz::walk(solver, {0.03, 5}, in);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return palpate::fuzz::play({softening, damped, plastic, relaxing}, data, size);
}
