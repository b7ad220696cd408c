// SPDX-License-Identifier: MIT
#pragma once

/// @file From the tool's pose to the loads of a resolved contact, and to what the solver returns of it.

#include <palpate/contact/contact_state.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/resolved/contact_points.hpp>
#include <palpate/resolved/detail/resolved_state.hpp>
#include <palpate/resolved/detail/tool_surface.hpp>
#include <palpate/resolved/elastic_contact.hpp>
#include <palpate/solver/detail/gather.hpp>
#include <palpate/solver/detail/point_on_body.hpp>
#include <palpate/solver/tick_result.hpp>

namespace palpate::detail {

template <ResolvedTopology Contacts, Real S, class Force, bool has_friction>
class ResolvedCollector {
 public:
  ResolvedCollector(const Contacts&, const ToolPoints<S>& tool, const Force& force)
      : body_(force.compliance()), tool_points_(tool.size()), surface_(tool) {}

  using Body = typename Force::Compliance;
  using State = ResolvedState<S, Body, has_friction, Contacts::max_beside>;
  template <class>
  using Sum = NoMap;  // there is no sum by a law
  [[nodiscard]] State initial_state() const { return State(body_, tool_points_, Contacts::max_points); }

  void resolve(const ContactSurface auto& object, const ToolPoints<S>& tool, const Force& force,
               const auto& friction, const Pose<S>& X, const auto& acting, State& state,
               FixedVector<ContactState<S>, 1>& contacts, TickResult<S>& result) const noexcept {
    const S deepest = find(object, tool, force, X, state);
    solve(object, tool, force, friction, X, acting, deepest, state, contacts, result);
  }
  /// Points that are beneath the surface. Returns how deep [m].
  S find(const ContactSurface auto& object, const ToolPoints<S>& tool, const Force& force, const Pose<S>& X,
         State& state) const noexcept {
    state.begin_tick(object, force, tool, X);
    const Mat3<float> rotation = X.rotation.template cast<float>();
    S deepest = S(0);
    const Pose<S> over = state.over(X);
    const auto touch = [&](std::uint32_t begin, const PointBatch<S>& x,
                           const PenetrationBatch<S>& in) noexcept {
      deepest = (std::max)(deepest, state.touch(surface_, begin, rotation, over * tool.point(begin), x, in));
    };
    int looks = 0;
    do {
      if constexpr (State::moves) {
        const auto before = [&](const PointBatch<S>& x) noexcept { return state.before(x); };
        for_each_touching_leaf(tool, over, object, touch, before, state.most_before());
      } else {
        for_each_touching_leaf(tool, over, object, touch);
      }
    } while (state.look_again(++looks));
    if (deepest > 0) state.touch_beside_edges(object, tool);
    return deepest;
  }
  /// The loads at them.
  template <class Acting>
  void solve(const ContactSurface auto& object, const ToolPoints<S>& tool, const Force& force,
             const auto& friction, const Pose<S>& X, const Acting&, S deepest, State& state,
             FixedVector<ContactState<S>, 1>& contacts, TickResult<S>& result) const noexcept {
    result.status = Status::ok;
    const S shift = state.shift();  // of this tick: solve() leaves the next one's
    const bool was_touching = state.has_contact();
    state.solve(force, friction, tool, X);
    if (!state.has_contact()) return;
    result.status |= Status::contact | state.left_out();
    if (deepest > object.reach()) result.status |= Status::beyond_reach;
    if (!(state.residual().relative <= S(10) * static_cast<S>(force.params().tolerance)))
      result.status |= Status::unconverged;
    if (state.residual().near_field_only) result.status |= Status::near_field_only;
    if (!was_touching) ++state.id;
    contacts.push_back(summed(tool, X, Acting{}, state, deepest + shift, result.wrench));
  }

 private:
  /// The contact as one: the point contact with the same force and energy.
  template <class Acting>
  [[nodiscard]] static ContactState<S> summed(const ToolPoints<S>& tool, const Pose<S>& X, const Acting&,
                                              State& state, S deepest, Wrench<S>& wrench) noexcept {
    const Vec3<S> mass_centre = X * tool.centre_of_mass();
    ContactState<S> out{};
    Vec3<S> normal = Vec3<S>::Zero(), friction = Vec3<S>::Zero(), centre = Vec3<S>::Zero();
    S pressed = S(0), work = S(0);
    for (const PointContact<S>& c : state.contacts()) {
      const S fn = c.force.dot(c.normal);
      wrench.force += c.force;
      if constexpr (std::same_as<Acting, AtContact>)
        wrench.torque += (c.position - mass_centre).cross(c.force);
      normal += fn * c.normal;
      friction += c.force - fn * c.normal;
      centre += fn * c.position;
      pressed += fn;
      work += fn * c.depth;
      ++out.points;
    }
    if constexpr (State::has_friction && std::same_as<Acting, AtContact>) wrench.torque += state.couple();
    out.id = state.id;
    out.area = static_cast<S>(state.area(tool));
    out.mode = !State::has_friction ? ContactMode::frictionless
               : state.slides()     ? ContactMode::sliding
                                    : ContactMode::sticking;
    out.centre = centre / pressed;
    out.normal = normal.normalized();
    out.displacement = -(work / pressed) * out.normal;
    out.force = wrench.force;
    out.friction = friction;
    out.normal_force = normal.norm();
    out.depth = deepest;
    return out;
  }

  Body body_;
  std::size_t tool_points_;
  ToolSurface<S> surface_;
};

/// What finds and adds up contacts, by topology.
template <Topology Contacts, Real S, class Coupling, class Force, bool has_friction>
struct CollectorOf {
  using type = Collector<Contacts, S, Coupling>;
};
template <Real S, class Coupling, ForceModel Force, bool has_friction>
  requires HasBodyDisplacement<typename LawOf<Force>::Law>
struct CollectorOf<SinglePoint, S, Coupling, Force, has_friction> {
  using type = PointOnBody<S, Coupling>;
};
template <ResolvedTopology Contacts, Real S, class Coupling, class Force, bool has_friction>
struct CollectorOf<Contacts, S, Coupling, Force, has_friction> {
  using type = ResolvedCollector<Contacts, S, Force, has_friction>;
};

/// False where a resolved contact has not come to rest after two ticks at a pose.
[[nodiscard]] inline bool has_settled(const auto& state) noexcept {
  if constexpr (requires { state.has_settled(); })
    return state.has_settled();
  else
    return true;
}

/// A collector that resolves asks the force model, one that does not the coupling.
template <class Gather>
[[nodiscard]] inline const auto& for_collector(const auto& force, const auto& coupling) noexcept {
  if constexpr (requires { typename Gather::Body; })
    return force;
  else
    return coupling;
}

}  // namespace palpate::detail
