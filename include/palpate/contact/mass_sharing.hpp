// SPDX-License-Identifier: MIT
#pragma once

/// @file How a region shares the tool's mass among its points (section IV.C): m_i = weight(A_i) norm(n) m.
///
/// | shipped           | m_i / m              | use it when                                                 |
/// |-------------------|----------------------|-------------------------------------------------------------|
/// | `SurfacePressure` | projected area / A_0 | the default: walls do not count, nor how the tool is meshed |
/// | `AreaSharing`     | A_i / A_0            | the tool is bare points: no direction of a face is known    |
/// | `EqualSharing`    | 1 / n                | comparing with the paper: the force jumps when n changes    |

#include <palpate/core/scalar.hpp>

#include <concepts>

namespace palpate {

/// m_i = m A_i / A_0, with A_i [m^2] the point's area on the tool and A_0 [m^2] the tool's nominal contact
/// area. No equation: reading of IV.C, because m/n makes the force jump when a point joins with zero depth.
/// Along the body's exit direction, whichever way the tool's face looks.
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

/// Pressure on the tool's surface (contact/pressure_sum.hpp): every point of the tool's face bears the
/// pressure law(delta_i) / A_0 [Pa] along its own normal, so a region bears that of its area projected on the
/// push. Reading of IV.C, because A_i counts a pin's walls as its face: needs a tool with vector areas
/// (ToolPoints of a mesh). `weight` is the share of a point whose face looks straight against the push.
struct SurfacePressure : AreaSharing {};

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

static_assert(MassSharing<SurfacePressure> && MassSharing<AreaSharing> && MassSharing<EqualSharing>);

}  // namespace palpate
