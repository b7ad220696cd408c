// SPDX-License-Identifier: MIT
#pragma once

/// @file  The contact of a frictionless sphere with a body: its force, and its loads of second order in depth. Per tick.
///
/// | what                       | how                                                                                                        |
/// |----------------------------|------------------------------------------------------------------------------------------------------------|
/// | force across the normal    | F h, h = (K w_t - s) / (1 + R_s K): where the slopes of sphere and body meet, the body of curvature K moved sideways by w_t and turned by s, the slope of w_n. Nothing is fitted |
/// | radial double force        | D = -k nu/(1-nu) F d; far away that is all of second order that a half-space has                            |
/// | a body that stiffens       | D e, e the surface's strain by w: by F 8/3 D e / F, as F is of power 3/2 in d and e in proportion to F       |
/// | finite strain              | `ball_softening` (sphere_contact.hpp)                                                                       |
/// | within the contact         | the surface slides outwards, `ball_spread` (contact_near.hpp)                                               |
///
/// R_s: radius of the sphere; K: half of k1 + k2; w: what the body adds to the half-space's displacement. Frictionless in the sense of the
/// body: no shear on the sphere's own surface.

#include <palpate/response/contact_loads.hpp>
#include <palpate/response/sphere_contact.hpp>

namespace palpate::detail {

/// Sets P and the loads of `c`, which knows its place, normal, way and sphere. `curvature`: k1 + k2 of the surface. The force returned is that
/// along the normal; the one across, a few percent, acts on the field.
template <class Contacts>
SphereForce<double> press_sphere(const ResponseField& field, const Contacts& contacts, PlacedContact& c,
                                 double curvature) noexcept {
  const SecondOrder* const k = contacts.second_order();
  const double nu = field.nu(), mu = field.shear_modulus(), modulus = field.E() / (1 - nu * nu);
  const double depth = c.d.dot(c.m), bent = 0.5 * curvature,
               R = 1 / (std::max)(1 / c.ball + bent, 1e-3 / c.ball);
  const auto cube = [](double x) { return x * x * x; };
  const double less = 1 - std::clamp(cube(R / c.ball) + cube(R * bent), 0.0, 1.0);
  const double softening = k != nullptr ? k->ball_softening * R / c.ball : 0;
  SphereForce<double> out{0, 0, std::sqrt(0.5 * R * (std::min)(depth, R))};
  constexpr int passes = 3;  // C_w hardly depends on a
  double stiffer = 0;        // taken from C_w mu
  for (int pass = 1; pass <= passes; ++pass) {
    c.a = out.radius;
    contacts.locate(c);
    const double own = c.m.dot(c.w * c.m);
    out = sphere_force(depth, R, modulus, (own - stiffer) / mu, less, softening);
    if (k == nullptr || pass == passes) continue;
    const double most = 0.25 * disc_compliance(c.a, nu).normal;
    stiffer = 8.0 / 3 * k->ball_pull * outward(nu) * (depth - own * out.force / mu) *
              MovedByLoads(field, c).radial.dot(c.m);
    stiffer *= fading(stiffer * stiffer, most * most);
  }
  c.a = (std::max)(out.radius, 1e-9);
  const double P = out.force / mu;
  c.P = P * c.m;
  if (k == nullptr) return out;
  const MovedByLoads moved(field, c);
  for (int pass = 0; pass < 3; ++pass) {
    const Vec3<double> slid = tangential(Vec3<double>(c.w * c.P), c.m),
                       slope = tangential(Vec3<double>(moved.tilting * c.P), c.m),
                       across = R / c.ball * (bent * slid - slope);
    c.P = P * (c.m + fading(across.squaredNorm(), 0.0625) * across);
  }
  const double dipole = -k->ball_pull * outward(nu) * P * depth;
  c.kept = kept(moved.size(dipole * moved.radial, dipole, Vec3<double>::Zero()), c);
  c.dipole = c.kept * dipole;
  c.spread = c.kept * k->ball_spread * depth / R;
  return out;
}

}  // namespace palpate::detail
