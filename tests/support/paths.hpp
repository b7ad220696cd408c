// SPDX-License-Identifier: MIT
#pragma once

/// @file  Random smooth tool paths over a body, for continuity and stress tests.

#include <palpate/core/pose.hpp>
#include <palpate/geometry/concept.hpp>

#include <array>
#include <cmath>
#include <random>

namespace palpate::test {

/// Rotation about the unit axis by `angle` [rad] (Rodrigues).
template <Real S>
[[nodiscard]] inline Mat3<S> rotation_about(const Vec3<S>& axis, S angle) {
  Mat3<S> K;
  K << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Mat3<S>::Identity() + std::sin(angle) * K + (S(1) - std::cos(angle)) * K * K;
}

/// A path that wanders over a body in smooth loops, dips in and out of it, and turns the tool. The tool's
/// origin follows the surface point seen from the body's middle in a direction that traces a Lissajous
/// figure, at a height above it that oscillates between `lowest` and `highest` [m].
template <class Body>
class WanderingPath {
 public:
  using S = typename Body::Scalar;

  template <class Random>
  WanderingPath(const Body& body, const Vec3<S>& middle, S lowest, S highest, S turn, Random& random)
      : body_(body), middle_(middle), low_(lowest), high_(highest), turn_(turn) {
    std::uniform_real_distribution<double> phase(0, two_pi), unit(-1, 1);
    for (double& p : phase_) p = phase(random);
    const auto direction = [&] {
      Vec3<S> d;
      do {
        d = Vec3<S>(S(unit(random)), S(unit(random)), S(unit(random)));
      } while (d.norm() < S(0.1) || d.norm() > S(1));
      return Vec3<S>(d.normalized());
    };
    towards_ = direction();
    side_ = perpendicular<S>(towards_);
    other_ = towards_.cross(side_);
    axis_ = direction();
    sweep_ = S(0.2 + 0.4 * std::abs(unit(random)));
    dips_ = 1 + static_cast<int>(3 * std::abs(unit(random)));
  }

  /// The tool's pose at t in [0, 1].
  [[nodiscard]] Pose<S> at(double t) const {
    const auto wave = [&](int k, int n) {
      return S(std::sin(two_pi * n * t + phase_[static_cast<std::size_t>(k)]));
    };
    const Vec3<S> look = (towards_ + sweep_ * (wave(0, 1) * side_ + wave(1, 2) * other_)).normalized();
    const RayHit<S> hit = body_.raycast(middle_, look);
    const S height = low_ + (high_ - low_) * (S(1) + wave(2, dips_)) / S(2);
    Pose<S> X;
    X.rotation = rotation_about<S>(axis_, turn_ * wave(3, 1));
    X.translation = hit.position + height * look;
    return X;
  }

 private:
  static constexpr double two_pi = 6.283185307179586476925;
  const Body& body_;
  Vec3<S> middle_, towards_, side_, other_, axis_;
  S low_, high_, turn_, sweep_;
  int dips_;
  std::array<double, 4> phase_;
};

}  // namespace palpate::test
