// SPDX-License-Identifier: MIT
#pragma once

/// @file  The section of a skeleton's beams: from the body's volume, or given.

#include <palpate/core/error.hpp>
#include <palpate/luo_xiao/beam/section.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {

/// All beams are equal circles and together have the body's volume:
///
///     S sum l_i = V,   r = sqrt(S / pi)
///
/// | symbol | name     | unit | range |
/// |--------|----------|------|-------|
/// | V      | `volume` | m^3  | > 0   |
///
/// Beams whose lengths sum to less than V^(1/3) would be wider than long: the sum is bounded below by that,
/// which also defines the section at length 0, and above by 1e9 m, so that the radius stays positive.
/// Reported at set-up: a volume that is not positive. No equation: reading of "determined by the physical
/// properties as well as the exact parametric surface" (V.A.1).
template <Real S>
class VolumePreserving {
 public:
  using Scalar = S;
  using Section = CircularSection<S>;

  struct Params {
    S volume{1e-3};  ///< V [m^3]
  };

  explicit VolumePreserving(const Params& params) : p_(params) {
    require_positive(params.volume, "VolumePreserving", "volume [m^3] must be > 0");
    min_length_ = std::cbrt(params.volume);
    require_positive(radius(max_length), "VolumePreserving", "volume [m^3] is too small: radius [m]");
  }

  /// `total_length` = sum l_i [m].
  [[nodiscard]] Section section(S total_length) const noexcept {
    return Section({.radius = radius(total_length)});
  }
  [[nodiscard]] constexpr const Params& params() const noexcept { return p_; }

 private:
  static constexpr S max_length = S(1e9);  // [m]: far above a body's 1e3 m

  [[nodiscard]] S radius(S total_length) const noexcept {
    const S sum = (std::min)((std::max)(min_length_, total_length), (std::max)(min_length_, max_length));
    return std::sqrt(p_.volume / (std::numbers::pi_v<S> * sum));
  }

  Params p_;
  S min_length_;
};

/// The same given section for every beam.
template <BeamSection C>
class UniformSection {
 public:
  using Scalar = typename C::Scalar;
  using Section = C;

  explicit UniformSection(const C& section) noexcept : section_(section) {}
  [[nodiscard]] Section section(Scalar /*total_length*/) const noexcept { return section_; }

 private:
  C section_;
};

static_assert(SectionRule<VolumePreserving<float>> && SectionRule<VolumePreserving<double>>);
static_assert(SectionRule<UniformSection<EllipticSection<float>>> &&
              SectionRule<UniformSection<EllipticSection<double>>>);

}  // namespace palpate
