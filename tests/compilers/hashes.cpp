// SPDX-License-Identifier: MIT

/// @file A hash of the wrenches and contacts of each scene along one path, for comparing compilers and flags:
/// tests/compilers/run. With --digits the numbers themselves, to see by how much two differ.

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/hertz.hpp>
#include <palpate/law/force/relaxing.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/joined.hpp>

#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <vector>

using namespace palpate;

namespace {
bool digits = false;

/// Comes down, slides, turns and leaves. Sums and products only: no function of the C library.
template <class Solver>
void scene(const char* name, typename Solver::Parts parts) {
  using S = typename Solver::Scalar;
  Solver solver(std::move(parts));
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](S x) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof x);
    hash = (hash ^ bits) * 0x100000001b3;
    hash ^= hash >> 29;
    if (digits) std::printf("%.17g\n", double(x));
  };
  if (digits) std::printf("%s\n", name);
  for (int i = 0; i < 400; ++i) {
    const S t = S(i) / S(400), wave = (t - S(0.25)) * (t - S(0.5)) * (t - S(0.75)) * S(16);
    Pose<S> X;
    X.translation = Vec3<S>(S(0.02) * wave, S(0.041) - S(0.012) * t * (S(1) - t), S(0.004) * t);
    const S a = S(0.3) * wave, q = S(1) / (S(1) + a * a);  // about y, by 2 atan(a)
    X.rotation << (S(1) - a * a) * q, S(0), S(2) * a * q, S(0), S(1), S(0), S(-2) * a * q, S(0),
        (S(1) - a * a) * q;
    const auto felt = solver.tick(X, S(1e-3));
    for (int k = 0; k < 3; ++k) add(felt.wrench.force[k]), add(felt.wrench.torque[k]);
    add(S(static_cast<unsigned>(felt.status)));
    for (const auto& c : solver.contacts())
      for (int k = 0; k < 3; ++k) add(c.displacement[k]), add(c.friction[k]);
  }
  if (!digits) std::printf("%s %016" PRIx64 "\n", name, hash);
}

template <Real S>
ToolPoints<S> pins() {
  MeshData<S> mesh =
      Box<S>({.half = Vec3<S>(S(2e-3), S(4e-3), S(2e-3)), .centre = Vec3<S>(S(-6e-3), S(4e-3), S(0))})
          .mesh(26);
  test::append<S>(mesh, mesh, Vec3<S>(S(0.012), S(0), S(0)));
  return ToolPoints<S>(TriangleMesh<S>(mesh),
                       {.contact_area = S(16e-6), .centre_of_mass = Vec3<S>(S(0), S(0.05), S(0))});
}
template <Real S>
Ellipsoid<S> egg() {
  return Ellipsoid<S>({.axes = Vec3<S>(S(0.06), S(0.04), S(0.04))});
}
template <Real S>
void scenes(const char* point, const char* regions) {
  const DuffingForce<S> law({.c1 = S(300), .c3 = S(1e6)});
  const CoulombFriction<S> dry({.mu_static = S(0.5), .mu_dynamic = S(0.3)});
  scene<ContactSolver<Ellipsoid<S>, DuffingForce<S>, CoulombFriction<S>>>(
      point, {egg<S>(), {.tip = Vec3<S>::Zero(), .centre_of_mass = Vec3<S>(S(0), S(0.1), S(0))}, law, dry});
  scene<ContactSolver<Ellipsoid<S>, DuffingForce<S>, CoulombFriction<S>, Regions<4>, NoDeformation<S>,
                      AtContact, CompliantRegions<>>>(regions, {egg<S>(), pins<S>(), law, dry, {3e-3}});
}
}  // namespace

int main(int argc, char** argv) {
  digits = argc > 1 && std::strcmp(argv[1], "--digits") == 0;
  scenes<double>("ellipsoid,point,double", "ellipsoid,coupled_regions,double");
  scenes<float>("ellipsoid,point,float", "ellipsoid,coupled_regions,float");
  const PowerLawFriction<double> fibre({.K = 0.56, .beta = 0.75, .mu_dynamic = 0.3});
  const Box<double> box({.half = {0.06, 0.04, 0.04}});
  scene<ContactSolver<Box<double>, DampedForce<DuffingForce<double>>, PowerLawFriction<double>,
                      Regions<4, AreaSharing>>>(
      "box,damped_regions,double",
      {box,
       pins<double>(),
       DampedForce<DuffingForce<double>>(DuffingForce<double>({.c1 = 300, .c3 = -1e6}), {.damping = 0.5}),
       fibre,
       {3e-3}});
  scene<ContactSolver<MeshSurface<double>, DuffingForce<double>, PowerLawFriction<double>, SingleRegion<>>>(
      "mesh,region,double", {MeshSurface<double>(TriangleMesh<double>(egg<double>().mesh(500))),
                             pins<double>(), DuffingForce<double>({.c1 = 300, .c3 = 1e6}), fibre});
  using Law = RelaxingForce<HertzForce<double>, 2>;
  scene<ContactSolver<SampledSurface<Cylinder<double>>, Law, PowerLawFriction<double>, SingleRegion<>>>(
      "cylinder_sampled,relaxing_region,double",
      {SampledSurface<Cylinder<double>>(Cylinder<double>({.radius = 0.06, .half_height = 0.04}),
                                        {.spacing = 2e-3}),
       pins<double>(),
       Law(HertzForce<double>({.k = 1e4}), {.terms = {{{0.3, 0.1}, {0.2, 2}}}, .extent = 2e-3}), fibre});
}
