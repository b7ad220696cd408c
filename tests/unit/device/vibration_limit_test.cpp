// SPDX-License-Identifier: MIT

/// @file What counts as a vibration at the device, on prescribed motion over a spring.

#include <palpate/device/detail/vibration_limit.hpp>

#include <support/check.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

using namespace palpate;

namespace {

using V = Vec3<double>;

constexpr double pi = std::numbers::pi, dt = 1e-3;
const DeviceModel<double> device{.friction = 0.04, .resolution = 3e-5};  // 2 f_c/Delta = 2,670 N/m

struct Spring {
  double k = 4000, torsion = 0;  // [N/m], [N m/rad]; pressed by 1 mm or turned by 0.1 rad
};

/// The scale after `seconds` of y(t), a depth [m] (or an angle [rad]), while the tool slides at `drift`
/// [m/s].
double scale_after(double seconds, const std::function<double(double)>& y, const Spring& spring = {},
                   double drift = 0) {
  detail::VibrationLimit<double> limit(device);
  double last = y(0);
  Wrench<double> held;
  for (int i = 1; i * dt < seconds; ++i) {
    const double now = y(i * dt), work = -(held.force.y() + held.torque.z()) * (now - last);
    last = now;
    limit.observe(held, work, V(drift * i * dt, 0, 0), true, dt);
    held = {V(0, spring.k * (1e-3 + now), 0), V(0, 0, spring.torsion * (0.1 + now))};
  }
  return limit.scale();
}
auto sine(double amplitude, double frequency, double ratio = 1) {  // times `ratio` in each half cycle
  return [=](double t) {
    return amplitude * std::pow(ratio, 2 * frequency * t) * std::sin(2 * pi * frequency * t);
  };
}

}  // namespace

TEST_CASE("vibration limit: a cycle of a stiff contact makes it softer, by a fifth each half cycle") {
  // Turning points at a quarter of a cycle, three quarters ...; the first three swings may be a transient's.
  CHECK(scale_after(0.034, sine(1e-4, 50)) == 1);
  const double early = scale_after(0.1, sine(1e-4, 50)), late = scale_after(0.2, sine(1e-4, 50));
  CHECK(early < 0.5);  // 0.8^6 or 0.8^7, by when the last of ten turns is seen
  CHECK_RELATIVE(late / early, std::pow(0.8, 10), 1e-12);                 // ten half cycles, to rounding
  CHECK(scale_after(0.3, sine(3e-3, 50), {.k = 0, .torsion = 4}) < 0.5);  // torque alone
}

TEST_CASE("vibration limit: what is no limit cycle is left alone") {
  CHECK(scale_after(1, sine(2.8e-5, 50)) == 1);            // the encoders' dither
  CHECK(scale_after(2, sine(1e-3, 6)) == 1);               // a hand that moves on purpose
  CHECK(scale_after(2, sine(1e-4, 10), {.k = 500}) == 1);  // its tremor, in a soft scene
  CHECK(scale_after(1, sine(1e-3, 50, 0.9)) == 1);         // an impact that dies away
  CHECK(scale_after(1, sine(1e-4, 50), {}, 0.05) == 1);    // a slide over ridges 1 mm apart
  CHECK(scale_after(1, [](double t) { return 0.01 * t; }) == 1);
}

TEST_CASE("vibration limit: a new contact begins anew after 0.2 s in free air, a bounce does not") {
  const auto shake = [](detail::VibrationLimit<double>& limit, int i) {
    const Wrench<double> push{V(0, 4, 0), V::Zero()}, more{V(0, 5, 0), V::Zero()};
    const double step = i / 10 % 2 == 0 ? 2e-5 : -2e-5;
    limit.observe(i / 10 % 2 == 0 ? push : more, -4 * step, V::Zero(), true, dt);
    return limit.scale();
  };
  for (const double free : {0.15, 0.25}) {
    detail::VibrationLimit<double> limit(device), fresh(device);
    for (int i = 0; i < 105; ++i) {  // ends in the middle of a swing
      const double before = limit.scale();
      CHECK(before - shake(limit, i) <= dt / 0.02 + 1e-12);  // no jump of the force; rounding
    }
    REQUIRE(limit.scale() < 1);
    for (int i = 0; i < int(free / dt); ++i) limit.observe({}, 0, V::Zero(), false, dt);
    CHECK((limit.scale() == 1) == (free > 0.2));
    bool as_new = true;
    for (int i = 0; i < 105; ++i) as_new = shake(limit, i) == shake(fresh, i) && as_new;
    CHECK(as_new == (free > 0.2));
  }
}
