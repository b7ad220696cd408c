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
#include <palpate/elasticity/none.hpp>
#include <palpate/contact/topology.hpp>
#include <palpate/contact/coupling.hpp>
#include <palpate/law/friction/none.hpp>
#include <palpate/contact/region_sum.hpp>
#include <palpate/law/friction/anchor.hpp>
#include <palpate/contact/contact_state.hpp>
#include <palpate/law/map/concept.hpp>
#include <palpate/solver/tick_result.hpp>
#include <palpate/solver/rate_window.hpp>
#include <palpate/solver/detail/gather.hpp>
#include <palpate/solver/detail/resolve_adaptive.hpp>
#include <palpate/solver/detail/stress_forces.hpp>
#include <palpate/solver/detail/tick_memory.hpp>
// clang-format on

#include <algorithm>
#include <array>
#include <concepts>
#include <span>
#include <type_traits>
#include <utility>

namespace palpate {

/// Contact of a rigid tool with an elastic object: sections II to VI of [luo2005], one tick at a time.
///
/// | role      | parameter     | ships                                               | default              |
/// |-----------|---------------|-----------------------------------------------------|----------------------|
/// | object    | `Object`      | the surfaces of geometry/concept.hpp                |                      |
/// | force law | `Force`       | the laws of law/force/concept.hpp, maps of law/map/ |                      |
/// | friction  | `Friction`    | Frictionless, CoulombFriction, PowerLawFriction     | `Frictionless`       |
/// | regions   | `Contacts`    | SinglePoint, SingleRegion, Regions<N>               | `SinglePoint`        |
/// | shape     | `Deformation` | the models of elasticity/concept.hpp                | `NoDeformation`      |
/// | wrench    | `Acting`      | AtContact, AtMassCentre                             | `AtContact`          |
/// | coupling  | `Coupling`    | the couplings of contact/coupling.hpp (section VI)  | the deformation's    |
///
/// Slip and skew rules belong to the friction law, sharing to the topology. An absent policy costs nothing.
///
/// Real time: tick(), evaluate() and draw() are noexcept, take no heap, lock or I/O, and a tick's time is
/// bounded by the tool's points. Same poses, same bits. From the third tick on at one pose the last result
/// stands and nothing is worked out. A pose that is not finite or not a rotation gives the zero wrench and
/// `Status::invalid_pose`; contact is forgotten and begins anew at the next usable pose.
///
/// Threads: one thread ticks, another may draw, with contacts that were handed over (device/): a tick does
/// not touch the deformation's vertices, and draw() touches nothing else. evaluate() changes only the state
/// it is given, so that several threads, or an integrator that goes back in time, may share one solver.
template <ContactSurface Object, ForceModel Force,
          FrictionLaw Friction = Frictionless<typename Object::Scalar>, Topology Contacts = SinglePoint,
          DeformationModel Deformation = NoDeformation<typename Object::Scalar>,
          WrenchPolicy Acting = AtContact,
          RegionForceCoupling<typename Object::Scalar> Coupling = DefaultCoupling<Deformation>>
  requires std::same_as<typename Object::Scalar, typename Force::Scalar> &&
           std::same_as<typename Object::Scalar, typename Friction::Scalar> &&
           std::same_as<typename Object::Scalar, typename Deformation::Scalar> &&
           (ElasticForceModel<Force> == ResolvedTopology<Contacts>)
class ContactSolver {
 public:
  using Scalar = typename Object::Scalar;
  using S = Scalar;
  using Tool = typename Contacts::template Tool<S>;
  static constexpr std::size_t max_regions = Contacts::max_regions;
  static constexpr bool has_friction = Friction::active;
  static constexpr bool is_rate_dependent = RateDependentForceLaw<Force>;
  static constexpr bool has_memory = StatefulForceLaw<Force>;
  static constexpr bool is_resolved = ResolvedTopology<Contacts>;
  static constexpr bool resists_twist =
      !is_resolved && detail::Twists<Friction, Contacts, std::same_as<Acting, AtContact>>::value;

  /// What a solver is made of. Each part has checked itself when it was made.
  struct Parts {
    Object object;
    Tool tool;
    Force force;
    PALPATE_NO_UNIQUE_ADDRESS Friction friction{};
    PALPATE_NO_UNIQUE_ADDRESS Contacts contacts{};
    PALPATE_NO_UNIQUE_ADDRESS Deformation deformation{};
    PALPATE_NO_UNIQUE_ADDRESS Coupling coupling{};
    PALPATE_NO_UNIQUE_ADDRESS detail::Present<RateWindow<S>, 3, is_rate_dependent> rate{};
  };

  using Gather = typename detail::CollectorOf<Contacts, S, Coupling, Force, has_friction>::type;

  /// What a tick leaves for the next one: a value, made by initial_state(). A copy goes on from the same
  /// tick. Copies among the states of one solver take no heap; with one region its size is fixed.
  class State : private detail::TickMemory<S, typename Gather::State, Force, has_friction && !is_resolved,
                                           resists_twist, max_regions> {
   public:
    /// The regions of the last tick: values to hand over, record or draw.
    [[nodiscard]] std::span<const ContactState<S>> contacts() const noexcept {
      return {this->contacts_.begin(), this->contacts_.size()};
    }
    using State::TickMemory::loads;     ///< of a resolved contact, to a list: what a shape is drawn from
    using State::TickMemory::points;    ///< likewise: forces at the tool's points
    using State::TickMemory::residual;  ///< what its conditions lack after the last tick
    /// `Contacts::max_beside` > 0: loads() of other tools on this body, for the next tick, kept until then.
    using State::TickMemory::refresh;  ///< object or laws are others now: the next tick is worked out anew
    using State::TickMemory::set_beside;
    /// Forgets all contact, as after a calibration of the device, and what laws with memory remember.
    void reset() noexcept { this->forget(); }

   private:
    friend class ContactSolver;
    using State::TickMemory::TickMemory;
  };

  /// @throws SetupError where the clustering distance of `Regions` is not positive, or joins too many points.
  explicit ContactSolver(Parts parts)
      : object_(std::move(parts.object)),
        tool_(std::move(parts.tool)),
        force_(std::move(parts.force)),
        friction_(std::move(parts.friction)),
        deformation_(std::move(parts.deformation)),
        coupling_(std::move(parts.coupling)),
        rate_(parts.rate),
        collector_(parts.contacts, tool_, detail::for_collector<Gather>(force_, coupling_)),
        state_(initial_state()) {
    if constexpr (is_rate_dependent) detail::check(rate_);
  }

  /// One tick with the tool at X (tool to object coordinates).
  [[nodiscard]] TickResult<S> tick(const Pose<S>& X) noexcept
    requires(!is_rate_dependent && !has_memory)
  {
    return step(X, S(0), Status::ok, state_);
  }

  /// One tick, dt [s] after the last. Force laws with a rate term or memory use dt; if it is not finite or
  /// not > 0 the rate terms are left out of this tick (`Status::invalid_step`).
  [[nodiscard]] TickResult<S> tick(const Pose<S>& X, S dt) noexcept { return evaluate(X, dt, state_); }

  /// A tick from a state of the caller's, which becomes that after the tick: trial steps, going back in time.
  [[nodiscard]] TickResult<S> evaluate(const Pose<S>& X, [[maybe_unused]] S dt, State& state) const noexcept {
    if constexpr (is_rate_dependent || has_memory) {
      if (!is_finite(dt) || !(dt > S(0))) return step(X, S(0), Status::invalid_step, state);
    }
    return step(X, dt, Status::ok, state);
  }

  /// A tick of a moving object: `tool` and `object` map their coordinates to world coordinates.
  [[nodiscard]] WorldResult<S> tick(const Pose<S>& tool, const Pose<S>& object, S dt) noexcept {
    return evaluate(tool, object, dt, state_);
  }
  [[nodiscard]] WorldResult<S> evaluate(const Pose<S>& tool, const Pose<S>& object, S dt,
                                        State& state) const noexcept {
    if (!is_usable(object)) {
      state.reset();
      return {{}, {}, Status::invalid_pose};
    }
    const TickResult<S> result = evaluate(relative(tool, object), dt, state);
    WorldResult<S> world{rotated(object.rotation, result.wrench), {}, result.status};
    const Vec3<S> arm = tool * centre_of_mass() - object.translation;
    world.object = {-world.tool.force, -world.tool.torque - arm.cross(world.tool.force)};
    return world;
  }

  /// Before any contact. Takes heap where the topology clusters.
  [[nodiscard]] State initial_state() const { return State(collector_.initial_state()); }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  void set_beside(const auto& loads) noexcept { state_.set_beside(loads); }  ///< of the solver's own state
  /// The next tick goes on from `state`, one of this solver's.
  void restore(const State& state) noexcept { state_ = state; }

  /// The regions of the last tick: values to hand over, record or draw.
  [[nodiscard]] std::span<const ContactState<S>> contacts() const noexcept { return state_.contacts(); }
  /// p0 of a contact: the origin of its deformation, on the undeformed surface [m].
  [[nodiscard]] Vec3<S> origin(const ContactState<S>& contact) const noexcept {
    return object_.closest(contact.origin()).position;
  }

  /// Forgets all contact, as after a calibration of the device.
  void reset() noexcept { state_.reset(); }
  /// Writes what moved since the last call under these contacts (or loads), of any tick and from any thread.
  template <Real T>
  Moved<S> draw(std::span<const DrawnBy<Deformation>> contacts, const VertexBuffer<T>& out) noexcept
    requires(Deformation::active)
  {
    return deformation_.write(contacts, out);
  }
  /// Writes the undeformed shape into a fresh buffer; the next draw() starts from it.
  template <Real T>
  void draw_rest(const VertexBuffer<T>& out) noexcept
    requires(Deformation::active)
  {
    deformation_.write_rest(out);
  }

  /// Other parameters from the next tick on. The force changes at once: WrenchRamp takes the kick out of it.
  /// States of the caller's are to be refreshed. A resolved contact keeps its body.
  void set_force_law(const Force& force) noexcept
    requires(!is_resolved)
  {
    force_ = force;
    state_.refresh();
  }
  void set_friction_law(const Friction& friction) noexcept {
    friction_ = friction;
    state_.refresh();
  }

  [[nodiscard]] const Object& object() const noexcept { return object_; }
  /// For objects that follow a deformation (geometry/deformed_surface.hpp): the next tick is worked out anew.
  [[nodiscard]] Object& mutable_object() noexcept {
    state_.refresh();
    return object_;
  }
  [[nodiscard]] const Tool& tool() const noexcept { return tool_; }
  /// Of the tool, in its coordinates [m].
  [[nodiscard]] Vec3<S> centre_of_mass() const noexcept {
    if constexpr (std::same_as<Contacts, SinglePoint>) {
      return tool_.centre_of_mass;
    } else {
      return tool_.centre_of_mass();
    }
  }
  [[nodiscard]] const Force& force_law() const noexcept { return force_; }
  [[nodiscard]] const Friction& friction_law() const noexcept { return friction_; }
  [[nodiscard]] const Deformation& deformation() const noexcept { return deformation_; }

 private:
  using Sum = typename Gather::template Sum<Force>;
  static constexpr bool is_relieved = std::derived_from<Sum, detail::RelievedSum<S>>;

  TickResult<S> step(const Pose<S>& X, [[maybe_unused]] S dt, Status status, State& state) const noexcept {
    // The second tick at a pose settles what the motion into it left (slip, rate); later ones change nothing.
    auto& last = state.last_;
    const bool again = last.ticks > 0 && same_bits(X, last.pose);
    bool settled = again && last.ticks > 1 && !has_memory;
    if constexpr (is_rate_dependent) settled = settled && state.poses_.at_rest(rate_);
    if (settled) return {last.result.wrench, last.result.status | status};
    if (!is_usable(X)) {
      state.forget_contact();
      if constexpr (has_memory) detail::add_dents(force_, state.regions_, state.law_, state.contacts_);
      return {{}, status | Status::invalid_pose};
    }
    TickResult<S> result;
    if constexpr (std::same_as<Contacts, SinglePoint>)
      result = in_contact(X, dt, state);  // a call would be 3 % of its instructions
    else
      result = contact_at(X, dt, state);
    if constexpr (has_memory) detail::add_dents(force_, state.regions_, state.law_, state.contacts_);
    if (!is_finite(result.wrench.force) || !is_finite(result.wrench.torque)) {
      state.reset();
      return {{}, result.status | status | Status::non_finite_result};
    }
    last = {X, result, again && detail::has_settled(state.regions_) ? 2 : 1};
    return {result.wrench, result.status | status};
  }

  TickResult<S> contact_at(const Pose<S>& X, S dt, State& state) const noexcept;

  TickResult<S> in_contact(const Pose<S>& X, [[maybe_unused]] S dt, State& state) const noexcept {
    state.contacts_.clear();
    TickResult<S> result;
    if constexpr (is_resolved)
      collector_.resolve(object_, tool_, force_, friction_, X, Acting{}, state.regions_, state.contacts_,
                         result);
    else
      add_regions(X, dt, state, result);
    return result;
  }

  void add_regions(const Pose<S>& X, [[maybe_unused]] S dt, State& state,
                   TickResult<S>& result) const noexcept {
    if constexpr (is_rate_dependent) state.poses_.push(X, dt);
    detail::TickSums<Sum, max_regions> found;
    if constexpr (has_memory) {
      result.status = detail::collect_and_remember(collector_, object_, tool_, force_, X, dt, state.regions_,
                                                   state.law_, found);
    } else {
      result.status = collector_.collect(object_, tool_, force_, X, state.regions_, found);
    }
    if (!has(result.status, Status::contact)) return;
    auto& sums = found.list();
    if constexpr (has_friction && ClusteredTopology<Contacts>) {
      if (state.regions_.changed())
        detail::inherit(friction_, force_, state.regions_, sums, X, state.last_.pose.rotation, state.memory_);
    }
    for (std::size_t k = 0; k < max_regions; ++k) {
      if (state.regions_.slot(k).active) press(k, sums[k], X, dt, state, result.wrench);
    }
    if constexpr (detail::PassesForces<Coupling>)
      detail::pass_on<Acting>(coupling_, Vec3<S>(X * centre_of_mass()), state.contacts_, result);
  }

  /// One region: equivalent contact, rate term, friction; adds its force to the wrench.
  void press(std::size_t k, Sum& sum, const Pose<S>& X, [[maybe_unused]] S dt, State& state,
             Wrench<S>& wrench) const noexcept {
    const RegionSlot& slot = state.regions_.slot(k);
    const Vec3<S> normal = sum.normal();
    S normal_force = sum.normal_force();
    const S depth = equivalent_depth(k, sum, normal_force, state);
    if constexpr (is_rate_dependent) {
      if (dt > S(0) && normal_force > (std::numeric_limits<S>::min)()) {
        // Of the tool's point at the pressure centre. Differences of depths would jump when regions merge.
        const S gone_in = state.poses_.rate(X.to_tool(sum.centre()), normal, rate_);
        const S rate = (std::min)(gone_in, sum.deepest / dt);  // no deeper than it came
        S total = (std::max)(normal_force + (force_.force(depth, rate) - force_.force(depth)), S(0));
        // A finite force has a finite square, of which areas are made: in next to no time it may have none.
        if (!is_finite(total * total)) total = std::numeric_limits<S>::infinity();
        sum.scale(total / normal_force);
        normal_force = total;
      }
    }
    ContactState<S> contact{slot.id,         sum.points, ContactMode::frictionless, sum.centre(), normal,
                            -depth * normal, sum.force,  Vec3<S>::Zero(),           normal_force, sum.area(),
                            sum.deepest};
    if constexpr (is_relieved) {
      contact.dent = equivalent_depth(k, sum, sum.full_normal_force(), state) - depth;
      contact.displacement -= contact.dent * normal;
    }
    if constexpr (has_friction) {
      auto& memory = state.memory_[k];
      if (slot.merged == 0 && slot.parent == RegionSlot::none) {
        memory.anchor = Anchor<S>::begin(X, contact.centre, normal, depth);
        if constexpr (resists_twist) memory.twist.release(X.rotation);
      }
      const auto& law = detail::law_at(force_, contact.centre);
      const auto disc = [&] { return detail::disc_of(law, sum, normal_force, detail::skew_of(friction_)); };
      const AnchoredForce<S> anchored = advance(memory.anchor, friction_, law, X, normal, contact.centre,
                                                depth, normal_force, memory.twist, disc);
      if (anchored.normal_force != normal_force && normal_force > S(0))
        sum.scale(anchored.normal_force / normal_force);
      memory.friction = anchored.friction, memory.normal_force = anchored.normal_force;
      memory.depth = depth;
      contact.mode = memory.anchor.slip.sliding ? ContactMode::sliding : ContactMode::sticking;
      contact.centre = anchored.at;
      contact.displacement += anchored.stretch;
      contact.friction = anchored.friction;
      contact.force = sum.force + anchored.friction;
      contact.normal_force = anchored.normal_force;
      if constexpr (std::same_as<Acting, AtContact>) {
        wrench.torque += (anchored.at - X * centre_of_mass()).cross(anchored.friction);
        if constexpr (resists_twist) wrench.torque += memory.twist.torque;
      }
    }
    contact.depth = sum.depth_below(contact.origin(), normal);
    wrench.force += contact.force;
    if constexpr (std::same_as<Acting, AtContact>) wrench.torque += sum.torque;
    if constexpr (is_relieved) {
      // Within another's dent it does not touch; side walls that are left may still push.
      if (!(sum.magnitude > S(0)) && sum.full > S(0) && contact.force == Vec3<S>::Zero()) {
        if constexpr (has_memory) detail::add_dent(force_, state.law_[k], state.contacts_);
        return;
      }
    }
    state.contacts_.push_back(contact);
  }

  /// D_n of the point contact with the same force (IV.C); a single point is its own.
  [[nodiscard]] S equivalent_depth([[maybe_unused]] std::size_t k, const Sum& sum, S normal_force,
                                   [[maybe_unused]] const State& state) const noexcept {
    if constexpr (has_memory) {
      return force_.depth(normal_force, state.law_[k].state);
    } else if constexpr (std::same_as<Contacts, SinglePoint>) {
      return sum.deepest;
    } else {
      return detail::law_at(force_, sum.centre()).depth(normal_force);
    }
  }

  Object object_;
  Tool tool_;
  Force force_;
  PALPATE_NO_UNIQUE_ADDRESS Friction friction_;
  PALPATE_NO_UNIQUE_ADDRESS Deformation deformation_;
  PALPATE_NO_UNIQUE_ADDRESS Coupling coupling_;
  PALPATE_NO_UNIQUE_ADDRESS detail::Present<RateWindow<S>, 3, is_rate_dependent> rate_;
  Gather collector_;
  State state_;
};

// Outside the class, so that a solver that is instantiated explicitly elsewhere (`extern template`) is not
// compiled again: compilers do so with functions that are inline.
template <ContactSurface Object, ForceModel Force, FrictionLaw Friction, Topology Contacts,
          DeformationModel Deformation, WrenchPolicy Acting,
          RegionForceCoupling<typename Object::Scalar> Coupling>
  requires std::same_as<typename Object::Scalar, typename Force::Scalar> &&
           std::same_as<typename Object::Scalar, typename Friction::Scalar> &&
           std::same_as<typename Object::Scalar, typename Deformation::Scalar> &&
           (ElasticForceModel<Force> == ResolvedTopology<Contacts>)
auto ContactSolver<Object, Force, Friction, Contacts, Deformation, Acting, Coupling>::contact_at(
    const Pose<S>& X, S dt, State& state) const noexcept -> TickResult<S> {
  return in_contact(X, dt, state);
}

}  // namespace palpate
