// SPDX-License-Identifier: MIT

/// @file Ticks of tools of many points: regions of every kind, coupled and not.

#include "ticks.hpp"

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/plastic.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/luo_xiao/beam/region_skeletons.hpp>

#include <support/joined.hpp>

namespace {
using namespace palpate;
using fuzz::Bytes;

constexpr double unlimited = std::numeric_limits<double>::infinity();
const Vec3<double> axes(0.03, 0.02, 0.01);

/// Two boxes, 30 mm apart: up to two regions on a smooth body, more on edges. A_0: a quarter of its area.
template <Real S>
ToolPoints<S> dumbbell() {
  MeshData<S> mesh = Box<S>({.half = Vec3<S>(S(6e-3), S(4e-3), S(4e-3))}).mesh(26);
  const MeshData<S> other = mesh;
  for (Vec3<S>& v : mesh.vertices) v.x() -= S(0.015);
  test::append<S>(mesh, other, S(0.015) * Vec3<S>::UnitX());
  const TriangleMesh<S> body(mesh);
  return ToolPoints<S>(body, {.contact_area = body.area() / S(4), .centre_of_mass = {S(0), S(0.05), S(0)}});
}
template <Real S>
DuffingForce<S> softening() {
  return DuffingForce<S>({.c1 = S(300), .c3 = S(-1e6)});
}
const double most = 4 * softening<double>().force(1);
template <Real S>
CoulombFriction<S> coulomb() {
  return CoulombFriction<S>({.mu_static = S(0.5), .mu_dynamic = S(0.3)});
}
PowerLawFriction<double> fibre() {
  return PowerLawFriction<double>({.K = 0.56, .beta = 0.75, .mu_dynamic = 0.3});
}

void mesh(Bytes& in) {
  static ContactSolver<MeshSurface<float>, DuffingForce<float>, CoulombFriction<float>, SingleRegion<>>
      solver(
          {MeshSurface<float>(TriangleMesh<float>(Ellipsoid<float>({.axes = axes.cast<float>()}).mesh(60))),
           dumbbell<float>(), softening<float>(), coulomb<float>()});
  fuzz::walk(solver, {0.03, most}, in);
}
void samples(Bytes& in) {
  using Law = PlasticForce<DuffingForce<double>>;
  static ContactSolver<SampledSurface<Ellipsoid<double>>, Law, PowerLawFriction<double>, Regions<4>> solver(
      {SampledSurface<Ellipsoid<double>>(Ellipsoid<double>({.axes = axes}), {.spacing = 2e-3}),
       dumbbell<double>(),
       Law(softening<double>(), {.yield_force = 0.5, .extent = 2e-3}),
       fibre(),
       {3e-3}});
  fuzz::walk(solver, {0.03, most}, in);
}
void box(Bytes& in) {
  using Law = DampedForce<DuffingForce<double>, Viscous>;
  using Disc = CoulombFriction<double, ReturnMapping, BondedDisc<double>>;
  static ContactSolver<Box<double>, Law, Disc, Regions<4, AreaSharing>> solver(
      {Box<double>({.half = axes}),
       dumbbell<double>(),
       Law(softening<double>(), {.damping = 0.5}),
       Disc({.mu_static = 0.5, .mu_dynamic = 0.3, .skew = BondedDisc<double>({.nu = 0.45})}),
       {3e-3}});
  fuzz::walk(solver, {0.03, unlimited}, in);
}
void compliant(Bytes& in) {
  static ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, Regions<4>,
                       NoDeformation<double>, AtContact, CompliantRegions<>>
      solver({Ellipsoid<double>({.axes = axes}),
              dumbbell<double>(),
              softening<double>(),
              coulomb<double>(),
              {3e-3}});
  fuzz::walk(solver, {0.03, most}, in);
}
void skeletons(Bytes& in) {
  using Coupling = RegionSkeletons<Skeleton<double>>;
  static const std::array<Vec3<double>, 6> ends{
      {{0.03, 0, 0}, {-0.03, 0, 0}, {0, 0.02, 0}, {0, -0.02, 0}, {0, 0, 0.01}, {0, 0, -0.01}}};
  static ContactSolver<Ellipsoid<double>, DuffingForce<double>, PowerLawFriction<double>,
                       Regions<4, AreaSharing>, NoDeformation<double>, AtContact, Coupling>
      solver({Ellipsoid<double>({.axes = axes}),
              dumbbell<double>(),
              softening<double>(),
              fibre(),
              {3e-3},
              {},
              Coupling(Skeleton<double>(
                  ends, EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e5, .nu = 0.5})),
                  VolumePreserving<double>({.volume = 2.5e-5})))});
  fuzz::walk(solver, {0.03, most, true}, in);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return palpate::fuzz::play({mesh, samples, box, compliant, skeletons}, data, size);
}
