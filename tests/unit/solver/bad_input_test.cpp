// SPDX-License-Identifier: MIT
// Bad input at run time: the table of docs/stability.md, row by row, for every topology, with friction, laws
// with a rate term and laws with memory. The text of the rows is made from what is checked.
#include <palpate/contact/compliant_regions.hpp>
#include <palpate/device/gate.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/plastic.hpp>
#include <palpate/law/force/relaxing.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/paths.hpp>
#include "unit/solver/scene.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace palpate;
using namespace palpate::test;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
constexpr double ms = 1e-3;

/// What comes out; the words are the page's.
enum class Solver { refused, law, law_without_rate };
enum class Next { new_contact, goes_on };
enum class Gated { passes, tripped };
enum class Later { armed, again };

std::string words(Solver s) {
  switch (s) {
    case Solver::refused:
      return "zero, `invalid_pose`";
    case Solver::law:
      return "the law's";
    default:
      return "the law's, `invalid_step`";
  }
}
std::string words(Next n) { return n == Next::new_contact ? "a new contact" : "goes on"; }
std::string words(Gated g, const char* bit) {
  switch (g) {
    case Gated::passes:
      return "the wrench, within the limits";
    default:
      return std::string("zero, `") + bit + "`";
  }
}
std::string words(Later l) { return l == Later::armed ? "armed" : "arms anew"; }

/// The tool rests in contact at `pose`; then one tick of bad input.
struct Row {
  const char* input;
  std::function<void(Pose<double>&)> pose;
  double dt, speed;
  Solver solver;
  Next next;
  Gated gate;
  const char* bit;
  Later later;
};

std::vector<Row> rows() {
  const auto same = [](Pose<double>&) {};
  const auto jump = [](Pose<double>& X) { X.translation += V(0.01, -3e-3, 0); };
  const auto refused = [](const char* input, std::function<void(Pose<double>&)> pose) {
    return Row{input,          std::move(pose), ms,          0, Solver::refused, Next::new_contact,
               Gated::tripped, "disarmed",      Later::again};
  };
  return {
      refused("position NaN", [](auto& X) { X.translation.x() = nan; }),
      refused("position infinite", [](auto& X) { X.translation.z() = -inf; }),
      refused("position beyond 1e6 m", [](auto& X) { X.translation.y() = 1e300; }),
      refused("rotation NaN", [](auto& X) { X.rotation(1, 2) = nan; }),
      refused("rotation of zeros", [](auto& X) { X.rotation.setZero(); }),
      refused("rotation 1 % too large", [](auto& X) { X.rotation *= 1.01; }),
      refused("rotation sheared by 1 %", [](auto& X) { X.rotation(0, 1) += 0.01; }),
      refused("rotation a mirror image", [](auto& X) { X.rotation.col(2) *= -1; }),
      {"jump, the tip's speed given", jump, ms, 10, Solver::law, Next::goes_on, Gated::tripped, "over_speed",
       Later::again},
      {"jump, no speed given", jump, ms, 0, Solver::law, Next::goes_on, Gated::passes, "", Later::armed},
      {"dt = 0", same, 0, 0, Solver::law_without_rate, Next::goes_on, Gated::passes, "", Later::armed},
      {"dt < 0: time backwards", same, -ms, 0, Solver::law_without_rate, Next::goes_on, Gated::tripped,
       "invalid_step", Later::again},
      {"dt NaN", same, nan, 0, Solver::law_without_rate, Next::goes_on, Gated::tripped, "invalid_step",
       Later::again},
      {"dt infinite", same, inf, 0, Solver::law_without_rate, Next::goes_on, Gated::tripped, "invalid_step",
       Later::again},
      {"dt of 1 s, a gap", same, 1, 0, Solver::law, Next::goes_on, Gated::tripped, "gap", Later::again},
  };
}

std::string line(const Row& row) {
  return std::string("| ") + row.input + " | " + words(row.solver) + " | " + words(row.next) + " | " +
         words(row.gate, row.bit) + " | " + words(row.later) + " |";
}

/// Force on the tool without friction [N].
template <class S>
V normal_force(const S& solver, const V& force) {
  V sum = force;
  for (const ContactState<double>& c : solver.contacts()) sum -= c.friction;
  return sum;
}

/// `deep`: in contact, with friction on the way to it; `above`: out of it.
template <class Make>
void check_rows(const char* what, const Make& make) {
  using Touch = decltype(make());
  constexpr bool uses_dt = Touch::is_rate_dependent || Touch::has_memory;
  // Contact, friction and a force that has settled; then the row's input for one tick.
  const Pose<double> above = at(0.001, 0.06, 0), pressed = at(0.001, 0.038, 0);
  for (const Row& row : rows()) {
    INFO(what, ": ", row.input);
    Touch touch = make();
    Gate<double> gate({.max_force = 20, .max_torque = 5, .arm_after = 0.05, .ramp_time = 0.05});
    double speed = 0;
    const auto tick = [&](const Pose<double>& X, double dt) {
      const TickResult<double> felt = touch.tick(X, dt);
      if (has(felt.status, Status::invalid_pose)) gate.disarm();
      const Wrench<double> out = gate.pass(felt.wrench, has(felt.status, Status::contact), dt, speed);
      return std::pair(felt, out);
    };
    const auto rest = [&](const Pose<double>& X, int ticks) {
      for (int i = 0; i < ticks; ++i) (void)tick(X, ms);
      return tick(X, ms);
    };
    (void)rest(above, 120);  // arms and ramps
    REQUIRE(gate.armed());
    // Down to 3 mm, up to 2 mm: a body that yields has; then as long as rates and forces take to settle.
    for (int i = 0; i < 100; ++i) (void)tick(at(1e-5 * (i + 1), 0.041 - 4e-5 * (i + 1), 0), ms);
    for (int i = 0; i < 20; ++i) (void)tick(at(0.001, 0.037 + 5e-5 * (i + 1), 0), ms);
    const TickResult<double> before = rest(pressed, 60).first;
    REQUIRE(has(before.status, Status::contact));
    const V normal_before = normal_force(touch, before.wrench.force);

    // The tick of bad input.
    Pose<double> X = pressed;
    row.pose(X);
    speed = row.speed;
    const auto [bad, out] = tick(X, row.dt);
    CHECK(is_finite(bad.wrench.force));
    CHECK(is_finite(bad.wrench.torque));
    CHECK(has(bad.status, Status::invalid_pose) == (row.solver == Solver::refused));
    CHECK(has(bad.status, Status::invalid_step) == (uses_dt && row.solver == Solver::law_without_rate));
    if (row.solver == Solver::refused) {
      CHECK(bad.wrench.force == V::Zero());
      CHECK(bad.wrench.torque == V::Zero());
      for (const ContactState<double>& c : touch.contacts()) CHECK(c.points == 0);  // dents of the body
    } else {
      CHECK(has(bad.status, Status::contact));
      Touch fresh = make();
      const V there = normal_force(fresh, fresh.tick(X, ms).wrench.force);
      const V here = normal_force(touch, bad.wrench.force);
      double friction = 0;
      for (const ContactState<double>& c : touch.contacts()) {
        friction = (std::max)(friction, c.friction.norm() / c.normal_force);
        CHECK(c.friction.norm() <= 0.5 * c.normal_force * (1 + 1e-12));  // mu_static
      }
      if constexpr (Touch::has_memory) {
        // A body that has yielded or relaxed pushes less; 1 % for the weight of the region, the greatest so
        // far.
        CHECK(here.norm() <= 1.01 * there.norm());
      } else if constexpr (Touch::is_rate_dependent) {
        CHECK(here.norm() >= 0.9999 * there.norm());  // the jump's speed on top
      } else {
        CHECK((here - there).norm() <= 1e-12 * there.norm());  // rounding of sums over at most 49 points
      }
    }
    switch (row.gate) {
      case Gated::passes: {
        const double scale = (std::min)({1.0, gate.params().max_force / bad.wrench.force.norm(),
                                         gate.params().max_torque / bad.wrench.torque.norm()});
        CHECK((out.force - scale * bad.wrench.force).norm() <= 1e-12 * bad.wrench.force.norm());
        CHECK((out.torque - scale * bad.wrench.torque).norm() <= 1e-12 * bad.wrench.torque.norm());
        break;
      }
      case Gated::tripped:
        CHECK(out.force == V::Zero());
        CHECK(out.torque == V::Zero());
        CHECK_FALSE(gate.armed());
        break;
    }

    // The next good tick.
    speed = 0;
    const auto [after, passed] = tick(pressed, ms);
    CHECK(has(after.status, Status::contact));
    CHECK_FALSE(has(after.status, Status::invalid_pose));
    CHECK_FALSE(has(after.status, Status::invalid_step));
    const V normal_after = normal_force(touch, after.wrench.force);
    if (row.next == Next::new_contact) {
      for (const ContactState<double>& c : touch.contacts())
        CHECK(c.friction.norm() <=
              1e-15 * c.normal_force);  // a rounding of the position, times the stiffness
      Touch fresh = make();
      const TickResult<double> first = fresh.tick(pressed, ms);
      if constexpr (Touch::has_memory)
        CHECK(normal_after.norm() < 0.95 * first.wrench.force.norm());  // what the body remembers stays
      else
        CHECK((after.wrench.force - first.wrench.force).norm() == 0);
    }
    if constexpr (Touch::has_memory) CHECK(normal_after.norm() <= 1.0001 * normal_before.norm());
    CHECK(gate.armed() == (row.later == Later::armed));
    if (row.later == Later::again) {
      CHECK(passed.force == V::Zero());
      (void)rest(pressed, 80);  // in contact it never arms
      CHECK_FALSE(gate.armed());
      (void)rest(above, 45);
      CHECK_FALSE(gate.armed());
      (void)rest(above, 10);  // 50 ms
      CHECK(gate.armed());
    }
    // 50 ms of ramp, and at most 20 N at 500 N/s: then all is as before.
    const auto [end, settled] = rest(pressed, 120);
    CHECK((settled.force - end.wrench.force).norm() <= 1e-12 * end.wrench.force.norm());
    CHECK(gate.armed());
  }

  // From deep inside.
  INFO(what, ": begins deep inside");
  Touch touch = make();
  Gate<double> gate;
  for (int i = 0; i < 600; ++i) {  // longer than arm_after
    const TickResult<double> felt = touch.tick(at(0.001, 0.025, 0), ms);
    CHECK(has(felt.status, Status::contact));
    CHECK(is_finite(felt.wrench.force));
    CHECK(felt.wrench.force.y() > 0);
    CHECK(gate.pass(felt.wrench, true, ms).force == V::Zero());
    CHECK(has(gate.status(), GateStatus::in_contact));
  }
}

template <class Force, class Contacts, class Friction = CoulombFriction<double>,
          class Coupling = IndependentRegions>
void check_solver(const char* what, const Force& force, const Contacts& contacts, const Friction& friction) {
  using Touch =
      ContactSolver<Ellipsoid<double>, Force, Friction, Contacts, NoDeformation<double>, AtContact, Coupling>;
  check_rows(what, [&] {
    typename Touch::Tool tool = [] {
      if constexpr (std::is_same_v<Contacts, SinglePoint>)
        return PointTool<double>{V::Zero(), V(0, 0.03, 0)};
      else
        return face(7, 1e-3, 4e-5);
    }();
    return Touch({.object = egg, .tool = tool, .force = force, .friction = friction, .contacts = contacts});
  });
}

const LinearForce<double> spring({.k = 800});

}  // namespace

TEST_CASE("bad input: one point, friction") { check_solver("one point", law, SinglePoint{}, dry); }
TEST_CASE("bad input: one region, friction") {
  check_solver("one region", law, SingleRegion<AreaSharing>{}, dry);
}
TEST_CASE("bad input: regions, friction") {
  check_solver("regions", law, Regions<4, AreaSharing>{.distance = 1.2e-3}, dry);
}
TEST_CASE("bad input: coupled regions, friction") {
  check_solver<DuffingForce<double>, Regions<4, AreaSharing>, CoulombFriction<double>, CompliantRegions<>>(
      "coupled regions", law, {.distance = 1.2e-3}, dry);
}
TEST_CASE("bad input: a rate term") {
  check_solver("rate", DampedForce<LinearForce<double>>(spring, {.damping = 0.3}), SinglePoint{}, dry);
}
TEST_CASE("bad input: a permanent set, regions") {
  check_solver("set", PlasticForce<LinearForce<double>>(spring, {.yield_force = 0.5, .extent = 5e-3}),
               Regions<2, AreaSharing>{.distance = 1.2e-3}, dry);
}
TEST_CASE("bad input: relaxation") {
  check_solver(
      "relaxation",
      RelaxingForce<LinearForce<double>>(spring, {.terms = {{{.part = 0.5, .time = 0.05}}}, .extent = 5e-3}),
      SinglePoint{}, dry);
}

TEST_CASE("a rate term after a step of next to no time: a contact that is finite, or no force and a status") {
  using Damped = DampedForce<LinearForce<double>, Viscous>;
  ContactSolver<Ellipsoid<double>, Damped, CoulombFriction<double>, SingleRegion<AreaSharing>> touch(
      {.object = egg,
       .tool = face(7, 1e-3, 4e-5),
       .force = Damped(spring, {.damping = 0.5}),
       .friction = dry});
  int refused = 0;
  for (double dt = 1e-3; dt > 0; dt /= 10) {
    touch.reset();
    (void)touch.tick(at(0.001, 0.0385, 0), ms);
    const TickResult<double> felt = touch.tick(at(0.001, 0.038, 0), dt);
    INFO("dt ", dt);
    CHECK(is_finite(felt.wrench.force));
    if (has(felt.status, Status::non_finite_result)) {
      ++refused;
      CHECK(felt.wrench.force == V::Zero());
      continue;
    }
    CHECK(felt.wrench.force.y() > 0);
    for (const ContactState<double>& c : touch.contacts()) CHECK(is_finite(c.area));
  }
  CHECK(refused > 0);
}

TEST_CASE("docs/stability.md has these rows and no others") {
  std::ifstream page(std::filesystem::path(__FILE__).parent_path() / "../../../docs/stability.md");
  REQUIRE(page.is_open());
  std::vector<std::string> table;
  bool inside = false;
  for (std::string text; std::getline(page, text);) {
    if (text.rfind("## ", 0) == 0) inside = text == "## Bad input at run time";
    if (inside && text.rfind("| ", 0) == 0) table.push_back(text);
  }
  const std::vector<Row> all = rows();
  REQUIRE(table.size() == all.size() + 2);  // and the heading
  for (std::size_t i = 0; i < all.size(); ++i) CHECK(table[i + 2] == line(all[i]));
}
