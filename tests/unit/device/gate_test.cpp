// SPDX-License-Identifier: MIT
#include <palpate/device/gate.hpp>

#include <support/check.hpp>

#include <cstring>
#include <random>
#include <string>

namespace {

using palpate::Gate;
using palpate::GateStatus;
using palpate::Vec3;
using palpate::Wrench;

template <class S>
Wrench<S> push(S x, S y = S(0), S z = S(0)) {
  Wrench<S> w;
  w.force = Vec3<S>(x, y, z);
  return w;
}

template <class S>
constexpr S ms = S(1e-3);

/// A gate that has been free of contact for long enough to be at full gain.
template <class S>
Gate<S> armed(typename Gate<S>::Params params = {}) {
  Gate<S> gate(params);
  for (int i = 0; i < 1100; ++i) (void)gate.pass({}, false, ms<S>);
  REQUIRE(gate.armed());
  REQUIRE(gate.status() == GateStatus::armed);
  return gate;
}

template <class S>
constexpr S infinity = std::numeric_limits<S>::infinity();
template <class S>
constexpr S not_a_number = std::numeric_limits<S>::quiet_NaN();

std::string message_of(auto&& build) {
  try {
    build();
  } catch (const palpate::SetupError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE_TEMPLATE("gate, start: zero for arm_after, then a linear ramp, then the demand itself", S, float,
                   double) {
  Gate<S> gate(
      {.max_force_rate = infinity<S>, .arm_after = S(0.25), .ramp_time = S(0.5), .max_gap = S(0.25)});
  const S dt = S(1) / S(64);  // exact in binary, so that the sums below are
  const auto w = push<S>(S(0.5), S(-0.25));
  for (int i = 1; i <= 15; ++i) {
    CHECK(gate.pass(w, false, dt).force == Vec3<S>::Zero());
    CHECK(gate.status() == GateStatus::ok);
  }
  for (int i = 0; i < 32; ++i) {
    const Wrench<S> out = gate.pass(w, false, dt);
    CHECK(out.force == Vec3<S>(w.force * (S(i) / S(32))));
    CHECK(has(gate.status(), GateStatus::armed | GateStatus::ramping));
  }
  CHECK(gate.pass(w, true, dt).force == w.force);
  CHECK(gate.status() == GateStatus::armed);
}

TEST_CASE_TEMPLATE("gate, start: torque rises as force does", S, float, double) {
  Gate<S> gate({.max_torque_rate = infinity<S>, .arm_after = S(0), .ramp_time = S(0.5), .max_gap = S(0.25)});
  Wrench<S> w;
  w.torque = Vec3<S>(S(0.125), S(0), S(-0.0625));
  for (int i = 0; i < 32; ++i)
    CHECK(gate.pass(w, false, S(1) / S(64)).torque == Vec3<S>(w.torque * (S(i) / S(32))));
  CHECK(gate.pass(w, false, S(1) / S(64)).torque == w.torque);
}

TEST_CASE_TEMPLATE("gate, start inside an object: no force until the tool has been pulled free", S, float,
                   double) {
  Gate<S> gate;
  for (int i = 0; i < 5000; ++i) {
    CHECK(gate.pass(push<S>(2), true, ms<S>).force == Vec3<S>::Zero());
    CHECK(has(gate.status(), GateStatus::in_contact));
  }
  // A touch in between starts the wait again.
  for (int i = 0; i < 400; ++i) (void)gate.pass({}, false, ms<S>);
  (void)gate.pass(push<S>(1), true, ms<S>);
  for (int i = 0; i < 400; ++i) (void)gate.pass({}, false, ms<S>);
  CHECK_FALSE(gate.armed());
  for (int i = 0; i < 102; ++i) (void)gate.pass({}, false, ms<S>);  // 2 to spare: the sum of 500 steps rounds
  CHECK(gate.armed());
}

TEST_CASE_TEMPLATE("gate, saturation: never above the limit, direction kept, whatever the size", S, float,
                   double) {
  auto gate = armed<S>({.max_force = S(2),
                        .max_torque = S(0.1),
                        .max_force_rate = infinity<S>,
                        .max_torque_rate = infinity<S>});
  const Vec3<S> direction = Vec3<S>(S(1), S(-2), S(2)) / S(3);
  for (S size : {S(1.99), S(2.01), S(1e3), S(9e8)}) {
    Wrench<S> w;
    w.force = w.torque = size * direction;
    const Wrench<S> out = gate.pass(w, true, ms<S>);
    CHECK(out.force.norm() <= S(2));
    CHECK(out.torque.norm() <= S(0.1));
    // A normalisation and a product: a few roundings.
    CHECK_ABSOLUTE((out.force / out.force.norm() - direction).norm(), 0, palpate::test::ulps<S>(8));
    CHECK_RELATIVE(out.force.norm(), (std::min)(size, S(2)), palpate::test::ulps<S>(16));
    CHECK(has(gate.status(), GateStatus::force_saturated) == (size > S(2)));
    CHECK(has(gate.status(), GateStatus::torque_saturated));
  }
}

TEST_CASE_TEMPLATE("gate, slew: a jump becomes a slope of max_force_rate, both ways", S, float, double) {
  auto gate = armed<S>({.max_force_rate = S(500)});
  S last = S(0);
  int ticks = 0;
  for (; ticks < 20; ++ticks) {
    const S now = gate.pass(push<S>(S(2)), true, ms<S>).force.x();
    CHECK(now - last <= S(0.5) * (1 + S(palpate::test::ulps<S>(8))));
    last = now;
    if (!has(gate.status(), GateStatus::slew_limited)) break;
  }
  CHECK(ticks <= 4);  // 2 N at 0.5 N per tick; rounding may cost one tick more
  CHECK(last == S(2));
  CHECK_RELATIVE(gate.pass({}, false, ms<S>).force.x(), 1.5, palpate::test::ulps<S>(8));
  // dt = 0: no time has passed, the output holds.
  CHECK_RELATIVE(gate.pass({}, false, S(0)).force.x(), 1.5, palpate::test::ulps<S>(8));
}

TEST_CASE_TEMPLATE("gate, trips: zero at once, disarmed, armed again through wait and ramp", S, float,
                   double) {
  struct Case {
    const char* name;
    GateStatus bit;
    Wrench<S> wrench;
    S dt, speed;
  };
  Wrench<S> bad_torque;
  bad_torque.torque.z() = infinity<S>;
  const Case cases[] = {
      {"NaN force", GateStatus::non_finite, push<S>(not_a_number<S>), ms<S>, S(0)},
      {"absurd force", GateStatus::non_finite, push<S>(S(0), S(2e9)), ms<S>, S(0)},
      {"infinite torque", GateStatus::non_finite, bad_torque, ms<S>, S(0)},
      {"gap", GateStatus::gap, push<S>(1), S(6e-3), S(0)},
      {"NaN step", GateStatus::invalid_step, push<S>(1), not_a_number<S>, S(0)},
      {"infinite step", GateStatus::invalid_step, push<S>(1), infinity<S>, S(0)},
      {"negative step", GateStatus::invalid_step, push<S>(1), -ms<S>, S(0)},
      {"over-speed", GateStatus::over_speed, push<S>(1), ms<S>, S(1.6)},
      {"NaN speed", GateStatus::over_speed, push<S>(1), ms<S>, not_a_number<S>},
  };
  for (const Case& c : cases) {
    INFO(c.name);
    auto gate = armed<S>();
    for (int i = 0; i < 10; ++i) (void)gate.pass(push<S>(1), true, ms<S>);
    const Wrench<S> out = gate.pass(c.wrench, true, c.dt, c.speed);
    CHECK(out.force == Vec3<S>::Zero());
    CHECK(out.torque == Vec3<S>::Zero());
    CHECK(gate.status() == c.bit);
    CHECK_FALSE(gate.armed());
    CHECK(gate.pass(push<S>(1), true, ms<S>).force == Vec3<S>::Zero());
    for (int i = 0; i < 502; ++i) (void)gate.pass({}, false, ms<S>);
    CHECK(gate.armed());
    CHECK(has(gate.status(), GateStatus::ramping));
  }
  auto gate = armed<S>();
  gate.disarm();
  CHECK(gate.pass(push<S>(1), false, ms<S>).force == Vec3<S>::Zero());
  CHECK(gate.status() == GateStatus::disarmed);
  (void)gate.pass({}, false, ms<S>);
  CHECK(gate.status() == GateStatus::ok);  // once, not for ever
}

TEST_CASE_TEMPLATE("gate, heat budget: peaks pass, a force held for ever ends at continuous_force", S, float,
                   double) {
  auto gate = armed<S>({.max_force = S(3), .continuous_force = S(0.88), .heat_time = S(1)});
  Vec3<S> last = Vec3<S>::Zero();
  bool peak_passed = false;
  for (int i = 0; i < 20000; ++i) {
    const Vec3<S> now = gate.pass(push<S>(S(0), S(5)), true, ms<S>).force;
    peak_passed |= now.y() > S(2.999);
    // The limit falls at most by 2 (3 - 0.88)/0.88^2 times dq = 9 N^2 dt/heat_time: 0.05 N in a tick.
    CHECK((now - last).norm() <= S(0.5) * (1 + S(palpate::test::ulps<S>(8))));
    if (i > 20) CHECK((now - last).norm() <= S(0.06));
    last = now;
  }
  CHECK(peak_passed);
  // After 20 time constants the transient is below 1e-8; float's heat sum stalls at dt/heat_time of an ulp.
  CHECK_RELATIVE(last.y(), 0.88, (std::is_same_v<S, float> ? 1e-3 : 1e-7));
  CHECK(has(gate.status(), GateStatus::heat_limited));
  for (int i = 0; i < 5000; ++i) (void)gate.pass({}, false, ms<S>);
  CHECK(gate.status() == GateStatus::armed);  // cooled
}

TEST_CASE_TEMPLATE("gate, heat budget: it is the mean square that counts", S, float, double) {
  // L N in one tick of four: q = L^2/4, and L = 2 - (2 q - 1): L = sqrt(7) - 1. By its mean, L/4, it would stay 2.
  auto gate = armed<S>(
      {.max_force = S(2), .continuous_force = S(1), .heat_time = S(2), .max_force_rate = infinity<S>});
  S felt = S(0);
  for (int i = 0; i < 60000; ++i) {
    const S f = gate.pass(push<S>(i % 4 == 0 ? S(2) : S(0)), true, ms<S>).force.x();
    if (i % 4 == 0) felt = f;
  }
  CHECK_RELATIVE(felt, std::sqrt(7.0) - 1,
                 2e-3);  // q goes up and down by 3/4 L^2 dt/heat_time within four ticks
}

TEST_CASE_TEMPLATE("gate, heat budget: a trip does not cool the motors", S, float, double) {
  auto gate = armed<S>({.max_force = S(3),
                        .continuous_force = S(1),
                        .heat_time = S(2),
                        .max_force_rate = infinity<S>,
                        .arm_after = S(0),
                        .ramp_time = S(0)});
  for (int i = 0; i < 40000; ++i) (void)gate.pass(push<S>(5), true, ms<S>);
  gate.disarm();
  CHECK(gate.pass(push<S>(5), false, ms<S>).force == Vec3<S>::Zero());
  // Two ticks without force take q from 1 to 1 - dt/heat_time: the limit is still 1 N and next to nothing.
  CHECK_ABSOLUTE(gate.pass(push<S>(5), false, ms<S>).force.x(), 1, 0.01);
  CHECK(has(gate.status(), GateStatus::heat_limited));
}

TEST_CASE_TEMPLATE("gate, one tick: the output is no further apart than the inputs", S, float, double) {
  std::mt19937_64 random(7);
  INFO("seed 7");
  std::uniform_real_distribution<S> uniform(S(-4), S(4));
  auto gate = armed<S>({.continuous_force = S(0.88), .heat_time = S(0.2)});
  for (int i = 0; i < 20000; ++i) {
    const auto draw = [&] { return push<S>(uniform(random), uniform(random), uniform(random)); };
    const Wrench<S> a = draw();
    Wrench<S> b = a;
    b.force += draw().force * S(0.01);
    Gate<S> twin = gate;
    const Vec3<S> out_a = gate.pass(a, true, ms<S>).force, out_b = twin.pass(b, true, ms<S>).force;
    // Both stages project on a ball, which never stretches; rounding of numbers up to 7 N.
    CHECK((out_a - out_b).norm() <= (a.force - b.force).norm() + S(palpate::test::ulps<S>(64)));
  }
}

TEST_CASE_TEMPLATE("gate, abuse: any input, bounded output, steps bounded but for the drop to zero", S, float,
                   double) {
  std::mt19937_64 random(11);
  INFO("seed 11");
  Gate<S> gate({.max_force = S(2.5), .continuous_force = S(1), .arm_after = S(0.01), .ramp_time = S(0.02)});
  Gate<S> twin = gate;
  const S weird[] = {not_a_number<S>,
                     infinity<S>,
                     -infinity<S>,
                     std::numeric_limits<S>::max(),
                     std::numeric_limits<S>::denorm_min(),
                     std::numeric_limits<S>::lowest(),
                     S(-0.0),
                     S(1e-30)};
  std::uniform_real_distribution<S> uniform(S(-6), S(6));
  const auto number = [&] { return random() % 400 == 0 ? weird[random() % 8] : uniform(random); };
  Vec3<S> last = Vec3<S>::Zero();
  Vec3<S> last_torque = Vec3<S>::Zero();
  int trips = 0, full = 0;
  for (int i = 0; i < 100000; ++i) {
    Wrench<S> w;
    w.force = Vec3<S>(number(), number(), number());
    w.torque = Vec3<S>(number(), number(), number());
    const S dt = random() % 500 == 0 ? number() : ms<S>;
    const bool contact = random() % 2 == 0 && random() % 100 < 60 && (i / 50) % 2 == 0;
    const Wrench<S> out = gate.pass(w, contact, dt), same = twin.pass(w, contact, dt);
    REQUIRE(palpate::is_finite(out.force));
    REQUIRE(palpate::is_finite(out.torque));
    REQUIRE(out.force.norm() <= S(2.5));
    REQUIRE(out.torque.norm() <= S(0.17));
    REQUIRE(std::memcmp(&out, &same, sizeof out) == 0);
    if (!gate.armed()) {
      REQUIRE(out.force == Vec3<S>::Zero());
      ++trips;
    } else {
      // 500 N/s; rounding of numbers up to 2.5 N.
      REQUIRE((out.force - last).norm() <= S(500) * dt + S(palpate::test::ulps<S>(32)));
      REQUIRE((out.torque - last_torque).norm() <= S(25) * dt + S(palpate::test::ulps<S>(32)));
      full += out.force.norm() > S(0.9);
    }
    last = out.force;
    last_torque = out.torque;
  }
  CHECK(trips > 100);  // the test must have been where it matters
  CHECK(full > 1000);
}

TEST_CASE("gate, set-up: each bad limit is named with its value; infinity is allowed where documented") {
  using G = Gate<double>;
  const double bad[] = {0.0, -1.0, not_a_number<double>};
  for (double v : bad) {
    INFO(v);
    CHECK(message_of([&] { G g({.max_force = v}); }).find("max_force [N] must be") != std::string::npos);
    CHECK(message_of([&] { G g({.continuous_force = v}); }).find("continuous_force") != std::string::npos);
    CHECK(message_of([&] { G g({.heat_time = v}); }).find("heat_time") != std::string::npos);
    CHECK(message_of([&] { G g({.max_torque = v}); }).find("max_torque [N m] must be") != std::string::npos);
    CHECK(message_of([&] { G g({.max_force_rate = v}); }).find("max_force_rate") != std::string::npos);
    CHECK(message_of([&] { G g({.max_torque_rate = v}); }).find("max_torque_rate") != std::string::npos);
    CHECK(message_of([&] { G g({.max_gap = v}); }).find("max_gap") != std::string::npos);
    CHECK(message_of([&] { G g({.max_speed = v}); }).find("max_speed") != std::string::npos);
  }
  for (double v : {-1.0, not_a_number<double>, infinity<double>}) {
    CHECK(message_of([&] { G g({.arm_after = v}); }).find("arm_after") != std::string::npos);
    CHECK(message_of([&] { G g({.ramp_time = v}); }).find("ramp_time") != std::string::npos);
  }
  CHECK(message_of([] { G g({.max_force = infinity<double>}); }).find("max_force") != std::string::npos);
  CHECK(message_of([] { G g({.max_gap = infinity<double>}); }).find("max_gap") != std::string::npos);
  CHECK(message_of([] { G g({.max_force = -2}); }).find("-2") != std::string::npos);
  CHECK(message_of([] {
          G g({.continuous_force = infinity<double>,
               .max_force_rate = infinity<double>,
               .max_torque_rate = infinity<double>,
               .max_speed = infinity<double>});
        }).empty());
  // No wait and no ramp: armed at the first tick that is free of contact.
  G g({.max_force_rate = infinity<double>, .arm_after = 0, .ramp_time = 0});
  CHECK(g.pass(push<double>(1), false, 1e-3).force.x() == 1);
}
