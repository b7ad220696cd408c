// SPDX-License-Identifier: MIT
#pragma once

/// @file  Which points of the tool may touch: a walk through its tree of balls against the surface.

#include <palpate/core/simd.hpp>
#include <palpate/detection/tool_points.hpp>
#include <palpate/geometry/concept.hpp>

#include <cmath>

namespace palpate {

namespace detail {
/// Upper bound of |R v| / |v|: 1 to rounding for a rotation, and safe for what is_usable() lets pass.
template <Real S>
[[nodiscard]] inline S max_stretch(const Mat3<S>& R) noexcept {
  const Mat3<S> G = R.transpose() * R;
  return std::sqrt(G.cwiseAbs().rowwise().sum().maxCoeff());  // Gershgorin's bound on the largest eigenvalue
}

/// X times each point.
template <Real S>
[[nodiscard]] inline PointBatch<S> transformed(const Pose<S>& X, const PointBatch<S>& p) noexcept {
  using V = simd_at_most<S, static_cast<int>(batch_size)>;
  const auto& R = X.rotation;
  const auto& t = X.translation;
  PointBatch<S> x;
  for (std::size_t i = 0; i < batch_size; i += V::size()) {
    const V px(&p.x[i]), py(&p.y[i]), pz(&p.z[i]);
    (R(0, 0) * px + R(0, 1) * py + R(0, 2) * pz + t.x()).copy_to(&x.x[i]);
    (R(1, 0) * px + R(1, 1) * py + R(1, 2) * pz + t.y()).copy_to(&x.y[i]);
    (R(2, 0) * px + R(2, 1) * py + R(2, 2) * pz + t.z()).copy_to(&x.z[i]);
  }
  return x;
}
}  // namespace detail

/// Calls visit(begin, count, x) for every leaf of the tool's tree with a point that may be inside the
/// surface: `count` <= batch_size points from `begin` on, with x their positions in object coordinates [m].
/// No equation.
///
/// Precondition: X is usable (core/pose.hpp). A ball that surface.separated() says is apart is left out with
/// all its points; so a tool far away costs one such test, and the rest costs in proportion to what touches:
/// every point that touches is visited, with the others of its leaf. The loop ends after at most one test for
/// each node. `margin` [m]: points that are no farther outside are visited, too.
template <Real S, ContactSurface B, class Visit>
  requires std::same_as<S, typename B::Scalar>
inline void for_each_candidate_leaf(const ToolPoints<S>& tool, const Pose<S>& X, const B& surface,
                                    const Visit& visit, S margin = S(0)) noexcept {
  const auto nodes = tool.nodes();
  const S stretch = detail::max_stretch(X.rotation);
  // More than the rounding of X * p, which may differ between a ball's centre and its points.
  const S reach =
      nodes[0].centre.cwiseAbs().maxCoeff() + nodes[0].radius + X.translation.cwiseAbs().maxCoeff();
  const S guard = S(16) * std::numeric_limits<S>::epsilon() * reach + margin;
  for (std::uint32_t n = 0; n < nodes.size();) {
    const auto& node = nodes[n];
    if (surface.separated(X * node.centre, stretch * node.radius + guard)) {
      n = node.skip;
      continue;
    }
    if (node.skip == n + 1)
      visit(node.begin, node.end - node.begin, detail::transformed(X, tool.batch(node.begin)));
    ++n;
  }
}

/// The same with visit(point, x) for each point, in their order.
template <Real S, ContactSurface B, class Visit>
  requires std::same_as<S, typename B::Scalar>
inline void for_each_candidate(const ToolPoints<S>& tool, const Pose<S>& X, const B& surface,
                               const Visit& visit) noexcept {
  for_each_candidate_leaf(tool, X, surface,
                          [&](std::uint32_t begin, std::uint32_t count, const PointBatch<S>& x) noexcept {
                            for (std::uint32_t i = 0; i < count; ++i)
                              visit(begin + i, Vec3<S>(x.x[i], x.y[i], x.z[i]));
                          });
}

}  // namespace palpate
