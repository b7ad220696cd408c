// SPDX-License-Identifier: MIT
#pragma once

/// @file The rows of the patch table for force dipoles and couples that are spread over a patch
/// (moment_loads.hpp). Set-up only.

#include <palpate/response/setup/constants.hpp>
#include <palpate/response/tick/influence_functions.hpp>
#include <palpate/response/tick/load_mesh.hpp>
#include <palpate/response/tick/moment_loads.hpp>

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

namespace palpate::detail {

/// The five loads' tensors A.
[[nodiscard]] inline std::array<Mat3<double>, 5> moment_loads(const Vec3<double>& normal) noexcept {
  const Vec3<double> t1 = perpendicular(normal), t2 = normal.cross(t1);
  const Mat3<double> across = t1 * t2.transpose();
  return {Mat3<double>::Identity(), t1 * t1.transpose() - t2 * t2.transpose(), across + across.transpose(),
          -2 * normal * t1.transpose(), -2 * normal * t2.transpose()};
}

/// The table's row but for `sagitta`. see(node, each): each(vertex, weight) of the node's position.
template <class See>
[[nodiscard]] MomentRow find_moments(const LoadMesh& load_mesh, std::size_t k,
                                     std::span<const LoadMesh::Share> shares,
                                     const InfluenceFunctions& influence, const See& see) {
  struct Seen {
    std::uint32_t vertex;
    double weight;
    Vec3<double> q;
  };
  const std::size_t stride = influence.stride;
  MomentRow out;
  std::vector<Seen> seen;
  std::vector<std::pair<std::uint32_t, Vec3<double>>> nodes;
  each_moment(load_mesh, k, shares, [&](std::uint32_t node, const Vec3<double>& q) {
    const double share = double(shares[nodes.size()].weight);
    nodes.push_back({node, q});
    see(node, [&](std::uint32_t vertex, double weight) {
      auto at =
          std::find_if(seen.begin(), seen.end(), [vertex](const Seen& s) { return s.vertex == vertex; });
      if (at == seen.end()) at = seen.insert(at, {vertex, 0, Vec3<double>::Zero()});
      at->weight += weight * share;
      at->q += weight * q;
    });
  });
  const auto loads = moment_loads(load_mesh.nodes()[k].normal);
  double mean[5][3] = {}, own[5][5] = {};
  for (const auto& [node, q] : nodes)
    for (std::size_t l = 0; l < 3; ++l) {
      const float* c = influence(node, l);
      Vec3<double> sum = Vec3<double>::Zero();
      Mat3<double> moment = Mat3<double>::Zero();  // sum u q^T
      for (const Seen& s : seen) {
        const Vec3<double> u{double(c[s.vertex]), double(c[stride + s.vertex]),
                             double(c[2 * stride + s.vertex])};
        sum += s.weight * u;
        moment += u * s.q.transpose();
      }
      for (std::size_t s = 0; s < 5; ++s) {
        const double f = loads[s].row(Eigen::Index(l)).dot(q);
        for (std::size_t i = 0; i < 3; ++i) mean[s][i] += f * sum[Eigen::Index(i)];
        for (std::size_t r = 0; r < 5; ++r) own[r][s] += f * loads[r].cwiseProduct(moment).sum();
      }
    }
  for (std::size_t r = 0, e = 0; r < 5; ++r) {
    for (std::size_t i = 0; i < 3; ++i) out.mean[r][i] = static_cast<float>(mean[r][i]);
    for (std::size_t s = 0; s <= r; ++s) out.own[e++] = static_cast<float>(0.5 * (own[r][s] + own[s][r]));
  }
  return out;
}

/// `sagitta` and `mean_sagitta` of a patch of radius s around node k. Of six positions on the edge of a
/// quadric's patch one is within 30 degrees of its deepest; the mean sagitta is resolved for radii from the
/// node's spacing on.
inline void find_edge(const LoadMesh& load_mesh, std::size_t k, double s, MomentRow& row) {
  const LoadNode& node = load_mesh.nodes()[k];
  const Vec3<double> t1 = perpendicular(node.normal), t2 = node.normal.cross(t1);
  const auto each_depth = [&](double radius, const auto& each) {
    for (std::size_t i = 0; i < 6; ++i) {
      const double angle = double(i) * std::numbers::pi / 3;
      const Vec3<double> x = node.source + radius * (std::cos(angle) * t1 + std::sin(angle) * t2);
      const LoadPosition at = load_mesh.locate(x);
      Vec3<double> y = Vec3<double>::Zero();
      for (std::size_t c = 0; c < 3; ++c)
        y += at.weight[Eigen::Index(c)] * load_mesh.nodes()[at.node[c]].source;
      each((x - y).dot(node.normal));
    }
  };
  double deepest = 0, sum = 0;
  each_depth(s, [&](double depth) { deepest = (std::max)(deepest, depth); });
  const double known = (std::max)(s, node.spacing), less = s / known;
  each_depth(known, [&](double depth) { sum += depth; });
  row.sagitta = static_cast<float>(setup::deepest_edge * deepest);
  row.mean_sagitta = static_cast<float>(less * less * sum / 6);
}

}  // namespace palpate::detail
