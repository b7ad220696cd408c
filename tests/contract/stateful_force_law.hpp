// SPDX-License-Identifier: MIT
#pragma once

/// @file  What every force law with memory must keep (law/force/concept.hpp), run on an example of each
/// policy.
///
/// An example is a type with
///     static constexpr double depth;     // a depth [m] at which the law is well in its range
///     static constexpr double time;      // the time [s] in which its state changes
///     static constexpr bool curved;      // whether a tick takes the law's force as straight
///     template <class T> static Law<T> make();

#include "support/check.hpp"

#include <palpate/law/force/concept.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

namespace palpate::test {

/// A force law with memory of whatever type, so that the suite is compiled once for all of them.
template <Real S>
struct AnyStatefulLaw {
  /// A state of whatever type, as a value.
  struct State {
    alignas(long double) std::array<std::byte, 256> bytes{};
  };
  struct Part {
    State state;
    S depth, share;
  };
  virtual ~AnyStatefulLaw() = default;
  [[nodiscard]] virtual S force(S depth) const = 0;
  [[nodiscard]] virtual S stiffness(S depth) const = 0;
  [[nodiscard]] virtual S energy(S depth) const = 0;
  [[nodiscard]] virtual S depth(S force) const = 0;
  [[nodiscard]] virtual State fresh() const = 0;
  [[nodiscard]] virtual State advance(const State& state, S depth, S dt) const = 0;
  [[nodiscard]] virtual S force(S depth, const State& state) const = 0;
  [[nodiscard]] virtual S stiffness(S depth, const State& state) const = 0;
  [[nodiscard]] virtual S energy(S depth, const State& state) const = 0;
  [[nodiscard]] virtual S depth(S force, const State& state) const = 0;
  [[nodiscard]] virtual bool has_carried() const = 0;
  /// Of two parts. Precondition: has_carried().
  [[nodiscard]] virtual State carried(const std::array<Part, 2>& parts, S depth) const = 0;
};

template <StatefulForceLaw Law, Real S = typename Law::Scalar>
class StatefulLaw final : public AnyStatefulLaw<S> {
 public:
  using State = typename AnyStatefulLaw<S>::State;
  explicit StatefulLaw(Law law) : law_(std::move(law)) {}
  S force(S depth) const override { return law_.force(depth); }
  S stiffness(S depth) const override { return law_.stiffness(depth); }
  S energy(S depth) const override { return law_.energy(depth); }
  S depth(S force) const override { return law_.depth(force); }
  State fresh() const override { return wrapped({}); }
  State advance(const State& state, S depth, S dt) const override {
    return wrapped(law_.advance(own(state), depth, dt));
  }
  S force(S depth, const State& state) const override { return law_.force(depth, own(state)); }
  S stiffness(S depth, const State& state) const override { return law_.stiffness(depth, own(state)); }
  S energy(S depth, const State& state) const override { return law_.energy(depth, own(state)); }
  S depth(S force, const State& state) const override { return law_.depth(force, own(state)); }
  bool has_carried() const override { return HasCarried<Law>; }
  State carried([[maybe_unused]] const std::array<typename AnyStatefulLaw<S>::Part, 2>& parts,
                [[maybe_unused]] S depth) const override {
    if constexpr (HasCarried<Law>) {
      const CarriedState<Law> of[] = {{own(parts[0].state), parts[0].depth, parts[0].share},
                                      {own(parts[1].state), parts[1].depth, parts[1].share}};
      return wrapped(law_.carried(of, depth));
    }
    return {};
  }

 private:
  using Own = typename Law::State;
  static_assert(std::is_trivially_copyable_v<Own> && sizeof(Own) <= sizeof(State));
  static State wrapped(const Own& state) {
    State out;
    std::memcpy(out.bytes.data(), &state, sizeof state);
    return out;
  }
  static Own own(const State& state) {
    Own out{};
    std::memcpy(&out, state.bytes.data(), sizeof out);
    return out;
  }
  Law law_;
};

/// The suite, of a law and the same one in long double.
template <Real S>
struct StatefulForceLawSuite {
  using State = typename AnyStatefulLaw<S>::State;

  const AnyStatefulLaw<S>& law;
  const AnyStatefulLaw<long double>& exact;
  double whole_depth, whole_time;  // of the example
  bool curved;
  S most = static_cast<S>(whole_depth), time = static_cast<S>(whole_time);

  void run() const {
    never_touched();
    bad_input();
    ends_of_the_range();
    queries_of_a_state();
    without_contact_only_time_counts();
    never_gains();
    halved();
    continuous();
  }

  /// Corners of a path of the depth: in and out, held, out of contact; the same for every scalar.
  struct Corner {
    double depth, time;  // [m] reached after so long [s]
  };
  [[nodiscard]] std::vector<Corner> path(unsigned seed, int corners) const {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<Corner> all;
    double last = 0;
    for (int i = 0; i < corners; ++i) {
      const double kind = share(random);
      // A quarter of the corners out of contact, a sixth held. Depths rounded to float: the same number in
      // all.
      if (kind > 0.25 && kind < 0.42) {
      } else {
        last = kind < 0.25 ? 0 : whole_depth * share(random);
      }
      const double reached = static_cast<double>(static_cast<float>(last));
      // From ticks far shorter than the law's time to ticks far longer.
      all.push_back({reached, whole_time * std::pow(10.0, -2 + 3 * share(random))});
      last = reached;
    }
    return all;
  }

  void never_touched() const {
    const State fresh = law.fresh();
    for (const S depth : {S(0), -S(0), S(-1e-3), -std::numeric_limits<S>::infinity()}) {
      CHECK(law.force(depth, fresh) == S(0));
      CHECK(law.stiffness(depth, fresh) == S(0));
      CHECK(law.energy(depth, fresh) == S(0));
    }
    for (int i = 1; i <= 100; ++i) {  // nothing is added to these numbers and 0, so the bits are the law's
      const S depth = most * S(i) / S(100);
      CHECK(law.force(depth, fresh) == law.force(depth));
      CHECK(law.stiffness(depth, fresh) == law.stiffness(depth));
      CHECK(law.energy(depth, fresh) == law.energy(depth));
      CHECK(law.depth(law.force(depth), fresh) == law.depth(law.force(depth)));
    }
    CHECK(law.depth(S(0), fresh) == S(0));
  }

  // After anything at all, a good depth gives a finite force, and no depth none.
  void bad_input() const {
    const S nan = std::numeric_limits<S>::quiet_NaN(), infinity = std::numeric_limits<S>::infinity();
    State state = law.advance(law.fresh(), most, time);
    for (const S depth : {nan, infinity, -infinity, S(0), most}) {
      for (const S dt : {nan, infinity, -infinity, S(0), S(-1), (std::numeric_limits<S>::max)(), time}) {
        state = law.advance(state, depth, dt);
        CHECK(is_finite(law.force(most, state)));
        CHECK(is_finite(law.energy(most, state)));
        CHECK(is_finite(law.depth(S(0), state)));
        CHECK(law.force(nan, state) == S(0));
        CHECK(law.force(S(0), state) == S(0));
      }
    }
  }

  // At depths up to the largest number and to infinity, in the state of a good depth: numbers that do not
  // fall. After such a depth a good one gives a number again; so does what is carried to or from it.
  void ends_of_the_range() const {
    using L = std::numeric_limits<S>;
    std::vector<S> deep;
    for (int e = -20; e < L::max_exponent; ++e) deep.push_back(std::ldexp(S(1), e));
    deep.insert(deep.end(), {(L::max)() / S(2), (L::max)(), L::infinity()});
    const State pressed = law.advance(law.fresh(), most, time);
    S before = S(0), energy = S(0), reached = S(0);
    int bad = 0;  // a NaN makes every comparison false
    const auto numbers = [&](const State& state) {
      for (const S depth : {most, L::infinity()})
        bad += !(law.force(depth, state) >= S(0)) + !(law.energy(depth, state) >= S(0)) +
               !(law.stiffness(depth, state) >= S(0)) + !(law.depth(depth, state) >= S(0));
    };
    for (const S x : deep) {
      const S force = law.force(x, pressed), D = law.depth(x, pressed), U = law.energy(x, pressed);
      bad += !(force >= before) + !(law.stiffness(x, pressed) >= S(0)) + !(D >= reached * (S(1) - ulps_of));
      bad += x > most && !(U >= energy * (S(1) - ulps_of));
      before = force;
      energy = U;
      reached = D;
      State after = law.advance(pressed, x, time);
      numbers(after);
      after = law.advance(after, most, time);
      numbers(after);
      if (!law.has_carried()) continue;
      for (const S from : {most, x})
        for (const S to : {L::denorm_min(), most, x})
          numbers(law.carried({{{after, from, S(0.5)}, {pressed, L::denorm_min(), S(0.5)}}}, to));
    }
    CHECK(bad == 0);
  }
  static constexpr S ulps_of = S(64) * std::numeric_limits<S>::epsilon();

  // Along a path: F against long double; the tangent is its derivative and the energy its integral at a
  // constant state; the inverse; no force at the depth of no force and above.
  void queries_of_a_state() const {
    State state = law.fresh();
    auto reference = exact.fresh();
    // Each tick rounds a few times what the next one starts from.
    const long double unit = ulps<S>(2000);
    const long double full = exact.force(static_cast<long double>(most));
    for (const Corner& corner : path(20050613, 400)) {
      const S depth = static_cast<S>(corner.depth), dt = static_cast<S>(corner.time);
      state = law.advance(state, depth, dt);
      reference = exact.advance(reference, static_cast<long double>(depth), static_cast<long double>(dt));
      CHECK_ABSOLUTE(law.force(depth, state), exact.force(static_cast<long double>(depth), reference),
                     unit * full);
      const S none = law.depth(S(0), state);
      CHECK(law.force(none, state) <= static_cast<S>(unit * full));
      CHECK(law.force(none / S(2), state) == S(0));
      for (const double share : {0.3, 0.7, 1.0}) {
        const auto D = static_cast<long double>(most * static_cast<S>(share));
        if (exact.force(D * 0.99L, reference) <= 0) continue;
        const long double h = 1e-3L * D;
        const auto central = [&](const auto& f, long double s) { return (f(D + s) - f(D - s)) / (2 * s); };
        const auto slope = [&](const auto& f) { return (4 * central(f, h / 2) - central(f, h)) / 3; };
        const auto F = [&](long double x) { return exact.force(x, reference); };
        const auto U = [&](long double x) { return exact.energy(x, reference); };
        // Two step widths: h^4 of smooth laws, 1e-12; the scale as in the suite of laws without memory.
        const long double scale = exact.stiffness(D, reference) + F(D) / D;
        CHECK_ABSOLUTE(exact.stiffness(D, reference), slope(F), 1e-10L * scale);
        CHECK_ABSOLUTE(F(D), slope(U), 1e-10L * full);
        CHECK_ABSOLUTE(law.stiffness(static_cast<S>(D), state), exact.stiffness(D, reference), unit * scale);
        CHECK_ABSOLUTE(law.depth(law.force(static_cast<S>(D), state), state), D,
                       unit * (full / exact.stiffness(D, reference)));
      }
    }
  }

  void without_contact_only_time_counts() const {
    const State before = law.advance(law.advance(law.fresh(), most, time), most, time);
    const State at_zero = law.advance(before, S(0), time);
    for (const S depth :
         {-S(0), S(-1), std::numeric_limits<S>::quiet_NaN(), -std::numeric_limits<S>::infinity()}) {
      const State other = law.advance(before, depth, time);
      CHECK(law.force(most, other) == law.force(most, at_zero));
      CHECK(law.energy(most, other) == law.energy(most, at_zero));
    }
  }

  // Over random paths the work done on the body is never below what it stores, tick by tick; and a closed
  // path gives nothing back.
  void never_gains() const {
    constexpr int steps = 400;
    double least = 1, gross = 0, store = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
      State state = law.fresh();
      S depth = S(0), force = S(0);
      double work = 0, energy = 0;
      for (const Corner& corner : path(seed, 60)) {
        const S from = depth, to = static_cast<S>(corner.depth);
        for (int i = 1; i <= steps; ++i) {
          const S next = from + (to - from) * S(i) / S(steps);
          state = law.advance(state, next, static_cast<S>(corner.time) / S(steps));
          const S now = law.force(next, state);
          const double done = 0.5 * (static_cast<double>(force) + static_cast<double>(now)) *
                              static_cast<double>(next - depth);  // trapezoid
          const double stored = static_cast<double>(law.energy(next, state));
          least = (std::min)(least, (work + done) - stored - (work - energy));
          work += done;
          gross += std::abs(done);
          store = (std::max)(store, stored);
          energy = stored;
          depth = next;
          force = now;
        }
      }
      CHECK(work >= 0);
    }
    // Of one tick: where F has a kink within it (yield, contact lost) the trapezoid is off by up to dF dD/8
    // and the free body by as much, some (1/steps)^2 of the store; and the store's own rounding.
    CHECK(least >= -store * static_cast<double>(4.0L / (steps * steps) + ulps<S>(16)));
    CHECK(gross > 0);
  }

  // A tick is as good as two of half the time: where the law's force runs straight, to rounding; else within
  // what its middle lies off that line, since no part of it counts more than once.
  void halved() const {
    State state = law.fresh();
    S last = S(0);
    bool touching = true;  // a fresh body is met where it begins
    int compared = 0;
    const auto full = static_cast<long double>(law.force(most));
    for (const Corner& corner : path(7, 2000)) {
      const S depth = static_cast<S>(corner.depth), dt = static_cast<S>(corner.time),
              middle = last + (depth - last) / S(2);
      const State whole = law.advance(state, depth, dt);
      const State first = law.advance(state, middle, dt / S(2));
      const State half = law.advance(first, depth, dt / S(2));
      const bool stays = law.force(middle, first) > S(0) && law.force(depth, half) > S(0);
      if (touching && stays &&
          law.force(depth, whole) > S(0)) {  // what meets or loses contact does so within a tick
        const S sagitta = std::abs(law.force(middle) - (law.force(last) + law.force(depth)) / S(2));
        CHECK_ABSOLUTE(law.force(depth, half), law.force(depth, whole),
                       (curved ? static_cast<long double>(sagitta) : 0) + ulps<S>(64) * full);
        ++compared;
      }
      touching = law.force(depth, whole) > S(0);
      state = whole;
      last = depth;
    }
    CHECK(compared > 100);
  }

  // A path cut into steps of 1e-4: no step of F is above the law's greatest stiffness times the motion, and
  // what time does in a tick.
  void continuous() const {
    State state = law.fresh();
    S depth = S(0), force = S(0), worst = S(0);
    const S stiffest = (std::max)(law.stiffness(most), law.force(most) / most);
    for (const Corner& corner : path(11, 100)) {
      const S from = depth, to = static_cast<S>(corner.depth);
      for (int i = 1; i <= 10000; i += 1) {
        depth = from + (to - from) * S(i) / S(10000);
        state = law.advance(state, depth, time * S(1e-4));
        const S now = law.force(depth, state);
        worst = (std::max)(worst, std::abs(now - force) - stiffest * std::abs(to - from) * S(1e-4));
        force = now;
      }
    }
    CHECK(worst <= law.force(most) * (S(1e-4) + static_cast<S>(ulps<S>(200))));
  }
};

template <class Example, Real S>
void check_stateful_force_law() {
  const StatefulLaw law(Example::template make<S>());
  const StatefulLaw exact(Example::template make<long double>());
  StatefulForceLawSuite<S>{law, exact, Example::depth, Example::time, Example::curved}.run();
}

}  // namespace palpate::test
