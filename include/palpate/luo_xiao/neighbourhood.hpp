// SPDX-License-Identifier: MIT
#pragma once

/// @file Local neighbourhood (V.B): a contact over more area makes a shallower dent under the same force.
///
/// | shipped              | w                               | use it when                              |
/// |----------------------|---------------------------------|------------------------------------------|
/// | `AreaNeighbourhood`  | 1/(1 + ln(max(1, A/A_ref)))     | default; independent of the tool's mesh  |
/// | `CountNeighbourhood` | 1/(1 + ln n)                    | the paper's n; w -> 0 in finer meshes    |
/// | `Printed<N>`         | N's                             | the paper's form: a hill under the tool  |
/// | `NoNeighbourhood`    | 1                               | absent: no byte, no instruction          |
///
/// Two forms. With u[d] the field of V.A.2 whose contact corner has the displacement d, p0 the contact's
/// position, n its normal, a the radius of a disc of the region's area:
///
///     tool_face:  u = (1 - c) u[w D] + c D',  c = b(r) max(0, delta - h - g)/(delta - g)
///     printed:    u = (1 - (1 - w) b) u[D],   b = (1 - (r/R)^2)^2
///
/// - `tool_face`: the surface under the tool is the tool's own face, a plane across n at the tool's depth
///   delta, and w makes the dent around it shallower. D' is D with delta in place of its normal part; g the
///   normal part of u[w D]; h how far the vertex is below p0's tangent plane; r its distance from the axis
///   through p0 along n. b is 1 for r <= a and 0 from R on: 1 - t^3 (10 - 15 t + 6 t^2), t = (r^2 - a^2)/(R^2
///   - a^2), which has two continuous derivatives and needs no root. The corners are bounded, |u_i| <= w |D|
///   a/l_i at the distance l_i from the contact: nothing moves more than what is under the tool, and the
///   closer to it, the more (V.A.2). docs/shape.md has the derivation and what is measured.
/// - `printed`: w D inside R over a field with D, joined without a step: the simplest b with b(0) = 1, b(R) =
///   b'(R) = 0; r the distance from p0. The surface goes down from the contact to R, a hill under the tool,
///   and the tool stands in the drawn body.
///
/// Absent on purpose: a physical law for a fixed force (a punch sinks as A^(-1/2)); that belongs to the force
/// law.

#include <palpate/core/error.hpp>
#include <palpate/luo_xiao/interpolation/concept.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace palpate {

/// What w and R are applied to: see the top of this file.
enum class NeighbourhoodForm : std::uint8_t { tool_face, printed };

/// `active` false: nothing else is asked of it.
template <class N>
concept Neighbourhood = Real<typename N::Scalar> && std::copyable<N> && requires {
  { N::active } -> std::convertible_to<bool>;
} && (!N::active || requires(const N& n, const ContactDisplacement<typename N::Scalar>& contact) {
                          { N::form } -> std::convertible_to<NeighbourhoodForm>;
                          { n.factor(contact) } noexcept -> std::same_as<typename N::Scalar>;  // w in (0, 1]
                          { n.radius(contact) } noexcept -> std::same_as<typename N::Scalar>;  // R [m] >= 0
                        });

namespace detail {
/// Radius of a disc of the region's area [m].
template <Real S>
[[nodiscard]] inline S region_radius(S area) noexcept {
  return is_finite(area) && area > S(0) ? std::sqrt(area / std::numbers::pi_v<S>) : S(0);
}
/// Twice the radius of a disc of the region's area [m]: R where none is given. V.B leaves R open; beyond two
/// radii a half-space's displacement has fallen to a quarter of the centre's under a uniform pressure.
template <Real S>
[[nodiscard]] inline S twice_region_radius(S area) noexcept {
  return S(2) * region_radius(area);
}
}  // namespace detail

template <Real S>
struct NoNeighbourhood {
  using Scalar = S;
  static constexpr bool active = false;
};

/// w = 1/(1 + ln(max(1, A/A_ref))): V.B with n read as area over a reference area, log natural.
///
/// | symbol | name             | unit | range                                                        |
/// |--------|------------------|------|--------------------------------------------------------------|
/// | A_ref  | `reference_area` | m^2  | > 0: up to here a contact counts as a point, w = 1           |
/// | R      | `radius`         | m    | >= 0; 0: twice the region's radius, 2 sqrt(A/pi)             |
template <Real S>
class AreaNeighbourhood {
 public:
  using Scalar = S;
  static constexpr bool active = true;
  static constexpr NeighbourhoodForm form = NeighbourhoodForm::tool_face;

  struct Params {
    S reference_area{S(1e-6)};  ///< A_ref [m^2]; chosen: a square millimetre
    S radius{0};                ///< R [m]
  };

  explicit AreaNeighbourhood(const Params& params) : p_(params) {
    require_positive(p_.reference_area, "AreaNeighbourhood", "reference_area [m^2] must be > 0");
    require_non_negative(p_.radius, "AreaNeighbourhood", "radius [m] must be >= 0");
  }

  [[nodiscard]] S factor(const ContactDisplacement<S>& contact) const noexcept {
    const S ratio = contact.area / p_.reference_area;
    return is_finite(ratio) && ratio > S(1) ? S(1) / (S(1) + std::log(ratio)) : S(1);
  }
  [[nodiscard]] S radius(const ContactDisplacement<S>& contact) const noexcept {
    return p_.radius > S(0) ? p_.radius : detail::twice_region_radius(contact.area);
  }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  Params p_;
};

/// w = 1/(1 + ln n), n the region's points: V.B as printed, log natural.
///
/// | symbol | name     | unit | range                                            |
/// |--------|----------|------|--------------------------------------------------|
/// | R      | `radius` | m    | >= 0; 0: twice the region's radius, 2 sqrt(A/pi) |
template <Real S>
class CountNeighbourhood {
 public:
  using Scalar = S;
  static constexpr bool active = true;
  static constexpr NeighbourhoodForm form = NeighbourhoodForm::tool_face;

  struct Params {
    S radius{0};  ///< R [m]
  };

  explicit CountNeighbourhood(const Params& params) : p_(params) {
    require_non_negative(p_.radius, "CountNeighbourhood", "radius [m] must be >= 0");
  }

  [[nodiscard]] S factor(const ContactDisplacement<S>& contact) const noexcept {
    return is_finite(contact.points) && contact.points > S(1) ? S(1) / (S(1) + std::log(contact.points))
                                                              : S(1);
  }
  [[nodiscard]] S radius(const ContactDisplacement<S>& contact) const noexcept {
    return p_.radius > S(0) ? p_.radius : detail::twice_region_radius(contact.area);
  }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  Params p_;
};

/// The paper's form, literal, with N's w and R: `Printed<CountNeighbourhood<S>>` is V.B as printed.
template <Neighbourhood N>
struct Printed : N {
  static constexpr NeighbourhoodForm form = NeighbourhoodForm::printed;
  using N::N;
};

static_assert(Neighbourhood<NoNeighbourhood<float>> && Neighbourhood<NoNeighbourhood<double>>);
static_assert(Neighbourhood<AreaNeighbourhood<float>> && Neighbourhood<AreaNeighbourhood<double>>);
static_assert(Neighbourhood<CountNeighbourhood<float>> && Neighbourhood<CountNeighbourhood<double>>);
static_assert(Neighbourhood<Printed<CountNeighbourhood<float>>> &&
              Neighbourhood<Printed<CountNeighbourhood<double>>>);

}  // namespace palpate
