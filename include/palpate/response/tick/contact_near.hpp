// SPDX-License-Identifier: MIT
#pragma once

/// @file The near field of one solved contact, a register of places at a time. Per tick.
///
/// Places near the contact lie on a bent surface, the disc in a plane. The disc is taken at the depth z of
/// its own edge below the tangent plane: for a quadric z (a/r)^2, so depth = z (1 - (a/r)^2), which vanishes
/// at the edge. The edge is at most `sag` deep: the side of a block is below its top by all of z.
///
/// Second order in depth and more, s = max(r/a, 1), beta = delta_n/a, e_p = p/r: u = q_r e_p + q_n m + q_t
/// e_p,
///     q_r = (d_n delta_n/a) (k_r asin(1/s) / (s sqrt(s^2 - 1 + e^2)) + sqrt(1 - s^-2) (r_4 s^-4 + r_6 s^-6))
///     q_n = (d_n delta_n/a) sqrt(1 - s^-2) (n_4 s^-4 + n_6 s^-6),   q_t = beta^2 (delta_t . e_p) t sqrt(1 - s^-2) s^-3
/// r_4 to n_6 and t are linear in beta (DeepFactor); beta is held at 2, for q_t at 1. e is such that all
/// terms add up to nothing at the patch's edge; they do so within, too.
///
/// A frictionless sphere: Hertz's field; a double force, of which outside the contact (1 - s^-6) is drawn,
/// over what Hertz's weight makes of it on the surface, about 1 + 0.9 s^-2 + 0.7 s^-4; within, (1 - (r/a)^2)
/// r `radial` along the surface instead.

#include <palpate/elasticity/flat_punch.hpp>

namespace palpate::detail {

/// Places or displacements, one register per axis. `V`: Float4 or FloatRegister.
template <class V>
struct Axes {
  V x, y, z;
  PALPATE_INLINE Axes& operator+=(const Axes& u) noexcept {
    x += u.x;
    y += u.y;
    z += u.z;
    return *this;
  }
  [[nodiscard]] friend PALPATE_INLINE Axes operator+(const Axes& u, const Axes& v) noexcept {
    return {u.x + v.x, u.y + v.y, u.z + v.z};
  }
  [[nodiscard]] friend PALPATE_INLINE Axes operator-(const Axes& u, const Axes& v) noexcept {
    return {u.x - v.x, u.y - v.y, u.z - v.z};
  }
  template <class K>
  [[nodiscard]] friend PALPATE_INLINE Axes operator*(const K& k, const Axes& u) noexcept {
    return {k * u.x, k * u.y, k * u.z};
  }
  [[nodiscard]] friend PALPATE_INLINE V dot(const Axes& u, const Axes& v) noexcept {
    return u.x * v.x + u.y * v.y + u.z * v.z;
  }
  [[nodiscard]] friend PALPATE_INLINE Axes cross(const Axes& u, const Axes& v) noexcept {
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  }
};
using Lane3 = Axes<Lane>;

struct ContactNear {
  Vec3<float> place, m;  ///< m: unit normal into the body
  Vec3<float> along;     ///< tangential part of the force / (4 pi mu)
  Vec3<float> tilt;      ///< moment of tilt / (4 pi mu)
  float twist = 0;       ///< moment about m / (4 pi mu)
  Vec3<float> turn;      ///< slope at the patch's edge that is taken back outside, times s^-7
  Mat3<float> shear;     ///< in the patch's plane / (4 pi mu)
  Mat3<float> turned;    ///< the tool's rotation less one
  Vec3<float> push;      ///< taken back outside the patch, times s^-8
  float normal = 0;      ///< normal part of the force / (4 pi mu)
  float dipole = 0;      ///< radial double force / (4 pi mu)
  float radial = 0;      ///< k_r d_n delta_n / a; of a sphere: along the surface, by r, at the middle
  float radial_4 = 0, radial_6 = 0;         ///< r_4 d_n delta_n / a^2, r_6 likewise
  float normal_4 = 0, normal_6 = 0;         ///< n_4 d_n delta_n / a, n_6 likewise
  Vec3<float> slide = Vec3<float>::Zero();  ///< t beta^2 delta_t / a^2
  float rim2 = 1;                           ///< e^2
  float a = 1, nu = 0.5f;
  float grip = 1;        ///< 0: let go, a contact that changes nothing (ContactSystem::loosen)
  float sag = 0;         ///< how deep the patch's edge lies below its plane, at most
  bool second = false;   ///< any load beside the force
  bool tilted = false;   ///< tilt is not zero
  bool twisted = false;  ///< twist is not zero
  bool sheared = false;  ///< shear is not zero
  bool ball = false;     ///< Hertz's weight

  /// All loads times `share`.
  void scale(float share) noexcept {
    along *= share;
    tilt *= share;
    turn *= share;
    shear *= share;
    push *= share;
    slide *= share;
    for (float* part : {&normal, &twist, &dipole, &radial, &radial_4, &radial_6, &normal_4, &normal_6})
      *part *= share;
  }
  template <class V>
  [[nodiscard]] PALPATE_INLINE Axes<V> operator()(const Axes<V>& at) const noexcept {
    const V rx = at.x - place.x(), ry = at.y - place.y(), rz = at.z - place.z();
    const V z = rx * m.x() + ry * m.y() + rz * m.z();
    const V px = rx - z * m.x(), py = ry - z * m.y(), pz = rz - z * m.z();
    const V r2 = larger(rx * rx + ry * ry + rz * rz, all_of<V>(1e-12f * a * a)),
            p2 = px * px + py * py + pz * pz;
    const V near2 = smaller(a * a / r2, all_of<V>(1.f));
    const V depth = larger(z - smaller(z * near2, all_of<V>(sag)), V{});
    const Disc<V, float> disc(p2, depth, a);
    if (ball) {
      auto u = disc.hertz(normal, nu);
      if (second) {
        const auto d = disc.force_dipole(nu),
                   t = disc.flat_punch(0, px * along.x() + py * along.y() + pz * along.z(), nu);
        const V near4 = near2 * near2, share = (1.f - near4 * near2) / (1.f + 0.9f * near2 + 0.7f * near4);
        u.in_plane += t.in_plane + dipole * share * d.in_plane + radial * larger(1.f - r2 / (a * a), V{});
        u.normal += t.normal + dipole * share * d.normal;
        u.along = t.along;
      }
      return {u.in_plane * px + u.normal * m.x() + u.along * along.x(),
              u.in_plane * py + u.normal * m.y() + u.along * along.y(),
              u.in_plane * pz + u.normal * m.z() + u.along * along.z()};
    }
    const auto u = disc.flat_punch(normal, px * along.x() + py * along.y() + pz * along.z(), nu);
    V in_plane = u.in_plane, down = u.normal, turned_back{};
    Axes<V> out{u.along * along.x(), u.along * along.y(), u.along * along.z()};
    if (second) {
      const auto d = disc.force_dipole(nu);
      const V inverse = root(near2), beyond = larger(1.f - near2, V{});  // 1 / s, at most 1; 1 - 1 / s^2
      // q_r / (a s): asin(1/s) / (s sqrt(s^2 - 1 + e^2)), with the roots of 1/s^2 instead.
      const V q_r = (radial / a) * arc_sine(inverse) * near2 * inverse /
                    root(larger(beyond + rim2 * near2, all_of<V>(1e-12f)));
      const V near4 = near2 * near2, falling = near4 * root(beyond),
              slid = px * slide.x() + py * slide.y() + pz * slide.z();
      in_plane += dipole * d.in_plane + q_r + inverse * falling * (radial_4 + radial_6 * near2 + slid);
      const V back = near4 * near4;
      turned_back = back * inverse;
      down += dipole * d.normal + falling * (normal_4 + normal_6 * near2);
      out.x -= back * push.x();
      out.y -= back * push.y();
      out.z -= back * push.z();
    }
    if (tilted) {
      const V tp = px * tilt.x() + py * tilt.y() + pz * tilt.z();
      const auto t = disc.bending_couple(tp, nu);
      in_plane += t.in_plane;
      // The patch itself does not turn: what second order does at its edge is taken back, as the push is.
      down += t.normal - turned_back * (px * turn.x() + py * turn.y() + pz * turn.z());
      out.x += t.along * tilt.x();
      out.y += t.along * tilt.y();
      out.z += t.along * tilt.z();
    }
    if (twisted) {
      const V around = twist * disc.torsional_couple();
      out.x += around * (m.y() * pz - m.z() * py);
      out.y += around * (m.z() * px - m.x() * pz);
      out.z += around * (m.x() * py - m.y() * px);
    }
    if (sheared) {
      const V sx = shear(0, 0) * px + shear(0, 1) * py + shear(0, 2) * pz,
              sy = shear(1, 0) * px + shear(1, 1) * py + shear(1, 2) * pz,
              sz = shear(2, 0) * px + shear(2, 1) * py + shear(2, 2) * pz;
      const auto s = disc.shear_dipole(px * sx + py * sy + pz * sz, nu);
      in_plane += s.in_plane;
      down += s.normal;
      out.x += s.along * sx;
      out.y += s.along * sy;
      out.z += s.along * sz;
    }
    out.x += in_plane * px + down * m.x();
    out.y += in_plane * py + down * m.y();
    out.z += in_plane * pz + down * m.z();
    return out;
  }
};

}  // namespace palpate::detail
