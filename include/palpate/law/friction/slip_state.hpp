// SPDX-License-Identifier: MIT
#pragma once

/// @file  What slip and skew rules exchange with the rest (section IV.B): plain numbers of one contact.

#include <palpate/core/scalar.hpp>

namespace palpate {

/// Normal and tangential part of the force [N] of a skewed deformation.
template <Real S>
struct SkewedForce {
  S normal;
  S tangential;
};

/// What stick and slip remember of one contact between ticks.
template <Real S>
struct SlipState {
  bool sliding = false;
  /// Present limit over the law's (f_max while sticking, f_slide + static_share (f_max - f_slide) while
  /// sliding) [-], >= 1. Above 1 after regions merged; falls to 1 as the tool travels on.
  S strength = S(1);
  S slid = S(0);  ///< largest |D_t| since the last slip [m]
  /// Tangential springs in parallel [-], >= 1: F_ct = springs F_ct(|D_t|). Above 1 after regions merged; a
  /// slip lets the surplus go before it shortens D_t.
  S springs = S(1);
  /// Part of f_max - f_slide that a sliding contact has still [-], in [0, 1]: 1 at breakaway, falls to 0 as
  /// the tool travels on.
  S static_share = S(0);
};

/// One tick's motion of the contact, as the slip rule needs it.
template <Real S>
struct SlipTrial {
  S depth;         ///< D_n of the equivalent contact [m]
  S normal_force;  ///< F_cn at zero stretch [N]
  S stretch;       ///< |D_t| if the tool stuck in this tick [m]
  S before;        ///< |D_t| at the end of the last tick [m]
  S travel;        ///< distance the contact's tool point moved in this tick [m]
};

/// The stretch after the slip rule, and the force it gives.
template <Real S>
struct SlipResult {
  S stretch;             ///< |D_t| [m]
  SkewedForce<S> force;  ///< F_cn, F_ct [N]
};

}  // namespace palpate
