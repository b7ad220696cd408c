// SPDX-License-Identifier: MIT
#pragma once

/// @file One servo tick, from the tool's pose to the wrench on it. Only here do all rooms of the force meet;
/// the include list is the data flow.

// clang-format off
#include <palpate/core/pose.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/absent.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/detection/tool_points.hpp>
#include <palpate/contact/topology.hpp>
#include <palpate/contact/coupling.hpp>
#include <palpate/law/friction/none.hpp>
#include <palpate/contact/region_sum.hpp>
#include <palpate/law/friction/anchor.hpp>
#include <palpate/contact/contact_state.hpp>
#include <palpate/law/map/concept.hpp>
#include <palpate/solver/detail/gather.hpp>
// clang-format on

#include <algorithm>
#include <array>
#include <concepts>
#include <span>
#include <type_traits>
#include <utility>

namespace palpate {

/// Where the contact force acts on the tool.
struct AtContact {};     ///< at the pressure centre: the wrench has a torque about the centre of mass (6 DOF)
struct AtMassCentre {};  ///< at the centre of mass, the paper's assumption (section II): no torque

template <class W>
concept WrenchPolicy = std::same_as<W, AtContact> || std::same_as<W, AtMassCentre>;

/// What a tick returns. The regions behind it: ContactSolver::contacts().
template <Real S>
struct TickResult {
  Wrench<S> wrench;  ///< on the tool, object coordinates: force [N], torque about its centre of mass [N m]
  Status status;
};

/// Contact of a rigid tool with an elastic object: sections II to IV of [luo2005], one tick at a time.
///
/// | role      | parameter  | ships                                               | default              |
/// |-----------|------------|-----------------------------------------------------|----------------------|
/// | object    | `Object`   | the surfaces of geometry/concept.hpp                |                      |
/// | force law | `Force`    | the laws of law/force/concept.hpp, maps of law/map/ |                      |
/// | friction  | `Friction` | Frictionless, CoulombFriction, PowerLawFriction     | `Frictionless`       |
/// | regions   | `Contacts` | SinglePoint, SingleRegion, Regions<N>               | `SinglePoint`        |
/// | wrench    | `Acting`   | AtContact, AtMassCentre                             | `AtContact`          |
/// | coupling  | `Coupling` | IndependentRegions, RegionSkeletons (section VI)    | `IndependentRegions` |
///
/// Slip and skew rules belong to the friction law, mass sharing to the topology. An absent policy is a type
/// and costs no byte and no instruction.
///
/// Real time: tick() is noexcept, takes no heap, lock or I/O, and its time is bounded by the tool's points.
/// Same poses, same bits. From the third tick on at one pose the last result stands and nothing is worked
/// out. A pose that is not finite or not a rotation gives the zero wrench and `Status::invalid_pose`; contact
/// is forgotten and begins anew at the next usable pose.
template <ContactSurface Object, ForceModel Force,
          FrictionLaw Friction = Frictionless<typename Object::Scalar>, Topology Contacts = SinglePoint,
          WrenchPolicy Acting = AtContact,
          RegionForceCoupling<typename Object::Scalar> Coupling = IndependentRegions>
  requires std::same_as<typename Object::Scalar, typename Force::Scalar> &&
           std::same_as<typename Object::Scalar, typename Friction::Scalar>
class ContactSolver {
 public:
  using Scalar = typename Object::Scalar;
  using S = Scalar;
  using Tool = typename Contacts::template Tool<S>;
  static constexpr std::size_t max_regions = Contacts::max_regions;
  static constexpr bool has_friction = Friction::active;
  static constexpr bool is_rate_dependent = RateDependentForceLaw<Force>;

  /// What a solver is made of. Each part has checked itself when it was made.
  struct Parts {
    Object object;
    Tool tool;
    Force force;
    PALPATE_NO_UNIQUE_ADDRESS Friction friction{};
    PALPATE_NO_UNIQUE_ADDRESS Contacts contacts{};
    PALPATE_NO_UNIQUE_ADDRESS Coupling coupling{};
  };

  /// @throws SetupError where the clustering distance of `Regions` is not positive, or joins too many points.
  explicit ContactSolver(Parts parts)
      : object_(std::move(parts.object)),
        tool_(std::move(parts.tool)),
        force_(std::move(parts.force)),
        friction_(std::move(parts.friction)),
        coupling_(std::move(parts.coupling)),
        collector_(parts.contacts, tool_) {}

  /// One tick with the tool at X (tool to object coordinates).
  [[nodiscard]] TickResult<S> tick(const Pose<S>& X) noexcept
    requires(!is_rate_dependent)
  {
    return step(X, S(0), Status::ok);
  }

  /// One tick, dt [s] after the last. Only rate-dependent force laws use dt; if it is not finite or not > 0
  /// the rate terms are left out of this tick (`Status::invalid_step`).
  [[nodiscard]] TickResult<S> tick(const Pose<S>& X, [[maybe_unused]] S dt) noexcept {
    if constexpr (is_rate_dependent) {
      if (!is_finite(dt) || !(dt > S(0))) return step(X, S(0), Status::invalid_step);
    }
    return step(X, dt, Status::ok);
  }

  /// The regions of the last tick: values to hand over, record or draw.
  [[nodiscard]] std::span<const ContactState<S>> contacts() const noexcept {
    return {contacts_.begin(), contacts_.size()};
  }

  /// p0 of a contact: the origin of its deformation, on the undeformed surface [m].
  [[nodiscard]] Vec3<S> origin(const ContactState<S>& contact) const noexcept {
    return object_.closest(contact.origin()).position;
  }

  /// Forgets all contact, as after a calibration of the device.
  void reset() noexcept {
    contacts_.clear();
    collector_.reset();
    last_.ticks = 0;
  }

  [[nodiscard]] const Object& object() const noexcept { return object_; }
  /// For objects that follow a deformation (geometry/deformed_surface.hpp): the next tick is worked out anew.
  [[nodiscard]] Object& mutable_object() noexcept {
    last_.ticks = (std::min)(last_.ticks, 1);
    return object_;
  }
  [[nodiscard]] const Tool& tool() const noexcept { return tool_; }
  [[nodiscard]] const Force& force_law() const noexcept { return force_; }
  [[nodiscard]] const Friction& friction_law() const noexcept { return friction_; }

 private:
  using Sum = typename Collector<Contacts, S>::template Sum<Force>;
  using Sums = std::array<Sum, max_regions>;

  struct Memory {  // what friction remembers of a region
    Anchor<S> anchor;
    Vec3<S> friction;  // of the last tick [N]
    S depth;           // D_n of the last tick [m]
  };
  struct Last {
    Pose<S> pose;
    TickResult<S> result{};
    int ticks = 0;  // in a row at this pose, up to 2; 0: none yet
  };
  template <class Item, int Role, bool present>
  using Present = std::conditional_t<present, Item, Absent<Role>>;

  TickResult<S> step(const Pose<S>& X, [[maybe_unused]] S dt, Status status) noexcept {
    // The second tick at a pose settles what the motion into it left (slip, rate); after that nothing
    // changes.
    const bool again = last_.ticks > 0 && same_bits(X, last_.pose);
    if (again && last_.ticks > 1) return {last_.result.wrench, last_.result.status | status};
    if (!is_usable(X)) {
      reset();
      return {{}, status | Status::invalid_pose};
    }
    TickResult<S> result;
    if constexpr (std::same_as<Contacts, SinglePoint>)
      result = in_contact(X, dt);  // a call would be 3 % of its instructions
    else
      result = contact_at(X, dt);
    if (!is_finite(result.wrench.force) || !is_finite(result.wrench.torque)) {
      reset();
      return {{}, result.status | status | Status::non_finite_result};
    }
    last_ = {X, result, again ? 2 : 1};
    return {result.wrench, result.status | status};
  }

  TickResult<S> contact_at(const Pose<S>& X, S dt) noexcept;

  TickResult<S> in_contact(const Pose<S>& X, [[maybe_unused]] S dt) noexcept {
    contacts_.clear();
    Sums sums;
    TickResult<S> result{{}, collector_.collect(object_, tool_, force_, X, sums)};
    if (!has(result.status, Status::contact)) return result;
    if constexpr (has_friction && ClusteredTopology<Contacts>) {
      if (collector_.changed()) inherit(X, sums);
    }
    for (std::size_t k = 0; k < max_regions; ++k) {
      if (collector_.slot(k).active) press(k, sums[k], X, dt, result.wrench);
    }
    if constexpr (Coupling::active) couple(X, result.wrench);
    return result;
  }

  /// One region: equivalent contact, rate term, friction; adds its force to the wrench.
  void press(std::size_t k, Sum& sum, const Pose<S>& X, [[maybe_unused]] S dt, Wrench<S>& wrench) noexcept {
    const RegionSlot& slot = collector_.slot(k);
    const Vec3<S> normal = sum.normal();
    S normal_force = sum.normal_force();
    const S depth = equivalent_depth(sum, normal_force);
    if constexpr (is_rate_dependent) {
      if (dt > S(0) && last_.ticks > 0 && normal_force > (std::numeric_limits<S>::min)()) {
        // How fast the tool's point at the pressure centre goes in. Differences of depths would jump when
        // regions merge.
        const Vec3<S> centre = sum.centre();
        const S gone_in = normal.dot(last_.pose * X.to_tool(centre) - centre);
        const S rate = (std::min)(gone_in, sum.deepest) / dt;  // no deeper than it came
        const S total = (std::max)(normal_force + (force_.force(depth, rate) - force_.force(depth)), S(0));
        sum.scale(total / normal_force);
        normal_force = total;
      }
    }
    ContactState<S> contact{slot.id,         sum.points, ContactMode::frictionless, sum.centre(), normal,
                            -depth * normal, sum.force,  Vec3<S>::Zero(),           normal_force, sum.area(),
                            sum.deepest};
    if constexpr (has_friction) {
      Memory& memory = memory_[k];
      if (slot.merged == 0 && slot.parent == RegionSlot::none) {
        memory.anchor = Anchor<S>::begin(X, contact.centre, normal, depth);
      }
      const AnchoredForce<S> anchored = advance<typename Friction::Slip, typename Friction::Skew>(
          memory.anchor, friction_, detail::law_at(force_, contact.centre), X, normal, contact.centre, depth,
          normal_force);
      if (anchored.normal_force != normal_force && normal_force > S(0))
        sum.scale(anchored.normal_force / normal_force);
      memory.friction = anchored.friction;
      memory.depth = depth;
      contact.mode = memory.anchor.slip.sliding ? ContactMode::sliding : ContactMode::sticking;
      contact.centre = anchored.at;
      contact.displacement += anchored.stretch;
      contact.friction = anchored.friction;
      contact.force = sum.force + anchored.friction;
      contact.normal_force = anchored.normal_force;
      if constexpr (std::same_as<Acting, AtContact>) {
        wrench.torque += (anchored.at - X * centre_of_mass()).cross(anchored.friction);
      }
    }
    wrench.force += contact.force;
    if constexpr (std::same_as<Acting, AtContact>) wrench.torque += sum.torque;
    contacts_.push_back(contact);
  }

  /// Section VI: adds to each region's force what the other regions pass on through the body.
  void couple(const Pose<S>& X, Wrench<S>& wrench) noexcept
    requires(Coupling::active)
  {
    if (contacts_.size() < 2) return;
    std::array<typename Coupling::Contact, max_regions> loaded;
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      const ContactState<S>& c = contacts_[j];
      loaded[j] = {c.origin(), -c.force, c.displacement, c.normal_force};
    }
    coupling_.share({loaded.data(), contacts_.size()}, passed_on_);
    for (std::size_t j = 0; j < passed_on_.from_others.size(); ++j) {
      const Vec3<S>& f = passed_on_.from_others[j];
      contacts_[j].force += f;
      wrench.force += f;
      if constexpr (std::same_as<Acting, AtContact>) {
        wrench.torque += (contacts_[j].centre - X * centre_of_mass()).cross(f);
      }
    }
  }

  /// D_n of the point contact with the same force (IV.C); a single point is its own.
  [[nodiscard]] S equivalent_depth(const Sum& sum, S normal_force) const noexcept {
    if constexpr (std::same_as<Contacts, SinglePoint>) {
      return sum.deepest;
    } else {
      return detail::law_at(force_, sum.centre()).depth(normal_force);
    }
  }

  [[nodiscard]] Vec3<S> centre_of_mass() const noexcept {
    if constexpr (std::same_as<Contacts, SinglePoint>) {
      return tool_.centre_of_mass;
    } else {
      return tool_.centre_of_mass();
    }
  }

  /// Carries friction over when regions merge or split: each region takes the share of every predecessor's
  /// tangential force and elastic energy that its normal force is of all of that predecessor's successors; so
  /// the sum of the forces is kept and no energy is added.
  void inherit(const Pose<S>& X, const Sums& sums) noexcept
    requires(has_friction && ClusteredTopology<Contacts>)
  {
    using Skew = typename Friction::Skew;
    const std::array<Memory, max_regions> last = memory_;
    std::array<S, max_regions> share{};  // of the predecessors' total normal force
    std::array<int, max_regions> heirs{};
    for (std::size_t p = 0; p < max_regions; ++p) {
      for (std::size_t k = 0; k < max_regions; ++k) {
        if (!collector_.slot(k).inherits(p)) continue;
        share[p] += sums[k].magnitude;
        ++heirs[p];
      }
    }
    for (std::size_t k = 0; k < max_regions; ++k) {
      const RegionSlot& slot = collector_.slot(k);
      if (!slot.active || (slot.merged == std::uint64_t(1) << k && heirs[k] == 1))
        continue;  // lives on unchanged
      Vec3<S> friction = Vec3<S>::Zero(), point_T = Vec3<S>::Zero(), tip = Vec3<S>::Zero(),
              normal = Vec3<S>::Zero();
      S weight = S(0), strength = S(1), energy = S(0);
      bool sliding = false;
      for (std::size_t p = 0; p < max_regions; ++p) {
        if (!slot.inherits(p) || !(share[p] > S(0))) continue;
        const Anchor<S>& before = last[p].anchor;
        const S fraction = sums[k].magnitude / share[p];
        const S w =
            fraction * last[p].friction.norm() + std::numeric_limits<S>::epsilon() * sums[k].magnitude;
        friction += fraction * last[p].friction;
        point_T += w * before.point_T;
        tip += w * before.tip;
        normal += w * before.normal;
        weight += w;
        const S stretched = tangential<S>(before.tip - before.origin, before.normal).norm();
        energy += fraction * before.slip.springs *
                  Skew::energy(detail::law_at(force_, before.tip), last[p].depth, stretched);
        strength = (std::max)(strength, before.slip.strength);
        sliding = sliding || before.slip.sliding;
      }
      Anchor<S>& anchor = memory_[k].anchor;
      const auto& law = detail::law_at(force_, sums[k].centre());
      const S normal_force = sums[k].normal_force();
      const S depth = law.depth(normal_force);
      if (!(weight > S(0))) {  // new, or from regions without force
        anchor = Anchor<S>::begin(X, sums[k].centre(), sums[k].normal(), depth);
        continue;
      }
      anchor.point_T = point_T / weight;
      anchor.tip = tip / weight;
      // A normal across the force keeps all of it where regions on both sides of an edge merge; slips turn it
      // back.
      const Vec3<S> along = unit_or<S>(friction, Vec3<S>::Zero());
      const S carried = friction.norm();
      anchor.normal =
          unit_or<S>(tangential<S>(unit_or<S>(normal, sums[k].normal()), along), perpendicular<S>(along));
      // A merged region's limit may be below the sum of its parts' (beta < 1): the excess wears off with
      // travel.
      const S limit = sliding ? friction_.sliding_limit(normal_force) : friction_.static_limit(normal_force);
      if (limit > S(0))
        strength = (std::max)(strength, (std::min)(carried / limit, S(1) / (std::numeric_limits<S>::min)()));
      anchor.slip = {sliding, strength};
      const S stretch = carried_stretch<Skew>(law, depth, carried, energy, anchor.slip);
      anchor.slip.slid = stretch;
      anchor.origin = anchor.tip + stretch * along + depth * anchor.normal;
    }
  }

  Object object_;
  Tool tool_;
  Force force_;
  PALPATE_NO_UNIQUE_ADDRESS Friction friction_;
  PALPATE_NO_UNIQUE_ADDRESS Coupling coupling_;
  PALPATE_NO_UNIQUE_ADDRESS typename Coupling::Result passed_on_{};
  Collector<Contacts, S> collector_;
  Last last_{};
  PALPATE_NO_UNIQUE_ADDRESS Present<std::array<Memory, max_regions>, 0, has_friction> memory_{};
  FixedVector<ContactState<S>, max_regions> contacts_;
};

// Outside the class, so that a solver that is instantiated explicitly elsewhere (`extern template`) is not
// compiled again: compilers do so with functions that are inline.
template <ContactSurface Object, ForceModel Force, FrictionLaw Friction, Topology Contacts,
          WrenchPolicy Acting, RegionForceCoupling<typename Object::Scalar> Coupling>
  requires std::same_as<typename Object::Scalar, typename Force::Scalar> &&
           std::same_as<typename Object::Scalar, typename Friction::Scalar>
TickResult<typename Object::Scalar>
ContactSolver<Object, Force, Friction, Contacts, Acting, Coupling>::contact_at(
    const Pose<typename Object::Scalar>& X, typename Object::Scalar dt) noexcept {
  return in_contact(X, dt);
}

}  // namespace palpate
