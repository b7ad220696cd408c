// SPDX-License-Identifier: MIT
#pragma once

/// @file  Compliance of the regular part w: means of w over patches of any size, tabulated.

#include <palpate/response/tick/influence_functions.hpp>
#include <palpate/response/tick/load_mesh.hpp>
#include <palpate/response/tick/mid_edge_table.hpp>
#include <palpate/response/tick/moment_loads.hpp>

#include <cmath>

namespace palpate {

namespace detail {
struct NodeWeight {
  std::uint32_t node;
  double weight;
};
}  // namespace detail

/// mu w averaged over a patch whose load is spread over it in the same way, mu = 1:
///
///     w(x, s) = sum_ik l_i l_k W_ik(s),   second(x, s) = sum_k l_k Q_k(s)
///
/// with the position x of weights l_i in a triangle of nodes, W_ik the mean over a patch at node i of the
/// field of forces spread over a patch at node k, and Q_k the mean of the loads of second order at k itself.
/// Linear in s^2 between the tabulated s_0 = 0, s_l^2 = 2^(l-1) (spacing / 2)^2 with the least spacing, to
/// the body's size.
///
/// | symbol | name                                                              | unit |
/// |--------|-------------------------------------------------------------------|------|
/// | s      | radius over which the table averages: s^2 = a^2 - (spacing / 2)^2 | m    |
/// | a      | radius of the patch; spacing: LoadNode's                          | m    |
class PatchTable {
 public:
  struct Own {
    /// W_00, W_11, W_22, W_01 + W_10, W_12 + W_21, W_20 + W_02, each xx, yy, zz, xy, yz, zx [1/m].
    float pair[6][6];
  };
  struct Second {
    /// Of the unit radial force dipole, of the unit bending couples along the node's two tangents, of the
    /// unit torsional couple [1/m^2].
    float mean[12];
  };
  using Moments = MomentRow;
  using Share = LoadMesh::Share;

  PatchTable() = default;
  PatchTable(const LoadMesh& load_mesh, std::vector<Own> own, std::vector<Second> second,
             std::vector<Moments> moments, std::size_t levels, std::vector<std::uint32_t> spread_begin,
             std::vector<Share> spread)
      : unit_(unit(load_mesh)),
        levels_(levels),
        own_(std::move(own)),
        second_(std::move(second)),
        moments_(std::move(moments)),
        spread_begin_(std::move(spread_begin)),
        spread_(std::move(spread)) {}

  /// `load_mesh` and what a unit load at each of its nodes does: `influence`.
  PatchTable(const ElementMesh& mesh, const MidEdgeTable& mid_edges, const LoadMesh& load_mesh,
             unsigned threads, const InfluenceFunctions& influence);

  /// Position of s^2 in the table.
  struct Level {
    std::size_t below;
    double part;
  };
  [[nodiscard]] Level level(double s2) const noexcept {
    const double t = s2 / unit_;
    Level at{0, (std::max)(t, 0.0)};
    if (t >= 1) {
      int exponent = 0;
      at.part = 2 * std::frexp(t, &exponent) - 1;  // t = 2^(exponent - 1) (1 + part)
      at.below = static_cast<std::size_t>(exponent);
    }
    return at.below < levels_ - 1 ? at : Level{levels_ - 2, 1};
  }
  /// w at a position of triangle t.
  [[nodiscard]] Mat3<double> own(std::size_t t, const Vec3<double>& l, const Level& at) const noexcept {
    using Six = Eigen::Matrix<double, 6, 1>;
    const double g[6] = {l[0] * l[0], l[1] * l[1], l[2] * l[2], l[0] * l[1], l[1] * l[2], l[2] * l[0]};
    Six w = Six::Zero();
    const Own &low = own_[t * levels_ + at.below], &high = own_[t * levels_ + at.below + 1];
    for (int p = 0; p < 6; ++p)
      for (int e = 0; e < 6; ++e)
        w[e] += g[p] * ((1 - at.part) * double(low.pair[p][e]) + at.part * double(high.pair[p][e]));
    Mat3<double> out;
    out << w[0], w[3], w[5], w[3], w[1], w[4], w[5], w[4], w[2];
    return out;
  }
  /// Q of node k, by column: of its force dipole, of its two bending couples.
  [[nodiscard]] Mat3<double> second(std::size_t k, const Level& at) const noexcept {
    using Nine = Eigen::Map<const Eigen::Matrix3f>;
    const Nine low(second_[k * levels_ + at.below].mean), high(second_[k * levels_ + at.below + 1].mean);
    return (1 - at.part) * low.cast<double>() + at.part * high.cast<double>();
  }
  /// Of its torsional couple.
  [[nodiscard]] Vec3<double> second_by_twist(std::size_t k, const Level& at) const noexcept {
    using Three = Eigen::Map<const Vec3<float>>;
    const Three low(second_[k * levels_ + at.below].mean + 9),
        high(second_[k * levels_ + at.below + 1].mean + 9);
    return (1 - at.part) * low.cast<double>() + at.part * high.cast<double>();
  }
  /// Solved nodes that share a load that is spread over a patch of the radius of `level` around node k. What
  /// is missing from 1 acts on the fixed region.
  [[nodiscard]] std::span<const Share> spread(std::size_t k, std::size_t level) const noexcept {
    const std::size_t i = k * levels_ + level;
    return {spread_.data() + spread_begin_[i], spread_begin_[i + 1] - spread_begin_[i]};
  }
  /// `sagitta` or `mean_sagitta` of a patch of radius a.
  [[nodiscard]] double edge(float Moments::*depth, const std::array<std::uint32_t, 3>& node,
                            const Vec3<double>& l, double a) const noexcept {
    const Level at = level(a * a);
    double out = 0;
    for (std::size_t i = 0; i < 3; ++i)
      out += l[Eigen::Index(i)] * ((1 - at.part) * double(moments(node[i], at.below).*depth) +
                                   at.part * double(moments(node[i], at.below + 1).*depth));
    return out;
  }
  [[nodiscard]] const Moments& moments(std::size_t k, std::size_t level) const noexcept {
    return moments_[k * levels_ + level];
  }
  [[nodiscard]] const std::vector<Moments>& moment_rows() const noexcept { return moments_; }
  [[nodiscard]] const std::vector<std::uint32_t>& spread_begin() const noexcept { return spread_begin_; }
  [[nodiscard]] const std::vector<Share>& all_spread() const noexcept { return spread_; }
  [[nodiscard]] const std::vector<Own>& own_rows() const noexcept { return own_; }
  [[nodiscard]] const std::vector<Second>& second_rows() const noexcept { return second_; }
  [[nodiscard]] std::size_t memory() const noexcept {
    return own_.size() * sizeof(Own) + second_.size() * sizeof(Second) + moments_.size() * sizeof(Moments) +
           spread_.size() * sizeof(Share);
  }

 private:
  void keep_solved(const LoadMesh& load_mesh, const std::vector<detail::NodeWeight>& list);
  [[nodiscard]] static double unit(const LoadMesh& load_mesh);
  [[nodiscard]] double radius2(std::size_t level) const noexcept {
    return level == 0 ? 0 : std::ldexp(unit_, int(level) - 1);
  }
  double unit_ = 1;
  std::size_t levels_ = 2;
  std::vector<Own> own_;        // per triangle and level
  std::vector<Second> second_;  // per node and level
  std::vector<Moments> moments_;
  std::vector<std::uint32_t> spread_begin_{0};
  std::vector<Share> spread_;
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/response/setup/patch_table_impl.hpp>
#endif
