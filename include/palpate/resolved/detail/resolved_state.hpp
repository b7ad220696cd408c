// SPDX-License-Identifier: MIT
#pragma once

/// @file A tick of a resolved contact: from touching points to forces at them.

#include <palpate/contact/surface_load.hpp>
#include <palpate/core/absent.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/detection/tool_points.hpp>
#include <palpate/resolved/contact_points.hpp>
#include <palpate/resolved/detail/bounded_list.hpp>
#include <palpate/resolved/detail/contact_area.hpp>
#include <palpate/resolved/detail/convex_problem.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/static_strength.hpp>
#include <palpate/resolved/detail/touching_point.hpp>
#include <palpate/resolved/elastic_contact.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace palpate::detail {

/// What a tick leaves for the next: loads at the points, and where those that stick hold the surface.
template <Real S, ContactCompliance Compliance, bool has_friction_>
class ResolvedState {
 public:
  static constexpr bool has_friction = has_friction_;
  using Force = ElasticContact<S, Compliance>;

  ResolvedState(const Compliance& body, std::size_t tool_points, std::size_t capacity)
      : points_(tool_points),
        touching_(capacity),
        inside_(capacity),
        contacts_(capacity),
        system_(capacity, static_cast<float>(1 - 2 * body.nu()), has_friction),
        unloaded_(capacity),
        regular_(body, capacity) {
    const std::size_t padded = AlignedList<float>::padded(capacity);
    pressure_.resize(padded);
    if constexpr (has_friction) traction_.resize(padded);
  }

  void reset() noexcept {
    contacts_.clear();
    tick_ += 2;  // no point has touched in the tick before
    forget();
  }
  [[nodiscard]] bool has_contact() const noexcept { return !contacts_.empty(); }
  [[nodiscard]] std::span<const PointContact<S>> contacts() const noexcept {
    return {contacts_.begin(), contacts_.size()};
  }
  /// The last tick's loads on the body, as many as the list has room for.
  template <class List>
  void loads(List& out) const noexcept {
    out.clear();
    for (std::size_t i = 0; has_contact() && i < size() && !out.full(); ++i) {
      const Touching& at = touching_[inside_[i]];
      const Point& p = points_[at.point];
      if (!p.loaded) continue;
      out.push_back({origin_ + system_.foot(i).template cast<S>(), system_.axes(i).col(0).template cast<S>(),
                     per_load_ * p.load.template cast<S>(), static_cast<S>(system_.area(i))});
    }
  }
  [[nodiscard]] const Residual& residual() const noexcept { return residual_; }
  [[nodiscard]] bool slides() const noexcept { return slides_; }

  /// Area that touches [m^2].
  [[nodiscard]] float area() noexcept {
    unloaded_.clear();
    for (const Touching& c : touching_)
      if (!points_[c.point].loaded) unloaded_.add(relative(c.x));
    unloaded_.pad();
    return contact_area(system_, pressure_, unloaded_);
  }

  void begin_tick() noexcept {
    ++tick_;
    touching_.clear();
  }
  /// Tool point i, at x in object coordinates, is `depth` in the body, whose inward normal is m. False where
  /// there is no place left.
  bool touch(std::uint32_t i, const Vec3<S>& x, S depth, const Vec3<S>& m) noexcept {
    if (touching_.full()) return false;
    touching_.push_back({i, x, m.template cast<float>(), static_cast<float>(depth)});
    Point& p = points_[i];
    if (p.tick + 1 != tick_) p = {};
    p.tick = tick_;
    return true;
  }

  /// Solves for the loads with the tool at X.
  template <class Friction>
  void solve(const Force& force, const Friction& friction, const ToolPoints<S>& tool,
             const Pose<S>& X) noexcept {
    contacts_.clear();
    residual_ = {};
    const Pose<S> before = std::exchange(pose_, X);
    if (touching_.empty()) {
      forget();
      return;
    }
    float deepest = 0, size2 = 0;
    for (const Touching& c : touching_) {
      deepest = (std::max)(deepest, c.depth);
      size2 += c.depth * c.depth;
    }
    const float tolerance = static_cast<float>(force.params().tolerance) * std::sqrt(size2);
    if constexpr (has_friction) move_anchors(before, tool);
    // First those that carry load or came near to it.
    inside_.clear();
    for (std::uint32_t c = 0; c < touching_.size(); ++c) {
      const Point& p = points_[touching_[c].point];
      if (p.loaded || p.sunk - touching_[c].depth < near * deepest) inside_.push_back(c);
    }
    for (int round = 0; round < 4; ++round) {
      build(force, tool);
      solve_inside(force, friction, tolerance);
      if (!take_in(force, tool, tolerance)) break;
    }
    finish(force, tool);
  }

 private:
  using RegularPart = typename RegularPartOf<Compliance>::type;
  /// Points whose gap was less than this share of the depth are solved for at once.
  static constexpr float near = 0.05f;
  static constexpr int max_turns = 4;

  using Point = PointMemory;
  using Touching = TouchingPoint<S>;

  [[nodiscard]] std::size_t size() const noexcept { return inside_.size(); }
  [[nodiscard]] Vec3<float> relative(const Vec3<S>& x) const noexcept {
    return (x - origin_).template cast<float>();
  }
  void forget() noexcept {
    slides_ = false;
    strength_ = {};
    if constexpr (has_friction) traction_.step = 0;
  }
  [[nodiscard]] Point& point(std::size_t i) noexcept { return points_[touching_[inside_[i]].point]; }

  void build(const Force& force, const ToolPoints<S>& tool) noexcept {
    system_.clear();
    origin_ = touching_[0].x;
    for (const Touching& at : touching_)
      system_.touch(relative(at.x), at.m, at.depth, static_cast<float>(tool.area(at.point)),
                    at.point / static_cast<std::uint32_t>(batch_size));  // a leaf of the tool's points
    for (const std::uint32_t c : inside_) {
      const Touching& at = touching_[c];
      system_.add(relative(at.x), at.m, at.depth, static_cast<float>(tool.area(at.point)));
    }
    system_.build();
    if constexpr (RegularPart::active) {
      regular_.clear();
      for (std::size_t i = 0; i < size(); ++i)
        regular_.add(force.compliance(),
                     (origin_ + system_.foot(i).template cast<S>()).template cast<double>(),
                     point(i).triangle);
      regular_.build();
    }
    for (std::size_t i = 0; i < size(); ++i) {
      const Vec3<float> P = system_.axes(i).transpose() * point(i).load;
      pressure_.q[i] = (std::max)(P.x(), 0.f);
      if constexpr (has_friction) traction_.s[i] = P.y(), traction_.t[i] = P.z();
    }
    for (std::size_t i = size(); i < system_.stride(); ++i) {
      pressure_.q[i] = 0;
      if constexpr (has_friction) traction_.s[i] = traction_.t[i] = 0;
    }
  }

  template <class Friction>
  void solve_inside(const Force& force, const Friction& friction, float tolerance) noexcept {
    const int iterations = force.params().iterations;
    const float per_norm = static_cast<float>(force.params().tolerance) / tolerance;
    const std::size_t n = size();
    const auto pressures = [&] {
      const Remainder left = solve_pressures(n, pressure_, tolerance, iterations,
                                             [&](const float* q, float* y) noexcept { normal_by(q, y); });
      residual_.iterations += left.iterations;
      return left;
    };
    normal_by(pressure_.q.data(), pressure_.r.data());
    for (std::size_t i = 0; i < n; ++i) {
      pressure_.d[i] = system_.depth[i];
      pressure_.r[i] -= pressure_.d[i];
    }
    if constexpr (!has_friction) {
      residual_.relative = pressures().norm * per_norm;
    } else {
      for (std::size_t i = 0; i < n; ++i) traction_.raised[i] = 0;
      // Pressures and tractions in turns: they hardly depend on each other.
      float mu = 0;
      Remainder dragged;
      for (int turn = 0;; ++turn) {
        raise_by_tractions();
        const Remainder pressed = pressures();
        residual_.relative = (std::max)(pressed.norm, dragged.norm) * per_norm;
        // Done where what the tractions change is within the tolerance.
        if (turn == max_turns || (turn > 0 && pressed.iterations == 0)) return;
        if (turn == 0) mu = coefficient(force, friction);
        for (std::size_t i = 0; i < n; ++i) {
          traction_.limit[i] = mu * pressure_.q[i];
          traction_.move(i, 0, 0);
        }
        begin_tractions();
        if (turn == 0) begin_anchors();
        dragged = solve_tractions(n, traction_, tolerance, iterations,
                                  [&](const float* s, const float* t, float* us, float* ut) noexcept {
                                    tangential_by(s, t, us, ut);
                                  });
        residual_.iterations += dragged.iterations;
      }
    }
  }
  void clear(float* u) const noexcept {
    for (std::size_t i = 0; i < system_.stride(); ++i) u[i] = 0;
  }
  void normal_by(const float* q, float* y) noexcept {
    clear(y);
    system_.template add<PointSystem::pressing, PointSystem::pressing>({q}, {y});
    if constexpr (RegularPart::active) regular_.add_normal(system_, q, y);
  }
  void tangential_by(const float* s, const float* t, float* us, float* ut) noexcept {
    clear(us), clear(ut);
    system_.template add<PointSystem::tangents, PointSystem::tangents>({s, t}, {us, ut});
    if constexpr (RegularPart::active) regular_.add_tangential(system_, s, t, us, ut);
  }
  // Depths and residuals of the pressures, with what the tractions raise.
  void raise_by_tractions() noexcept {
    float* const y = pressure_.y.data();
    clear(y);
    const float *const s = traction_.s.data(), *const t = traction_.t.data();
    system_.template add<PointSystem::pressing, PointSystem::tangents>({s, t}, {y});
    if constexpr (RegularPart::active) regular_.add_normal_by_tractions(system_, s, t, y);
    for (std::size_t i = 0; i < size(); ++i) {
      pressure_.d[i] = system_.depth[i] - y[i];
      pressure_.r[i] += y[i] - std::exchange(traction_.raised[i], y[i]);
    }
  }
  void begin_tractions() noexcept {
    float *const us = traction_.us.data(), *const ut = traction_.ut.data();
    tangential_by(traction_.s.data(), traction_.t.data(), us, ut);
    const float* const q = pressure_.q.data();
    system_.template add<PointSystem::tangents, PointSystem::pressing>({q}, {us, ut});
    if constexpr (RegularPart::active) regular_.add_tangential_by_pressures(system_, q, us, ut);
    if (traction_.step == 0) traction_.step = system_.flexible_step();
  }

  /// Takes in points that the surface has not given way to. False where there are none.
  bool take_in(const Force& force, const ToolPoints<S>& tool, float tolerance) noexcept {
    const std::size_t n = size();
    std::size_t next = 0;
    bool more = false;
    if constexpr (RegularPart::active) regular_.gather_pressures(system_, pressure_.q.data());
    for (std::uint32_t c = 0; c < touching_.size(); ++c) {
      if (next < n && inside_[next] == c) {
        ++next;
        continue;
      }
      const Touching& at = touching_[c];
      Point& p = points_[at.point];
      // Gaps change little in a tick: each is looked at in every eighth.
      if ((tick_ + at.point) % 8 != 0) continue;
      const Vec3<float> m = system_.direction_at(relative(at.x), at.m);
      const float depth = at.depth / m.dot(at.m);
      const Vec3<S> foot = at.x - (depth * m).template cast<S>();
      float sunk = system_.normal_displacement_at(pressure_.q.data(), relative(foot), m,
                                                  static_cast<float>(tool.area(at.point)));
      if constexpr (RegularPart::active)
        sunk += regular_.normal_at(force.compliance(), foot.template cast<double>(),
                                   points_[at.point].triangle, m);
      p.sunk = sunk - (depth - at.depth);
      if (sunk - depth < -tolerance / 10) {
        inside_.push_back(c);  // sorted below; never beyond the capacity, which is that of touching_
        more = true;
      }
    }
    if (!more) return false;
    for (std::size_t i = 0; i < n; ++i) store_load(i);  // the next round begins there
    std::sort(inside_.begin(), inside_.end());
    return true;
  }

  void move_anchors(const Pose<S>& before, const ToolPoints<S>& tool) noexcept {
    for (const Touching& c : touching_) {
      Point& p = points_[c.point];
      if (p.loaded) p.anchor += Vec3<S>(c.x - before * tool.point(c.point)).template cast<float>();
    }
  }
  /// A point that has just come into contact holds the surface where it is.
  void begin_anchors() noexcept {
    for (std::size_t i = 0; i < size(); ++i) {
      const Mat3<float>& axes = system_.axes(i);
      if (point(i).loaded) {
        traction_.as[i] = axes.col(1).dot(point(i).anchor);
        traction_.at[i] = axes.col(2).dot(point(i).anchor);
      } else {
        traction_.as[i] = traction_.us[i], traction_.at[i] = traction_.ut[i];
      }
    }
  }
  /// mu of every point: the law's limit of the whole contact over its normal force.
  template <class Friction>
  float coefficient(const Force& force, const Friction& friction) noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < size(); ++i) sum += double(pressure_.q[i]);
    const S normal = static_cast<S>(sum * 4 * std::numbers::pi * force.shear_modulus());
    if (!(normal > S(0))) return 0;
    return strength_.coefficient(friction, normal);
  }
  // Static strength fades as the tool slides over the surface.
  void fade() noexcept {
    Vec3<float> slip = Vec3<float>::Zero(), stretch = Vec3<float>::Zero();
    for (std::size_t i = 0; i < size(); ++i) {
      const float q = pressure_.q[i], us = traction_.us[i], ut = traction_.ut[i];
      const Mat3<float>& axes = system_.axes(i);
      slip += q * ((traction_.as[i] - us) * axes.col(1) + (traction_.at[i] - ut) * axes.col(2));
      stretch += q * (us * axes.col(1) + ut * axes.col(2));
    }
    strength_.fade(slip.norm(), stretch.norm());
  }
  void store_load(std::size_t i) noexcept {
    Vec3<float> P(pressure_.q[i], 0, 0);
    if constexpr (has_friction) P.y() = traction_.s[i], P.z() = traction_.t[i];
    point(i).load = system_.axes(i) * P;
  }

  void finish(const Force& force, const ToolPoints<S>& tool) noexcept {
    const S scale = per_load_ = static_cast<S>(4 * std::numbers::pi * force.shear_modulus());
    bool any_sticks = false;
    for (const Touching& c : touching_) points_[c.point].loaded = false;
    for (std::size_t i = 0; i < size(); ++i) store_load(i);
    Vec3<float> slope = Vec3<float>::Zero();
    if constexpr (RegularPart::active)
      slope = regular_.slope(system_, pressure_.q.data(), [this](std::size_t i) { return point(i).load; });
    for (std::size_t i = 0; i < size(); ++i) {
      const Touching& at = touching_[inside_[i]];
      Point& p = point(i);
      const float q = pressure_.q[i];
      p.sunk = pressure_.r[i] + at.depth;
      p.loaded = q > 0;
      if (!p.loaded) continue;
      bool sticks = false;
      float slips = 1;
      if constexpr (has_friction) {
        const Mat3<float>& axes = system_.axes(i);
        const float s = traction_.s[i], t = traction_.t[i];
        const float held2 = s * s + t * t, limit2 = traction_.limit[i] * traction_.limit[i];
        sticks = held2 < 0.9999f * limit2;
        if (sticks) slips = held2 / limit2;
        p.anchor = sticks ? Vec3<float>(traction_.as[i] * axes.col(1) + traction_.at[i] * axes.col(2))
                          : Vec3<float>(traction_.us[i] * axes.col(1) + traction_.ut[i] * axes.col(2));
      }
      any_sticks |= sticks;
      // The tool feels minus the gradient of the energy: of the depth along the direction of pressing, and of
      // the regular part as far as the point slips; where it sticks the body goes with it.
      const Vec3<float> m = system_.axes(i).col(0), n = system_.normal(i);
      const Vec3<float> felt = p.load + q * (n / n.dot(m) - m - slips * slope);
      contacts_.push_back({at.point, sticks, at.x, -at.m.template cast<S>(), -scale * felt.template cast<S>(),
                           scale * static_cast<S>(q) / tool.area(at.point), static_cast<S>(at.depth)});
    }
    slides_ = has_friction && !contacts_.empty() && !any_sticks;
    if (!slides_)
      strength_ = {};
    else if constexpr (has_friction)
      fade();
  }

  std::vector<Point> points_;
  BoundedList<Touching> touching_;
  BoundedList<std::uint32_t> inside_;  // of touching_, rising: those that are solved for
  BoundedList<PointContact<S>> contacts_;
  PointSystem system_;
  Unloaded unloaded_;
  PressureLists pressure_;
  PALPATE_NO_UNIQUE_ADDRESS std::conditional_t<has_friction, TractionLists, Absent<4>> traction_;
  PALPATE_NO_UNIQUE_ADDRESS RegularPart regular_;
  Residual residual_;
  Pose<S> pose_;
  Vec3<S> origin_;
  S per_load_ = 0;  // 4 pi mu [Pa]
  std::uint32_t tick_ = 1;
  bool slides_ = false;
  PALPATE_NO_UNIQUE_ADDRESS std::conditional_t<has_friction, StaticStrength, Absent<6>> strength_;

 public:
  std::uint32_t id = 0;  ///< of the contact: another one after each lift-off
};

}  // namespace palpate::detail
