// SPDX-License-Identifier: MIT
#pragma once

/// @file What a tick of adaptive points leaves for the next: a resolved contact of either spacing.

#include <palpate/contact/surface_load.hpp>
#include <palpate/resolved/adaptive_contact_points.hpp>
#include <palpate/resolved/detail/bounded_list.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace palpate::detail {

/// Both contacts, of which one or both go on in a tick, and the fine one's share (AdaptiveContactPoints).
/// `Resolved`: ResolvedState.
template <AdaptiveTopology Contacts, Real S, class Resolved>
class AdaptiveState {
 public:
  AdaptiveState(Resolved coarse, Resolved fine)
      : coarse_(std::move(coarse)), fine_(std::move(fine)), contacts_(2 * Contacts::max_points) {}

  [[nodiscard]] Resolved& coarse() noexcept { return coarse_; }
  [[nodiscard]] Resolved& fine() noexcept { return fine_; }
  /// Which go on in this tick, after choose(); before it, in the last one. One of them does.
  [[nodiscard]] bool has_coarse() const noexcept { return has_coarse_; }
  [[nodiscard]] bool has_fine() const noexcept { return has_fine_; }
  /// Of the load, what the fine points carry: 0 to 1.
  [[nodiscard]] S share() const noexcept { return share_; }

  void reset() noexcept {
    coarse_.reset(), fine_.reset(), contacts_.clear();
    share_ = S(1), has_fine_ = true, has_coarse_ = has_contact_ = false;
  }
  /// When points have been looked for, the fine ones if they went on in the last tick, else the coarse ones.
  void choose(const AdaptiveTool<S>& tool) noexcept {
    // A contact goes on for longer than it would begin, and begins before it carries load: n is not quite the
    // same by fine points and by coarse ones.
    constexpr float fine_begins = 1.08f * Contacts::all_coarse, fine_ends = 1.15f * Contacts::all_coarse,
                    coarse_begins = 0.9f * Contacts::all_fine, coarse_ends = 0.8f * Contacts::all_fine;
    const float per_coarse =
                    static_cast<float>(tool.coarse().size()) / static_cast<float>(tool.fine().size()),
                n = has_fine_ ? per_coarse * fine_.effective_points() : coarse_.effective_points();
    const S t = static_cast<S>(
        std::clamp((Contacts::all_coarse - n) / (Contacts::all_coarse - Contacts::all_fine), 0.f, 1.f));
    share_ = t * t * (S(3) - S(2) * t);
    const bool had_fine = std::exchange(has_fine_, n < (has_fine_ ? fine_ends : fine_begins));
    const bool had_coarse = std::exchange(has_coarse_, n > (has_coarse_ ? coarse_ends : coarse_begins));
    if (has_fine_ && !had_fine) fine_.take_over(coarse_, tool.coarse(), tool.fine(), tool.fine_at());
    if (has_coarse_ && !had_coarse) coarse_.take_over(fine_, tool.fine(), tool.coarse(), tool.coarse_at());
    if (!has_fine_ && had_fine) fine_.reset();
    if (!has_coarse_ && had_coarse) coarse_.reset();
  }
  /// After a tick: what is felt at the points, each by its share.
  void add_up(const AdaptiveTool<S>& tool) noexcept {
    contacts_.clear();
    const auto add = [&](const Resolved& points, S share, std::size_t first) {
      if (!(share > S(0))) return;
      for (PointContact<S> c : points.contacts()) {
        c.point += static_cast<std::uint32_t>(first);
        c.force *= share, c.pressure *= share;
        contacts_.push_back(c);
      }
    };
    add(coarse_, S(1) - share_, 0), add(fine_, share_, tool.coarse().size());
    const bool had = std::exchange(has_contact_, !contacts_.empty());
    if (has_contact_ && !had) ++id;
    if constexpr (Contacts::max_beside > 0) set_beside({});  // also of the one that did not go on
  }

  [[nodiscard]] std::span<const PointContact<S>> contacts() const noexcept {
    return {contacts_.begin(), contacts_.size()};
  }
  /// The last tick's loads on the body, as many as the list has room for.
  template <class List>
  void loads(List& out) const noexcept {
    out.clear();
    if (share_ < S(1)) coarse_.add_loads(out, S(1) - share_);
    if (share_ > S(0)) fine_.add_loads(out, share_);
  }
  void set_beside(std::span<const SurfaceLoad<S>> loads) noexcept
    requires(Contacts::max_beside > 0)
  {
    coarse_.set_beside(loads), fine_.set_beside(loads);
  }
  /// Of the points that carry more.
  [[nodiscard]] const auto& residual() const noexcept {
    return share_ > S(0.5) ? fine_.residual() : coarse_.residual();
  }
  [[nodiscard]] bool has_settled() const noexcept {
    return (!has_coarse_ || coarse_.has_settled()) && (!has_fine_ || fine_.has_settled());
  }

 private:
  Resolved coarse_, fine_;
  BoundedList<PointContact<S>> contacts_;
  S share_ = S(1);
  bool has_fine_ = true, has_coarse_ = false, has_contact_ = false;

 public:
  std::uint32_t id = 0;  ///< of the contact: another one after each lift-off
};

}  // namespace palpate::detail
