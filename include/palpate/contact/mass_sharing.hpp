// SPDX-License-Identifier: MIT
#pragma once

/// @file How a region shares the tool's mass among its points (section IV.C): m_i = weight(A_i) norm(n) m.
///
/// | shipped        | m_i / m   | use it when                                                              |
/// |----------------|-----------|--------------------------------------------------------------------------|
/// | `AreaSharing`  | A_i / A_0 | the default: a point that just touches adds nothing, the force converges |
/// | `EqualSharing` | 1 / n     | comparing with the paper: the force jumps whenever n changes             |

#include <palpate/core/scalar.hpp>

#include <concepts>

namespace palpate {

/// m_i = m A_i / A_0, with A_i [m^2] the point's area on the tool and A_0 [m^2] the tool's nominal contact
/// area. No equation: reading of IV.C, because m/n makes the force jump when a point joins with zero depth.
struct AreaSharing {
  template <Real S>
  [[nodiscard]] static constexpr S weight(S area, S nominal_area) noexcept {
    return area / nominal_area;
  }
  template <Real S>
  [[nodiscard]] static constexpr S norm(S /*points*/) noexcept {
    return S(1);
  }
};

/// m_i = m / n, as printed.
struct EqualSharing {
  template <Real S>
  [[nodiscard]] static constexpr S weight(S /*area*/, S /*nominal_area*/) noexcept {
    return S(1);
  }
  template <Real S>
  [[nodiscard]] static constexpr S norm(S points) noexcept {
    return S(1) / points;
  }
};

template <class W, class S>  // of a point: (A_i, A_0) [m^2] -> [-]
concept HasWeight = requires(S area) {
  { W::weight(area, area) } noexcept -> std::same_as<S>;
};

template <class W, class S>  // of all points of a region: (n) -> [-]
concept HasNorm = requires(S points) {
  { W::norm(points) } noexcept -> std::same_as<S>;
};

/// Static functions, templates of the scalar.
template <class W>
concept MassSharing = HasWeight<W, float> && HasWeight<W, double> && HasNorm<W, float> && HasNorm<W, double>;

static_assert(MassSharing<AreaSharing> && MassSharing<EqualSharing>);

}  // namespace palpate
