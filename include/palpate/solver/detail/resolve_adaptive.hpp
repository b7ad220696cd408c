// SPDX-License-Identifier: MIT
#pragma once

/// @file From the tool's pose to the loads of a resolved contact at points of two spacings.

#include <palpate/resolved/detail/adaptive_state.hpp>
#include <palpate/solver/detail/resolve.hpp>

namespace palpate::detail {

template <AdaptiveTopology Contacts, Real S, class Force, bool has_friction>
class AdaptiveCollector {
  using Each = ResolvedCollector<Contacts, S, Force, has_friction>;

 public:
  AdaptiveCollector(const Contacts& contacts, const AdaptiveTool<S>& tool, const Force& force)
      : coarse_(contacts, tool.coarse(), force), fine_(contacts, tool.fine(), force) {}

  using Body = typename Force::Compliance;
  using State = AdaptiveState<Contacts, S, typename Each::State>;
  template <class>
  using Sum = NoMap;  // there is no sum by a law
  [[nodiscard]] State initial_state() const { return {coarse_.initial_state(), fine_.initial_state()}; }

  void resolve(const ContactSurface auto& object, const AdaptiveTool<S>& tool, const Force& force,
               const auto& friction, const Pose<S>& X, const auto& acting, State& state,
               FixedVector<ContactState<S>, 1>& contacts, TickResult<S>& result) const noexcept {
    FixedVector<ContactState<S>, 1> by_fine;
    TickResult<S> fine;
    const bool looks_fine = state.has_fine();
    const S found = looks_fine ? fine_.find(object, tool.fine(), force, X, state.fine())
                               : coarse_.find(object, tool.coarse(), force, X, state.coarse());
    state.choose(tool);
    if (state.has_coarse()) {
      const S deepest = looks_fine ? coarse_.find(object, tool.coarse(), force, X, state.coarse()) : found;
      coarse_.solve(object, tool.coarse(), force, friction, X, acting, deepest, state.coarse(), contacts,
                    result);
    }
    if (state.has_fine()) {
      const S deepest = looks_fine ? found : fine_.find(object, tool.fine(), force, X, state.fine());
      fine_.solve(object, tool.fine(), force, friction, X, acting, deepest, state.fine(), by_fine, fine);
    }
    state.add_up(tool);
    const S share = state.share();
    if (!(share < S(1))) {
      result = fine, contacts = by_fine;
    } else if (share > S(0)) {
      result = {mixed(result.wrench, fine.wrench, share), result.status | fine.status};
      if (contacts.empty() && !by_fine.empty()) contacts.push_back(unloaded(by_fine[0]));
      if (!contacts.empty())
        contacts[0] = mixed(contacts[0], by_fine.empty() ? unloaded(contacts[0]) : by_fine[0], share);
    }
    for (ContactState<S>& contact : contacts) contact.id = state.id;
  }

 private:
  static void mix(auto& a, const auto& b, S share) noexcept { a += share * (b - a); }
  [[nodiscard]] static Wrench<S> mixed(Wrench<S> a, const Wrench<S>& b, S share) noexcept {
    mix(a.force, b.force, share), mix(a.torque, b.torque, share);
    return a;
  }
  [[nodiscard]] static ContactState<S> unloaded(ContactState<S> a) noexcept {
    a.points = 0, a.normal_force = S(0);
    a.force.setZero(), a.friction.setZero();
    return a;
  }
  [[nodiscard]] static ContactState<S> mixed(ContactState<S> a, const ContactState<S>& b, S share) noexcept {
    if (share > S(0.5)) a.mode = b.mode;
    a.points += b.points;
    for (const auto part : {&ContactState<S>::centre, &ContactState<S>::displacement, &ContactState<S>::force,
                            &ContactState<S>::friction, &ContactState<S>::normal})
      mix(a.*part, b.*part, share);
    for (const auto part : {&ContactState<S>::normal_force, &ContactState<S>::area, &ContactState<S>::depth})
      mix(a.*part, b.*part, share);
    a.normal.normalize();
    return a;
  }

  Each coarse_, fine_;
};

template <AdaptiveTopology Contacts, Real S, class Coupling, class Force, bool has_friction>
struct CollectorOf<Contacts, S, Coupling, Force, has_friction> {
  using type = AdaptiveCollector<Contacts, S, Force, has_friction>;
};

}  // namespace palpate::detail
