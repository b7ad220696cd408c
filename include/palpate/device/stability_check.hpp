// SPDX-License-Identifier: MIT
#pragma once

/// @file  At set-up: is a scene too stiff for the device, and what to change.

#include <palpate/device/device_model.hpp>

#include <algorithm>

namespace palpate {

/// A scene's stiffness beside what the device bears: in N/m of the hand, and in N m/rad.
template <Real S>
struct StabilityCheck {
  S stiffness;                    ///< the scene's: largest tangent stiffness times the workspace's scale
  S passive;                      ///< passive_stiffness(): for any hand, without a passivity controller
  S quantised;                    ///< quantisation_stiffness()
  S nominal;                      ///< the maker's figure; 0 where there is none
  S rotational_stiffness = S(0);  ///< the scene's, of the torque that is sent; 0 where none is
  S passive_rotational = S(0);    ///< passive_rotational_stiffness()

  [[nodiscard]] bool is_passive() const noexcept {
    return stiffness <= (std::min)(passive, quantised) && is_passive_in_rotation();
  }
  [[nodiscard]] bool is_passive_in_rotation() const noexcept {
    return rotational_stiffness <= passive_rotational;
  }
  [[nodiscard]] bool is_nominal() const noexcept { return !(nominal > S(0)) || stiffness <= nominal; }

  /// One sentence for a log.
  [[nodiscard]] const char* advice() const noexcept {
    if (is_passive()) return "The device answers this scene passively.";
    if (!is_nominal()) {
      return "Stiffer than the device's own figure: the passivity controller will soften it. Lower the force "
             "law or the workspace's scale, raise the rate, or put a VirtualCoupling between.";
    }
    if (stiffness <= (std::min)(passive, quantised)) {
      return "Stiffer in rotation than the arm alone answers passively: keep the passivity controller, raise "
             "the rate, or hold the tool nearer to where it touches.";
    }
    return "Stiffer than the arm alone answers passively: keep the passivity controller, hold it firmly, "
           "or raise the rate.";
  }
};

/// `stiffness`, `rotational_stiffness`: largest_stiffness() of the scene [N/m, N m/rad], the latter about
/// the stylus point (a centre of mass at c from it adds about K |c|^2 to that about the centre) and 0 for a
/// device without motors for torque; `scale`: metres of the scene per metre of the hand, which turns nothing;
/// `period` [s]; `nominal`: the maker's figure [N/m], 0 where there is none.
template <Real S>
[[nodiscard]] StabilityCheck<S> check_stability(S stiffness, S scale, S period, const DeviceModel<S>& device,
                                                S nominal = S(0), S rotational_stiffness = S(0)) noexcept {
  return {.stiffness = scale * stiffness,
          .passive = passive_stiffness(device, period),
          .quantised = quantisation_stiffness(device),
          .nominal = nominal,
          .rotational_stiffness = rotational_stiffness,
          .passive_rotational = passive_rotational_stiffness(device, period)};
}

}  // namespace palpate
