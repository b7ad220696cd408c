// SPDX-License-Identifier: MIT
#pragma once

/// @file  A force law whose two coefficients vary over the object, blended without a click.

#include <palpate/core/error.hpp>
#include <palpate/law/map/concept.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace palpate {

/// A law of two coefficients that SplineMap can vary: `Law` checks the parameters of a node, `pair()` are its
/// coefficients, and two coefficients and their gradients make the law at a point.
template <class L>
concept BlendedLaw = ForceLaw<L> && ForceLaw<typename L::Law> &&
                     requires(const typename L::Pair& c, const Vec3<typename L::Scalar>& gradient,
                              const typename L::Law::Params& params) {
                       { L::name } -> std::convertible_to<const char*>;
                       { L::pair(params) } -> std::same_as<typename L::Pair>;
                       { L::may_sharpen(c, c) } -> std::same_as<bool>;
                       L(c, gradient, gradient);
                     };

/// Coefficients c of a law at the nodes of a grid, between them by quadratic B-splines [deboor1978]:
///
///     c(x) = sum_i B((x - x_i) / w) c'_i,   c' = c - (1/8) (dx^2 + dy^2 + dz^2) c at the nodes
///
/// | symbol | name           | unit | range                                                           |
/// |--------|----------------|------|-----------------------------------------------------------------|
/// | w      | `spacing`      | m    | > 0: about the length over which the object's stiffness changes |
/// |        | `lower, upper` | m    | box of the object; at most 10 million nodes                     |
///
/// B is the product of three quadratic B-splines, dx^2 the second difference. Coefficients, their gradient
/// and the force are continuous; the error is of order w^3 where the coefficients are smooth. Where a node is
/// so far off its neighbours that c' might not be a law's (`may_sharpen`), c itself is taken. Weights are >=
/// 0 and add to 1, so every blend is a law. Beyond the box the values go over to those at its rim. Real time:
/// at() reads 27 nodes.
template <BlendedLaw L>
class SplineMap {
 public:
  using Scalar = typename L::Scalar;
  using S = Scalar;
  using Local = L;
  using Coefficients = typename L::Law::Params;

  struct Params {
    S spacing;             ///< w [m]
    Vec3<S> lower, upper;  ///< corners of the object's box [m]
  };

  /// The nodes of the grid, in the order in which the constructor asks for them. Reports bad parameters.
  [[nodiscard]] static std::vector<Vec3<S>> nodes(const Params& params) {
    const Grid grid(params);
    std::vector<Vec3<S>> all;
    all.reserve(grid.count[0] * grid.count[1] * grid.count[2]);
    for (std::size_t z = 0; z < grid.count[2]; ++z)
      for (std::size_t y = 0; y < grid.count[1]; ++y)
        for (std::size_t x = 0; x < grid.count[0]; ++x)
          all.push_back(grid.lower +
                        params.spacing * Vec3<S>(static_cast<S>(x), static_cast<S>(y), static_cast<S>(z)));
    return all;
  }
  /// coefficients(x) -> Coefficients, asked once for each node. Reports bad parameters and whatever the law
  /// reports of a node.
  template <class F>
  SplineMap(const Params& params, const F& coefficients) : w_(params.spacing) {
    const std::vector<Vec3<S>> all = nodes(params);
    lower_ = all.front();
    count_ = Grid(params).count;
    nodes_.reserve(all.size());
    for (const Vec3<S>& node : all) nodes_.push_back(L::pair(typename L::Law(coefficients(node)).params()));
    sharpen();
    check_blends();
    for (const Pair& c : nodes_)
      max_depth_ = (std::min)(max_depth_, L(c, Vec3<S>::Zero(), Vec3<S>::Zero()).max_depth());
  }

  [[nodiscard]] Local at(const Vec3<S>& x) const noexcept {
    std::array<Axis, 3> on;
    for (std::size_t k = 0; k < 3; ++k)
      on[k] = Axis((x[static_cast<int>(k)] - lower_[static_cast<int>(k)]) / w_, count_[k]);
    Pair c = Pair::Zero(), along_x = Pair::Zero(), along_y = Pair::Zero(), along_z = Pair::Zero();
    for (std::size_t z = 0; z < 3; ++z)
      for (std::size_t y = 0; y < 3; ++y) {
        const Pair* row = &nodes_[(on[2].node[z] * count_[1] + on[1].node[y]) * count_[0]];
        const Pair &c0 = row[on[0].node[0]], &c1 = row[on[0].node[1]], &c2 = row[on[0].node[2]];
        const auto &v = on[0].value, &d = on[0].slope;
        const Pair value = v[0] * c0 + v[1] * c1 + v[2] * c2, slope = d[0] * c0 + d[1] * c1 + d[2] * c2;
        const S both = on[1].value[y] * on[2].value[z];
        c += both * value;
        along_x += both * slope;
        along_y += on[1].slope[y] * on[2].value[z] * value;
        along_z += on[1].value[y] * on[2].slope[z] * value;
      }
    return L(c, Vec3<S>(along_x[0], along_y[0], along_z[0]) / w_,
             Vec3<S>(along_x[1], along_y[1], along_z[1]) / w_);
  }

  /// The smallest of all nodes' laws [m]; no blend's is smaller.
  [[nodiscard]] S max_depth() const noexcept { return max_depth_; }
  [[nodiscard]] S spacing() const noexcept { return w_; }

 private:
  using Pair = typename L::Pair;

  struct Grid {
    Vec3<S> lower;  // the first node
    std::array<std::size_t, 3> count{};

    explicit Grid(const Params& params) {
      static constexpr const char* name = L::name;
      require_positive(params.spacing, name, "spacing [m] must be > 0");
      S nodes = S(1);
      for (int k = 0; k < 3; ++k) {
        require_finite(params.lower[k], name, "lower [m] must be finite");
        require_finite(params.upper[k], name, "upper [m] must be finite");
        const S extent = params.upper[k] - params.lower[k];
        require_non_negative(extent, name, "upper - lower [m] must be >= 0");
        const S n = std::ceil(extent / params.spacing) + S(3);  // one more on either side for the splines
        nodes *= n;
        if (!(nodes <= S(1e7L)))  // chosen: bounds the memory
          fail(name, "spacing [m] asks for more than 10 million nodes", static_cast<double>(params.spacing));
        count[static_cast<std::size_t>(k)] = static_cast<std::size_t>(n);
      }
      lower = params.lower - Vec3<S>::Constant(params.spacing);
    }
  };

  // The three splines along an axis that are not 0 at a position, in units of w from the first node.
  struct Axis {
    std::array<std::size_t, 3> node;
    std::array<S, 3> value, slope;
    Axis() = default;
    Axis(S position, std::size_t count) noexcept {
      const S last = static_cast<S>(count - 1);
      // Clamped where all three splines are those of the rim.
      const S clamped = (std::min)((std::max)(S(-2), position), last + S(2));
      const S nearest = std::floor(clamped + S(0.5L)), t = clamped - nearest;
      for (std::size_t k = 0; k < 3; ++k) {
        const S i = nearest + static_cast<S>(k) - S(1);
        node[k] = static_cast<std::size_t>((std::min)((std::max)(S(0), i), last));
      }
      const S a = S(0.5L) - t, b = S(0.5L) + t;
      value = {a * a / S(2), S(0.75L) - t * t, b * b / S(2)};
      slope = {-a, S(-2) * t, b};
    }
  };

  // c to c', inside the rim.
  void sharpen() {
    const std::vector<Pair> given = nodes_;
    const std::array<std::size_t, 3> step{1, count_[0], count_[0] * count_[1]};
    for (std::size_t z = 1; z + 1 < count_[2]; ++z)
      for (std::size_t y = 1; y + 1 < count_[1]; ++y)
        for (std::size_t x = 1; x + 1 < count_[0]; ++x) {
          const std::size_t i = x + y * step[1] + z * step[2];
          Pair sharp = S(1.75L) * given[i];  // 1 + 6/8
          for (const std::size_t to : step) sharp -= (given[i - to] + given[i + to]) / S(8);
          if (is_finite(sharp[0]) && is_finite(sharp[1]) && L::may_sharpen(given[i], sharp))
            nodes_[i] = sharp;
        }
  }

  // What holds at each node must hold of every blend: a sum of 27 rounded products.
  void check_blends() const {
    Pair least = nodes_.front(), most = least;
    for (const Pair& c : nodes_) {
      least = least.min(c);
      most = most.max(c);
    }
    const S largest = (std::max)(most.abs().maxCoeff(), least.abs().maxCoeff());
    if (!(largest <= (std::numeric_limits<S>::max)() / S(2)))
      fail(L::name, "coefficients are out of the scalar's range", static_cast<double>(largest));
    if constexpr (requires { L::check_blends(least, most); }) L::check_blends(least, most);
  }

  S w_;
  Vec3<S> lower_;  // the first node
  std::array<std::size_t, 3> count_;
  std::vector<Pair> nodes_;  // x fastest
  S max_depth_ = std::numeric_limits<S>::infinity();
};

}  // namespace palpate
