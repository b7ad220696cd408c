// SPDX-License-Identifier: MIT
#pragma once

/// @file A body grown by the radius of a ball: what the ball's centre meets where the ball meets the body.

#include <palpate/core/error.hpp>
#include <palpate/geometry/sampled_surface.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace palpate {

/// Parallel surface: all points at the signed distance r from the body.
///
///     d_r(x) = d(x) - r,   p_r(x) = p(x) + r n(x),   n(x) = sign(d) (x - p) / |x - p|
///
/// | symbol | name       | unit | range                                                            |
/// |--------|------------|------|------------------------------------------------------------------|
/// | r      | `radius`   | m    | > 0                                                              |
/// | d, p   | the body's |      | signed distance and closest point                                |
///
/// So depth and direction of a ball of radius r are exact from every side, for one query of its centre:
/// convex edges of the body become round. Concave creases stay, for there the ball touches twice. Reports a
/// bad radius. No equation of the paper: Minkowski's sum of body and ball.
template <SampledBody B>
class GrownSurface {
 public:
  using Scalar = typename B::Scalar;
  using S = Scalar;

  GrownSurface(B body, S radius) : body_(std::move(body)), radius_(radius) {
    require_positive(radius_, "GrownSurface", "radius [m] must be > 0");
  }

  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept {
    const SurfacePoint<S> at = body_.closest(x);
    const Vec3<S> normal = outward(x, at);
    return {at.position + radius_ * normal, normal, at.distance - radius_};
  }
  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept {
    const SurfacePoint<S> at = body_.closest(x);
    const S depth = radius_ - at.distance;
    if (!is_positive(depth)) return {S(0), Vec3<S>::Zero()};
    return {depth, outward(x, at)};
  }
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept
    requires HasSeparated<B>
  {
    return r >= S(0) && body_.separated(c, r + radius_);
  }
  [[nodiscard]] S reach() const noexcept { return body_.reach() + radius_; }
  [[nodiscard]] Vec3<S> lower() const noexcept { return body_.lower() - Vec3<S>::Constant(radius_); }
  [[nodiscard]] Vec3<S> upper() const noexcept { return body_.upper() + Vec3<S>::Constant(radius_); }
  [[nodiscard]] S radius() const noexcept { return radius_; }
  [[nodiscard]] const B& body() const noexcept { return body_; }

 private:
  [[nodiscard]] Vec3<S> outward(const Vec3<S>& x, const SurfacePoint<S>& at) const noexcept {
    // Nearer to the surface than that the difference is rounding.
    if (is_within(at.distance, std::sqrt(std::numeric_limits<S>::epsilon()) * radius_)) return at.normal;
    const Vec3<S> away = x - at.position;
    return unit_or<S>(at.distance < S(0) ? Vec3<S>(-away) : away, at.normal);
  }

  B body_;
  S radius_;
};

}  // namespace palpate
