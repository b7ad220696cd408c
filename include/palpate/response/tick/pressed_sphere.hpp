// SPDX-License-Identifier: MIT
#pragma once

/// @file The contact of a frictionless sphere with a body: its force, and its loads of second order in depth.
/// Per tick.
///
/// | what                    | how                                                                                                      |
/// |-------------------------|----------------------------------------------------------------------------------------------------------|
/// | force across the normal | F h, h = (K w_t - s) / (1 + R_s K): where the slopes of sphere and body meet                             |
/// | where it acts           | on the body at x_c = R_s h - w_t from the first touch: the middle of the near field                      |
/// | what it has gone        | d less dG/dF, G = F (R_s h^2 + K x_c^2) / 2 + F s.x_c + F s.w_t / 2, of which the last is a body's that turns as a whole |
/// | radial double force     | D = -nu/(1-nu) F (C_w F + k d_H): a patch's, less what a pressure that is tilted outwards takes of d_H   |
/// | a body that stiffens    | D e, by the part of D with d_H: 8/3 D e / F, as that part is of power 5/3 in F and e in proportion to F  |
/// | finite strain           | `ball_softening` (sphere_contact.hpp)                                                                    |
/// | within the contact      | the surface slides outwards, `ball_spread` (contact_near.hpp)                                            |
///
/// | symbol | name                                                                                              | unit |
/// |--------|---------------------------------------------------------------------------------------------------|------|
/// | R_s    | radius of the sphere                                                                              | m    |
/// | K      | half of k1 + k2, the surface's curvatures                                                         | 1/m  |
/// | w, w_t | what the body adds to the half-space's displacement, w_t along the surface; s: the slope of w_n   | m    |
/// | e      | strain of the surface by w                                                                        | -    |
///
/// d = d_H + C_w F: sphere_contact.hpp. Nothing is fitted but k, `ball_softening` and `ball_spread`. Far away
/// D is all of second order that a half-space has. Bounds: docs/response_field.md.

#include <palpate/response/tick/contact_loads.hpp>
#include <palpate/response/tick/sphere_contact.hpp>

namespace palpate {

/// What a sphere that is pressed into a body feels; `force` and `stiffness` are along the normal.
struct PressedSphere : SphereForce<double> {
  /// Tangential force on the body [N], 1 to 5 % of `force` where the body leans.
  Vec3<double> across = Vec3<double>::Zero();

  /// Force that the sphere exerts on the body [N]; `normal`: the contact's, outward, unit.
  [[nodiscard]] Vec3<double> on_body(const Vec3<double>& normal) const noexcept {
    return across - force * normal;
  }
};

}  // namespace palpate

namespace palpate::detail {

/// Sets P and the loads of `c`, which knows its place, normal, way and sphere. `curvature`: k1 + k2 of the
/// surface.
template <class Contacts>
PressedSphere press_sphere(const ResponseField& field, const Contacts& contacts, PlacedContact& c,
                           double curvature) noexcept {
  const SecondOrder* const k = contacts.second_order();
  const double nu = field.nu(), mu = field.shear_modulus(), modulus = field.E() / (1 - nu * nu);
  const double depth = c.d.dot(c.m), bent = 0.5 * curvature,
               R = 1 / (std::max)(1 / c.ball + bent, 1e-3 / c.ball);
  const auto cube = [](double x) { return x * x * x; };
  const double less = 1 - std::clamp(cube(R / c.ball) + cube(R * bent), 0.0, 1.0);
  const double softening = k != nullptr ? k->ball_softening * R / c.ball : 0;
  SphereForce<double> out{0, 0, std::sqrt(0.5 * R * (std::min)(depth, R))};
  c.first = c.x;
  Vec3<double> aside = Vec3<double>::Zero(), radial = aside;  // x_c; MovedByLoads
  double local = depth, lifted = 0, stiffer = 0;              // d_H; taken from d, from C_w mu
  constexpr int passes = 3;                                   // what the others ask of each other is small
  for (int pass = 1; pass <= passes; ++pass) {
    c.a = out.radius;
    contacts.locate(c);
    const double own = c.m.dot(c.w * c.m);
    out = sphere_force(depth - lifted, R, modulus, (own - stiffer) / mu, less, softening);
    const double P = out.force / mu;
    c.P = P * c.m;
    if (k == nullptr) continue;
    const MovedByLoads moved(field, c);
    // What the force across does to w_t and s counts: lean = leaning (m + lean), of a matrix that is held at
    // a half. A body that bends easily would else be thrown aside.
    Mat3<double> leaning = R / c.ball * P * (bent * c.w - moved.tilting);
    leaning -= c.m * (c.m.transpose() * leaning);
    leaning *= smooth_limit(leaning.squaredNorm(), 0.25);
    Vec3<double> lean = (Mat3<double>::Identity() - leaning).inverse() * (leaning * c.m);
    lean *= smooth_limit(lean.squaredNorm(), 0.0625);
    c.P += P * lean;
    const Vec3<double> slid = tangential(Vec3<double>(c.w * c.P), c.m),
                       slope = tangential(Vec3<double>(moved.tilting * c.P), c.m);
    aside = c.ball * lean - slid;
    aside *= smooth_limit(aside.squaredNorm(), 0.25 * c.a * c.a);
    radial = moved.radial;
    local = depth - std::clamp(P * own, -depth, depth);  // held as it is in sphere_contact.hpp
    if (pass == passes) break;
    lifted = 0.5 * (c.ball * lean.squaredNorm() + bent * aside.squaredNorm()) + lean.dot(slid) +
             2 * slope.dot(aside) + 1.5 * slope.dot(slid);
    lifted *= smooth_limit(lifted * lifted, 0.01 * depth * depth);
    const double most = 0.25 * flat_punch_compliance(c.a, nu).normal;
    stiffer = 8.0 / 3 * k->ball_pull * outward(nu) * local * radial.dot(c.m);
    stiffer *= smooth_limit(stiffer * stiffer, most * most);
  }
  c.a = (std::max)(out.radius, 1e-9);
  if (k == nullptr) return {out, Vec3<double>::Zero()};
  c.x = c.first + aside;
  const double dipole = -outward(nu) * (out.force / mu) * (depth - local + k->ball_pull * local);
  c.kept = kept(radial.norm() * std::abs(dipole), c);
  c.dipole = c.kept * dipole;
  c.spread = c.kept * k->ball_spread * local / R;
  return {out, mu * tangential(c.P, c.m)};
}

/// Within the contact the surface lies on the sphere; beside it, not inside. at: an undeformed place; u: its
/// displacement, changed along m by less than 0.4 d: what is farther off is another side of the body. reach:
/// where that ends, from the contact's rim.
inline void rest_on_ball(const PlacedContact& c, const Vec3<double>& at, double reach,
                         Vec3<double>& u) noexcept {
  const Vec3<double> moved = at + u - c.first;
  const double depth = c.d.dot(c.m), rest = c.ball * c.ball - tangential(moved, c.m).squaredNorm();
  if (!(rest > 0)) return;
  const double inside = depth - c.ball + std::sqrt(rest) - moved.dot(c.m), off = inside / depth,
               r = (at - c.x).norm();
  // What is inside is moved out, to a radius from the rim or `reach`; what lies below is drawn up, towards
  // the rim less and less.
  const double share = inside > 0 ? 2 - 2 * (r - c.a) / (std::min)(c.a, reach) : 10 * (1 - r / c.a);
  u += std::clamp(share, 0.0, 1.0) * (std::min)(4 * rest / (c.ball * c.ball), 1.0) *
       (std::max)(1 - off * off, 0.0) * inside * c.m;
}

}  // namespace palpate::detail
