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
/// on 50 points is 3.4 % too stiff, with this it is within 0.3 %. Source: [johnson1985], ch. 3;
/// [marin2014].

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/core/simd.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/core/simd_vec3.hpp>

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

  PointSystem(std::size_t capacity, bool has_friction) : has_friction_(has_friction) {
    const std::size_t padded = AlignedList<float>::padded(capacity);
    for (auto* list : {&area_, &weight_}) list->resize(padded);
    for (auto* list : {&x_at_, &x_, &n_}) list->resize(padded);
    for (auto& axis : axis_) axis.resize(padded);
    matrix_[0][0].resize(padded * capacity);
    if (has_friction)
      for (auto& row : matrix_)
        for (auto& entry : row) entry.resize(padded * capacity);
    axes_.resize(capacity);
    depth.resize(padded);
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::size_t stride() const noexcept { return stride_; }
  void clear() noexcept { size_ = 0; }
  /// A point at x, `deep` beneath the surface along its inward normal n, with its cell's area. Precondition:
  /// fewer than the capacity.
  void add(const Vec3<float>& x, const Vec3<float>& n, float deep, float area) noexcept {
    x_at_.set(size_, x);
    n_.set(size_, n);
    depth[size_] = deep;
    area_[size_] = area;
    weight_[size_++] = deep * area;
  }
  /// The direction of pressing, first and second tangent of point i, by column.
  [[nodiscard]] const Mat3<float>& axes(std::size_t i) const noexcept { return axes_[i]; }
  [[nodiscard]] Vec3<float> normal(std::size_t i) const noexcept { return n_[i]; }
  /// Where the load of point i acts on the undeformed surface.
  [[nodiscard]] Vec3<float> foot(std::size_t i) const noexcept { return x_[i]; }

  /// Directions, depths along them, and matrices of all points.
  void build(float b) noexcept {
    stride_ = padded<V>(size_);
    for (std::size_t i = size_; i < stride_; ++i) {
      for (auto* list : {&x_at_, &x_}) list->set(i, Vec3<float>::Constant(1e3f));  // apart from all points
      n_.set(i, Vec3<float>::Zero());
      for (auto& axis : axis_) axis.set(i, Vec3<float>::Zero());
      weight_[i] = area_[i] = 0;
    }
    direct();
    for (std::size_t j = 0; j < size_; ++j) column(j, b);
  }

  /// y = A q, the displacements along the first axes by forces along them.
  void normal_displacements(const float* q, float* y) const noexcept {
    for (std::size_t i = 0; i < stride_; i += V::size()) store(y + i, V{});
    add(matrix_[0][0], q, y);
  }
  /// Displacements along the tangents by tractions.
  void tangential_displacements(const float* s, const float* t, float* us, float* ut) const noexcept {
    for (std::size_t i = 0; i < stride_; i += V::size()) store(us + i, V{}), store(ut + i, V{});
    add(matrix_[1][1], s, us), add(matrix_[1][2], t, us);
    add(matrix_[2][1], s, ut), add(matrix_[2][2], t, ut);
  }
  void add_normal_by_tractions(const float* s, const float* t, float* y) const noexcept {
    add(matrix_[0][1], s, y), add(matrix_[0][2], t, y);
  }
  void add_tangential_by_pressures(const float* q, float* us, float* ut) const noexcept {
    add(matrix_[1][0], q, us), add(matrix_[2][0], q, ut);
  }
  /// The displacement along n at a further point of the surface by the pressures q.
  [[nodiscard]] float normal_displacement_at(const float* q, float b, const Vec3<float>& x,
                                             const Vec3<float>& n, float area) const noexcept {
    Mat3<float> axes = Mat3<float>::Zero();
    axes.col(0) = n;
    V sum{};
    for (std::size_t i = 0; i < stride_; i += V::size())
      entries<1>(i, axes, between(i, x, area), b,
                 [&](std::size_t, std::size_t, const V& value) { sum += V(q + i) * value; });
    return reduce(sum);
  }

  /// The direction in which a point at x presses, where the surface's inward normal is n: the mean of the
  /// contact's normals, for the surface turns from its own normal to the tool's, and this is halfway; against
  /// finite elements a ball pressed by half its radius is 3.6 % too stiff with the mean and 9.5 % with n.
  /// Other contacts of the tool, some widths away, hardly count.
  [[nodiscard]] Vec3<float> direction(const Vec3<float>& x, const Vec3<float>& n) const noexcept {
    const SimdVec3<V> here = each(x);
    SimdVec3<V> total{V{}, V{}, V{}};
    for (std::size_t i = 0; i < stride_; i += V::size()) {
      const SimdVec3<V> r = x_at_.load(i) - here;
      const V far = 1.f + per_size2_ * dot(r, r);
      total += (V(&weight_[i]) / (far * far)) * n_.load(i);
    }
    const Vec3<float> m = Vec3<float>(reduce(total.x), reduce(total.y), reduce(total.z)).normalized();
    return m.dot(n) > 0.5f ? m : n;  // never more than 60 degrees off the surface's normal
  }

  AlignedList<float> depth;  ///< along the first axes [m]

 private:
  struct Vectors {
    AlignedList<float> x, y, z;
    void resize(std::size_t n) { x.resize(n), y.resize(n), z.resize(n); }
    [[nodiscard]] Vec3<float> operator[](std::size_t i) const noexcept { return {x[i], y[i], z[i]}; }
    void set(std::size_t i, const Vec3<float>& v) noexcept { x[i] = v.x(), y[i] = v.y(), z[i] = v.z(); }
    [[nodiscard]] PALPATE_INLINE SimdVec3<V> load(std::size_t i) const noexcept {
      return {V(&x[i]), V(&y[i]), V(&z[i])};
    }
  };
  struct Pair {
    V inverse;      // 1/r
    SimdVec3<V> e;  // to i
  };
  [[nodiscard]] static PALPATE_INLINE SimdVec3<V> each(const Vec3<float>& v) noexcept {
    return {V(v.x()), V(v.y()), V(v.z())};
  }

  // Axes, depths along the first of them, and feet.
  void direct() noexcept {
    float sum = 0;
    for (std::size_t i = 0; i < size_; ++i) sum += area_[i];
    per_size2_ = 1 / (2 * sum);
    for (std::size_t j = 0; j < size_; ++j) axes_[j].col(0) = direction(x_at_[j], n_[j]);
    for (std::size_t j = 0; j < size_; ++j) {
      const Vec3<float> m = axes_[j].col(0), n = n_[j];
      depth[j] /= m.dot(n);
      x_.set(j, x_at_[j] - depth[j] * m);
      axes_[j].col(1) = perpendicular(m);
      axes_[j].col(2) = m.cross(axes_[j].col(1));
      for (std::size_t k = 0; k < 3; ++k) axis_[k].set(j, axes_[j].col(Eigen::Index(k)));
    }
  }

  [[nodiscard]] PALPATE_INLINE Pair between(std::size_t i, const Vec3<float>& x, float area) const noexcept {
    const SimdVec3<V> r = x_.load(i) - each(x);
    // Loads of a steep wall act at nearly one position: no nearer than half a cell, or the matrix is not
    // positive.
    const V inverse = inverse_sqrt((max)(dot(r, r), V(0.26f * area)));
    return {inverse, inverse * r};
  }
  // a_ik . K a_jl for the axes k, l < count, to entry(k, l, value).
  template <std::size_t count, class Entry>
  PALPATE_INLINE void entries(std::size_t i, const Mat3<float>& aj, const Pair& pair, float b,
                              const Entry& entry) const noexcept {
    std::array<V, count> ei, ej;
    std::array<std::array<V, count>, count> along;  // a_ik . a_jl
    for (std::size_t k = 0; k < count; ++k) {
      const SimdVec3<V> ai = axis_[k].load(i);
      ei[k] = dot(ai, pair.e);
      ej[k] = dot(pair.e, each(aj.col(Eigen::Index(k))));
      for (std::size_t l = 0; l < count; ++l) along[k][l] = dot(ai, each(aj.col(Eigen::Index(l))));
    }
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t l = 0; l < count; ++l) {
        V sum = (1 + b) * along[k][l] + (1 - b) * (ei[k] * ej[l]);
        if (b > 0)  // m e^T - e m^T with the mean of both first axes
          sum += (b / 2) * ((along[k][0] + (k == 0 ? 1.f : 0.f)) * ej[l] -
                            ei[k] * (along[0][l] + (l == 0 ? 1.f : 0.f)));
        entry(k, l, pair.inverse * sum);
      }
  }
  void column(std::size_t j, float b) noexcept {
    const Vec3<float> x = x_[j];
    const Mat3<float> axes = axes_[j];
    for (std::size_t i = 0; i < stride_; i += V::size()) {
      const Pair pair = between(i, x, area_[j]);
      const auto put = [&](std::size_t k, std::size_t l, const V& value) {
        store(&matrix_[k][l][j * stride_ + i], value);
      };
      if (has_friction_)
        entries<3>(i, axes, pair, b, put);
      else
        entries<1>(i, axes, pair, b, put);
    }
    const std::size_t own = j * stride_ + j;
    const float cell = own_cell / std::sqrt(area_[j]);
    matrix_[0][0][own] = (1 + b) * cell;
    if (!has_friction_) return;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = k == 0 ? 1 : 0; l < 3; ++l)
        matrix_[k][l][own] = k == l ? (1.5f + b / 2) * cell : 0;
  }
  void add(const AlignedList<float>& matrix, const float* load, float* u) const noexcept {
    for (std::size_t j = 0; j < size_; ++j) {
      if (load[j] == 0) continue;
      const float* const column = &matrix[j * stride_];
      for (std::size_t i = 0; i < stride_; i += V::size()) store(u + i, V(u + i) + load[j] * V(column + i));
    }
  }

  std::size_t size_ = 0, stride_ = 0;
  bool has_friction_;
  std::vector<Mat3<float>> axes_;
  AlignedList<float> area_, weight_;
  float per_size2_ = 1;   // of direct()
  Vectors x_at_, x_, n_;  // the points, their feet, normals
  std::array<Vectors, 3> axis_;
  std::array<std::array<AlignedList<float>, 3>, 3> matrix_;  // by axes of i and j, each by column
};

}  // namespace palpate::detail
