// SPDX-License-Identifier: MIT
#pragma once

/// @file What a position on the load mesh stands for: lengths there, and the solved nodes that share its
/// load. Per tick.

#include <palpate/response/response_field.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace palpate::detail {

/// Solved nodes of one position, at most.
constexpr std::size_t place_nodes = 3 * LoadMesh::most_parts;

/// Mean of a length of the nodes (size or spacing) around a position, interpolated [m].
[[nodiscard]] inline double mean_of(double LoadNode::*length, const ResponseField& field,
                                    const LoadPosition& position) noexcept {
  double mean = 0;
  for (std::size_t i = 0; i < 3; ++i)
    mean += position.weight[Eigen::Index(i)] * field.load_mesh().nodes()[position.node[i]].*length;
  return mean;
}

/// Share of w that counts. Far from the surface the nearest position may jump, so w fades with the distance:
/// to a half at one edge, whose length is `size` [m].
[[nodiscard]] inline double regular_share(const LoadPosition& position, double size) noexcept {
  const double far2 = position.distance2 / (size * size);
  return 1 / (1 + far2 * far2);
}

/// Solved nodes of a position, as `{node, weight}`: its own, and for each node that is not solved those that
/// share its load.
template <class List>
void add_position(const LoadMesh& touch, const LoadPosition& position, List& list) noexcept {
  const auto add = [&list](std::uint32_t node, double weight) {
    const auto same =
        std::find_if(list.begin(), list.end(), [node](const auto& w) { return w.node == node; });
    if (same != list.end())
      same->weight += weight;
    else
      list.push_back({node, weight});
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const double weight = position.weight[Eigen::Index(i)];
    if (position.node[i] < touch.solved())
      add(position.node[i], weight);
    else
      for (const LoadMesh::Share& s : touch.shares(position.node[i])) add(s.node, weight * double(s.weight));
  }
}

}  // namespace palpate::detail
