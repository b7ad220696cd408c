// SPDX-License-Identifier: MIT
#pragma once

/// @file What loads at a contact's points do to each other on the half-space: the matrix of a tick.
///
///     u_i = sum_j K_ij P_j,   P = f / (4 pi mu);   K_ij: half_space_kernel.hpp
///     K_ii = k/sqrt(A_i) ((1 + b) I + (1 - b)/2 (I - m m^T)),   k = 3.92,   b = 1 - 2 nu       own cell
///
/// k makes the sum over an even lattice equal to the integral of any smooth pressure, as in the corrected
/// trapezoidal rule for 1/r: 3.900 for squares, 3.921 for hexagons. With the mean over a disc, 3.01, a ball
/// on 50 points is 3.4 % too stiff, with this it is within 0.3 %. K_ji = K_ij^T: pairs i > j are kept.
/// Source: [johnson1985], ch. 3; [marin2014].

#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/bounded_list.hpp>
#include <palpate/resolved/detail/half_space_kernel.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace palpate::detail {

/// Points in contact and what they do to each other. Each presses along a direction of its own, m, into the
/// body. Without friction loads and displacements are along these, a number per point; with friction they are
/// vectors in object coordinates.
class PointSystem {
 public:
  using V = VectorList::V;
  static constexpr float own_cell = 3.92f;

  /// A position that is far from all points, to fill up registers with [m].
  [[nodiscard]] static Vec3<float> apart() noexcept { return Vec3<float>::Constant(1e3f); }

  PointSystem(std::size_t capacity, float compressibility, bool has_friction)
      : has_friction_(has_friction), b_(compressibility), groups_(capacity) {
    const std::size_t padded = AlignedList<float>::padded(capacity);
    for (auto* list : {&depth, &area_, &per_width_, &back_}) list->resize(padded);
    for (auto* list : {&m_, &x_at_, &x_, &n_, &backs_}) list->resize(padded);
    if (!has_friction) matrix_.resize(capacity * (capacity / 2 + 2 * V::size()));  // columns, each rounded up
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::size_t stride() const noexcept { return stride_; }
  /// Of what was given to touch(): the deepest [m], depth by area [m^3], mean of normals by that.
  [[nodiscard]] float deepest() const noexcept { return deepest_; }
  [[nodiscard]] float volume() const noexcept { return volume_; }
  [[nodiscard]] Vec3<float> mean_normal() const noexcept {
    Vec3<float> sum = Vec3<float>::Zero();
    for (const Group& group : groups_) sum += group.n;
    return sum / volume_;
  }
  /// Before a tick's first touch().
  void begin_tick() noexcept {
    groups_.clear();
    deepest_ = volume_ = 0;
  }
  /// Any point beneath the surface counts for the direction of pressing: a group of points that lie side by
  /// side, the deepest [m], the sum of depth by area [m^3], and of positions and inward normals by these.
  /// Precondition: fewer groups than the capacity.
  void touch(float deepest, float volume, const Vec3<float>& volume_x, const Vec3<float>& volume_n) noexcept {
    deepest_ = (std::max)(deepest_, deepest);
    volume_ += volume;
    groups_.push_back({volume_x / volume, volume_n});
  }
  void clear() noexcept { size_ = 0; }
  /// A point that is solved for, after all touch(). Precondition: fewer than the capacity.
  void add(const Vec3<float>& x, const Vec3<float>& n, float deep, float area) noexcept {
    x_at_.set(size_, x);
    n_.set(size_, n);
    depth[size_] = deep;
    area_[size_++] = area;
  }
  [[nodiscard]] bool has_friction() const noexcept { return has_friction_; }
  [[nodiscard]] const VectorList& directions() const noexcept { return m_; }  ///< of pressing
  [[nodiscard]] const VectorList& normals() const noexcept { return n_; }     ///< inward
  [[nodiscard]] const VectorList& positions() const noexcept { return x_at_; }
  [[nodiscard]] const VectorList& feet() const noexcept { return x_; }
  [[nodiscard]] const float* areas() const noexcept { return area_.data(); }
  [[nodiscard]] std::uint32_t groups() const noexcept { return static_cast<std::uint32_t>(groups_.size()); }
  /// Whether normals differ by a milliradian at most, their mean's length by 1e-6, ten roundings, from 1.
  [[nodiscard]] bool is_flat() const noexcept { return mean_normal().norm() >= 1 - 1e-6f; }
  /// By how much directions turn with N, the sum of weighted normals that they are along: 1/|N| [1/m^3], less
  /// where the surface's own normal counts.
  [[nodiscard]] PALPATE_INLINE V turns(std::size_t i) const noexcept {
    return direction(x_at_.load(i), n_.load(i)).turns;
  }
  /// Sum of `list`, of points, by what a group's normals count for their directions.
  [[nodiscard]] Vec3<float> turned_by(std::size_t group, const VectorList& list) const noexcept {
    const SimdVec3<V> x = each(groups_[group].x);
    SimdVec3<V> sum{};
    for (std::size_t i = 0; i < stride_; i += V::size()) sum += weight(x - x_at_.load(i)) * list.load(i);
    return sum_of(sum);
  }
  [[nodiscard]] Vec3<float> direction(std::size_t i) const noexcept { return m_[i]; }
  [[nodiscard]] Vec3<float> position(std::size_t i) const noexcept { return x_at_[i]; }
  [[nodiscard]] float area(std::size_t i) const noexcept { return area_[i]; }
  /// Where the load of point i acts on the undeformed surface.
  [[nodiscard]] Vec3<float> foot(std::size_t i) const noexcept { return x_[i]; }

  /// Directions, depths along them, and without friction the matrix of all points.
  void build() noexcept {
    stride_ = padded<V>(size_);
    for (std::size_t i = size_; i < stride_; ++i) {
      for (auto* list : {&x_at_, &n_}) list->set(i, Vec3<float>::UnitX());
      depth[i] = 0;
    }
    direct();
    if (has_friction_) return;
    float* to = matrix_.data();
    for (std::size_t j = 0; j < size_; ++j) to = b_ != 0 ? column<true>(j, to) : column<false>(j, to);
  }

  [[nodiscard]] float norm_of_depths() const noexcept {
    return Eigen::Map<const Eigen::VectorXf>(depth.data(), static_cast<Eigen::Index>(size_)).norm();
  }
  /// The surface is moved by w [m].
  void move(const Vec3<float>& w) noexcept {
    for (std::size_t i = 0; i < size_; ++i) depth[i] -= m_[i].dot(w);
  }
  /// u = K q, both along the directions of pressing. Precondition: no friction; zeros beyond size().
  void displace(const float* q, float* u) noexcept {
    const float cell = own_cell * (1 + b_);
    for (std::size_t i = 0; i < stride_; i += V::size()) (cell * V(&per_width_[i]) * V(q + i)).copy_to(u + i);
    const float* k = matrix_.data();
    for (std::size_t j = 0; j < size_; ++j) {
      const V own(q[j]);
      V back{};
      for (std::size_t i = first_of(j); i < stride_; i += V::size(), k += V::size()) {
        const V K(k);
        (V(u + i) + K * own).copy_to(u + i);
        back += K * V(q + i);
      }
      // Kept apart for now: a number that is written into u would hold up the registers that read it next.
      back_[j] = reduce(back);
    }
    for (std::size_t i = 0; i < stride_; i += V::size()) (V(u + i) + V(&back_[i])).copy_to(u + i);
  }
  /// u = K P. Precondition: friction; zeros beyond size(). The entries of K, nine for a pair, are not kept: a
  /// tick needs few products, and reading them takes longer than making them.
  void displace(const VectorList& P, VectorList& u) noexcept {
    const V along(own_cell * (1 + b_)), across(own_cell * (1.5f + b_ / 2));
    for (std::size_t i = 0; i < stride_; i += V::size()) {
      const SimdVec3<V> m = m_.load(i), load = P.load(i), cell = V(&per_width_[i]) * load;
      u.store(i, across * cell + ((along - across) * dot(m, cell)) * m);
    }
    if (b_ != 0)
      add_pairs<true>(P, u);
    else
      add_pairs<false>(P, u);
    for (std::size_t i = 0; i < stride_; i += V::size()) u.store(i, u.load(i) + backs_.load(i));
  }
  [[nodiscard]] float b() const noexcept { return b_; }
  /// Of the tangential over the normal response, all over the contact.
  [[nodiscard]] float tangential_share() const noexcept { return (1.5f + b_ / 2) / (1 + b_); }
  /// Half of the mean displacement by a unit load all over the contact's area, 3 (1 + b)/sqrt(area) [1/m]:
  /// the other half is left to the points, for loads that are not even do less.
  [[nodiscard]] Mat3<float> common() const noexcept {
    return 1.5f * (1 + b_) / std::sqrt(whole_area_) * Mat3<float>::Identity();
  }
  /// A step of normal loads that is stable for a single point, and short of what all could take [m].
  [[nodiscard]] float flexible_step() const noexcept { return 1 / ((1 + b_) * own_cell * per_width_[0]); }

  /// The displacement along n at a further point of the surface by the pressures q.
  [[nodiscard]] float normal_displacement_at(const float* q, const Vec3<float>& x, const Vec3<float>& n,
                                             float area) const noexcept {
    V sum{};
    for (std::size_t i = 0; i < stride_; i += V::size()) {
      const SimdVec3<V> mi = m_.load(i);
      sum += V(q + i) * dot(mi, pushed(b_, between(i, x, mi, each(n), area), each(n), {}));
    }
    return reduce(sum);
  }

  template <SimdOrReal W>
  struct Direction {
    SimdVec3<W> m;
    W turns;  ///< turns()
  };
  /// The direction in which a point at x presses, where the surface's inward normal is n: the mean of the
  /// contact's normals, for the surface turns from its own normal to the tool's, and this is halfway; against
  /// finite elements a ball pressed by half its radius is 3.6 % too stiff with the mean and 9.5 % with n.
  /// Weights are what is pressed in, so that m is continuous in the pose. Other contacts of the tool, some
  /// widths away, hardly count.
  template <SimdOrReal W>
  [[nodiscard]] PALPATE_INLINE Direction<W> direction(const SimdVec3<W>& x,
                                                      const SimdVec3<W>& n) const noexcept {
    SimdVec3<W> total{W(0.f), W(0.f), W(0.f)};
    for (const Group& group : groups_) total += weight(each<W>(group.x) - x) * each<W>(group.n);
    const W per_total = inverse_sqrt(dot(total, total));
    const SimdVec3<W> m = per_total * total;
    // From 37 to 60 degrees off it goes over to the surface's own normal, as over an edge of the body.
    const W share = clamp(W((dot(m, n) - 0.5f) * (1 / 0.3f)), 0.f, 1.f);
    const SimdVec3<W> mixed = share * m + (1.f - share) * n;
    return {inverse_sqrt(dot(mixed, mixed)) * mixed, share * per_total};
  }
  [[nodiscard]] Vec3<float> direction_at(const Vec3<float>& x, const Vec3<float>& n) const noexcept {
    const SimdVec3<float> m = direction(each<float>(x), each<float>(n)).m;
    return {m.x, m.y, m.z};
  }

  AlignedList<float> depth;  ///< along the directions of pressing [m]

 private:
  struct Group {
    Vec3<float> x, n;  // mean position, sum of normals, by depth and area
  };

  // Of a group at r from a point, for its direction.
  template <SimdOrReal W>
  [[nodiscard]] PALPATE_INLINE W weight(const SimdVec3<W>& r) const noexcept {
    const W far = 1.f + per_size2_ * dot(r, r);
    return 1.f / (far * far);
  }
  [[nodiscard]] static std::size_t first_of(std::size_t j) noexcept { return j / V::size() * V::size(); }

  // 0 up to lane k, then 1.
  [[nodiscard]] static V after(std::size_t k) noexcept {
    alignas(64) static constexpr auto steps = [] {
      std::array<float, 2 * V::size()> out{};
      for (std::size_t i = V::size(); i < out.size(); ++i) out[i] = 1;
      return out;
    }();
    return V(&steps[V::size() - 1 - k]);
  }
  // Directions, depths along them, and feet.
  void direct() noexcept {
    whole_area_ = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      per_width_[i] = 1 / std::sqrt(area_[i]);
      whole_area_ += area_[i];
    }
    per_size2_ = deepest_ / (2 * volume_);
    for (std::size_t i = 0; i < stride_; i += V::size()) {
      const SimdVec3<V> n = n_.load(i);
      const SimdVec3<V> m = direction(x_at_.load(i), n).m;
      const V deep = V(&depth[i]) / dot(m, n);
      deep.copy_to(&depth[i]);
      x_.store(i, x_at_.load(i) - deep * m);
      m_.store(i, m);
    }
    for (std::size_t i = size_; i < stride_; ++i) {  // what fills up presses on no point
      x_.set(i, apart());
      m_.set(i, Vec3<float>::Zero());
      per_width_[i] = 0;
      area_[i] = 1;
    }
  }

  // Points i .. on, pressing along mi, seen from a point at x that presses along m.
  [[nodiscard]] PALPATE_INLINE PointPair<V> between(std::size_t i, const Vec3<float>& x,
                                                    const SimdVec3<V>& mi, const SimdVec3<V>& m,
                                                    float area) const noexcept {
    return point_pair(x_.load(i) - each(x), mi, m, V(area));
  }
  // Column j of the matrix, of what is at and below the diagonal, to `to`. Returns its end.
  template <bool coupled>
  float* column(std::size_t j, float* to) noexcept {
    const Vec3<float> x = x_[j];
    const SimdVec3<V> m = each(m_[j]);
    const float area = area_[j];
    V keep = after(j - first_of(j));  // all of K is a multiple of 1/r
    for (std::size_t i = first_of(j); i < stride_; i += V::size(), to += V::size(), keep = V(1.f)) {
      const SimdVec3<V> mi = m_.load(i);
      PointPair<V> p = between(i, x, mi, m, area);
      p.inverse *= keep;
      dot(mi, pushed<coupled>(b_, p, m, {})).copy_to(to);
    }
    return to;
  }
  // u_i += K_ij P_j of all i > j; what these do to j, to backs_. Two columns at a time share their loads.
  template <bool coupled>
  void add_pairs(const VectorList& P, VectorList& u) noexcept {
    struct Column {
      SimdVec3<V> x, m, own, back;
      V area, keep;
    };
    const auto column_of = [&](std::size_t j) PALPATE_INLINE_LAMBDA {
      return Column{each(x_[j]), each(m_[j]), each(P[j]), {}, V(area_[j]), after(j - first_of(j))};
    };
    for (std::size_t j = 0; j < size_; j += 2) {
      Column first = column_of(j), second = column_of(j + 1);  // beyond size(): no load, and apart
      for (std::size_t i = first_of(j); i < stride_; i += V::size()) {
        const SimdVec3<V> x = x_.load(i), m = m_.load(i), load = P.load(i);
        SimdVec3<V> moved = u.load(i);
        for (Column* const c : {&first, &second}) {
          PointPair<V> p = point_pair(x - c->x, m, c->m, c->area);
          p.inverse *= c->keep;
          c->keep = V(1.f);
          moved = pushed<coupled>(b_, p, c->own, moved);
          c->back = pushed<coupled>(b_, coupled ? reversed(p) : p, load, c->back);
        }
        u.store(i, moved);
      }
      backs_.set(j, sum_of(first.back));
      backs_.set(j + 1, sum_of(second.back));
    }
  }

  std::size_t size_ = 0, stride_ = 0;
  bool has_friction_;
  float b_ = 0;  // 1 - 2 nu
  float deepest_ = 0, volume_ = 0,
        per_size2_ = 1;  // the volume pressed over the depth: a ball's contact area
  float whole_area_ = 0;
  AlignedList<float> area_, per_width_;
  VectorList m_, x_at_, x_, n_;  // directions of pressing, the points, their feet, normals
  BoundedList<Group> groups_;
  AlignedList<float> matrix_;  // without friction: pairs i > j by column
  AlignedList<float> back_;    // of displace(), without friction and with it
  VectorList backs_;
};

}  // namespace palpate::detail
