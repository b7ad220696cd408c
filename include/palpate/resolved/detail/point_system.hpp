// SPDX-License-Identifier: MIT
#pragma once

/// @file What loads at a contact's points do to each other on the half-space: the matrices of a tick.
///
///     u_i = sum_j K_ij P_j,   P = f / (4 pi mu),   e = (X_i - X_j)/r,   b = 1 - 2 nu
///     K_ij = ((1 + b) I + (1 - b) e e^T + b (m e^T - e m^T)) / r                        Boussinesq, Cerruti
///     K_ii = k/sqrt(A_i) ((1 + b) I + (1 - b)/2 (I - m m^T)),   k = 3.92               own cell
///
/// X_i: where the point's load acts on the undeformed surface, m: the mean of both points' directions. k
/// makes the sum over an even lattice equal to the integral of any smooth pressure, as in the corrected
/// trapezoidal rule for 1/r: 3.900 for squares, 3.921 for hexagons. With the mean over a disc, 3.01, a ball
/// on 50 points is 3.4 % too stiff, with this it is within 0.3 %. K_ji = K_ij^T: pairs i > j are kept.
/// Source: [johnson1985], ch. 3; [marin2014].

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/core/simd.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/core/simd_vec3.hpp>
#include <palpate/core/unroll.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace palpate::detail {

/// Points in contact and what they do to each other. Each has axes of its own: the direction in which it
/// presses, into the body, and two tangents; loads and displacements are along these.
class PointSystem {
 public:
  using V = native_simd<float>;
  static constexpr float own_cell = 3.92f;

  /// A place that is far from all points, to fill up registers with [m].
  [[nodiscard]] static Vec3<float> apart() noexcept { return Vec3<float>::Constant(1e3f); }
  /// Vectors of space, coordinate by coordinate.
  struct Vectors {
    AlignedList<float> x, y, z;
    void resize(std::size_t n) { x.resize(n), y.resize(n), z.resize(n); }
    [[nodiscard]] Vec3<float> operator[](std::size_t i) const noexcept { return {x[i], y[i], z[i]}; }
    void set(std::size_t i, const Vec3<float>& v) noexcept { x[i] = v.x(), y[i] = v.y(), z[i] = v.z(); }
    [[nodiscard]] PALPATE_INLINE SimdVec3<V> load(std::size_t i) const noexcept {
      return {V(&x[i]), V(&y[i]), V(&z[i])};
    }
    PALPATE_INLINE void store(std::size_t i, const SimdVec3<V>& v) noexcept {
      v.x.copy_to(&x[i]), v.y.copy_to(&y[i]), v.z.copy_to(&z[i]);
    }
  };

  PointSystem(std::size_t capacity, float compressibility, bool has_friction)
      : has_friction_(has_friction), b_(compressibility) {
    const std::size_t padded = AlignedList<float>::padded(capacity);
    for (auto* list : {&depth, &area_, &per_width_, &group_weight_}) list->resize(padded);
    for (auto* list : {&x_at_, &x_, &n_, &group_x_, &group_n_}) list->resize(padded);
    for (auto& axis : axis_) axis.resize(padded);
    for (std::size_t k = 0; k < (has_friction ? 3 : 1); ++k) {
      back_[k].resize(padded);
      for (std::size_t l = 0; l < (has_friction ? 3 : 1); ++l) matrix_[k][l].resize(padded * capacity);
    }
    axes_.resize(capacity);
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::size_t stride() const noexcept { return stride_; }
  void clear() noexcept {
    size_ = groups_ = 0;
    deepest_ = volume_ = 0;
  }
  /// Any point beneath the surface counts for the direction of pressing: x, inward normal n, depth along it,
  /// area of its cell. Points of the same `group` follow each other and lie side by side.
  void touch(const Vec3<float>& x, const Vec3<float>& n, float deep, float area,
             std::uint32_t group) noexcept {
    const float weight = deep * area;
    deepest_ = (std::max)(deepest_, deep);
    volume_ += weight;
    if (groups_ == 0 || group != last_group_) {
      last_group_ = group;
      group_weight_[groups_] = 0;
      for (auto* list : {&group_x_, &group_n_}) list->set(groups_, Vec3<float>::Zero());
      ++groups_;
    }
    const std::size_t g = groups_ - 1;
    group_weight_[g] += weight;
    group_x_.set(g, group_x_[g] + weight * x);
    group_n_.set(g, group_n_[g] + weight * n);
  }
  /// A point that is solved for, after all touch(). Precondition: fewer than the capacity.
  void add(const Vec3<float>& x, const Vec3<float>& n, float deep, float area) noexcept {
    x_at_.set(size_, x);
    n_.set(size_, n);
    depth[size_] = deep;
    area_[size_++] = area;
  }
  /// The direction of pressing, first and second tangent of point i, by column.
  [[nodiscard]] const Mat3<float>& axes(std::size_t i) const noexcept { return axes_[i]; }
  [[nodiscard]] Vec3<float> normal(std::size_t i) const noexcept { return n_[i]; }
  [[nodiscard]] Vec3<float> position(std::size_t i) const noexcept { return x_at_[i]; }
  [[nodiscard]] float area(std::size_t i) const noexcept { return area_[i]; }
  /// Where the load of point i acts on the undeformed surface.
  [[nodiscard]] Vec3<float> foot(std::size_t i) const noexcept { return x_[i]; }

  /// Directions, depths along them, and matrices of all points.
  void build() noexcept {
    stride_ = padded<V>(size_);
    for (std::size_t i = size_; i < stride_; ++i) {
      for (auto* list : {&x_at_, &n_}) list->set(i, Vec3<float>::UnitX());
      depth[i] = 0;
    }
    direct();
    for (std::size_t j = 0; j < size_; ++j)
      if (has_friction_)
        column<3>(j);
      else
        column<1>(j);
  }

  struct Axes {
    std::size_t first, count;
  };
  static constexpr Axes pressing{0, 1}, tangents{1, 2};
  /// To u along some axes of each point come the displacements by loads along some axes.
  template <Axes To, Axes From>
  void add(const std::array<const float*, From.count>& load, const std::array<float*, To.count>& u) noexcept {
    for (std::size_t j = 0; j < size_; ++j) {
      std::array<std::array<const float*, From.count>, To.count> there, back;  // K_ij and its transpose
      unroll<To.count>([&](std::size_t k) PALPATE_INLINE_LAMBDA {
        unroll<From.count>([&](std::size_t l) PALPATE_INLINE_LAMBDA {
          there[k][l] = matrix_[To.first + k][From.first + l].data() + j * stride_;
          back[k][l] = matrix_[From.first + l][To.first + k].data() + j * stride_;
        });
      });
      std::array<V, To.count> of_others{};
      std::array<V, From.count> own;
      unroll<From.count>([&](std::size_t l) PALPATE_INLINE_LAMBDA { own[l] = V(load[l][j]); });
      for (std::size_t i = j / V::size() * V::size(); i < stride_; i += V::size())
        unroll<To.count>([&](std::size_t k) PALPATE_INLINE_LAMBDA {
          V sum(u[k] + i);
          unroll<From.count>([&](std::size_t l) PALPATE_INLINE_LAMBDA {
            sum += own[l] * V(there[k][l] + i);
            of_others[k] += V(load[l] + i) * V(back[k][l] + i);
          });
          store(u[k] + i, sum);
        });
      // Kept apart for now: a number that is written into u would hold up the registers that read it next.
      unroll<To.count>([&](std::size_t k) PALPATE_INLINE_LAMBDA { back_[k][j] = reduce(of_others[k]); });
    }
    for (std::size_t k = 0; k < To.count; ++k)
      for (std::size_t j = 0; j < size_; ++j) u[k][j] += back_[k][j];
    if constexpr (To.first == From.first) {
      const float cell = own_cell * (To.first == 0 ? 1 + b_ : 1.5f + b_ / 2);
      for (std::size_t k = 0; k < To.count; ++k)
        for (std::size_t j = 0; j < size_; ++j) u[k][j] += cell * per_width_[j] * load[k][j];
    }
  }
  /// A step of tractions that is stable for a single point, and short of what all could take [1/m].
  [[nodiscard]] float flexible_step() const noexcept {
    return 1 / ((1.5f + b_ / 2) * own_cell * per_width_[0]);
  }
  /// The displacement along n at a further point of the surface by the pressures q.
  [[nodiscard]] float normal_displacement_at(const float* q, const Vec3<float>& x, const Vec3<float>& n,
                                             float area) const noexcept {
    const Kernel kernel(b_);
    V sum{};
    for (std::size_t i = 0; i < stride_; i += V::size()) {
      const SimdVec3<V> mi = axis_[0].load(i);
      const Pair pair = between(i, x, mi, each(n), area);
      sum += V(q + i) * dot(mi, kernel(pair, each(n)));
    }
    return reduce(sum);
  }

  /// The direction in which a point at x presses, where the surface's inward normal is n: the mean of the
  /// contact's normals, for the surface turns from its own normal to the tool's, and this is halfway; against
  /// finite elements a ball pressed by half its radius is 3.6 % too stiff with the mean and 9.5 % with n.
  /// Weights are what is pressed in, so that m is continuous in the pose. Other contacts of the tool, some
  /// widths away, hardly count.
  template <SimdOrReal W>
  [[nodiscard]] PALPATE_INLINE SimdVec3<W> direction(const SimdVec3<W>& x,
                                                     const SimdVec3<W>& n) const noexcept {
    SimdVec3<W> total{W(0.f), W(0.f), W(0.f)};
    for (std::size_t g = 0; g < groups_; ++g) {
      const SimdVec3<W> r = each<W>(group_x_[g]) - x;
      const W far = 1.f + per_size2_ * dot(r, r);
      total += (1.f / (far * far)) * each<W>(group_n_[g]);
    }
    const SimdVec3<W> m = inverse_sqrt(dot(total, total)) * total;
    // From 37 to 60 degrees off it goes over to the surface's own normal, as over an edge of the body.
    const W share = clamp(W((dot(m, n) - 0.5f) * (1 / 0.3f)), 0.f, 1.f);
    const SimdVec3<W> mixed = share * m + (1.f - share) * n;
    return inverse_sqrt(dot(mixed, mixed)) * mixed;
  }

  [[nodiscard]] Vec3<float> direction_at(const Vec3<float>& x, const Vec3<float>& n) const noexcept {
    const SimdVec3<float> m = direction(each<float>(x), each<float>(n));
    return {m.x, m.y, m.z};
  }

  AlignedList<float> depth;  ///< along the first axes [m]

 private:
  struct Pair {
    V inverse;      // 1/r
    SimdVec3<V> e;  // from j to i
    SimdVec3<V> m;  // mean of both directions of pressing
  };
  template <SimdOrReal W = V>
  [[nodiscard]] static PALPATE_INLINE SimdVec3<W> each(const Vec3<float>& v) noexcept {
    return {W(v.x()), W(v.y()), W(v.z())};
  }

  // Axes, depths along the first of them, and feet.
  void direct() noexcept {
    for (std::size_t i = 0; i < size_; ++i) per_width_[i] = 1 / std::sqrt(area_[i]);
    per_size2_ = deepest_ / (2 * volume_);
    for (std::size_t g = 0; g < groups_; ++g) group_x_.set(g, group_x_[g] / group_weight_[g]);
    for (std::size_t i = 0; i < stride_; i += V::size()) {
      const SimdVec3<V> n = n_.load(i), m = direction(x_at_.load(i), n);
      const V deep = V(&depth[i]) / dot(m, n);
      deep.copy_to(&depth[i]);
      x_.store(i, x_at_.load(i) - deep * m);
      axis_[0].store(i, m);
    }
    for (std::size_t i = size_; i < stride_; ++i) {  // what fills up presses on no point
      x_.set(i, apart());
      for (auto& axis : axis_) axis.set(i, Vec3<float>::Zero());
    }
    for (std::size_t i = 0; i < size_; ++i) {
      Mat3<float>& axes = axes_[i];
      axes.col(0) = axis_[0][i];
      axes.col(1) = perpendicular(axis_[0][i]);
      axes.col(2) = axes.col(0).cross(axes.col(1));
      for (std::size_t k = 1; k < 3; ++k) axis_[k].set(i, axes.col(Eigen::Index(k)));
    }
  }

  // Points i .. on, pressing along mi, seen from a point at x that presses along m.
  [[nodiscard]] PALPATE_INLINE Pair between(std::size_t i, const Vec3<float>& x, const SimdVec3<V>& mi,
                                            const SimdVec3<V>& m, float area) const noexcept {
    const SimdVec3<V> r = x_.load(i) - each(x);
    // Loads of a steep wall act at nearly one position: no nearer than half a cell, or the matrix is not
    // positive.
    const V inverse = inverse_sqrt((max)(dot(r, r), V(0.26f * area)));
    return {inverse, inverse * r, V(0.5f) * (mi + m)};
  }
  struct Kernel {
    V b, plus, minus;  // 1 + b, 1 - b
    explicit PALPATE_INLINE Kernel(float c) noexcept : b(c), plus(1 + c), minus(1 - c) {}
    // K_ij f.
    [[nodiscard]] PALPATE_INLINE SimdVec3<V> operator()(const Pair& p, const SimdVec3<V>& f) const noexcept {
      const V along = dot(p.e, f);
      return (plus * p.inverse) * f + (p.inverse * (minus * along - b * dot(p.m, f))) * p.e +
             (p.inverse * b * along) * p.m;
    }
  };
  template <std::size_t count>
  void column(std::size_t j) noexcept {
    const Vec3<float> x = x_[j];
    std::array<SimdVec3<V>, count> axes;
    for (std::size_t l = 0; l < count; ++l) axes[l] = each(axes_[j].col(Eigen::Index(l)));
    std::array<std::array<float*, count>, count> to;
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t l = 0; l < count; ++l) to[k][l] = matrix_[k][l].data() + j * stride_;
    const float area = area_[j];
    const Kernel kernel(b_);
    const std::size_t first = j / V::size() * V::size();
    for (std::size_t i = first; i < stride_; i += V::size()) {
      std::array<SimdVec3<V>, count> at;
      unroll<count>([&](std::size_t k) PALPATE_INLINE_LAMBDA { at[k] = axis_[k].load(i); });
      const Pair pair = between(i, x, at[0], axes[0], area);
      unroll<count>([&](std::size_t l) PALPATE_INLINE_LAMBDA {
        const SimdVec3<V> u = kernel(pair, axes[l]);
        unroll<count>([&](std::size_t k) PALPATE_INLINE_LAMBDA { store(to[k][l] + i, dot(at[k], u)); });
      });
    }
    for (std::size_t i = first; i <= j; ++i)
      for (std::size_t k = 0; k < count; ++k)
        for (std::size_t l = 0; l < count; ++l) to[k][l][i] = 0;
  }

  std::size_t size_ = 0, stride_ = 0, groups_ = 0;
  std::uint32_t last_group_ = 0;
  bool has_friction_;
  float b_ = 0;  // 1 - 2 nu
  float deepest_ = 0, volume_ = 0,
        per_size2_ = 1;  // the volume pressed over the depth: a ball's contact area
  std::vector<Mat3<float>> axes_;
  AlignedList<float> area_, per_width_, group_weight_;
  Vectors x_at_, x_, n_;       // the points, their feet, normals
  Vectors group_x_, group_n_;  // sums over a group by depth and area; x: the mean
  std::array<Vectors, 3> axis_;
  std::array<std::array<AlignedList<float>, 3>, 3> matrix_;  // by axes of i and j, i > j, each by column
  std::array<AlignedList<float>, 3> back_;                   // of add()
};

}  // namespace palpate::detail
