// SPDX-License-Identifier: MIT
#pragma once

/// @file What a position on the load mesh stands for: lengths there, and the solved nodes that share its
/// load. Per tick.

#include <palpate/response/response_field.hpp>

#include <cstddef>
#include <cstdint>

namespace palpate::detail {

/// Mean of a length of the nodes (size or spacing) around a position, interpolated [m].
[[nodiscard]] inline double mean_of(double LoadNode::*length, const ResponseField& field,
                                    const LoadPosition& position) noexcept {
  double mean = 0;
  for (std::size_t i = 0; i < 3; ++i)
    mean += position.weight[Eigen::Index(i)] * field.load_mesh().nodes()[position.node[i]].*length;
  return mean;
}

/// Share of w that counts. Far from the surface the nearest position may jump, so w fades with the distance:
/// to a half at one edge. `far2`: the distance over an edge's length, squared.
template <Real S>
[[nodiscard]] inline S share_at(S far2) noexcept {
  return 1 / (1 + far2 * far2);
}
/// The same at a position; `size`: the edge's length [m].
[[nodiscard]] inline double regular_share(const LoadPosition& position, double size) noexcept {
  return share_at(position.distance2 / (size * size));
}

/// Solved nodes of a position, as `{node, weight}`: its own, and for each node that is not solved those that
/// share its load. At most LoadMesh::most_beneath.
template <class List>
void add_position(const LoadMesh& mesh, const LoadPosition& position, List& list) noexcept {
  for (const LoadMesh::Beneath& b : mesh.beneath(position.triangle))
    list.push_back({b.node, b.part.cast<double>().dot(position.weight)});
}

}  // namespace palpate::detail
