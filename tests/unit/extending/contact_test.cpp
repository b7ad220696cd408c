// SPDX-License-Identifier: MIT

// Policies that a user wrote, as docs/extending.md shows them. Each offers what its concept asks for and no
// more; the solvers here are made of nothing else, so what a concept forgets does not compile.

#include <palpate/detection/candidates_from.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/check.hpp>

#include <cmath>
#include <limits>

using namespace palpate;

namespace {

// [extending]
using V = palpate::Vec3<double>;

struct Ground {  // an elastic object: all below y = 0
  using Scalar = double;
  palpate::SurfacePoint<double> closest(const V& x) const noexcept {
    return {V(x.x(), 0, x.z()), V::UnitY(), x.y()};
  }
  palpate::Penetration<double> penetration(const V& x) const noexcept { return {-x.y(), V::UnitY()}; }
  bool separated(const V& centre, double radius) const noexcept { return centre.y() > radius; }
  double reach() const noexcept { return std::numeric_limits<double>::infinity(); }
};
// [extending]

// [extending]
struct Spring {  // a force law: F = k D
  using Scalar = double;
  double k;  // N/m
  double force(double D) const noexcept { return D > 0 ? k * D : 0; }
  double stiffness(double D) const noexcept { return D > 0 ? k : 0; }
  double energy(double D) const noexcept { return D > 0 ? 0.5 * k * D * D : 0; }
  double depth(double F) const noexcept { return F > 0 ? F / k : 0; }
  double max_depth() const noexcept { return std::numeric_limits<double>::infinity(); }
};
// [extending]

// [extending]
struct Cushion : Spring {  // a force law with a rate term: F = k D (1 + c D'), never below 0
  double c;                // s/m
  using Spring::force;
  double force(double D, double rate) const noexcept { return (std::max)(force(D) * (1 + c * rate), 0.0); }
};
// [extending]

// [extending]
struct Clay : Spring {  // a force law with memory: beyond 1 N it gives way, and what it gave stays
  struct State {
    double set = 0;  // m
  };
  using Spring::force, Spring::stiffness, Spring::energy, Spring::depth;
  State advance(const State& s, double D, double) const noexcept { return {(std::max)(s.set, D - 1 / k)}; }
  double force(double D, const State& s) const noexcept { return force(D - s.set); }
  double stiffness(double D, const State& s) const noexcept { return stiffness(D - s.set); }
  double energy(double D, const State& s) const noexcept { return energy(D - s.set); }
  double depth(double F, const State& s) const noexcept { return s.set + depth(F); }
};
// [extending]

// [extending]
struct Softer : Spring {  // a force law that takes several depths at once: V counts as a number does
  template <class Depths>
  Depths forces(const Depths& D) const noexcept {
    return k * D;
  }
};
// [extending]

// [extending]
struct Slope {  // a map: k = k_0 exp(x / L), stiffer to the right; U = k D^2/2, - dU/dx = - U / L
  struct Local : Spring {
    double L;
    V configurational_force(double D) const noexcept { return -energy(D) / L * V::UnitX(); }
  };
  using Scalar = double;
  double k_0, L;  // N/m, m
  Local at(const V& x) const noexcept { return {{k_0 * std::exp(x.x() / L)}, L}; }
  double max_depth() const noexcept { return std::numeric_limits<double>::infinity(); }
};
// [extending]

// [extending]
struct SofterAcross {  // a skew rule: F_ct = r law(|D_t|), as a bonded disc at nu = 1/2
  static constexpr double r = 2.0 / 3;
  template <class Law>
  static palpate::SkewedForce<double> force(const Law& law, double, double normal_force,
                                            double D_t) noexcept {
    return {normal_force, r * law.force(D_t)};
  }
  template <class Law>
  static double stretch(const Law& law, double, double F_ct) noexcept {
    return law.depth(F_ct / r);
  }
  template <class Law, class Limit>
  static double admissible(const Law& law, double D_n, double normal_force, double trial,
                           const Limit& limit) noexcept {
    return (std::min)(trial, stretch(law, D_n, limit(normal_force)));
  }
  template <class Law>
  static double energy(const Law& law, double, double D_t) noexcept {
    return r * law.energy(D_t);
  }
};
// [extending]

// [extending]
struct OneLimit {  // a slip rule: the stretch never gives more than the sliding limit
  static constexpr bool shifts_by_travel = false;
  template <palpate::FrictionLimits Friction, class Skew, class Law>
  static palpate::SlipResult<double> advance(const Friction& friction, const Skew& skew, const Law& law,
                                             const palpate::SlipTrial<double>& trial,
                                             palpate::SlipState<double>& state) noexcept {
    const auto limit = [&](double F_cn) { return friction.sliding_limit(F_cn); };
    const double D_t = skew.admissible(law, trial.depth, trial.normal_force, trial.stretch, limit);
    state.sliding = D_t < trial.stretch;
    return {D_t, skew.force(law, trial.depth, trial.normal_force, D_t)};
  }
};
// [extending]

// [extending]
struct Rubber {  // a friction law: f_max = mu F_n, at rest and sliding
  using Scalar = double;
  using Skew = SofterAcross;  // or palpate::ByComponents
  using Slip = OneLimit;      // or palpate::ReturnMapping
  static constexpr bool active = true;
  double mu;
  double static_limit(double F_n) const noexcept { return F_n > 0 ? mu * F_n : 0; }
  double sliding_limit(double F_n) const noexcept { return static_limit(F_n); }
  double max_coefficient() const noexcept { return mu; }
};
// [extending]

// [extending]
struct PinArray {  // a mass sharing: every point carries the whole law, as separate pins do
  template <class S>
  static S weight(S, S) noexcept {
    return S(1);
  }
  template <class S>
  static S norm(S) noexcept {
    return S(1);
  }
};
// [extending]

// [extending]
struct Relief {  // a coupling: each region is relieved by a part of what the others press
  static constexpr bool active = true;
  struct Contact {
    V origin, load, displacement;  // p0 [m], -F_c [N], D [m]
    double normal_force;           // F_cn [N]
  };
  struct Result {
    palpate::FixedVector<V, 8> from_others;
  };
  double part;
  void share(std::span<const Contact> contacts, Result& result) const noexcept {
    V sum = V::Zero();
    for (const Contact& c : contacts) sum += c.load;
    result.from_others.set_size(contacts.size());
    for (std::size_t j = 0; j < contacts.size(); ++j) result.from_others[j] = part * (sum - contacts[j].load);
  }
};
// [extending]

// [extending]
struct SkinOnBone {  // a compliance ratio: a layer on a hard base sinks only near where it is pressed
  double thickness;  // m
  double ratio(double r, double) const noexcept { return std::exp(-r / thickness); }
};
// [extending]

// [extending]
struct NearOrigin {  // a host's tree: the mesh lies within `radius` of the origin, more is not known
  double radius;     // m
  bool touches(const V& centre, double r) const noexcept { return centre.norm() <= radius + r; }
};
// [extending]

Pose<double> at(double x, double y) {
  Pose<double> X;
  X.translation = V(x, y, 0);
  return X;
}

/// Two pins 10 mm apart.
ToolPoints<double> pins() {
  return ToolPoints<double>({V(-0.005, 0, 0), V(0.005, 0, 0)}, {1e-6, 1e-6}, {.contact_area = 1e-6});
}

}  // namespace

TEST_CASE("a solver of the user's policies alone: two pins slide, each region feels the other") {
  using Coupled =
      ContactSolver<Ground, Spring, Rubber, Regions<8, PinArray>, NoDeformation<double>, AtContact, Relief>;
  Coupled solver({.object = {},
                  .tool = pins(),
                  .force = {100},
                  .friction = {.mu = 0.3},
                  .contacts = {.distance = 1e-3},
                  .coupling = {.part = 0.1}});
  TickResult<double> felt{};
  for (int i = 0; i <= 100; ++i) felt = solver.tick(at(1e-4 * i, -1e-3));
  REQUIRE(solver.contacts().size() == 2);
  // Each pin: k D up and mu k D against the motion, less a tenth of the other's.
  const double up = 100 * 1e-3, left = 0.9 * 2 * 0.3 * up;
  CHECK_RELATIVE(felt.wrench.force.y(), 0.9 * 2 * up, 1e-12);  // a sum of four
  CHECK_RELATIVE(felt.wrench.force.x(), -left, 1e-12);
  CHECK(solver.contacts()[0].mode == ContactMode::sliding);
}

TEST_CASE("the user's compliance ratio: two pins relieve each other by it") {
  using Skin = ContactSolver<Ground, Spring, Rubber, Regions<8, AreaSharing>, NoDeformation<double>,
                             AtContact, CompliantRegions<SkinOnBone>>;
  Skin solver({.object = {},
               .tool = pins(),
               .force = {100},
               .friction = {.mu = 0.3},
               .contacts = {.distance = 1e-3},
               .coupling = {SkinOnBone{0.01}}});
  CHECK_RELATIVE(solver.tick(at(0, -1e-3)).wrench.force.y(), 2 * 0.1 / (1 + std::exp(-1)), 1e-12);
}

TEST_CASE("the user's skew rule: stuck, it is softer across than along") {
  ContactSolver<Ground, Spring, Rubber> solver(
      {.object = {}, .tool = {}, .force = {100}, .friction = {.mu = 10}});
  (void)solver.tick(at(0, -1e-3));
  const auto felt = solver.tick(at(5e-4, -1e-3));
  CHECK_RELATIVE(felt.wrench.force.x(), -SofterAcross::r * 100 * 5e-4, 1e-12);  // a difference of positions
}

TEST_CASE("the user's rate term, his law for several depths at once, and his map") {
  ContactSolver<Ground, Cushion> cushion({.object = {}, .tool = {}, .force = {{100}, 2}});
  (void)cushion.tick(at(0, -1e-3), 1e-3);
  CHECK_RELATIVE(cushion.tick(at(0, -1.5e-3), 1e-3).wrench.force.y(), 0.15 * (1 + 2 * 0.5), 1e-12);

  static_assert(StatefulForceLaw<Clay> && !StatefulForceLaw<Spring>);
  static_assert(HasForces<Softer, double> && !HasForces<Spring, double>);
  ContactSolver<Ground, Spring, Frictionless<double>, SingleRegion<AreaSharing>> one(
      {.object = {}, .tool = pins(), .force = {100}});
  ContactSolver<Ground, Softer, Frictionless<double>, SingleRegion<AreaSharing>> several(
      {.object = {}, .tool = pins(), .force = {{100}}});
  CHECK(one.tick(at(0, -1e-3)).wrench.force == several.tick(at(0, -1e-3)).wrench.force);

  ContactSolver<Ground, Slope> slope({.object = {}, .tool = {}, .force = {.k_0 = 100, .L = 0.02}});
  const V force = slope.tick(at(0.02, -1e-3)).wrench.force;
  const double k = 100 * std::exp(1.0);
  CHECK_RELATIVE(force.y(), k * 1e-3, 1e-12);  // an exponential of a rounded quotient
  CHECK_RELATIVE(force.x(), -0.5 * k * 1e-6 / 0.02, 1e-12);
  ContactSolver<Ground, Slope, Rubber, Regions<2, PinArray>> rough({.object = {},
                                                                    .tool = pins(),
                                                                    .force = {.k_0 = 100, .L = 0.02},
                                                                    .friction = {.mu = 0.3},
                                                                    .contacts = {.distance = 1e-3}});
  CHECK(rough.tick(at(0, -1e-3)).wrench.force.y() > 0);
}

TEST_CASE("the user's law with memory: pressed 20 mm it holds 1 N, and 10 mm of it stay") {
  ContactSolver<Ground, Clay> solver({.object = {}, .tool = {}, .force = {{100}}});
  CHECK_RELATIVE(solver.tick(at(0, -0.02), 1e-3).wrench.force.y(), 1.0, 1e-12);
  CHECK(solver.tick(at(0, -0.009), 1e-3).wrench.force.y() == 0);
  CHECK_RELATIVE(solver.tick(at(0, -0.015), 1e-3).wrench.force.y(), 0.5, 1e-12);
}

TEST_CASE("the user's tree: what it calls apart is not asked, the rest is as without it") {
  ContactSolver<CandidatesFrom<Ground, NearOrigin>, Spring, Frictionless<double>, SingleRegion<AreaSharing>>
      solver({.object = {Ground{}, NearOrigin{0.1}}, .tool = pins(), .force = {100}});
  ContactSolver<Ground, Spring, Frictionless<double>, SingleRegion<AreaSharing>> without(
      {.object = {}, .tool = pins(), .force = {100}});
  for (const double y : {1e-3, -1e-3, -2e-3})
    CHECK(solver.tick(at(0, y)).wrench.force == without.tick(at(0, y)).wrench.force);
}
