// SPDX-License-Identifier: MIT
#pragma once

/// @file  At set-up: is a scene too stiff for the device, and what to change.

#include <palpate/device/device_model.hpp>

#include <algorithm>

namespace palpate {

/// A scene's stiffness beside what the device bears, all in N/m of the hand.
template <Real S>
struct StabilityCheck {
  S stiffness;  ///< the scene's: largest tangent stiffness times the workspace's scale
  S passive;    ///< passive_stiffness(): for any hand, without a passivity controller
  S quantised;  ///< quantisation_stiffness()
  S nominal;    ///< the maker's figure; 0 where there is none

  [[nodiscard]] bool is_passive() const noexcept { return stiffness <= (std::min)(passive, quantised); }
  [[nodiscard]] bool is_nominal() const noexcept { return !(nominal > S(0)) || stiffness <= nominal; }

  /// One sentence for a log.
  [[nodiscard]] const char* advice() const noexcept {
    if (is_passive()) return "The device answers this scene passively.";
    if (is_nominal()) {
      return "Stiffer than the arm alone answers passively: keep the passivity controller, hold it firmly, "
             "or raise the rate.";
    }
    return "Stiffer than the device's own figure: the passivity controller will soften it. Lower the force "
           "law or the workspace's scale, raise the rate, or put a VirtualCoupling between.";
  }
};

/// `stiffness`: largest_stiffness() of the scene [N/m]; `scale`: metres of the scene per metre of the hand;
/// `period` [s]; `nominal`: the maker's figure [N/m], 0 where there is none.
template <Real S>
[[nodiscard]] StabilityCheck<S> check_stability(S stiffness, S scale, S period, const DeviceModel<S>& device,
                                                S nominal = S(0)) noexcept {
  return {scale * stiffness, passive_stiffness(device, period), quantisation_stiffness(device), nominal};
}

}  // namespace palpate
