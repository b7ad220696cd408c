// SPDX-License-Identifier: MIT
#pragma once

/// @file  The haptic device as stability sees it: what moves in the hand, what brakes it, and how late it is.

#include <palpate/core/error.hpp>

#include <limits>

namespace palpate {

/// The device at the stylus point. Passivity is promised for a device that has at least this mass, damping
/// and friction and at most this delay; too small a figure costs stiffness in the hand, too large a one costs
/// the promise.
///
/// | symbol | name                 | unit       | range     |
/// |--------|----------------------|------------|-----------|
/// | m      | `mass`               | kg         | > 0       |
/// | I      | `inertia`            | kg m^2     | > 0       |
/// | b      | `damping`            | N s/m      | >= 0      |
/// | b_r    | `rotational_damping` | N m s/rad  | >= 0      |
/// | f_c    | `friction`           | N          | >= 0      |
/// | Delta  | `resolution`         | m          | >= 0      |
/// | d      | `delay`              | ticks      | 0 to 8    |
///
/// The defaults are of a light desktop arm with little friction; those without a source are chosen low.
template <Real S>
struct DeviceModel {
  S mass = S(0.045);            ///< apparent at the stylus point
  S inertia = S(2e-5);          ///< of a pen about that point; chosen
  S damping = S(0);             ///< viscous, of the arm alone
  S rotational_damping = S(0);  ///< the same about the stylus point
  S friction = S(0.04);         ///< Coulomb, back-drive friction of a large desktop arm
  S resolution = S(3e-5);       ///< encoder step at the tip
  int delay = 1;                ///< from a pose to the force that answers it, besides the hold of a tick
  static constexpr int max_delay = 8;
};

/// Reports a value out of the range above.
template <Real S>
void check(const DeviceModel<S>& device) {
  require_positive(device.mass, "DeviceModel", "mass [kg] must be > 0");
  require_positive(device.inertia, "DeviceModel", "inertia [kg m^2] must be > 0");
  require_non_negative(device.damping, "DeviceModel", "damping [N s/m] must be >= 0");
  require_non_negative(device.rotational_damping, "DeviceModel",
                       "rotational_damping [N m s/rad] must be >= 0");
  require_non_negative(device.friction, "DeviceModel", "friction [N] must be >= 0");
  require_non_negative(device.resolution, "DeviceModel", "resolution [m] must be >= 0");
  if (device.delay < 0 || device.delay > DeviceModel<S>::max_delay)
    fail("DeviceModel", "delay [ticks] must be in [0, 8]", static_cast<double>(device.delay));
}

/// Largest stiffness [N/m] of the hand that a device answers passively whatever holds it, for a spring with
/// damper F = - K x - B dx/dt, dx/dt the one-tick difference, held for the period T [s] [colgate1997]:
///
///     K = 2 (b - B)/((2 d + 1) T)
template <Real S>
[[nodiscard]] S passive_stiffness(const DeviceModel<S>& device, S period, S virtual_damping = S(0)) noexcept {
  return S(2) * (device.damping - virtual_damping) / (static_cast<S>(2 * device.delay + 1) * period);
}

/// The same for rotation [N m/rad].
template <Real S>
[[nodiscard]] S passive_rotational_stiffness(const DeviceModel<S>& device, S period) noexcept {
  return S(2) * device.rotational_damping / (static_cast<S>(2 * device.delay + 1) * period);
}

/// Largest stiffness [N/m] at which friction takes what quantised positions make, K = 2 f_c/Delta
/// [abbott2005]; infinity for Delta = 0 is given as the largest number.
template <Real S>
[[nodiscard]] S quantisation_stiffness(const DeviceModel<S>& device) noexcept {
  return device.resolution > S(0) ? S(2) * device.friction / device.resolution
                                  : (std::numeric_limits<S>::max)();
}

}  // namespace palpate
