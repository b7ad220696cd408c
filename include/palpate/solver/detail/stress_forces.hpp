// SPDX-License-Identifier: MIT
#pragma once

/// @file What a coupling passes on from region to region beside their own forces (VI), bounded.

#include <palpate/contact/contact_state.hpp>
#include <palpate/contact/coupling.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/solver/tick_result.hpp>

#include <array>

namespace palpate::detail {

/// Adds to each region's force, and to the wrench, what the other regions pass on through the body: at most
/// as much as the region's own, so that it never pulls, and then `Status::stress_bounded`. Torques are about
/// `centre_of_mass` [m].
template <WrenchPolicy Acting, PassesForces Coupling, Real S, std::size_t N>
inline void pass_on(const Coupling& coupling, const Vec3<S>& centre_of_mass,
                    FixedVector<ContactState<S>, N>& contacts, TickResult<S>& result) noexcept {
  if (contacts.size() < 2) return;
  std::array<typename Coupling::Contact, N> loaded;
  for (std::size_t j = 0; j < contacts.size(); ++j) {
    const ContactState<S>& c = contacts[j];
    loaded[j] = {c.origin(), -c.force, c.displacement, c.normal_force};
  }
  typename Coupling::Result passed_on;
  coupling.share({loaded.data(), contacts.size()}, passed_on);
  for (std::size_t j = 0; j < passed_on.from_others.size(); ++j) {
    Vec3<S> f = passed_on.from_others[j];
    const S own = contacts[j].force.norm(), passed = f.norm();
    if (passed > own) {
      f *= own / passed;
      result.status |= Status::stress_bounded;
    }
    contacts[j].force += f;
    result.wrench.force += f;
    if constexpr (std::same_as<Acting, AtContact>)
      result.wrench.torque += (contacts[j].centre - centre_of_mass).cross(f);
  }
}

}  // namespace palpate::detail
