// SPDX-License-Identifier: MIT
#pragma once

/// @file The contact of a frictionless sphere with a body: its force, and its loads of second order in depth.
/// Per tick.
///
/// | what | how |
/// |---|---|
/// | force across the normal | F h, h = (K w_t - s) / (1 + R_s K): where the slopes of sphere and body meet |
/// | where it acts | on the body at x_c = R_s h - w_t from the first touch: the middle of the near field |
/// | displacement | d less dG/dF, G = F (R_s h^2 + K x_c^2) / 2 + F s.x_c + F s.w_t / 2 |
/// | radial force dipole | D = -nu/(1-nu) F (C_w F + k d_H): a patch's, less what an outward pressure takes |
/// | a body that stiffens | D e, by the part of D with d_H: 8/3 D e / F (powers 5/3 and 1 of F) |
/// | finite strain | `sphere_softening`, `sphere_drawn_in` (sphere_contact.hpp) |
/// | within the contact | the surface slides outwards, `sphere_spread` (near_field.hpp) |
/// | | it is less deep than its force has it, by x a/R of d_H at the middle (near_field.hpp) |
///
/// | symbol | name | unit |
/// |---|---|---|
/// | R_s | radius of the sphere | m |
/// | K | half of k1 + k2, the surface's curvatures | 1/m |
/// | w, w_t; s | regular part of the displacement, its part along the surface; slope of w_n | m; - |
/// | e | strain of the surface by w | - |
///
/// d = d_H + C_w F: sphere_contact.hpp. Only k, `sphere_softening` and `sphere_spread` are fitted
/// (second_order.hpp). Far away D is all of second order that a half-space has. Bounds: constants.hpp.

#include <palpate/response/tick/second_order_loads.hpp>
#include <palpate/response/tick/sphere_contact.hpp>

#include <Eigen/LU>

namespace palpate::detail {

/// The gap between sphere and body.
struct SphereShape {
  double depth;      ///< of the sphere [m]
  double curvature;  ///< K [1/m]
  double R;          ///< radius of the relative curvature [m]
  double less;       ///< g of sphere_contact.hpp
  double softening;  ///< by finite strain
  double drawn_in;   ///< x of sphere_contact.hpp

  SphereShape(const Indenter& tool, double sum_of_curvatures, const SecondOrder* k) noexcept
      : depth(tool.d.dot(tool.m)),
        curvature(0.5 * sum_of_curvatures),
        R(1 / (std::max)(1 / tool.sphere + curvature, tick::min_relative_curvature / tool.sphere)),
        less(1 - std::clamp(cube(R / tool.sphere) + cube(R * curvature), 0.0, 1.0)),
        softening(k != nullptr ? k->sphere_softening * R / tool.sphere : 0),
        drawn_in(k != nullptr ? k->sphere_drawn_in : 0) {}

 private:
  [[nodiscard]] static double cube(double x) noexcept { return x * x * x; }
};

/// Force of a sphere and where it acts.
struct SphereSolution {
  SphereForce<double> felt;
  double a = 0;                                ///< radius of the contact [m]
  Vec3<double> P = Vec3<double>::Zero();       ///< force / mu
  Vec3<double> shift = Vec3<double>::Zero();   ///< x_c [m]
  Vec3<double> radial = Vec3<double>::Zero();  ///< MovedByLoads
  double indentation = 0;                      ///< d_H [m]
};

/// The force across the normal and what follows from it, of a sphere with the force P along the normal.
struct SphereAcross {
  Vec3<double> h, slid, slope;  ///< h; w_t [m]; s

  SphereAcross(const Indenter& tool, const SphereShape& shape, const PlacedContact& c,
               const MovedByLoads& moved, double P) noexcept {
    // h = A (m + h): the force across changes w_t and s, too. The norm of A is bounded by a half: otherwise h
    // would have no bound on a body that bends easily.
    Mat3<double> A = shape.R / tool.sphere * P * (shape.curvature * c.w - moved.couple);
    A -= tool.m * (tool.m.transpose() * A);
    A *= smooth_limit(A.squaredNorm(), tick::max_lean_feedback2);
    h = (Mat3<double>::Identity() - A).inverse() * (A * tool.m);
    h *= smooth_limit(h.squaredNorm(), tick::max_lean2);
    const Vec3<double> force = P * tool.m + P * h;
    slid = tangential(Vec3<double>(c.w * force), tool.m);
    slope = tangential(Vec3<double>(moved.couple * force), tool.m);
  }
};

/// dG/dF: the part of the depth that the shift of the contact takes [m].
[[nodiscard]] inline double sphere_lift(const Indenter& tool, const SphereShape& shape,
                                        const SphereAcross& across, const Vec3<double>& shift) noexcept {
  const double lift = 0.5 * (tool.sphere * across.h.squaredNorm() + shape.curvature * shift.squaredNorm()) +
                      across.h.dot(across.slid) + 2 * across.slope.dot(shift) +
                      1.5 * across.slope.dot(across.slid);
  return lift * smooth_limit(lift * lift, tick::max_lift2 * shape.depth * shape.depth);
}

/// Compliance / mu that is lost because the body spreads under the contact, 8/3 k nu/(1-nu) d_H e / F [1/m].
/// `near`: the half-space's compliance.
[[nodiscard]] inline double sphere_stiffening(const SecondOrder& k, double nu, double near,
                                              double indentation, double strain) noexcept {
  const double max = tick::max_stiffening * near,
               stiffer = 8.0 / 3 * k.sphere_dipole * dipole_ratio(nu) * indentation * strain;
  return stiffer * smooth_limit(stiffer * stiffer, max * max);
}

/// Force and position of a sphere's contact, by passes. Each uses the radius and the parts taken from depth
/// and compliance of the pass before. The placed stage is made in `placed`, for the radius of the last pass
/// but one.
[[nodiscard]] inline SphereSolution solve_sphere_contact(const ResponseField& field, const SecondOrder* k,
                                                         const Indenter& sphere, const SphereShape& shape,
                                                         PlacedContact& placed) noexcept {
  const double nu = field.nu(), mu = field.shear_modulus(), modulus = field.E() / (1 - nu * nu);
  const PatchMoments none;
  Indenter tool = sphere;
  SphereSolution out;
  out.felt = {0, 0, std::sqrt(0.5 * shape.R * (std::min)(shape.depth, shape.R))};
  out.indentation = shape.depth;
  double lift = 0, stiffening = 0;
  for (int pass = 1; pass <= tick::sphere_passes; ++pass) {
    tool.a = out.felt.radius;
    construct(placed, [&] { return place_contact(field, tool); });
    const double own = tool.m.dot(placed.w * tool.m);
    out.felt = sphere_force(shape.depth - lift, shape.R, modulus, (own - stiffening) / mu, shape.less,
                            shape.softening, shape.drawn_in);
    const double P = out.felt.force / mu;
    out.P = P * tool.m;
    if (k == nullptr) continue;
    const MovedByLoads moved(field, placed, none);
    const SphereAcross across(tool, shape, placed, moved, P);
    out.P += P * across.h;
    out.shift = tool.sphere * across.h - across.slid;
    out.shift *= smooth_limit(out.shift.squaredNorm(), tick::max_center_shift2 * tool.a * tool.a);
    out.radial = moved.radial;
    out.indentation = shape.depth - std::clamp(P * own, -shape.depth, shape.depth);
    if (pass == tick::sphere_passes) break;
    lift = sphere_lift(tool, shape, across, out.shift);
    stiffening = sphere_stiffening(*k, nu, placed.near.normal, out.indentation, out.radial.dot(tool.m));
  }
  out.a = (std::max)(out.felt.radius, 1e-9);  // [m]: the smallest radius that a contact may have (is_usable)
  return out;
}

/// The second order stage of a sphere: its dipole and the spread within the contact.
[[nodiscard]] inline SecondOrderContact sphere_loads(const SecondOrder* k, const ResponseField& field,
                                                     const Indenter& tool, const SphereShape& shape,
                                                     const SphereSolution& sphere) noexcept {
  const Vec3<double> zero = Vec3<double>::Zero();
  SecondOrderContact out{0, zero, zero, zero, 0, NearTerms::none(), zero};
  if (k == nullptr) return out;
  const double P = sphere.felt.force / field.shear_modulus(), local = sphere.indentation,
               dipole = -dipole_ratio(field.nu()) * P * (shape.depth - local + k->sphere_dipole * local);
  out.share = series_share(sphere.radial.norm() * std::abs(dipole), tool.displacement2());
  out.dipole = out.share * dipole;
  out.near.spread = out.share * k->sphere_spread * local / shape.R;
  out.near.raised = shape.drawn_in * sphere.a / shape.R * local;
  return out;
}

/// All stages of one sphere alone. `sum_of_curvatures`: k1 + k2 of the surface.
[[nodiscard]] PALPATE_COMPILED_INLINE PressedSphere
press_sphere(const ResponseField& field, const SecondOrder* k, const Indenter& tool, double sum_of_curvatures,
             PlacedContact& placed, SecondOrderContact& second, SolvedContact& solved) noexcept {
  const SphereShape shape(tool, sum_of_curvatures, k);
  const SphereSolution sphere = solve_sphere_contact(field, k, tool, shape, placed);
  construct(second, [&] { return sphere_loads(k, field, tool, shape, sphere); });
  construct(solved, [&] {
    return SolvedContact{tool.x + sphere.shift, sphere.a, sphere.P, Moments::Zero()};
  });
  return {sphere.felt, k == nullptr ? Vec3<double>(Vec3<double>::Zero())
                                    : Vec3<double>(field.shear_modulus() * tangential(sphere.P, tool.m))};
}

}  // namespace palpate::detail
