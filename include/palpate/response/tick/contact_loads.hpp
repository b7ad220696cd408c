// SPDX-License-Identifier: MIT
#pragma once

/// @file Loads of a solved contact beside its force: double force, moment of tilt, universal forces of second
/// order. Per tick.
///
/// Linear: for nu < 1/2 a disc under a force spreads and turns by itself; stuck, it is kept from it, in the
/// mean that the loads' energy knows. And what spreads and turns the surface beneath the patch is held back
/// by the half-space's loads for that, as far as PatchMoments does not: a narrow one's moments of w are w's
/// slopes.
///
/// Second order: the load has moved with the tool; far away that is a double force by d_n and the moment of
/// the force by w, the way that the body as a whole gives. Near by, a factor of d_n is the local indentation
/// delta_n = C_near P. docs/response_field.md.

#include <palpate/response/contact_types.hpp>
#include <palpate/response/tick/bounded_compliance.hpp>
#include <palpate/response/tick/contact_coupling.hpp>

namespace palpate::detail {

/// Radial double force of a unit normal force on a disc that is stuck [m].
[[nodiscard]] inline double stuck_load(double a, double nu) noexcept {
  return a * (1 - 2 * nu) / (std::numbers::pi * (1 - nu));
}
/// A double force along the normal, where there is no traction, works on the strain there: -nu / (1 - nu) of
/// the surface's. It acts like a radial one of that share.
[[nodiscard]] inline double outward(double nu) noexcept { return nu / (1 - nu); }

/// Share of a displacement that is kept: one of more than half of d, or whose force is more than half of the
/// contact's, means that the series in depth has ended.
[[nodiscard]] inline double kept(double size, const PlacedContact& c) noexcept {
  return smooth_limit(size * size, 0.25 * c.way2());
}
[[nodiscard]] inline double kept_of_force(const Vec3<double>& u, const PlacedContact& c) noexcept {
  return smooth_limit((c.S * u).squaredNorm(), 0.25 * c.P.squaredNorm());
}
/// The largest displacement by a double force and a tilt, given those by units. Not their sum's: where large
/// ones cancel each other, what is left is noise.
[[nodiscard]] inline double size_of_both(double by_pull, double pull, double by_turn,
                                         const Vec3<double>& turn) noexcept {
  return by_pull * std::abs(pull) + by_turn * turn.norm();
}

/// w at a contact's patch by its own loads, times mu; by reciprocity the spread and the slopes of w by unit
/// forces.
struct MovedByLoads {
  Vec3<double> radial = Vec3<double>::Zero();   ///< by a unit double force
  Mat3<double> tilting = Mat3<double>::Zero();  ///< rows: by a unit tilt along each axis
  const PlacedContact* contact;

  MovedByLoads(const ResponseField& field, const PlacedContact& c) noexcept : contact(&c) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t node = c.place.node[i];
      const Mat3<double> mean =
          c.share * c.share * c.place.weight[Eigen::Index(i)] * field.table().second(node, c.level);
      const Vec3<double>& n = field.touch().nodes()[node].normal;
      const Vec3<double> n1 = perpendicular(n);
      radial += mean.col(0);
      tilting += n1 * mean.col(1).transpose() + n.cross(n1) * mean.col(2).transpose();
    }
  }
  /// Less what a wide patch holds back.
  [[nodiscard]] Vec3<double> by(double pull, const Vec3<double>& turn) const noexcept {
    Vec3<double> u = pull * radial + tilting.transpose() * turn;
    const PatchMoments& held = contact->moments;
    if (held.share > 0) u -= held.G.transpose() * held.give * held.of_loads(pull, turn);
    return u;
  }
  /// Of `u` = by(pull, turn).
  [[nodiscard]] double size(const Vec3<double>& u, double pull, const Vec3<double>& turn) const noexcept {
    return std::lerp(size_of_both(radial.norm(), pull, tilting.norm(), turn), u.norm(),
                     contact->moments.share);
  }
};

/// Moment of tilt of a stuck disc by its slope / mu, as far as it grips: 1 / D_near (patch_moments.hpp).
[[nodiscard]] inline double tilt_stiffness(const PlacedContact& c, double nu) noexcept {
  return c.grip * 8 * c.a * c.a * c.a / (3 * (1 - nu));
}

/// Moment about m of a stuck disc by its rotation / mu, likewise. A bent surface has less around the patch to
/// shear: first order in the mean curvature H (docs/response_field.md), from the mean depth H a^2 / 2 of the
/// patch's edge.
[[nodiscard]] inline double twist_stiffness(const ResponseField& field, const PlacedContact& c) noexcept {
  const double bent = 2 / c.a * field.table().edge(&MomentRow::droop, c.place.node, c.place.weight, c.a);
  return c.grip * 16 * c.a * c.a * c.a / (3 + 6.75 / std::numbers::pi * std::clamp(bent, -0.5, 1.0));
}
/// Mean displacement of a contact's patch by w of its unit twist; by reciprocity, the twist of w by unit
/// forces [1/m^2].
[[nodiscard]] inline Vec3<double> moved_by_twist(const ResponseField& field,
                                                 const PlacedContact& c) noexcept {
  Vec3<double> u = Vec3<double>::Zero();
  for (std::size_t i = 0; i < 3; ++i)
    u += c.share * c.share * c.place.weight[Eigen::Index(i)] *
         field.table().second_by_twist(c.place.node[i], c.level);
  return u;
}

/// Sets the loads by which the tool turns its patch, and takes what they move it from `rhs`. Linear; before
/// the forces.
inline void turn_patch(const ResponseField& field, PlacedContact& c) noexcept {
  const Vec3<double> lean = c.lean();
  c.tool_tilt = (1 - c.moments.share) * tilt_stiffness(c, field.nu()) * lean;
  c.twist = twist_stiffness(field, c) * c.rotation.dot(c.m);
  // The half-space's own, by reciprocity with the tilt of a stuck disc in `press`.
  c.swayed = MovedByLoads(field, c).by(0, c.tool_tilt) + 0.5 * c.grip * stuck_load(c.a, field.nu()) * lean +
             c.twist * moved_by_twist(field, c);
  if (c.moments.share > 0) c.swayed += c.moments.G.transpose() * c.moments.give * c.moments.leaning(lean);
  c.rhs -= kept(c.swayed.norm(), c) * c.swayed;
}

/// Sets the loads of a contact with P, and takes what they move its patch from `rhs`. `second_order`: null
/// without.
inline void press(const ResponseField& field, const SecondOrder* second_order, PlacedContact& c) noexcept {
  const double nu = field.nu(), stuck = stuck_load(c.a, nu);
  const FlatPunchCompliance near = flat_punch_compliance(c.a, nu);
  const Vec3<double> t1 = c.t1(), t2 = c.t2();
  // The universal forces take no force above the half-space's for d: where the body is far stiffer, they have
  // nothing to say. The double force and what is drawn near the patch take twice as much.
  const double normal = c.P.dot(c.m);
  const Vec3<double> indentation = near.tangential * c.P + (near.normal - near.tangential) * normal * c.m;
  const double most = std::sqrt(c.way2()), length = indentation.norm();
  const double local = length > most ? most / length : 1, twice = (std::min)(2 * local, 1.0);
  const Vec3<double> P = local * c.P;
  const double pushed = P.dot(c.m);
  const Vec3<double> dragged = P - pushed * c.m;

  const MovedByLoads moved(field, c);
  // What is held takes less than all of a compliance: held to half where a patch is wide for a thin part.
  const double tilt_stiff = tilt_stiffness(c, nu);
  double stiff = (1 - c.moments.share) * tilt_stiff;
  const double taken = stiff * (2 * moved.radial.squaredNorm() + moved.tilting.squaredNorm()),
               whole = c.C.trace();
  stiff *= smooth_limit(taken * taken, 0.25 * whole * whole);
  const Vec3<double> slope = moved.tilting * P,
                     leaning = (slope.dot(t1) + c.bent[1]) * t1 + (slope.dot(t2) + c.bent[2]) * t2;
  c.dipole = stuck * pushed - 2 * stiff * (moved.radial.dot(P) + c.bent[0]);
  c.tilt = -0.5 * stuck * dragged - stiff * leaning;
  const Vec3<double> spread = moved.by(c.dipole, c.tilt);
  // Half of d is for both: for what the tool turns, too.
  const double swayed = c.swayed.norm(), resolved = kept(moved.size(spread, c.dipole, c.tilt) + swayed, c);
  c.dipole *= resolved;
  c.tilt *= resolved;
  c.tilt += c.tool_tilt;
  c.felt_tilt = c.tilt;
  c.rhs += (kept(swayed, c) - resolved) * c.swayed - resolved * spread;

  if (second_order == nullptr) return;
  const SecondOrder& k = *second_order;
  const double depth = std::clamp(c.d.dot(c.m), -2 * c.a, 2 * c.a), indented = near.normal * pushed,
               delta = near.normal * twice * normal;
  const Vec3<double> lean = c.lean();
  const double dipole =
      -outward(nu) * twice * normal * depth - k.foreshortened * tilt_stiff * lean.squaredNorm();
  c.dn2 = delta * depth;
  c.beta = std::clamp(delta / c.a, 0.0, 2.0);
  c.delta_t = near.tangential * twice * tangential(c.P, c.m);
  // By how much the body as a whole gives way, along the normal and the surface.
  const Vec3<double> gone = c.d - near.tangential * P - (near.normal - near.tangential) * pushed * c.m,
                     slid = tangential(gone, c.m);
  const double sunk = gone.dot(c.m);
  c.turn = k.turn_slid * pushed * slid - k.turn_sunk * sunk * dragged;
  const double steep = indented / c.a;
  c.push = near.tangential * near.tangential * k.drag / (1 + steep * steep) * indented * dragged -
           near.normal * k.softening * indented * depth * c.m;
  const Vec3<double> slipped = near.tangential * dragged;
  c.push -= k.tip * c.a * (near.tangential * indented * lean + near.normal * slipped.dot(lean) * c.m);
  // The patch, too, would turn with the body (turned_field.hpp); it is held where it is. The tool feels that
  // as `lever`. At most a quarter of d, and of the force.
  const Vec3<double> going = 0.5 * (k.turned * gone + k.crossed * (c.d - gone)),
                     turning = going.dot(leaning) * c.m - going.dot(c.m) * leaning,
                     twice_turned = 2 * turning,
                     turned = kept(twice_turned.norm(), c) * kept_of_force(twice_turned, c) * turning;
  const Vec3<double> answer = moved.by(dipole, c.turn), second = c.push - answer;
  const double share = kept(moved.size(answer, dipole, c.turn) + c.push.norm(), c) * kept_of_force(second, c);
  c.dn2 *= share;
  c.delta_t *= share;
  c.turn *= share;
  c.push *= share;
  c.dipole += share * dipole;
  c.tilt += c.turn;
  c.rhs += share * (second - turned);
  c.kept = share;
  c.felt_tilt -= share * (k.tip * c.a * indented * slipped + k.ease * c.beta * tilt_stiff * lean);
  // Two energies of third degree in P, of which the loads above are the derivatives by w's gradient; those by
  // P are felt by the tool only. D e: e is the surface's strain by w under the patch (by reciprocity radial .
  // P), D = -outward delta_n P_n; that by P_n is 2 D e / P_n. lever (P_n w_t - w_n P_t) . s, s the slope of
  // w_n: a body that bends or turns beneath the patch moves it sideways, too.
  const Vec3<double> stiffer = 2 * outward(nu) * indented * moved.radial.dot(P) * c.m -
                               k.lever * (slid.dot(leaning) * c.m + pushed * (c.w * leaning) -
                                          sunk * leaning - dragged.dot(leaning) * (c.w * c.m));
  const Vec3<double> doubled = 2 * stiffer;  // so that it is at most a quarter of d, and of the force
  c.extra = c.S * (share * turned + kept(doubled.norm(), c) * kept_of_force(doubled, c) * stiffer);
}

}  // namespace palpate::detail
