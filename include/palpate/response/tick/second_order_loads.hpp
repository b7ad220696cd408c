// SPDX-License-Identifier: MIT
#pragma once

/// @file Second order in depth: loads of a contact that are quadratic in its displacement, and the forces
/// that only the tool feels. Per tick. Derivation: docs/response_field.md, "Second order in depth".
///
/// | load | formula, divided by mu |
/// |---|---|
/// | radial force dipole | -nu/(1-nu) P_n d_n - foreshortened k s^2 |
/// | bending couple | couple_slid P_n w_t - couple_sunk w_n P_t |
/// | universal forces | drag delta_n delta_t / (1 + beta^2), -softening delta_n d_n |
/// | rotated tool | derivatives of the energy -tip a delta_n delta_t . s |
/// | felt only: stiffening | 2 nu/(1-nu) delta_n (radial . P) along m |
/// | felt only: lever | derivatives by P of the energy lever (P_n w_t - w_n P_t) . (slope of w_n) |
///
/// The load has moved with the tool: far away that is a force dipole by d_n and the couple of the force by w.
/// A factor of d_n is the local indentation delta_n = C_near P_n. k: bending stiffness; s: slope by the
/// tool's rotation; radial, slope of w: MovedByLoads. Constants: second_order.hpp.

#include <palpate/response/second_order.hpp>
#include <palpate/response/tick/linear_loads.hpp>

namespace palpate::detail {

/// nu / (1 - nu): the part of the surface's strain by which a force dipole along the normal acts, where there
/// is no traction.
[[nodiscard]] inline double dipole_ratio(double nu) noexcept { return nu / (1 - nu); }

/// d less the local indentation: by how much the body as a whole moves at the patch.
struct RegularDisplacement {
  Vec3<double> u, tangential;  ///< w and its part along the surface [m]
  double normal;

  PALPATE_INLINE RegularDisplacement(const Indenter& tool, const IndentingForce& F) noexcept
      : u(tool.d - F.near.tangential * F.P - (F.near.normal - F.near.tangential) * F.normal * tool.m),
        tangential(palpate::tangential(u, tool.m)),
        normal(u.dot(tool.m)) {}
};

/// Displacement of the patch by the universal forces: the surface is dragged along, and softens; with a slope
/// s by the tool, the derivatives of -tip a delta_n delta_t . s by the force.
[[nodiscard]] PALPATE_INLINE Vec3<double> universal_push(const SecondOrder& k, const Indenter& tool,
                                                         const IndentingForce& F, double depth,
                                                         double indented, const Vec3<double>& slipped,
                                                         const Vec3<double>& slope) noexcept {
  const double beta = indented / tool.a;
  Vec3<double> push =
      F.near.tangential * F.near.tangential * k.drag / (1 + beta * beta) * indented * F.tangential -
      F.near.normal * k.softening * indented * depth * tool.m;
  push -=
      k.tip * tool.a * (F.near.tangential * indented * slope + F.near.normal * slipped.dot(slope) * tool.m);
  return push;
}

/// Displacement by which the patch would rotate with the body (rotation_correction.hpp), 1/2 omega x (k_t w +
/// k_c delta) with omega from the slope of w; the patch is bonded, so the force takes it back. At most a
/// quarter of d and of the force.
[[nodiscard]] PALPATE_INLINE Vec3<double> patch_rotation(const SecondOrder& k, const PlacedContact& c,
                                                         const BondedContact& bonded,
                                                         const LinearContact& linear, const Vec3<double>& w,
                                                         const Vec3<double>& slope) noexcept {
  const Indenter& tool = c.tool;
  const Vec3<double> moving = 0.5 * (k.rotated * w + k.crossed * (tool.d - w)),
                     rotating = moving.dot(slope) * tool.m - moving.dot(tool.m) * slope, twice = 2 * rotating;
  return series_share(twice.norm(), c.displacement2) * series_share_of_force(twice, bonded.S, linear.P) *
         rotating;
}

/// Displacement u whose force S u the tool feels, without a field: derivatives by the force of two energies
/// of third degree. The loads above are the derivatives of these energies by w's gradient.
///
///     stiffening: D e, e = radial . P the surface's strain by w, D = -nu/(1-nu) delta_n P_n
///     lever (P_n w_t - w_n P_t) . slope: a body that bends beneath the patch moves it sideways, too
///
/// At most a quarter of d and of the force.
[[nodiscard]] PALPATE_INLINE Vec3<double> felt_only(const SecondOrder& k, const PlacedContact& c,
                                                    const BondedContact& bonded, const LinearContact& linear,
                                                    const IndentingForce& F, const RegularDisplacement& w,
                                                    double indented, double strain, const Vec3<double>& slope,
                                                    double nu) noexcept {
  const Indenter& tool = c.tool;
  const Vec3<double> u = 2 * dipole_ratio(nu) * indented * strain * tool.m -
                         k.lever * (w.tangential.dot(slope) * tool.m + F.normal * (c.w * slope) -
                                    w.normal * slope - F.tangential.dot(slope) * (c.w * tool.m)),
                     twice = 2 * u;
  return series_share(twice.norm(), c.displacement2) * series_share_of_force(twice, bonded.S, linear.P) * u;
}

/// The loads of first order alone as a second order stage.
[[nodiscard]] inline SecondOrderContact first_order_alone(const LinearLoads& first) noexcept {
  return {first.dipole, first.couple, first.couple, Vec3<double>::Zero(), 0, NearTerms::none(), first.rhs};
}

/// The second order stage. `constants`: null for the loads of first order alone.
[[nodiscard]] PALPATE_COMPILED_INLINE SecondOrderContact
second_order_loads(const ResponseField& field, const SecondOrder* constants, const PlacedContact& c,
                   const BondedContact& bonded, const LinearContact& linear) noexcept {
  const Indenter& tool = c.tool;
  const double nu = field.nu();
  const IndentingForce F(c, linear.P);
  const MovedByLoads moved(field, c, bonded.moments);
  const LinearLoads first = linear_loads(field, c, bonded, linear, moved, F);
  if (constants == nullptr) return first_order_alone(first);
  const SecondOrder& k = *constants;

  const double ratio = (std::min)(tick::max_force_ratio * F.factor, 1.0),
               depth = std::clamp(tool.d.dot(tool.m), -tick::max_depth * tool.a, tick::max_depth * tool.a),
               indented = F.near.normal * F.normal, delta = F.near.normal * ratio * F.whole;
  const Vec3<double> slope = tool.slope(), slipped = F.near.tangential * F.tangential;
  const double dipole =
      -dipole_ratio(nu) * ratio * F.whole * depth - k.foreshortened * first.bending * slope.squaredNorm();
  const RegularDisplacement w(tool, F);
  const Vec3<double> couple =
                         k.couple_slid * F.normal * w.tangential - k.couple_sunk * w.normal * F.tangential,
                     push = universal_push(k, tool, F, depth, indented, slipped, slope),
                     rotation = patch_rotation(k, c, bonded, linear, w.u, first.slope),
                     answer = moved.by(dipole, couple), second = push - answer;
  const double share = series_share(moved.size(answer, dipole, couple) + push.norm(), c.displacement2) *
                       series_share_of_force(second, bonded.S, linear.P);

  SecondOrderContact out;
  out.share = share;
  NearTerms& near = out.near;
  near.dn2 = delta * depth * share;
  near.beta = std::clamp(delta / tool.a, 0.0, tick::max_depth);
  near.delta_t = F.near.tangential * ratio * tangential(linear.P, tool.m);
  near.delta_t *= share;
  near.couple = couple * share;
  near.push = push * share;
  near.spread = near.raised = 0;
  out.dipole = first.dipole + share * dipole;
  out.couple = first.couple + near.couple;
  out.rhs = first.rhs + share * (second - rotation);
  out.felt_couple = first.couple - share * (k.tip * tool.a * indented * slipped +
                                            k.ease * near.beta * first.bending * slope);
  out.extra = bonded.S * (share * rotation + felt_only(k, c, bonded, linear, F, w, indented,
                                                       moved.radial.dot(F.P), first.slope, nu));
  return out;
}

}  // namespace palpate::detail
