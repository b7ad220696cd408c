// SPDX-License-Identifier: MIT
#pragma once

/// @file A surface that counts how often a walk through a tool's tree asks it.

#include <palpate/geometry/concept.hpp>

#include <cstddef>

namespace palpate::test {

template <class B>
struct Counting {
  using Scalar = typename B::Scalar;
  B body;
  std::size_t* asked;
  [[nodiscard]] SurfacePoint<Scalar> closest(const Vec3<Scalar>& x) const noexcept { return body.closest(x); }
  [[nodiscard]] Penetration<Scalar> penetration(const Vec3<Scalar>& x) const noexcept {
    return body.penetration(x);
  }
  [[nodiscard]] Scalar reach() const noexcept { return body.reach(); }
  [[nodiscard]] bool separated(const Vec3<Scalar>& x, Scalar r) const noexcept {
    ++*asked;
    return body.separated(x, r);
  }
};

}  // namespace palpate::test
