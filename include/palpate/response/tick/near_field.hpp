// SPDX-License-Identifier: MIT
#pragma once

/// @file The near field of one solved contact: the half-space's displacement at any point of the surface,
/// several points at a time. Per tick.
///
/// The surface near a contact is curved, the disc is flat. The disc is taken at the depth z of its own edge
/// below the tangent plane: for a quadric z (a/r)^2, so depth = z (1 - (a/r)^2), which vanishes at the edge.
/// The edge is at most `sagitta` deep: the side of a block is below its top by all of z.
///
/// Second order in depth, s = max(r/a, 1), beta = delta_n/a, e_p = p/r: u = q_r e_p + q_n m + q_t e_p,
///     q_r = (d_n delta_n/a) (k_r asin(1/s)/(s sqrt(s^2 - 1 + e^2)) + sqrt(1 - s^-2) (r_4 s^-4 + r_6 s^-6))
///     q_n = (d_n delta_n/a) sqrt(1 - s^-2) (n_4 s^-4 + n_6 s^-6)
///     q_t = beta^2 (delta_t . e_p) t sqrt(1 - s^-2) s^-3
/// r_4 to n_6 and t are linear in beta (DepthFactor). e is such that all terms add up to nothing at the
/// patch's edge and within it. The patch's own displacement of second order (push, slope of the couple) is
/// subtracted again outside it.
///
/// A frictionless sphere: Hertz's field and a force dipole, of which outside the contact (1 - s^-6) is drawn,
/// over 1 + 0.9 s^-2 + 0.7 s^-4 (constants.hpp); within the contact (1 - (r/a)^2) r `radial` along the
/// surface instead, less (1 - (r/a)^2) `raised` along the normal.

#include <palpate/core/simd_vec3.hpp>
#include <palpate/elasticity/flat_punch.hpp>
#include <palpate/response/tick/constants.hpp>

namespace palpate::detail {

/// Coefficients of a contact's near field (near_coefficients.hpp); forces and moments are divided by 4 pi mu.
struct NearField {
  Vec3<float> x, m;  ///< middle of the contact [m]; unit normal into the body
  float a = 1, nu = 0.5f;
  float sagitta = 0;     ///< how deep the patch's edge lies below its plane, at most [m]
  float activation = 1;  ///< 0: a contact that changes nothing (ContactSystem::activate)
  float normal = 0;      ///< force along m [m^2]
  Vec3<float> along;     ///< force along the surface [m^2]
  Vec3<float> couple;    ///< bending couple [m^3]
  float torsion = 0;     ///< couple about m [m^3]
  float dipole = 0;      ///< radial force dipole [m^3]
  Mat3<float> shear;     ///< shear dipole in the patch's plane [m^3]
  Mat3<float> rotation;  ///< of the tool, less the unit matrix
  Vec3<float> push;      ///< displacement of the patch that is taken back outside, times s^-8 [m]
  Vec3<float> slope;     ///< of the patch by the couple of second order, taken back outside, times s^-7
  float radial = 0;      ///< k_r d_n delta_n / a; of a sphere: radial displacement by r at the middle
  float raised = 0;      ///< of a sphere: less along m at the middle [m]
  float radial_4 = 0, radial_6 = 0;         ///< r_4, r_6 times d_n delta_n / a^2
  float normal_4 = 0, normal_6 = 0;         ///< n_4, n_6 times d_n delta_n / a [m]
  Vec3<float> slide = Vec3<float>::Zero();  ///< t beta^2 delta_t / a^2 [1/m]
  float pole2 = 1;                          ///< e^2
  bool is_sphere = false;                   ///< Hertz's weight
  bool has_loads = false;                   ///< any load beside the force
  bool has_couple = false, has_torsion = false, has_shear = false;

  /// All loads times `share`.
  [[nodiscard]] NearField scaled(float share) const noexcept {
    NearField out = *this;
    for (Vec3<float>* part : {&out.along, &out.couple, &out.slope, &out.push, &out.slide}) *part *= share;
    out.shear *= share;
    for (float* part : {&out.normal, &out.torsion, &out.dipole, &out.radial, &out.raised, &out.radial_4,
                        &out.radial_6, &out.normal_4, &out.normal_6})
      *part *= share;
    return out;
  }
  /// Displacement [m] at points `at`.
  template <class V>
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> operator()(const SimdVec3<V>& at) const noexcept {
    const Seen<V> seen = see(at);
    return is_sphere ? of_sphere(seen) : of_patch(seen);
  }

 private:
  // The contact as points see it.
  template <class V>
  struct Seen {
    SimdVec3<V> p;  // from its middle, along the surface
    V r2, near2;    // distance^2; 1 / s^2 = min(1, (a/r)^2)
    Disc<V, float> disc;
  };
  template <class V>
  [[nodiscard]] PALPATE_INLINE Seen<V> see(const SimdVec3<V>& at) const noexcept {
    const V rx = at.x - x.x(), ry = at.y - x.y(), rz = at.z - x.z();
    const V z = rx * m.x() + ry * m.y() + rz * m.z();
    const SimdVec3<V> p{rx - z * m.x(), ry - z * m.y(), rz - z * m.z()};
    const V r2 = (max)(rx * rx + ry * ry + rz * rz, tick::min_distance2 * a * a),
            near2 = (min)(a * a / r2, 1.f), depth = (max)(z - (min)(z * near2, sagitta), V{});
    return {p, r2, near2, {p.x * p.x + p.y * p.y + p.z * p.z, depth, a}};
  }
  template <class V>
  [[nodiscard]] static PALPATE_INLINE V dot(const SimdVec3<V>& p, const Vec3<float>& v) noexcept {
    return p.x * v.x() + p.y * v.y() + p.z * v.z();
  }
  template <class V>
  static PALPATE_INLINE void add(SimdVec3<V>& u, const V& k, const Vec3<float>& v) noexcept {
    u.x += k * v.x();
    u.y += k * v.y();
    u.z += k * v.z();
  }

  template <class V>
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> of_sphere(const Seen<V>& seen) const noexcept {
    const SimdVec3<V>& p = seen.p;
    auto u = seen.disc.hertz(normal, nu);
    if (has_loads) {
      const auto d = seen.disc.force_dipole(nu), t = seen.disc.flat_punch(0, dot(p, along), nu);
      const V near4 = seen.near2 * seen.near2,
              share = (1.f - near4 * seen.near2) /
                      (1.f + tick::hertz_dipole_2 * seen.near2 + tick::hertz_dipole_4 * near4),
              within = (max)(1.f - seen.r2 / (a * a), V{});
      u.in_plane += t.in_plane + dipole * share * d.in_plane + radial * within;
      u.normal += t.normal + dipole * share * d.normal - raised * within;
      u.along = t.along;
    }
    return {u.in_plane * p.x + u.normal * m.x() + u.along * along.x(),
            u.in_plane * p.y + u.normal * m.y() + u.along * along.y(),
            u.in_plane * p.z + u.normal * m.z() + u.along * along.z()};
  }

  // Displacements of a patch add up along p, along m and along vectors of their own.
  template <class V>
  struct Sum {
    V in_plane, normal;
    V slope_back{};  // s^-7: what of the patch's slope is taken back at r
    SimdVec3<V> out;
  };
  template <class V>
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> of_patch(const Seen<V>& seen) const noexcept {
    const SimdVec3<V>& p = seen.p;
    const auto u = seen.disc.flat_punch(normal, dot(p, along), nu);
    Sum<V> sum{u.in_plane, u.normal, {}, {u.along * along.x(), u.along * along.y(), u.along * along.z()}};
    if (has_loads) add_loads(seen, sum);
    if (has_couple) add_couple(seen, sum);
    if (has_torsion) add_torsion(seen, sum);
    if (has_shear) add_shear(seen, sum);
    SimdVec3<V>& out = sum.out;
    out.x += sum.in_plane * p.x + sum.normal * m.x();
    out.y += sum.in_plane * p.y + sum.normal * m.y();
    out.z += sum.in_plane * p.z + sum.normal * m.z();
    return out;
  }
  // The dipole, the near terms q, and the push that is taken back.
  template <class V>
  PALPATE_INLINE void add_loads(const Seen<V>& seen, Sum<V>& sum) const noexcept {
    const auto d = seen.disc.force_dipole(nu);
    const V &near2 = seen.near2, inverse = sqrt(near2),
            beyond = (max)(1.f - near2, V{});  // 1 / s; 1 - 1 / s^2
    // q_r / (a s): asin(1/s) / (s sqrt(s^2 - 1 + e^2)), with the roots of 1/s^2 instead.
    const V q_r = (radial / a) * arc_sine(inverse) * near2 * inverse /
                  sqrt((max)(beyond + pole2 * near2, tick::min_distance2));
    const V near4 = near2 * near2, falling = near4 * sqrt(beyond);
    sum.in_plane +=
        dipole * d.in_plane + q_r + inverse * falling * (radial_4 + radial_6 * near2 + dot(seen.p, slide));
    const V back = near4 * near4;
    sum.slope_back = back * inverse;
    sum.normal += dipole * d.normal + falling * (normal_4 + normal_6 * near2);
    sum.out.x -= back * push.x();
    sum.out.y -= back * push.y();
    sum.out.z -= back * push.z();
  }
  template <class V>
  PALPATE_INLINE void add_couple(const Seen<V>& seen, Sum<V>& sum) const noexcept {
    const auto t = seen.disc.bending_couple(dot(seen.p, couple), nu);
    sum.in_plane += t.in_plane;
    sum.normal += t.normal - sum.slope_back * dot(seen.p, slope);
    add(sum.out, t.along, couple);
  }
  template <class V>
  PALPATE_INLINE void add_torsion(const Seen<V>& seen, Sum<V>& sum) const noexcept {
    const V around = torsion * seen.disc.torsional_couple();
    sum.out.x += around * (m.y() * seen.p.z - m.z() * seen.p.y);
    sum.out.y += around * (m.z() * seen.p.x - m.x() * seen.p.z);
    sum.out.z += around * (m.x() * seen.p.y - m.y() * seen.p.x);
  }
  template <class V>
  PALPATE_INLINE void add_shear(const Seen<V>& seen, Sum<V>& sum) const noexcept {
    const SimdVec3<V>& p = seen.p;
    const SimdVec3<V> sp{dot(p, shear.col(0)), dot(p, shear.col(1)), dot(p, shear.col(2))};  // symmetric
    const auto s = seen.disc.shear_dipole(p.x * sp.x + p.y * sp.y + p.z * sp.z, nu);
    sum.in_plane += s.in_plane;
    sum.normal += s.normal;
    sum.out.x += s.along * sp.x;
    sum.out.y += s.along * sp.y;
    sum.out.z += s.along * sp.z;
  }
};

}  // namespace palpate::detail
