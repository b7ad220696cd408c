// SPDX-License-Identifier: MIT
#pragma once

/// @file A surface that several solvers, threads or samplers share.

#include <palpate/geometry/concept.hpp>

#include <memory>
#include <utility>

namespace palpate {

/// Handle to a surface that does not change: a copy costs a reference count, and answers are the surface's
/// own, bit for bit. No equation.
template <class B>
  requires HasClosest<B> && HasReach<B>
class SharedSurface {
 public:
  using Scalar = typename B::Scalar;
  using S = Scalar;

  /// Precondition: not null.
  explicit SharedSurface(std::shared_ptr<const B> body) noexcept : body_(std::move(body)) {
    PALPATE_ASSERT(body_ != nullptr);
  }

  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept { return body_->closest(x); }
  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept
    requires HasPenetration<B>
  {
    return body_->penetration(x);
  }
  template <std::size_t N>
    requires HasPenetrationBatch<B, N>
  void penetration(const PointBatch<S, N>& x, PenetrationBatch<S, N>& in) const noexcept {
    body_->penetration(x, in);
  }
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept
    requires HasSeparated<B>
  {
    return body_->separated(c, r);
  }
  [[nodiscard]] S reach() const noexcept { return body_->reach(); }
  [[nodiscard]] auto lower() const noexcept
    requires requires(const B& b) { b.lower(); }
  {
    return body_->lower();
  }
  [[nodiscard]] auto upper() const noexcept
    requires requires(const B& b) { b.upper(); }
  {
    return body_->upper();
  }
  [[nodiscard]] Curvature<S> curvature(const Vec3<S>& x) const noexcept
    requires HasCurvature<B>
  {
    return body_->curvature(x);
  }

  [[nodiscard]] const B& body() const noexcept { return *body_; }

 private:
  std::shared_ptr<const B> body_;
};

}  // namespace palpate
