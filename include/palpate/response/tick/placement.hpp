// SPDX-License-Identifier: MIT
#pragma once

/// @file Places a contact on the load mesh: its nodes, the regular part w and the compliance of its mean. Per
/// tick.
///
///     C = C_near + (share)^2 w(x, s),   s^2 = a^2 - (spacing / 2)^2
///
/// w is the mean over the patch from the patch table; C_near the flat punch's compliance.

#include <palpate/response/tick/bounded_compliance.hpp>
#include <palpate/response/tick/constants.hpp>
#include <palpate/response/tick/solved_nodes.hpp>
#include <palpate/response/tick/stages.hpp>

#include <algorithm>

namespace palpate::detail {

/// S = C^-1 with the modes of C at least a tenth of the half-space's.
[[nodiscard]] inline Mat3<double> bounded_inverse(Mat3<double>& C, double min_near) noexcept {
  const double min = tick::min_compliance * min_near;
  if (!is_bounded_below(C, min)) bound_below(C, min);
  return C.inverse();
}

/// The placed stage of a contact.
[[nodiscard]] PALPATE_COMPILED_INLINE PlacedContact place_contact(const ResponseField& field,
                                                                  const Indenter& tool) noexcept {
  PlacedContact c;
  c.tool = tool;
  c.displacement2 = tool.displacement2();
  c.position = field.load_mesh().locate(tool.x);
  add_position(field.load_mesh(), c.position, c.nodes);
  const double size = mean_of(&LoadNode::size, field, c.position),
               spacing = mean_of(&LoadNode::spacing, field, c.position);
  c.level = field.table().level(tool.seen2() - 0.25 * spacing * spacing);
  c.sagitta = field.table().edge(&MomentRow::sagitta, c.position.node, c.position.weight, tool.a);
  c.regular = regular_share(c.position, size);
  double sum = 0;
  for (const NodeWeight& w : c.nodes) sum += w.weight;
  c.carried = 1 - c.regular * (std::max)(1 - sum, 0.0);
  c.w = c.regular * c.regular * field.table().own(c.position.triangle, c.position.weight, c.level);
  c.near = flat_punch_compliance(tool.a, field.nu());
  c.C = c.w + (c.near.normal - c.near.tangential) * (tool.m * tool.m.transpose());
  c.C.diagonal().array() += c.near.tangential;
  const Mat3<double> C = c.C;
  c.S = bounded_inverse(c.C, c.min_near());
  c.w += c.C - C;
  c.wide = tool.is_sphere() ? 0 : PatchMoments::share_of(tool.a, size);
  return c;
}

/// each(part, node, level) for the spreads (PatchTable) that together are the load of a contact whose flat
/// punch has the radius sqrt(loaded2). The load is interpolated twice, over the position's triangle and over
/// those of the spreads; each time it widens by a quarter of spacing^2.
template <class Each>
void each_spread(const ResponseField& field, const PlacedContact& c, double loaded2,
                 const Each& each) noexcept {
  const double spacing = mean_of(&LoadNode::spacing, field, c.position);
  const PatchTable::Level level = field.table().level(loaded2 - 0.5 * spacing * spacing);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t l = 0; l < 2; ++l)
      each(c.regular * c.position.weight[Eigen::Index(i)] * (l == 0 ? 1 - level.part : level.part),
           c.position.node[i], level.below + l);
}

/// Solved nodes that share the force: the spreads of the position's nodes, added up in `weight`, one number
/// per solved node, all 0 before; `nodes` lists those with a weight. Returns the part of the force that they
/// carry.
///
/// Continuous in the contact's position. Nearest positions of points of the patch's plane would not be: away
/// from the surface they jump from sheet to sheet.
[[nodiscard]] PALPATE_COMPILED_INLINE double spread_force(const ResponseField& field, const PlacedContact& c,
                                                          double loaded2, float* weight,
                                                          std::vector<std::uint32_t>& nodes) noexcept {
  nodes.clear();
  double sum = 0;
  each_spread(field, c, loaded2, [&](double part, std::uint32_t k, std::size_t level) {
    for (const LoadMesh::Share& s : field.table().spread(k, level)) {
      const double w = part * double(s.weight);
      if (!(w > tick::min_node_weight)) continue;
      if (weight[s.node] == 0) nodes.push_back(s.node);
      weight[s.node] += static_cast<float>(w);
      sum += w;
    }
  });
  return 1 - (std::max)(c.regular - sum, 0.0);
}

/// The nodes' parts q of the patch's moments (moment_loads.hpp), three numbers each, where they have a
/// weight.
PALPATE_COMPILED_INLINE void spread_moments(const ResponseField& field, const PlacedContact& c,
                                            double loaded2, const float* weight, float* q) noexcept {
  each_spread(field, c, loaded2, [&](double part, std::uint32_t k, std::size_t level) {
    each_moment(field.load_mesh(), k, field.table().spread(k, level),
                [&](std::uint32_t node, const Vec3<double>& own) {
                  if (weight[node] == 0) return;
                  const Vec3<double> moment = part * own;
                  for (std::size_t i = 0; i < 3; ++i)
                    q[3 * node + i] += static_cast<float>(moment[Eigen::Index(i)]);
                });
  });
}

}  // namespace palpate::detail
