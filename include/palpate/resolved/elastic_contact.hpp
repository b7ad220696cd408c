// SPDX-License-Identifier: MIT
#pragma once

/// @file The force model of a contact that is resolved at the tool's own points: what the body's surface does
/// under loads on it.
///
/// | shipped             | body                                         | set-up                  |
/// |---------------------|----------------------------------------------|-------------------------|
/// | `HalfSpace`         | large against the contact, far from edges    | none                    |
/// | `ResponseCompliance`| any, of a response field                     | the field: seconds      |

#include <palpate/core/error.hpp>
#include <palpate/core/scalar.hpp>
#include <palpate/core/vector.hpp>

#include <concepts>
#include <cstddef>

namespace palpate {

/// A body that is large against the contact.
///
/// | symbol | name            | unit | range    |
/// |--------|-----------------|------|----------|
/// | E      | Young's modulus | Pa   | > 0      |
/// | nu     | Poisson's ratio | -    | [0, 1/2] |
class HalfSpace {
 public:
  struct Params {
    double E;
    double nu;
  };
  explicit HalfSpace(const Params& params) : E_(params.E), nu_(params.nu) {
    require_positive(E_, "HalfSpace", "E [Pa] must be > 0");
    require_finite(nu_, "HalfSpace", "nu must be from 0 to 1/2");
    if (nu_ < 0 || nu_ > 0.5) fail("HalfSpace", "nu must be from 0 to 1/2", nu_);
  }
  [[nodiscard]] double E() const noexcept { return E_; }
  [[nodiscard]] double nu() const noexcept { return nu_; }

 private:
  double E_, nu_;
};

namespace detail {
/// The regular part of a body that is a half-space: nothing.
struct NoRegularPart {
  static constexpr bool active = false;
  NoRegularPart(const auto& /*body*/, std::size_t /*capacity*/) {}
  static void take_over(const NoRegularPart&) noexcept {}
  [[nodiscard]] static constexpr bool is_left_out() noexcept { return false; }
  [[nodiscard]] static Vec3<float> moved() noexcept { return Vec3<float>::Zero(); }
  [[nodiscard]] static constexpr bool has_all() noexcept { return true; }
  [[nodiscard]] static Mat3<float> common() noexcept { return Mat3<float>::Zero(); }
};
/// What a body adds to the half-space's response: `C::RegularPart`, if there is one.
template <class C>
struct RegularPartOf {
  using type = NoRegularPart;
};
template <class C>
  requires requires { typename C::RegularPart; }
struct RegularPartOf<C> {
  using type = typename C::RegularPart;
};
}  // namespace detail

/// What an elastic body is for a resolved contact.
template <class C>
concept ContactCompliance = std::copyable<C> && requires(const C& body) {
  { body.E() } noexcept -> std::convertible_to<double>;
  { body.nu() } noexcept -> std::convertible_to<double>;
};

/// Signorini's and Coulomb's conditions at each of the tool's points (`ContactPoints`).
///
/// | symbol | name         | unit | range, default                                                          |
/// |--------|--------------|------|-------------------------------------------------------------------------|
/// |        | `compliance` |      | the elastic body                                                        |
/// |        | `tolerance`  | -    | (0, 0.1], 1e-4: of what violates the conditions over the depths, norms  |
/// |        | `iterations` | -    | [1, 1000], 50: a tick's bound; 3 are common                             |
///
/// Without friction the force is minus the gradient of the least elastic energy over the tool's pose, to the
/// tolerance: passive, continuous, with its torque. Limits: small strain; points touch that are beneath the
/// undeformed surface; the body may not touch itself.
template <Real S, ContactCompliance Compliance_>
class ElasticContact {
 public:
  using Scalar = S;
  using Compliance = Compliance_;
  struct Params {
    Compliance compliance;
    double tolerance = 1e-4;
    int iterations = 50;
  };
  explicit ElasticContact(const Params& params) : p_(params) {
    require_positive(p_.tolerance, "ElasticContact", "tolerance must be > 0");
    if (p_.tolerance > 0.1) fail("ElasticContact", "tolerance must be <= 0.1", p_.tolerance);
    if (p_.iterations < 1 || p_.iterations > 1000)
      fail("ElasticContact", "iterations must be from 1 to 1000", double(p_.iterations));
  }
  [[nodiscard]] const Compliance& compliance() const noexcept { return p_.compliance; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }
  [[nodiscard]] double shear_modulus() const noexcept {
    return p_.compliance.E() / (2 * (1 + p_.compliance.nu()));
  }

 private:
  Params p_;
};

}  // namespace palpate
