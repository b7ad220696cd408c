// SPDX-License-Identifier: MIT
#pragma once

/// @file How much of what the last tick changed goes on.

#include <palpate/core/scalar.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/resolved/detail/touching_point.hpp>

namespace palpate::detail {

/// The share s by which loads and displacements go on, P + s dP and u + s du, so that the conditions of
/// contact are met best: least squares over the points.
class TickChange {
 public:
  /// A loaded point that presses along m: by how much it is to be displaced along it [m].
  void press(const PointMemory& p, const Vec3<float>& m, float depth) noexcept {
    add(depth - m.dot(p.u), m.dot(p.u_step));
  }
  /// The same point where it has an anchor [m]: it sticks to it, or slips with t + s dt along a - u - s du.
  void hold(const PointMemory& p, const Vec3<float>& m, const Vec3<float>& anchor) noexcept {
    const Vec3<float> off = tangential<float>(anchor - p.u, m), du = tangential<float>(p.u_step, m);
    if (p.sticks) {
      meets_ += du.dot(off), size2_ += du.squaredNorm();
      return;
    }
    const Vec3<float> t = tangential<float>(p.load, m), dt = tangential<float>(p.load_step, m);
    const float size = t.norm();
    if (size > 0) add(m.dot(t.cross(off)) / size, m.dot(t.cross(du) - dt.cross(off)) / size);
  }
  [[nodiscard]] float share() const noexcept {
    return size2_ > 0 ? clamp(meets_ / size2_, -most, most) : 0.f;
  }

 private:
  /// A tick may change this many times what the last one did, or undo it.
  static constexpr float most = 3;
  void add(float lacks, float goes) noexcept { meets_ += lacks * goes, size2_ += goes * goes; }
  float meets_ = 0, size2_ = 0;
};

}  // namespace palpate::detail
