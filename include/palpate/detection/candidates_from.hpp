// SPDX-License-Identifier: MIT
#pragma once

/// @file Candidates from a tree that the host has already: its tree says which points may touch, the body how
/// deep.

#include <palpate/core/error.hpp>
#include <palpate/geometry/concept.hpp>

#include <concepts>
#include <limits>
#include <utility>

namespace palpate {

/// What a host's tree over the object's mesh must answer: touches(c, r) is false only if no triangle has a
/// point within r of c [m], in object coordinates. c and r are finite, r >= 0. `FclTree` and `BulletTree` are
/// in adapters/.
template <class T, class S>
concept CandidateTree = std::move_constructible<T> && requires(const T& tree, const Vec3<S>& c, S r) {
  { tree.touches(c, r) } noexcept -> std::same_as<bool>;
};

/// An elastic object whose candidates come from a host's tree; hand it to ContactSolver in place of the body.
/// No equation.
///
/// | symbol | name     | unit | range, default                                                            |
/// |--------|----------|------|---------------------------------------------------------------------------|
/// | m      | `margin` | m    | >= 0, 0: farthest from the mesh in the tree that a contact begins          |
///
/// The body measures depth, from the undeformed surface; its own search, if it has one, is not asked. The
/// mesh is a surface without an inside. But contact begins within m of it, so a ball whose m-neighbourhood
/// meets no triangle lies wholly on one side, and the depth at its centre says on which:
///
///     separated(c, r) = depth(c) <= 0 and no triangle within r + m of c
///
/// Then every point that touches is a candidate, also one deep inside, and forces are those of the body
/// alone, bit for bit. m is 0 where the tree holds the mesh that the body measures from; else add up: how far
/// the mesh is from an exact body (chord error); 1.62 spacings for SampledSurface; the largest displacement
/// of a vertex |u| where the tree holds the deformed mesh, twice that around a DeformedSurface. Too large a
/// margin costs time; too small a one loses contacts.
///
/// Tree and mesh must outlive this and must not change during a tick. Run time, heap and locks: what the
/// tree's header says. Queries that are not finite, or r < 0: not separated. The constructor reports a margin
/// out of range.
template <class B, class Tree>
  requires HasClosest<B> && HasPenetration<B> && HasReach<B> && CandidateTree<Tree, typename B::Scalar>
class CandidatesFrom {
 public:
  using Scalar = typename B::Scalar;
  using S = Scalar;

  CandidatesFrom(B body, Tree tree, S margin = S(0))
      : body_(std::move(body)), tree_(std::move(tree)), margin_(margin) {
    require_non_negative(margin, "CandidatesFrom", "margin [m] must be >= 0");
  }

  /// For the next tick, after the mesh in the tree has moved. Out of range: every point is a candidate.
  void set_margin(S margin) noexcept {
    margin_ = is_finite(margin) && margin >= S(0) ? margin : std::numeric_limits<S>::infinity();
  }

  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept { return body_.closest(x); }
  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept { return body_.penetration(x); }
  template <std::size_t N>
    requires HasPenetrationBatch<B, N>
  void penetration(const PointBatch<S, N>& x, PenetrationBatch<S, N>& in) const noexcept {
    body_.penetration(x, in);
  }

  /// True only if no point of the ball is inside the body.
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept {
    const S grown = r + margin_;
    if (!is_finite(c) || !is_finite(grown) || !(r >= S(0))) return false;
    return !(body_.penetration(c).depth > S(0)) && !tree_.touches(c, grown);
  }

  [[nodiscard]] S reach() const noexcept { return body_.reach(); }
  [[nodiscard]] S margin() const noexcept { return margin_; }
  [[nodiscard]] const B& body() const noexcept { return body_; }
  [[nodiscard]] B& mutable_body() noexcept { return body_; }

 private:
  B body_;
  Tree tree_;
  S margin_;
};

}  // namespace palpate
