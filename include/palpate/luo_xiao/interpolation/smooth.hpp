// SPDX-License-Identifier: MIT
#pragma once

/// @file  Interpolation of minimum bending energy: no creases between faces.

#include <palpate/core/simd_math.hpp>
#include <palpate/luo_xiao/interpolation/concept.hpp>
#include <palpate/luo_xiao/interpolation/detail/face_weights.hpp>
#include <palpate/luo_xiao/interpolation/detail/triharmonic.hpp>

#include <utility>

namespace palpate {

/// Displacement vectors interpolated by a triharmonic spline in space, see `TriharmonicSpline`:
///
///     u(v) = sum_i L_i(v) u_i + H(v) (D - sum_i L_i(p) u_i)
///
/// | symbol | name                  | unit | range                                                       |
/// |--------|-----------------------|------|-------------------------------------------------------------|
/// | u_i, D | corners, displacement | m    | at most 1e6; otherwise nothing moves                        |
/// | L_i    | cardinal functions    | -    | 1 at point i, 0 at the others; set up once                  |
/// | H      | of the contact at p   | -    | 0 at the extremal points, 1 at p                            |
///
/// Twice continuously differentiable in space off the corners, linear in the load, exact on affine fields.
/// Every vertex moves with every corner: it costs n + 1 kernels per vertex where the others cost 4 weights,
/// and the field may leave the corners' range.
template <Real S>
class SmoothInterpolation {
 public:
  using Scalar = S;

  struct Load {
    bool active = false;
    Vec3<S> position = Vec3<S>::Zero();               // reduced
    std::array<Vec3<S>, max_extremal_points> kernel;  // read for active loads only
    Vec3<S> moving = Vec3<S>::Zero();
    std::array<Vec3<S>, 4> affine{};
  };

  explicit SmoothInterpolation(FacePartition<S> partition)
      : partition_(std::move(partition)), spline_(sites_of(partition_)) {
    const std::size_t n = partition_.list_length();
    kernels_.resize(spline_.size() * n);
    for (AlignedList<S>& list : reduced_) list.resize(n);
    for (const Face<S>& face : partition_.faces()) {
      for (std::size_t j = 0; j < face.length; ++j) {
        Vec3<double> x;
        for (int axis = 0; axis < 3; ++axis) x[axis] = static_cast<double>(partition_.rest(face, axis)[j]);
        x = spline_.reduced(x);
        for (std::size_t axis = 0; axis < 3; ++axis)
          reduced_[axis][face.row + j] = static_cast<S>(x[static_cast<int>(axis)]);
        for (std::size_t k = 0; k < spline_.size(); ++k)
          kernels_[k * n + face.row + j] = static_cast<S>(TriharmonicSpline::kernel(x - spline_.sites()[k]));
      }
    }
  }

  [[nodiscard]] const FacePartition<S>& partition() const noexcept { return partition_; }

  void prepare(std::span<const Vec3<S>> corners, const ContactDisplacement<S>& contact,
               Load& load) const noexcept {
    load.active = false;
    if (corners.size() != spline_.size() || !is_drawable(contact)) return;
    bool still = contact.displacement.isZero(S(0));
    for (const Vec3<S>& u : corners) {
      if (!is_drawable(u)) return;
      still = still && u.isZero(S(0));
    }
    if (still) return;
    const Vec3<double> p = spline_.reduced(contact.position.template cast<double>());
    // In units of the extent: beyond 10 the cubes would swamp the field. A contact is on the surface, near 1.
    if (!palpate::is_finite(p) || !(p.squaredNorm() < 100)) return;
    std::array<double, max_extremal_points> cardinal, values;
    TriharmonicSpline::Function own, part;
    spline_.cardinals(p, cardinal.data());
    spline_.moving(p, cardinal.data(), own);
    load.position = p.template cast<S>();
    for (int axis = 0; axis < 3; ++axis) {
      double rest = static_cast<double>(contact.displacement[axis]);
      for (std::size_t i = 0; i < spline_.size(); ++i) {
        values[i] = static_cast<double>(corners[i][axis]);
        rest -= cardinal[i] * values[i];
      }
      spline_.through(values.data(), part);
      for (std::size_t j = 0; j < spline_.size(); ++j)
        load.kernel[j][axis] = static_cast<S>(part.kernel[j] + rest * own.kernel[j]);
      for (std::size_t a = 0; a < 4; ++a)
        load.affine[a][axis] = static_cast<S>(part.affine[a] + rest * own.affine[a]);
      load.moving[axis] = static_cast<S>(rest * own.moving);
    }
    load.active = true;
  }

  [[nodiscard]] bool moves(const Load& load, std::size_t) const noexcept { return load.active; }

  [[nodiscard]] bool same(const Load& a, const Load& b, std::size_t) const noexcept {
    if (!a.active || !b.active) return a.active == b.active;
    for (std::size_t j = 0; j < spline_.size(); ++j) {
      if (a.kernel[j] != b.kernel[j]) return false;
    }
    return a.position == b.position && a.moving == b.moving && a.affine == b.affine;
  }

  PALPATE_FLATTEN void add(const Load& load, std::size_t face, std::size_t from, std::size_t count,
                           const Lists<const S>& start, const Lists<S>& to) const noexcept {
    const std::size_t first = partition_.faces()[face].row + from;
    const Terms terms(load, spline_.size());
    for (std::size_t i = 0; i < count; i += V::size()) {
      V u[3];
      evaluate(load, terms, first + i, u);
      detail::unroll<3>([&](std::size_t axis)
                            PALPATE_INLINE_LAMBDA { (V(start[axis] + i) + u[axis]).copy_to(to[axis] + i); });
    }
  }

 private:
  using V = detail::simd_group<S>;

  struct Terms {  // coefficients of u_x, u_y, u_z
    using Row = std::array<detail::simd_factor<S>, 3>;
    std::array<Row, 4> affine;
    Row moving;
    std::array<Row, max_extremal_points> kernel;

    PALPATE_INLINE Terms(const Load& load, std::size_t kernels) noexcept {
      for (std::size_t a = 0; a < 4; ++a) affine[a] = row(load.affine[a]);
      moving = row(load.moving);
      for (std::size_t j = 0; j < kernels; ++j) kernel[j] = row(load.kernel[j]);
    }
    static PALPATE_INLINE Row row(const Vec3<S>& u) noexcept {
      using F = detail::simd_factor<S>;
      return {F(u.x()), F(u.y()), F(u.z())};
    }
  };

  // The displacements at the group of slots from entry `at` of the lists on.
  PALPATE_INLINE void evaluate(const Load& load, const Terms& terms, std::size_t at,
                               V (&u)[3]) const noexcept {
    using detail::unroll;
    const V vx(&reduced_[0][at]), vy(&reduced_[1][at]), vz(&reduced_[2][at]);
    const V dx = vx - load.position.x(), dy = vy - load.position.y(), dz = vz - load.position.z(),
            square = dx * dx + dy * dy + dz * dz, moving = square * square * inverse_sqrt(square);
    unroll<3>([&](std::size_t k) PALPATE_INLINE_LAMBDA {
      u[k] = V(terms.affine[0][k]) + vx * terms.affine[1][k] + vy * terms.affine[2][k] +
             vz * terms.affine[3][k] + moving * terms.moving[k];
    });
    const S* kernel = &kernels_[at];
    for (std::size_t j = 0; j < spline_.size(); ++j, kernel += partition_.list_length()) {
      const V here(kernel);
      unroll<3>([&](std::size_t k) PALPATE_INLINE_LAMBDA { u[k] = u[k] + here * terms.kernel[j][k]; });
    }
  }

  static std::vector<Vec3<double>> sites_of(const FacePartition<S>& partition) {
    std::vector<Vec3<double>> sites;
    for (const ExtremalPoint<S>& point : partition.points())
      sites.push_back(point.position.template cast<double>());
    return sites;
  }

  FacePartition<S> partition_;
  TriharmonicSpline spline_;
  std::array<AlignedList<S>, 3> reduced_;  // vertices in the spline's coordinates
  AlignedList<S> kernels_;                 // |v - e_j|^3, site by site
};

static_assert(BlockInterpolation<SmoothInterpolation<float>> &&
              BlockInterpolation<SmoothInterpolation<double>>);

}  // namespace palpate
