// SPDX-License-Identifier: MIT
#pragma once

/// @file What the servo thread does in a tick and what it hands over: a solver of the library's, whatever the
/// object is.

#include <palpate/core/fixed_vector.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/core/status.hpp>

#include "shape.hpp"

namespace touch {

/// What the example keeps of a tick: plain values, so that another thread may have them.
struct Felt {
  palpate::Wrench<S> wrench;
  palpate::Pose<S> pose;  ///< where the tool was felt: the device's pose, or where it was held back
  palpate::Status status = palpate::Status::ok;
  std::uint32_t regions = 0;
  bool sliding = false;
  V normal = V::Zero();                                                  ///< normal part of the force [N]
  V friction = V::Zero();                                                ///< friction part [N]
  palpate::FixedVector<palpate::ContactState<S>, max_regions> contacts;  ///< what the shape is made of
};

/// What the device calls, one virtual call a tick; and, from any thread, the picture of a tick's contacts.
class Feel {
 public:
  Feel() = default;
  Feel(const Feel&) = delete;
  Feel& operator=(const Feel&) = delete;
  virtual ~Feel() = default;
  virtual Felt tick(const palpate::Pose<S>& X, S dt) noexcept = 0;
  virtual void reset() noexcept = 0;
  virtual palpate::Moved<S> draw(Shape::Contacts contacts, const Shape::Buffer& out) noexcept = 0;
  virtual void draw_rest(const Shape::Buffer& out) noexcept = 0;
  [[nodiscard]] virtual std::size_t tool_points() const noexcept = 0;
  /// Of the shape, where detection follows it [m].
  [[nodiscard]] virtual S highest_bulge() const noexcept { return 0; }
  /// Largest tangent stiffness met when the upright tool is pressed down from here, to that force [N/m].
  [[nodiscard]] virtual S stiffness_below(const V& from, S travel, S force) const = 0;
};

[[nodiscard]] std::unique_ptr<Feel> make_feel(const Options&, const Body&, const Tool&, Answer);

}  // namespace touch
