// SPDX-License-Identifier: MIT
#pragma once

/// @file Local neighbourhood (V.B): a contact over more area makes a shallower dent under the same force.
///
/// | shipped              | factor of D at the contact      | use it when                                  |
/// |----------------------|---------------------------------|----------------------------------------------|
/// | `AreaNeighbourhood`  | w = 1/(1 + ln(max(1, A/A_ref))) | default; independent of the tool's mesh       |
/// | `CountNeighbourhood` | w = 1/(1 + ln n)                | the paper's, literal; w -> 0 in finer meshes |
/// | `NoNeighbourhood`    | 1                               | absent: no byte, no instruction              |
///
/// Inside radius R of the contact the displacement is that of a contact with D replaced by
///
///     D (1 - (1 - w) b(r)),  b(r) = (1 - (r/R)^2)^2 for r < R, else 0
///
/// so it is wD at the contact and joins the global shape at R with the same slope (the paper's w inside R
/// alone would make a step there). b is this library's choice: the simplest with b(0) = 1, b(R) = b'(R) = 0
/// that needs no root. Absent on purpose: a physical law for a fixed force (a punch sinks as A^(-1/2)); that
/// belongs to the force law.

#include <palpate/core/error.hpp>
#include <palpate/luo_xiao/interpolation/concept.hpp>

#include <cmath>
#include <numbers>

namespace palpate {

/// `active` false: nothing else is asked of it.
template <class N>
concept Neighbourhood = Real<typename N::Scalar> && std::copyable<N> && requires {
  { N::active } -> std::convertible_to<bool>;
} && (!N::active || requires(const N& n, const ContactDisplacement<typename N::Scalar>& contact) {
                          { n.factor(contact) } noexcept -> std::same_as<typename N::Scalar>;  // w in (0, 1]
                          { n.radius(contact) } noexcept -> std::same_as<typename N::Scalar>;  // R [m] >= 0
                        });

namespace detail {
/// Twice the radius of a disc of the region's area [m]: R where none is given. V.B leaves R open; beyond two
/// radii a half-space's displacement has fallen to a quarter of the centre's under a uniform pressure.
template <Real S>
[[nodiscard]] inline S twice_region_radius(S area) noexcept {
  return is_finite(area) && area > S(0) ? S(2) * std::sqrt(area / std::numbers::pi_v<S>) : S(0);
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

static_assert(Neighbourhood<NoNeighbourhood<float>> && Neighbourhood<NoNeighbourhood<double>>);
static_assert(Neighbourhood<AreaNeighbourhood<float>> && Neighbourhood<AreaNeighbourhood<double>>);
static_assert(Neighbourhood<CountNeighbourhood<float>> && Neighbourhood<CountNeighbourhood<double>>);

}  // namespace palpate
