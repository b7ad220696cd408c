// SPDX-License-Identifier: MIT
#pragma once

/// @file The field of a resolved contact's loads: at the vertices of the boundary element mesh, and near the
/// loads anywhere on the surface.
///
///     u = sum_k F_k . w_k + sum_i u_near,i,   F_k = sum_i g_ik P_i
///
/// w_k: influence functions of the load mesh's nodes, g: the points' weights there, as in the regular part of
/// the solve. u_near: point_load() of elasticity/, within a cell's width, r^2 < A, with
///
///     (3.92 - 5.84 s + 3.42 s^2 - 0.5 s^3) / sqrt(A),   s = r^2 / A     in place of 1/r
///
/// At the points this is the solve's own cell; value and slope are 1/r's at r^2 = A; the last coefficient
/// makes the sum over a lattice of equal loads even: within 0.16/sqrt(A) all over squares and hexagons, half
/// a percent of the depth with 65 points. A load's `raised`, b, is taken back within its cell:
///
///     u -= b (1 - s)^2 m,   s < 1     (over a square lattice of equal b they sum up to b to 1.12 b)
///
/// At a rim, whose loads are uneven, the surface is off by 15 %: what is then inside the tool, as its points
/// y_i and normals n_i tell, is moved out along the mean direction of pressing, M:
///
///     u += s t M,   t = min (n_i.(y_i - y) + e_i)/(n_i.M),   t >= 0,   n_i.M >= 0.3,   y = x + u
///
/// over the loads with y in their cells, r_i^2 = |y - y_i|^2 < A_i. So that nothing jumps where y leaves a
/// cell, e_i = 0.02 sqrt(A_i) max(0, 1/(4 v_i) - 1), v_i = 1 - r_i^2/A_i; M has the weights v_i^2, s = max 2
/// v_i <= 1.

#include <palpate/contact/surface_load.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/core/simd_vec3.hpp>
#include <palpate/response/tick/drawing.hpp>
#include <palpate/response/tick/solved_nodes.hpp>
#include <palpate/response/tick/vertex_field.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace palpate::detail {

/// A load in single precision, over 4 pi mu.
struct NearLoad {
  Vec3<float> x, m;  ///< where; direction of pressing
  Vec3<float> P;     ///< [m^2]
  float area;        ///< [m^2]
  Vec3<float> y, n;  ///< the tool's point, its outward normal
  float raised;      ///< [m]

  /// Displacement [m] at `at`; b = 1 - 2 nu.
  template <class V>
  PALPATE_INLINE void add(const SimdVec3<V>& at, float b, SimdVec3<V>& u) const noexcept {
    const SimdVec3<V> r{at.x - x.x(), at.y - x.y(), at.z - x.z()};
    const V r2 = dot(r, r), i2 = 1.f / (max)(r2, V(area)), i1 = sqrt(i2);
    const V s = r2 * (1 / area),
            inner = (1 / std::sqrt(area)) * (3.92f + s * (-5.84f + s * (3.42f - 0.5f * s)));
    const V inverse = select(s < V(1.f), inner, i1);
    // In the middle of the cell r (P.r)/r^2 is its mean over all directions along the surface.
    const V outer = r2 * i2, half = 0.5f * (1.f - outer);
    const float Pm = P.dot(m);
    const Vec3<float> t = P - Pm * m;
    const V along = i2 * of(P, r);
    u.x += inverse * (P.x() + half * t.x() + along * r.x);
    u.y += inverse * (P.y() + half * t.y() + along * r.y);
    u.z += inverse * (P.z() + half * t.z() + along * r.z);
    if (raised > 0) {
      const V within = (max)(1.f - s, V(0.f)), back = raised * within * within;
      u.x -= back * m.x(), u.y -= back * m.y(), u.z -= back * m.z();
    }
    if (!(b > 0)) return;
    const V z = of(m, r), s1 = 1.f / (max)(1.f + z * i1, V(0.1f)),
            tp = of(t, r);  // as point_load() bounds it
    const SimdVec3<V> p{r.x - z * m.x(), r.y - z * m.y(), r.z - z * m.z()};
    const V scale = b * inverse, by_m = Pm + tp * i1 * s1, by_t = (1.f - half) * s1,
            by_p = i1 * s1 * (Pm + tp * i1 * s1);
    u.x += scale * (by_m * m.x() + by_t * t.x() - by_p * p.x);
    u.y += scale * (by_m * m.y() + by_t * t.y() - by_p * p.y);
    u.z += scale * (by_m * m.z() + by_t * t.z() - by_p * p.z);
  }

  /// v of a displaced position, 0 beside the cell and where the tool's normal is not known.
  template <class V>
  [[nodiscard]] PALPATE_INLINE V within(const SimdVec3<V>& at) const noexcept {
    const SimdVec3<V> r{at.x - y.x(), at.y - y.y(), at.z - y.z()};
    return (max)(V(n.squaredNorm()) - dot(r, r) * (1 / area), V(0.f));
  }
  /// How far along M a displaced position with v > 0 is inside the tool [m].
  template <class V>
  [[nodiscard]] PALPATE_INLINE V inside(const SimdVec3<V>& at, const V& v,
                                        const SimdVec3<V>& M) const noexcept {
    const V e = 0.02f * std::sqrt(area) * (max)(0.25f / (max)(v, V(1e-3f)) - 1.f, V(0.f));
    return (n.dot(y) - of(n, at) + e) / (max)(of(n, M), V(0.3f));
  }

 private:
  template <class V>
  [[nodiscard]] static PALPATE_INLINE V of(const Vec3<float>& f, const SimdVec3<V>& r) noexcept {
    return r.x * f.x() + r.y * f.y() + r.z * f.z();
  }
};

/// All loads as the drawing sees them: one near field, with a ball around it.
struct NearLoads {
  Vec3<float> x = Vec3<float>::Zero();  ///< middle [m]
  float a = 0;                          ///< all loads are within [m]
  float cell = 0;                       ///< the widest cell [m]
  float activation = 1;
  float b = 0;  ///< 1 - 2 nu
  std::span<const NearLoad> loads;

  template <class V>
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> operator()(const SimdVec3<V>& at) const noexcept {
    SimdVec3<V> u{V(0.f), V(0.f), V(0.f)};
    for (const NearLoad& load : loads) load.add(at, b, u);
    return u;
  }
  /// Moves what is inside the tool out of it; u: displacement of `at` [m].
  template <class V>
  PALPATE_INLINE void rest_on_tool(const SimdVec3<V>& at, SimdVec3<V>& u) const noexcept {
    const SimdVec3<V> at_last = at + u;
    SimdVec3<V> M{V(0.f), V(0.f), V(0.f)};
    V most(0.f), least((std::numeric_limits<float>::max)());
    for (const NearLoad& load : loads) {
      const V v = load.within(at_last);
      most = (max)(most, v);
      M += v * v * each<V>(load.m);
    }
    if (!(reduce_max(most) > 0)) return;
    M = inverse_sqrt((max)(dot(M, M), V((std::numeric_limits<float>::min)()))) * M;
    for (const NearLoad& load : loads)
      if (const V v = load.within(at_last); reduce_max(v) > 0)
        least = (min)(least, select(v > V(0.f), load.inside(at_last, v, M), least));
    u += clamp(2.f * most, 0.f, 1.f) * (max)(least, V(0.f)) * M;
  }
};

/// What the drawing of the field reads (tick/drawing.hpp).
struct DrawnLoads {
  NearLoads near;
  double largest2 = 0;  ///< of the field [m^2]
  [[nodiscard]] double displacement2() const noexcept { return largest2; }
};

template <class V>
PALPATE_INLINE void follow_tool(const DrawnLoads& loads, const SimdVec3<V>& at, float /*reach*/,
                                SimdVec3<V>& u) noexcept {
  const SimdVec3<V> r = at - each<V>(loads.near.x);
  // A cell's width round a load, and as much again by which that has been moved.
  const float most = loads.near.a + 2 * loads.near.cell;
  if (reduce_min(dot(r, r)) < most * most) loads.near.rest_on_tool(at, u);
}

/// Holds the buffers; no heap after construction. The field must outlive it.
class LoadField {
 public:
  LoadField(const ResponseField& field, std::size_t capacity)
      : field_(&field),
        near_loads_(capacity),
        force_(3 * field.load_mesh().solved(), 0.f),
        total_(3 * field.stride(), 0.f),
        near_(total_) {
    used_.reserve(field.load_mesh().solved());
  }

  /// Adds up the field of loads; precondition: no more than the capacity.
  template <Real S>
  void add_up(std::span<const SurfaceLoad<S>> loads) noexcept {
    const auto n = static_cast<Eigen::Index>(field_->stride());
    place(loads);
    using Row = Eigen::Map<const Eigen::ArrayXf>;
    const auto row = [&](std::uint32_t node, std::size_t l) {
      return Row(field_->influence(node, l), 3 * n);
    };
    Eigen::Map<Eigen::ArrayXf> total(total_.data(), 3 * n);
    total.setZero();
    for (const std::uint32_t node : used_)
      for (std::size_t l = 0; l < 3; ++l) {
        float& f = force_[3 * node + l];
        if (f != 0) total += 0.5f * f * (row(node, l) + row(node, ResponseField::sharpened + l));
        f = 0;
      }
    near_at_vertices(*field_, drawn_.near, near_.data());
    total += Eigen::Map<const Eigen::ArrayXf>(near_.data(), 3 * n);
    hold_fixed(*field_, total_.data());
    drawn_.largest2 = max2(*field_, total_.data());
  }
  [[nodiscard]] const float* total() const noexcept { return total_.data(); }
  [[nodiscard]] DrawnList<DrawnLoads> drawn() const noexcept { return {{&drawn_, 1}, near_.data()}; }

 private:
  // Forces at the nodes, and loads in single precision.
  template <Real S>
  void place(std::span<const SurfaceLoad<S>> loads) noexcept {
    used_.clear();
    const LoadMesh& mesh = field_->load_mesh();
    const double per_load = 1 / (4 * std::numbers::pi * field_->shear_modulus());
    drawn_.near = {};
    drawn_.near.activation = 0;
    if (loads.empty()) return;
    Vec3<double> low = loads[0].position.template cast<double>(), high = low;
    float widest = 0;
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const SurfaceLoad<S>& load = loads[i];
      const Vec3<double> x = load.position.template cast<double>(),
                         f = load.force.template cast<double>() / field_->shear_modulus();
      low = low.cwiseMin(x), high = high.cwiseMax(x);
      widest = (std::max)(widest, std::sqrt(static_cast<float>(load.area)));
      const LoadPosition position = mesh.locate(x + load.shift.template cast<double>());
      FixedVector<NodeWeight, LoadMesh::most_beneath, Spare::undefined> nodes;
      add_position(mesh, position, nodes);
      const double share = regular_share(position, mean_of(&LoadNode::size, *field_, position));
      double carried = 0;
      for (const NodeWeight& at : nodes) {
        if (!(at.weight > 0)) continue;
        float* const force = &force_[3 * at.node];
        if (force[0] == 0 && force[1] == 0 && force[2] == 0 && used_.size() < used_.capacity())
          used_.push_back(at.node);
        for (std::size_t l = 0; l < 3; ++l)
          force[l] += static_cast<float>(share * at.weight * f[Eigen::Index(l)]);
        carried += at.weight;
      }
      // What falls on the fixed region moves nothing.
      const double felt = 1 - share * (std::max)(1 - carried, 0.0);
      near_loads_[i] = {
          x.template cast<float>(),
          load.direction.template cast<float>(),
          (felt * per_load * (load.force + load.by_strain).template cast<double>()).template cast<float>(),
          static_cast<float>(load.area),
          load.tool_point.template cast<float>(),
          load.tool_normal.template cast<float>(),
          static_cast<float>(load.raised)};
    }
    drawn_.near = {(0.5 * (low + high)).cast<float>(),
                   static_cast<float>(0.5 * (high - low).norm()),
                   widest,
                   1,
                   static_cast<float>(1 - 2 * field_->nu()),
                   {near_loads_.data(), loads.size()}};
  }

  const ResponseField* field_;
  DrawnLoads drawn_;
  std::vector<NearLoad> near_loads_;
  std::vector<std::uint32_t> used_;  // solved nodes with a force
  std::vector<float> force_;         // three numbers per solved node; 0 between uses
  std::vector<float> total_, near_;  // at the mesh's vertices, by coordinate
};

}  // namespace palpate::detail
