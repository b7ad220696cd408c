// SPDX-License-Identifier: MIT
#pragma once

/// @file A tick of a resolved contact: from touching points to forces at them.

#include <palpate/contact/surface_load.hpp>
#include <palpate/core/absent.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/detection/tool_points.hpp>
#include <palpate/resolved/contact_points.hpp>
#include <palpate/resolved/detail/body_shift.hpp>
#include <palpate/resolved/detail/body_sway.hpp>
#include <palpate/resolved/detail/bounded_list.hpp>
#include <palpate/resolved/detail/carried_surface.hpp>
#include <palpate/resolved/detail/contact_area.hpp>
#include <palpate/resolved/detail/finite_strain.hpp>
#include <palpate/resolved/detail/friction_cones.hpp>
#include <palpate/resolved/detail/friction_problem.hpp>
#include <palpate/resolved/detail/loads_beside.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/reaction.hpp>
#include <palpate/resolved/detail/regular_gradient.hpp>
#include <palpate/resolved/detail/static_strength.hpp>
#include <palpate/resolved/detail/tick_change.hpp>
#include <palpate/resolved/detail/tool_surface.hpp>
#include <palpate/resolved/detail/touching_points.hpp>
#include <palpate/resolved/elastic_contact.hpp>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace palpate::detail {

/// What a tick leaves for the next: loads at the points, and where those that stick hold the surface.
template <Real S, ContactCompliance Compliance, bool has_friction_, std::size_t max_beside>
class ResolvedState {
 public:
  static constexpr bool has_friction = has_friction_;
  static constexpr bool moves = has_friction || RegularPartOf<Compliance>::type::active;  ///< the surface
  using Force = ElasticContact<S, Compliance>;

  ResolvedState(const Compliance& body, std::size_t tool_points, std::size_t capacity)
      : touching_(tool_points, capacity),
        inside_(capacity),
        contacts_(capacity),
        system_(capacity, static_cast<float>(1 - 2 * body.nu()), has_friction),
        unloaded_(capacity),
        regular_(body, capacity),
        beside_(max_beside, capacity, static_cast<float>(1 - 2 * body.nu())),
        carried_(capacity),
        strain_(body.nu()),
        cones_(body.nu(), capacity),
        sway_(body, capacity),
        gradient_(capacity) {
    const std::size_t padded = AlignedList<float>::padded(capacity);
    last_.resize(padded), pressure_.resize(padded), result_.resize(padded), reaction_.resize(padded);
  }

  void reset() noexcept { contacts_.clear(), forget(), beside_.forget(), touching_.forget(); }
  [[nodiscard]] bool has_contact() const noexcept { return !contacts_.empty(); }
  [[nodiscard]] std::span<const PointContact<S>> contacts() const noexcept {
    return {contacts_.begin(), contacts_.size()};
  }
  /// What the tool feels besides forces at these points [N m].
  [[nodiscard]] Vec3<S> couple() const noexcept
    requires(has_friction)
  {
    return -per_load_ * (reaction_.held() * cones_.couple(reaction_.tractions())).template cast<S>();
  }
  /// The last tick's loads on the body, as many as the list has room for.
  void loads(auto& out) const noexcept {
    out.clear();
    add_loads(out, S(1));
  }
  /// Adds `share` of them.
  void add_loads(auto& out, S share) const noexcept {
    const S per_load = share * per_load_;
    for (std::size_t i = 0, k = 0; i < size() && k < contacts_.size() && !out.full(); ++i) {
      const PointMemory& p = touching_.memory(inside_[i]);
      if (!p.loaded) continue;
      const auto in_S = [](const Vec3<float>& a) -> Vec3<S> { return a.template cast<S>(); };
      const Vec3<float> m = system_.direction(i), sway = m.dot(p.load) * sway_.pull();
      out.push_back({origin() + in_S(carried_.at_rest(system_.foot(i))), in_S(m),
                     per_load * in_S(p.load + sway), static_cast<S>(system_.area(i)),
                     per_load * in_S(strain_.beside(m, m.dot(p.load)) - sway), in_S(strain_.shift()),
                     contacts_[k++].position, in_S(touching_[inside_[i]].outward),
                     share * static_cast<S>(strain_.raised(i, system_, pressure_, regular_))});
    }
  }
  /// Loads of other tools on the same body, for the next solve().
  void set_beside(std::span<const SurfaceLoad<S>> loads) noexcept
    requires(max_beside > 0)
  {
    beside_.set(loads);
  }
  [[nodiscard]] const Residual& residual() const noexcept { return residual_; }
  [[nodiscard]] bool slides() const noexcept { return slides_; }
  /// Of what acts, in contact: what is left out.
  [[nodiscard]] Status left_out() const noexcept {
    return beside_.status() |
           (touching_.has_room() && regular_.has_all() ? Status::ok : Status::point_overflow);
  }
  /// Area that touches [m^2].
  [[nodiscard]] float area(const ToolPoints<S>& tool) noexcept {
    unloaded_.take(touching_);
    return contact_area(system_, pressure_, unloaded_, [&](std::size_t i) noexcept {
      return rounded_rim_pressure(tool, touching_[inside_[i]], system_.b());
    });
  }
  /// TouchingPoints' of those that have been found.
  [[nodiscard]] float effective_points() const noexcept { return touching_.effective_number(); }
  /// Before points are looked for: goes on from the last tick of `other`, the same tool at other points, of
  /// which those that touch in this one have been found; `nearest`: by its points, those to which each is the
  /// nearest.
  void take_over(const ResolvedState& other, const ToolPoints<S>& its, const ToolPoints<S>& tool,
                 const std::vector<std::vector<std::uint32_t>>& nearest) noexcept {
    touching_.take_over(other.touching_, its, tool, nearest);
    contacts_ = other.contacts_, pose_ = other.pose_, slides_ = other.slides_, strength_ = other.strength_;
    regular_.take_over(other.regular_), beside_.take_over(other.beside_);
    carried_ = other.carried_, strain_ = other.strain_, cones_ = other.cones_, sway_ = other.sway_;
    gradient_ = other.gradient_, shift_ = other.shift_, reaction_ = other.reaction_;
  }
  void begin_tick(const ContactSurface auto& object, const Force& force, const ToolPoints<S>& tool,
                  const Pose<S>& X) noexcept {
    per_load_ = static_cast<S>(4 * std::numbers::pi * force.shear_modulus());
    beside_.begin_tick(object, force.compliance(), tool, pose_, X, has_contact(), per_load_, regular_);
    touching_.begin_tick(), system_.begin_tick();
  }
  /// Where the tool at X is over the undeformed surface, which others' loads move.
  [[nodiscard]] Pose<S> over(const Pose<S>& X) const noexcept { return beside_.over(X); }
  /// The regular displacement there; and whether another tick at the same pose would change nothing.
  [[nodiscard]] S shift() const noexcept { return static_cast<S>(shift_.most()); }
  [[nodiscard]] bool has_settled() const noexcept { return shift_.has_settled() && sway_.has_settled(); }
  /// True where nothing touches and the body may have come back in part: look again, `tries` from 1 on.
  [[nodiscard]] bool look_again(int tries) noexcept {
    return touching_.begin_again() && shift_.come_back(tries);
  }
  /// A leaf of the tool's points over the surface as it lay before the body bent and friction carried it.
  [[nodiscard]] PointBatch<S> before(const PointBatch<S>& x) const noexcept {
    return carried_.before(shift_.before(x));
  }
  [[nodiscard]] S most_before() const noexcept { return shift() + static_cast<S>(carried_.most()); }
  /// Tool points from `begin` on, a leaf, over x in object coordinates (before()), are in the body;
  /// `rotation`: of the tool; the first is at `first` where it is. Returns how deep [m].
  S touch(const ToolSurface<S>& surface, std::uint32_t begin, const Mat3<float>& rotation,
          const Vec3<S>& first, const PointBatch<S>& x, const PenetrationBatch<S>& in) noexcept {
    return touching_.add(surface, begin, rotation, x, in, shift_.share_at(first), system_);
  }
  /// After all touch(), where one has returned more than 0.
  void touch_beside_edges(const ContactSurface auto& object, const ToolPoints<S>& tool) noexcept {
    touching_.press_beside_edges(object, tool, system_);
  }
  /// Solves for the loads with the tool at X.
  void solve(const Force& force, const auto& friction, const ToolPoints<S>& tool, const Pose<S>& X) noexcept {
    const bool first = contacts_.empty();
    contacts_.clear(), residual_ = {};
    const Pose<S> before = std::exchange(pose_, X);
    if (touching_.empty()) return forget();
    const float tolerance = static_cast<float>(force.params().tolerance) * touching_.norm_of_depths();
    const Vec3<S>& x = tool.point(touching_[0].point);
    const float moved = first ? 0.f : static_cast<float>((X * x - before * x).norm());
    if constexpr (has_friction) touching_.carry(tool, before, X, reaction_.held(), cones_);
    inside_.clear(), strain_.take_depth(system_.deepest());
    // First those that carry load or came near to it.
    for (std::uint32_t c = 0; c < touching_.size(); ++c) {
      const PointMemory& p = touching_.memory(c);
      if (p.loaded || p.sunk - touching_[c].depth < near * system_.deepest()) inside_.push_back(c);
    }
    bool left_out = false;
    for (int round = 0;; ++round) {
      build(force, tool);
      begin_loads(round == 0
                      ? share_that_goes_on<has_friction>(size(), last_, system_, given(), regular_.moved())
                      : 1.f);
      left_out |= solve_inside(force, friction, tolerance);
      if constexpr (Strain::active)  // of second order, as sway is, of which it knows nothing
        strain_.measure(system_, result_.load, pressure_.q.data(), pressure_.r.data(), regular_.response(),
                        beside_, reaction_.held(), gradient_.stretch());
      const bool again = Strain::active && first && round == 0;  // the strain was not known
      if (round == most_rounds || !take_in(force, tool, tolerance, again, left_out)) break;
    }
    finish(tool, moved);
    beside_.drop();
  }

 private:
  using RegularPart = typename RegularPartOf<Compliance>::type;
  using Strain = std::conditional_t<RegularPart::active, FiniteStrain, LinearStrain>;
  using Cones = std::conditional_t<has_friction, ConesOf<Strain::active>, NoCones>;
  using Shift = std::conditional_t<RegularPart::active, BodyShift<S>, NoBodyShift>;
  using Sway = std::conditional_t<has_friction && RegularPart::active, BodySway, NoBodySway>;
  using Beside = std::conditional_t<(max_beside > 0), LoadsBeside<S>, NoLoadsBeside>;
  static constexpr float near = 0.05f;   // of the depth; with less gap points are solved for at once
  static constexpr int most_rounds = 3;  // in which points may come in within a tick

  [[nodiscard]] std::size_t size() const noexcept { return inside_.size(); }
  void forget() noexcept {
    slides_ = false, strength_ = {}, carried_.clear(origin()), sway_.forget();
    shift_.forget(), gradient_.forget(), beside_.drop();
    if constexpr (has_friction) cones_.forget(), reaction_.forget(), result_.step = 0;
    if constexpr (Strain::active) strain_.forget(), regular_.take_in();
  }
  [[nodiscard]] const Vec3<S>& origin() const noexcept { return touching_.origin(); }
  // Where a load at `foot` acts, seen from afar.
  [[nodiscard]] Vec3<double> acts_at(const Vec3<float>& foot) const noexcept {
    return (origin() + (foot + strain_.shift()).template cast<S>()).template cast<double>();
  }
  [[nodiscard]] GivenDisplacements<Beside, Sway> given() const noexcept { return {beside_, sway_}; }
  [[nodiscard]] PointMemory& point(std::size_t i) noexcept { return touching_.memory(inside_[i]); }
  void build(const Force& force, const ToolPoints<S>& tool) noexcept {
    system_.clear();
    for (const std::uint32_t c : inside_) {
      const TouchingPoint& at = touching_[c];
      system_.add(at.x, at.m, at.depth, static_cast<float>(tool.area(at.point)));
    }
    system_.build();
    for (std::size_t i = 0; i < size(); ++i) {
      if constexpr (Shift::active)
        system_.depth[i] += touching_[inside_[i]].shifted * shift_.deeper(system_.direction(i));
      system_.depth[i] = strain_.depth(system_.depth[i]);
      if constexpr (RegularPart::active) system_.depth[i] -= point(i).held;
      last_.set(i, point(i));
      if constexpr (has_friction && Strain::active) cones_.outward.set(i, touching_[inside_[i]].outward);
    }
    for (std::size_t i = size(); i < system_.stride(); ++i) last_.set(i, {});
    if constexpr (RegularPart::active) {
      regular_.clear();
      regular_.place_points(force.compliance(), acts_at(Vec3<float>::Zero()), system_.feet(), size(),
                            [this](std::size_t i) -> std::uint32_t& { return point(i).triangle; });
    }
    if constexpr (Beside::active) beside_.place(force.compliance(), origin(), per_load_, regular_);
    if constexpr (RegularPart::active) regular_.build();
    if (regular_.is_left_out()) system_.move(regular_.moved());
    if constexpr (Beside::active) beside_.move_points(system_, regular_);
    sway_.displace(system_, last_, regular_);
  }
  Remainder iterate(const auto& friction, float tolerance, int iterations) noexcept {
    if constexpr (!has_friction)
      return solve_pressures(size(), pressure_, system_.depth.data(), tolerance, iterations,
                             [this](const float* q, float* u) noexcept { displace(q, u); });
    else
      return solve_loads(
          size(), result_, system_.directions(), cones_.axes(system_), system_.depth.data(),
          {system_.flexible_step(), system_.tangential_share(),
           system_.common() + regular_.common() - strain_.common()},
          tolerance, iterations, [this](const VectorList& P, VectorList& u) noexcept { displace(P, u); },
          [&](float q) noexcept { return strength_.coefficient(friction, static_cast<S>(q) * per_load_); });
  }
  // Returns whether w, which had moved the surface, has been left out.
  bool solve_inside(const Force& force, const auto& friction, float tolerance) noexcept {
    if constexpr (has_friction && RegularPart::active) regular_.begin_response();
    const Remainder left = iterate(friction, tolerance, force.params().iterations);
    if constexpr (RegularPart::active)
      if (left.is_astray(system_.norm_of_depths()) && regular_.leave_out()) {
        system_.move(regular_.moved());
        begin_loads(0.f);
        const bool had_moved = !regular_.moved().isZero(0);
        if (had_moved) hold(friction);
        (void)solve_inside(force, friction, tolerance);
        return had_moved;
      }
    complete(system_.stride(), system_.directions(), system_.depth.data(), pressure_, result_);
    if constexpr (!has_friction && RegularPart::active) regular_.respond(result_.load);
    if constexpr (RegularPart::active) residual_.near_field_only = regular_.is_left_out();
    residual_.iterations += left.iterations;
    residual_.relative = left.norm * static_cast<float>(force.params().tolerance) / left.tolerance;
    return false;
  }
  // Without w its slope, too, is gone: points go on with their loads, or as far out as these leave them.
  void hold(const auto& friction) noexcept {
    (void)iterate(friction, 0, 0);
    complete(system_.stride(), system_.directions(), system_.depth.data(), pressure_, result_);
    for (std::size_t i = 0; i < size(); ++i)
      system_.depth[i] -= point(i).held =
          point(i).loaded ? -pressure_.r[i] : (std::max)(system_.depth[i], 0.f);
  }
  void displace(const auto& loads, auto&& u) noexcept {
    system_.displace(loads, u);
    if constexpr (RegularPart::active) regular_.add(system_, loads, u);
    if constexpr (has_friction && Strain::active)
      strain_.add(system_, loads, u), cones_.twist.add(system_, loads, u);
  }
  void begin_loads(float share) noexcept {
    begin_with<has_friction>(system_, last_, share, given(), regular_.moved(), pressure_, result_);
    if constexpr (has_friction)
      cones_.place(system_, pressure_.q.data(), origin(), gradient_.slope(), reaction_.passes(), result_);
  }
  /// Takes in points that the surface has not given way to, or holds them where they are: w was `left_out` in
  /// this tick. False where none came in, and not `again`.
  bool take_in(const Force& force, const ToolPoints<S>& tool, float tolerance, bool again,
               bool left_out) noexcept {
    const std::size_t n = size();
    std::size_t next = 0;
    bool more = again;
    const bool none_loaded = !(std::reduce(pressure_.q.data(), pressure_.q.data() + n) > 0);
    for (std::uint32_t c = 0; c < touching_.size(); ++c) {
      if (next < n && inside_[next] == c) {
        ++next;
        continue;
      }
      const TouchingPoint& at = touching_[c];
      PointMemory& p = touching_.memory(c);
      // Gaps change little in a tick: each is looked at in every eighth, but where no other point is left.
      if ((touching_.tick() + at.point) % 8 != 0 && !none_loaded && !left_out) continue;
      const Vec3<float> m = system_.direction_at(at.x, at.m);
      float depth = at.depth / m.dot(at.m);
      const Vec3<float> foot = at.x - depth * m;
      depth += at.shifted * shift_.deeper(m);
      float gap = system_.normal_displacement_at(pressure_.q.data(), foot, m,
                                                 static_cast<float>(tool.area(at.point))) -
                  strain_.depth(depth) + p.held;
      if constexpr (Beside::active) gap += m.dot(beside_.displacement_at(foot, m) - beside_.v());
      if constexpr (RegularPart::active)
        gap += regular_.normal_at(force.compliance(), acts_at(foot), p.triangle, m);
      p.sunk = gap + at.depth;
      if (!(gap < -tolerance / 10)) continue;
      if (left_out)
        p.held -= gap;
      else
        inside_.push_back(c), more = true;  // sorted below; as many as touching_ at most
    }
    if (!more) return false;
    for (std::size_t i = 0; i < n; ++i)
      point(i).load_step = result_.load[i] - point(i).load;  // the next round's begin
    std::sort(inside_.begin(), inside_.end());
    return true;
  }
  void finish(const ToolPoints<S>& tool, [[maybe_unused]] float moved) noexcept {
    const Vec3<float> v = shift_.v();
    if constexpr (RegularPart::active) {
      gradient_.measure(system_, pressure_.q.data(), regular_.response(), v, given(), touching_, tool);
      regular_.keep(pressure_.q.data());
      if (!regular_.is_left_out())
        shift_.measure(system_, pressure_.q.data(), regular_.response(), gradient_.arc(), origin(), moved);
    }
    if constexpr (!has_friction) reaction_.measure(system_, pressure_.q, gradient_);
    if constexpr (has_friction)
      reaction_.measure(system_, cones_.axes(system_), pressure_.q, result_, given(), regular_.moved());
    carried_.clear(origin());
    for (std::size_t i = 0; i < size(); ++i) {
      const TouchingPoint& at = touching_[inside_[i]];
      PointMemory& p = point(i);
      const float q = pressure_.q[i];
      p.go_on(result_.load[i], result_.u[i]);
      p.sunk = pressure_.r[i] + at.depth;
      p.loaded = q > 0, p.sticks = false;
      if (!p.loaded) continue;
      if constexpr (has_friction) {
        p.sticks = reaction_.sticks(i), p.anchor = reaction_.anchor(i);
        const Vec3<float> m = system_.direction(i);
        const Vec3<float> a = p.anchor - m.dot(p.anchor) * m;
        carried_.add(at.point / static_cast<std::uint32_t>(batch_size), at.x, q,
                     beside_.own(shift_.own(a, m, at.shifted), m), m,
                     static_cast<float>(tool.area(at.point)));
      }
      contacts_.push_back({at.point, p.sticks, pose_ * tool.point(at.point), -at.m.template cast<S>(),
                           -per_load_ * reaction_.felt(result_, i).template cast<S>(),
                           per_load_ * static_cast<S>(q) / tool.area(at.point),
                           static_cast<S>(at.depth + at.shifted * at.m.dot(v))});
    }
    if constexpr (has_friction) {
      carried_.build();
      if (!regular_.is_left_out())
        sway_.measure(system_, pressure_.q.data(), result_.load, regular_, given(), acts_at({0, 0, 0}));
      slides_ = strength_.remember(reaction_.total(), reaction_.sticking(), system_, pressure_, result_);
    }
  }

  TouchingPoints<S> touching_;
  BoundedList<std::uint32_t> inside_;  // of touching_, rising: those that are solved for
  BoundedList<PointContact<S>> contacts_;
  PointSystem system_;
  MemoryLists last_;  // of those that are solved for
  Unloaded unloaded_;
  PressureLists pressure_;
  std::conditional_t<has_friction, FrictionLists, LoadLists> result_;
  Reaction<has_friction> reaction_;
  PALPATE_NO_UNIQUE_ADDRESS RegularPart regular_;
  PALPATE_NO_UNIQUE_ADDRESS Beside beside_;
  PALPATE_NO_UNIQUE_ADDRESS std::conditional_t<has_friction, CarriedSurface<S>, StillSurface> carried_;
  PALPATE_NO_UNIQUE_ADDRESS Strain strain_;
  PALPATE_NO_UNIQUE_ADDRESS Cones cones_;
  PALPATE_NO_UNIQUE_ADDRESS Sway sway_;
  PALPATE_NO_UNIQUE_ADDRESS GradientOf<RegularPart, has_friction> gradient_;
  PALPATE_NO_UNIQUE_ADDRESS Shift shift_;
  Residual residual_;
  Pose<S> pose_;
  S per_load_ = 0;  // 4 pi mu [Pa]
  bool slides_ = false;
  PALPATE_NO_UNIQUE_ADDRESS std::conditional_t<has_friction, StaticStrength, Absent<6>> strength_;

 public:
  std::uint32_t id = 0;  ///< of the contact: another one after each lift-off
};

}  // namespace palpate::detail
