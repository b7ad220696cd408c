// SPDX-License-Identifier: MIT
#pragma once

/// @file  Linear force law: Hooke's spring.

#include <palpate/core/error.hpp>
#include <palpate/law/force/concept.hpp>

#include <limits>

namespace palpate {

/// Contact force of a linear spring; eq. (3) with beta0^2 epsilon = 0.
///
///     F = k D,   dF/dD = k,   energy = k D^2 / 2      (0 for D <= 0)
///
/// | symbol | name     | unit | range                            |
/// |--------|----------|------|----------------------------------|
/// | D      | argument | m    | any; D <= 0 and NaN give 0       |
/// | k      | `k`      | N/m  | > 0                              |
///
/// dF/dD jumps from 0 to k at D = 0. Bad parameters: SetupError.
template <Real S>
class LinearForce {
 public:
  using Scalar = S;

  struct Params {
    S k;  ///< stiffness [N/m] > 0
  };

  constexpr explicit LinearForce(const Params& params) : p_(params) {
    require_positive(p_.k, "LinearForce", "k [N/m] must be > 0 and finite");
  }

  /// F [N] at depth D [m].
  [[nodiscard]] constexpr S force(S depth) const noexcept { return is_positive(depth) ? p_.k * depth : S(0); }
  /// dF/dD [N/m] at depth D [m].
  [[nodiscard]] constexpr S stiffness(S depth) const noexcept { return is_positive(depth) ? p_.k : S(0); }
  /// Integral of F from 0 to D [J].
  [[nodiscard]] constexpr S energy(S depth) const noexcept {
    return is_positive(depth) ? p_.k * depth * depth / S(2) : S(0);
  }
  /// D [m] at the force F [N].
  [[nodiscard]] constexpr S depth(S force) const noexcept { return is_positive(force) ? force / p_.k : S(0); }
  /// No limit: infinity.
  [[nodiscard]] constexpr S max_depth() const noexcept { return std::numeric_limits<S>::infinity(); }
  [[nodiscard]] constexpr const Params& params() const noexcept { return p_; }

 private:
  Params p_;
};

static_assert(ForceLaw<LinearForce<float>> && ForceLaw<LinearForce<double>>);

}  // namespace palpate
