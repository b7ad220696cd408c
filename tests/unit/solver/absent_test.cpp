// SPDX-License-Identifier: MIT
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/solver/contact_solver.hpp>

#include "support/check.hpp"

using namespace palpate;

namespace {

/// Absent friction in which every function is there and deleted: using one does not compile.
struct Probe {
  using Scalar = double;
  static constexpr bool active = false;
  double static_limit(double) const noexcept = delete;
  double sliding_limit(double) const noexcept = delete;
  double max_coefficient() const noexcept = delete;
};

/// Absent friction whose rules break the program where they are instantiated.
template <class T>
struct Bomb {
  static_assert(sizeof(T) == 0, "an absent policy was instantiated");
};
struct LoadedProbe : Probe {
  using Slip = Bomb<int>;
  using Skew = Bomb<int>;
};

using Body = Sphere<double>;
using Law = LinearForce<double>;
template <class Friction, class Contacts>
using Solver = ContactSolver<Body, Law, Friction, Contacts>;

template <class Friction, class Contacts>
double force_at_1mm(typename Contacts::template Tool<double> tool, Contacts contacts) {
  Solver<Friction, Contacts> solver({.object = Body({.radius = 0.03}),
                                     .tool = tool,
                                     .force = Law({100}),
                                     .friction = {},
                                     .contacts = contacts});
  Pose<double> X;
  X.translation = Vec3<double>(0, 0.029, 0);
  return solver.tick(X).wrench.force.y();
}

}  // namespace

TEST_CASE("absent friction: its functions may be deleted and its rules are never instantiated") {
  const ToolPoints<double> one({Vec3<double>::Zero()}, {1e-6}, {.contact_area = 1e-6});
  const double F = force_at_1mm<Frictionless<double>>({}, SinglePoint{});
  CHECK(F > 0);
  CHECK(force_at_1mm<Probe>({}, SinglePoint{}) == F);
  CHECK(force_at_1mm<LoadedProbe>({}, SinglePoint{}) == F);
  const double in_region = force_at_1mm<Frictionless<double>>(one, SingleRegion<AreaSharing>{});
  CHECK_RELATIVE(in_region, F, 100e-16);  // 30 mm - 29 mm: the depth's rounding is 30 times its own
  CHECK(force_at_1mm<Probe>(one, SingleRegion<AreaSharing>{}) == in_region);
  CHECK(force_at_1mm<LoadedProbe>(one, SingleRegion<AreaSharing>{}) == in_region);
  CHECK(force_at_1mm<Probe>(one, Regions<4, AreaSharing>{1e-3}) == in_region);
  CHECK(force_at_1mm<LoadedProbe>(one, Regions<4, AreaSharing>{1e-3}) == in_region);
}

TEST_CASE("sizes: frictionless point < friction < region < N regions, and an absent policy costs no byte") {
  using Dry = CoulombFriction<double>;
  constexpr std::size_t bare = sizeof(Solver<Frictionless<double>, SinglePoint>);
  constexpr std::size_t dry = sizeof(Solver<Dry, SinglePoint>);
  constexpr std::size_t region = sizeof(Solver<Dry, SingleRegion<AreaSharing>>);
  constexpr std::size_t regions = sizeof(Solver<Dry, Regions<4, AreaSharing>>);
  MESSAGE("bytes: ", bare, " < ", dry, " < ", region, " < ", regions);
  CHECK(bare < dry);
  CHECK(dry < region);
  CHECK(region < regions);
  CHECK(sizeof(Solver<Probe, SinglePoint>) == bare);
}
