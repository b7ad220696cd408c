// SPDX-License-Identifier: MIT
#pragma once

/// @file  How far the body's correction w lets a contact give way: means over patches of any size, tabulated.

#include <palpate/elasticity/flat_punch.hpp>
#include <palpate/response/setup/moment_loads.hpp>
#include <palpate/response/setup/parallel.hpp>
#include <palpate/response/tick/load_mesh.hpp>
#include <palpate/response/tick/mid_edge_table.hpp>

namespace palpate {

/// mu w averaged over a patch whose load is spread over it in the same way, mu = 1:
///
///     w(x, s) = sum_ik l_i l_k W_ik(s),   second(x, s) = sum_k l_k Q_k(s)
///
/// with the place x of weights l_i in a triangle of nodes, W_ik the mean over a patch at node i of the field
/// of forces spread over a patch at node k, and Q_k the mean of the loads of second order at k itself. Linear
/// in s^2 between the tabulated s_0 = 0, s_l^2 = 2^(l-1) (spacing / 2)^2 with the least spacing, to the
/// body's size.
///
/// | symbol | name                                                              | unit |
/// |--------|-------------------------------------------------------------------|------|
/// | s      | radius over which the table averages: s^2 = a^2 - (spacing / 2)^2 | m    |
/// | a      | radius of the patch; spacing: TouchNode's                         | m    |
class PatchTable {
 public:
  struct Own {
    float pair
        [6]
        [6];  ///< W_00, W_11, W_22, W_01 + W_10, W_12 + W_21, W_20 + W_02, each xx, yy, zz, xy, yz, zx [1/m]
  };
  struct Second {
    float mean
        [12];  ///< of the unit radial double force, the unit tilts along the node's two tangents, the unit twist [1/m^2]
  };
  using Moments = MomentRow;
  using Share = TouchMesh::Share;

  PatchTable() = default;
  PatchTable(const TouchMesh& touch, std::vector<Own> own, std::vector<Second> second,
             std::vector<Moments> moments, std::size_t levels, std::vector<std::uint32_t> spread_begin,
             std::vector<Share> spread)
      : unit_(unit(touch)),
        levels_(levels),
        own_(std::move(own)),
        second_(std::move(second)),
        moments_(std::move(moments)),
        spread_begin_(std::move(spread_begin)),
        spread_(std::move(spread)) {}

  /// `column(k, l)` points to the field of load l (ResponseField::loads) of node k: x of every vertex,
  /// y and z `stride` further each.
  template <class Column>
  PatchTable(const SolveMesh& mesh, const MidEdgeTable& bends, const TouchMesh& touch, unsigned threads,
             std::size_t stride, const Column& column)
      : unit_(unit(touch)) {
    Vec3<double> low = mesh.vertices[0], high = low;
    for (const auto& v : mesh.vertices) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    levels_ = 2;
    while (radius2(levels_ - 1) < 0.25 * (high - low).squaredNorm()) ++levels_;
    const std::size_t n = touch.nodes().size();
    const std::vector<std::vector<Weight>> at = seen_at(mesh, bends, touch);
    std::vector<std::vector<Weight>> loaded(n * levels_), seen(n * levels_);  // nodes; vertices
    detail::parallel_for(n * levels_, threads, [&](std::size_t i) {
      loaded[i] = spread(touch, i / levels_, std::sqrt(radius2(i % levels_)));
      for (const Weight& w : loaded[i])
        for (const Weight& v : at[w.node]) add(seen[i], v.node, w.weight * v.weight);
    });
    for (const auto& list : loaded) keep_solved(touch, list);
    moments_.resize(n * levels_);
    detail::parallel_for(n * levels_, threads, [&](std::size_t i) {
      const std::size_t k = i / levels_;
      const auto see = [&](std::uint32_t node, const auto& each) {
        for (const Weight& v : at[node]) each(v.node, v.weight);
      };
      moments_[i] = detail::find_moments(touch, k, spread(k, i % levels_), stride, column, see);
      detail::find_edge(touch, k, std::sqrt(radius2(i % levels_)), moments_[i]);
    });
    std::vector<std::vector<std::uint32_t>> around(n);  // triangles
    for (std::uint32_t t = 0; t < touch.triangles().size(); ++t)
      for (auto k : touch.triangles()[t]) around[k].push_back(t);
    own_.resize(touch.triangles().size() * levels_);
    second_.resize(n * levels_);
    std::vector<std::array<Mat3<double>, 9>> pairs(own_.size());
    detail::parallel_for(n, threads, [&](std::size_t k) {
      std::vector<std::uint32_t> slot(mesh.vertices.size(), ~0u), needed;
      std::vector<Mat3<double>> field;
      for (std::size_t level = 0; level < levels_; ++level) {
        for (auto v : needed) slot[v] = ~0u;
        needed.clear();
        for (auto t : around[k])
          for (auto i : touch.triangles()[t])
            for (const Weight& w : seen[i * levels_ + level]) {
              if (slot[w.node] != ~0u) continue;
              slot[w.node] = static_cast<std::uint32_t>(needed.size());
              needed.push_back(w.node);
            }
        field.assign(needed.size(), Mat3<double>::Zero());
        for (const Weight& w : loaded[k * levels_ + level])
          for (std::size_t l = 0; l < 3; ++l) {
            const float* c = column(w.node, l);
            for (std::size_t j = 0; j < needed.size(); ++j)
              field[j].col(Eigen::Index(l)) += w.weight * read(c, stride, needed[j]);
          }
        for (auto t : around[k]) {
          const auto& corner = touch.triangles()[t];
          for (std::size_t i = 0; i < 3; ++i) {
            Mat3<double> mean = Mat3<double>::Zero();
            for (const Weight& w : seen[corner[i] * levels_ + level]) mean += w.weight * field[slot[w.node]];
            for (std::size_t j = 0; j < 3; ++j)
              if (corner[j] == k) pairs[t * levels_ + level][3 * i + j] = mean;
          }
        }
        for (std::size_t l = 0; l < 4; ++l) {
          Vec3<double> u = Vec3<double>::Zero();
          for (const Weight& q : loaded[k * levels_ + level]) {
            const Eigen::Vector4d load =
                q.weight * (l == 1 || l == 2 ? in_tangents(touch, q.node, tangent(touch, k, l))
                                             : Eigen::Vector4d(Eigen::Vector4d::Unit(Eigen::Index(l))));
            for (std::size_t i = 0; i < 4; ++i)
              if (load[Eigen::Index(i)] != 0)
                for (const Weight& w : seen[k * levels_ + level])
                  u += load[Eigen::Index(i)] * w.weight * read(column(q.node, 3 + i), stride, w.node);
          }
          for (std::size_t i = 0; i < 3; ++i)
            second_[k * levels_ + level].mean[3 * l + i] = static_cast<float>(u[Eigen::Index(i)]);
        }
      }
    });
    for (std::size_t i = 0; i < own_.size(); ++i) {
      constexpr std::size_t pair_of[6][2] = {{0, 0}, {4, 4}, {8, 8}, {1, 3}, {5, 7}, {6, 2}};
      for (std::size_t p = 0; p < 6; ++p) {
        const Mat3<double> mean = 0.5 * (pairs[i][pair_of[p][0]] + pairs[i][pair_of[p][1]]);
        const Mat3<double> w = (p < 3 ? 0.5 : 1.0) * (mean + mean.transpose());
        const double entry[6] = {w(0, 0), w(1, 1), w(2, 2), w(0, 1), w(1, 2), w(2, 0)};
        for (int e = 0; e < 6; ++e) own_[i].pair[p][e] = static_cast<float>(entry[e]);
      }
    }
  }

  /// Where s^2 stands in the table.
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
  /// w at a place of triangle t.
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
  /// Q of node k, by column: its double force, its two tilts.
  [[nodiscard]] Mat3<double> second(std::size_t k, const Level& at) const noexcept {
    using Nine = Eigen::Map<const Eigen::Matrix3f>;
    const Nine low(second_[k * levels_ + at.below].mean), high(second_[k * levels_ + at.below + 1].mean);
    return (1 - at.part) * low.cast<double>() + at.part * high.cast<double>();
  }
  /// Of its twist.
  [[nodiscard]] Vec3<double> second_by_twist(std::size_t k, const Level& at) const noexcept {
    using Three = Eigen::Map<const Vec3<float>>;
    const Three low(second_[k * levels_ + at.below].mean + 9),
        high(second_[k * levels_ + at.below + 1].mean + 9);
    return (1 - at.part) * low.cast<double>() + at.part * high.cast<double>();
  }
  /// Solved nodes that share a load that is spread over a patch of the radius of `level` around node k. What
  /// is missing from 1 falls on what is held.
  [[nodiscard]] std::span<const Share> spread(std::size_t k, std::size_t level) const noexcept {
    const std::size_t i = k * levels_ + level;
    return {spread_.data() + spread_begin_[i], spread_begin_[i + 1] - spread_begin_[i]};
  }
  /// `sag` or `droop` of a patch of radius a.
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
  struct Weight {
    std::uint32_t node;
    double weight;
  };

  [[nodiscard]] static double unit(const TouchMesh& touch) {
    double least = (std::numeric_limits<double>::max)();
    for (const auto& node : touch.nodes()) least = (std::min)(least, node.spacing);
    return 0.25 * least * least;
  }
  [[nodiscard]] static Vec3<double> tangent(const TouchMesh& touch, std::size_t k, std::size_t number) {
    const Vec3<double>& n = touch.nodes()[k].normal;
    const Vec3<double> t1 = perpendicular(n);
    return number == 1 ? t1 : Vec3<double>(n.cross(t1));
  }
  [[nodiscard]] static Eigen::Vector4d in_tangents(const TouchMesh& touch, std::size_t k,
                                                   const Vec3<double>& tilt) {
    return {0, tilt.dot(tangent(touch, k, 1)), tilt.dot(tangent(touch, k, 2)), 0};
  }
  [[nodiscard]] double radius2(std::size_t level) const noexcept {
    return level == 0 ? 0 : std::ldexp(unit_, int(level) - 1);
  }
  [[nodiscard]] static Vec3<double> read(const float* c, std::size_t stride, std::uint32_t v) noexcept {
    return {double(c[v]), double(c[stride + v]), double(c[2 * stride + v])};
  }
  static void add(std::vector<Weight>& list, std::uint32_t node, double weight) {
    const auto found =
        std::find_if(list.begin(), list.end(), [node](const Weight& w) { return w.node == node; });
    if (found == list.end())
      list.push_back({node, weight});
    else
      found->weight += weight;
  }

  void keep_solved(const TouchMesh& touch, const std::vector<Weight>& list) {
    std::vector<Weight> solved;
    for (const Weight& w : list) {
      if (w.node < touch.solved())
        add(solved, w.node, w.weight);
      else
        for (const Share& s : touch.shares(w.node)) add(solved, s.node, w.weight * double(s.weight));
    }
    for (const Weight& w : solved)
      if (w.weight > 0) spread_.push_back({w.node, static_cast<float>(w.weight)});
    spread_begin_.push_back(static_cast<std::uint32_t>(spread_.size()));
  }

  // Weights of the solve mesh's vertices in the displacement at each node's place.
  [[nodiscard]] static std::vector<std::vector<Weight>> seen_at(const SolveMesh& mesh,
                                                                const MidEdgeTable& bends,
                                                                const TouchMesh& touch) {
    std::vector<std::vector<Weight>> out(touch.nodes().size());
    for (std::size_t k = 0; k < out.size(); ++k) {
      const TouchNode& node = touch.nodes()[k];
      const Vec3<double> l = node.part.cast<double>();
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t d = (c + 1) % 3;
        add(out[k], mesh.triangles[node.triangle][c], l[Eigen::Index(c)]);
        const double bent = 4 * l[Eigen::Index(c)] * l[Eigen::Index(d)];
        if (bent == 0) continue;
        for (const MidEdgeTable::Weight& w : bends.edge_rows()[bends.of_triangle()[node.triangle][c]])
          add(out[k], w.vertex, bent * double(w.weight));
      }
    }
    return out;
  }

  // The stuck disc's weight around the node.
  [[nodiscard]] static std::vector<Weight> spread(const TouchMesh& touch, std::size_t k, double s) {
    const TouchNode& node = touch.nodes()[k];
    std::vector<Weight> patch;
    if (!(s > 0)) {
      patch.push_back({static_cast<std::uint32_t>(k), 1});
      return patch;
    }
    const Vec3<double> t1 = perpendicular(node.normal), t2 = node.normal.cross(t1);
    for (const auto& p : flat_punch_points()) {
      const TouchPlace at = touch.locate(node.source + s * (p[0] * t1 + p[1] * t2));
      for (std::size_t c = 0; c < 3; ++c)
        add(patch, at.node[c], at.weight[Eigen::Index(c)] / double(flat_punch_points().size()));
    }
    return patch;
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
