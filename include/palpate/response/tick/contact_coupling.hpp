// SPDX-License-Identifier: MIT
#pragma once

/// @file One placed contact, and what one contact does to the patch of another. Per tick.
///
/// The displacement of patch i by the force on patch j, averaged over i, is that of a disc with the square
/// sum of the radii: exact to second moments, and never singular when patches meet.

#include <palpate/core/fixed_vector.hpp>
#include <palpate/response/tick/patch_moments.hpp>

namespace palpate::detail {

/// Solved nodes that share a contact's force.
struct PatchWeight {
  std::uint32_t node;
  double weight;
};
constexpr std::size_t place_nodes = 3 * TouchMesh::most_parts;

/// One contact placed and solved.
struct PlacedContact {
  Vec3<double> x, m, d;   ///< m: unit normal into the body
  Vec3<double> rotation;  ///< of the tool
  double a = 0;
  double least = 0;  ///< smaller compliance of the half-space, times mu
  double ball = 0;   ///< radius of the sphere; 0: stuck patch
  Vec3<double> first =
      Vec3<double>::Zero();  ///< of a sphere: where it touches first; its contact moves from there to x
  double spread = 0;         ///< of a sphere's contact along the surface, at its middle, by r
  TouchPlace place;
  FixedVector<PatchWeight, place_nodes> nodes;  ///< solved ones at the place
  double carried = 1;                           ///< of the force, not by what is held
  double share = 1;                             ///< of w that counts
  double grip = 1;  ///< 0: let go, for others have moved its patch as far as it would (ContactSystem::loosen)
  PatchTable::Level level;  ///< of the radius
  Mat3<double> w, C, S;     ///< correction, sum, times mu; the sum's inverse
  Vec3<double> rhs;
  Vec3<double> P = Vec3<double>::Zero();          ///< force / mu
  Vec3<double> extra = Vec3<double>::Zero();      ///< force / mu that the tool feels and the field does not
  double dipole = 0;                              ///< / mu
  double dn2 = 0, beta = 0;                       ///< delta_n d_n, delta_n / a, as the near terms take them
  Vec3<double> delta_t = Vec3<double>::Zero();    ///< likewise
  Vec3<double> tilt = Vec3<double>::Zero();       ///< / mu
  double twist = 0;                               ///< moment about m / mu
  Vec3<double> tool_tilt = Vec3<double>::Zero();  ///< part of `tilt` by which the tool turns a narrow patch
  Vec3<double> swayed =
      Vec3<double>::Zero();  ///< displacement by the loads with which the tool turns it, whole
  Vec3<double> felt_tilt = Vec3<double>::Zero();  ///< what the tool feels of `tilt`
  Vec3<double> turn = Vec3<double>::Zero();       ///< its part of second order
  Vec3<double> push = Vec3<double>::Zero();
  double kept = 0;                 ///< of second order
  double sag = 0;                  ///< how deep the patch's edge lies below its plane, at most
  PatchMoments moments;            ///< of a wide patch
  Moments held = Moments::Zero();  ///< its loads / mu
  Vec3<double> bent =
      Vec3<double>::Zero();  ///< by the other contacts beneath it: spread, slopes along t1, t2

  /// Tangents of the patch.
  [[nodiscard]] Vec3<double> t1() const noexcept { return perpendicular(Vec3<double>(-m)); }
  [[nodiscard]] Vec3<double> t2() const noexcept { return t1().cross(m); }

  /// s^2 of the stuck disc that spreads the load as far as the contact does, in mean r^2 of its weight: a
  /// disc's is 2/3 s^2, that of a sphere's pressure 2/5 a^2. `seen_loaded2`: in the mean of that of the load
  /// and of the disc by which the contact is seen.
  [[nodiscard]] double loaded2() const noexcept { return (ball > 0 ? 0.6 : 1) * a * a; }
  [[nodiscard]] double seen_loaded2() const noexcept { return (ball > 0 ? 0.8 : 1) * a * a; }

  /// The slope of its normal displacement that the tool's rotation gives it.
  [[nodiscard]] Vec3<double> lean() const noexcept { return m.cross(rotation); }
  [[nodiscard]] bool is_turned() const noexcept { return rotation.squaredNorm() > 0; }
  [[nodiscard]] bool has_loads() const noexcept { return dipole != 0 || is_turned(); }  ///< beside the force
  /// The square of how far it goes: its middle, and its edge by the tool's rotation.
  [[nodiscard]] double way2() const noexcept { return d.squaredNorm() + a * a * rotation.squaredNorm(); }

  void hold_moments() noexcept {
    held = moments.give * (moments.leaning(lean()) - moments.G * P - moments.of_loads(dipole, tilt));
  }
  /// Moment of tilt of the tool on the patch about its middle / mu.
  [[nodiscard]] Vec3<double> felt() const noexcept {
    return moments.share > 0 ? Vec3<double>(felt_tilt + moments.tilt(held)) : felt_tilt;
  }
};

/// Of the nodes around the contact's place, interpolated: size or spacing.
[[nodiscard]] inline double mean_of(double TouchNode::*length, const ResponseField& field,
                                    const PlacedContact& c) noexcept {
  double mean = 0;
  for (std::size_t i = 0; i < 3; ++i)
    mean += c.place.weight[Eigen::Index(i)] * field.touch().nodes()[c.place.node[i]].*length;
  return mean;
}

/// each(part, node, level) for the spreads (PatchTable) that together are the contact's. Interpolated twice,
/// over the place's triangle and over those that the spreads lie on: a quarter of spacing^2 each time.
template <class Each>
void each_spread(const ResponseField& field, const PlacedContact& c, const Each& each) noexcept {
  const double spacing = mean_of(&TouchNode::spacing, field, c);
  const PatchTable::Level level = field.table().level(c.loaded2() - 0.5 * spacing * spacing);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t l = 0; l < 2; ++l)
      each(c.share * c.place.weight[Eigen::Index(i)] * (l == 0 ? 1 - level.part : level.part),
           c.place.node[i], level.below + l);
}
/// each(node, q) (moment_loads.hpp) of the contact.
template <class Each>
void each_moment(const ResponseField& field, const PlacedContact& c, const Each& each) noexcept {
  each_spread(field, c, [&](double part, std::uint32_t k, std::size_t level) {
    each_moment(field.touch(), k, field.table().spread(k, level),
                [&](std::uint32_t node, const Vec3<double>& q) { each(node, Vec3<double>(part * q)); });
  });
}

/// A double force and a tilt as node k has them.
[[nodiscard]] inline Vec3<double> loads_of_node(const ResponseField& field, std::uint32_t k, double dipole,
                                                const Vec3<double>& tilt) noexcept {
  const Vec3<double>& n = field.touch().nodes()[k].normal;
  const Vec3<double> t1 = perpendicular(n);
  return {dipole, tilt.dot(t1), tilt.dot(n.cross(t1))};
}

/// The disc of radius a that stands for a mean over a patch, seen at r from contact j, p along it. Such a
/// mean has no edge at a, where a disc's own field has an infinite slope: it is taken a twentieth of a
/// deeper.
[[nodiscard]] inline Disc<double> mean_disc(const PlacedContact& cj, const Vec3<double>& r,
                                            const Vec3<double>& p, double a) noexcept {
  return {p.squaredNorm(), std::hypot(edge_depth(r, cj.m, a, cj.sag), 0.05 * a), a};
}

/// Near field at r from contact j of unit forces on a disc of radius a, times mu [1/m].
[[nodiscard]] inline Mat3<double> near_of_forces(const PlacedContact& cj, const Vec3<double>& r, double a,
                                                 double nu) noexcept {
  constexpr double scale = 1 / (4 * std::numbers::pi);
  const Vec3<double> p = tangential(r, cj.m);
  const Disc<double> disc = mean_disc(cj, r, p, a);
  Mat3<double> out;
  for (int l = 0; l < 3; ++l) {
    const double fn = cj.m[l];
    const Vec3<double> t = Vec3<double>::Unit(l) - fn * cj.m;
    const auto u = disc.flat_punch(fn, t.dot(p), nu);
    out.col(l) = scale * (u.in_plane * p + u.normal * cj.m + u.along * t);
  }
  return out;
}

/// Mean displacement of patch i by unit forces on patch j.
[[nodiscard]] inline Mat3<double> coupling(const ResponseField& field, const PlacedContact& ci,
                                           const PlacedContact& cj) noexcept {
  Mat3<double> out = ci.carried * cj.carried *
                     near_of_forces(cj, Vec3<double>(ci.x - cj.x), std::hypot(ci.a, cj.a), field.nu());
  for (const PatchWeight& i : ci.nodes)
    for (const PatchWeight& j : cj.nodes) {
      const double g = ci.share * cj.share * i.weight * j.weight;
      for (std::size_t l = 0; l < 3; ++l) out.col(Eigen::Index(l)) += g * field.at(i.node, j.node, l);
    }
  return out;
}
/// Mean displacement of patch i by contact j's unit loads: radial double force, tilts along its t1 and t2
/// [1/m^2]. Its transpose is what unit forces on patch i do beneath patch j: spread, slopes along t1 and t2
/// (reciprocity).
[[nodiscard]] inline Mat3<double> coupling_of_moments(const ResponseField& field, const PlacedContact& ci,
                                                      const PlacedContact& cj) noexcept {
  const double nu = field.nu(), a = std::hypot(ci.a, cj.a),
               near = ci.carried * cj.carried / (4 * std::numbers::pi);
  const Vec3<double> r = ci.x - cj.x, p = tangential(r, cj.m);
  const Disc<double> disc = mean_disc(cj, r, p, a);
  const auto d = disc.force_dipole(nu);
  const std::array<Vec3<double>, 3> tilt{Vec3<double>::Zero(), cj.t1(), cj.t2()};
  Mat3<double> out;
  out.col(0) = near * (d.in_plane * p + d.normal * cj.m);
  for (std::size_t l = 1; l < 3; ++l) {
    const auto t = disc.bending_couple(tilt[l].dot(p), nu);
    out.col(Eigen::Index(l)) = near * (t.in_plane * p + t.normal * cj.m + t.along * tilt[l]);
  }
  for (const PatchWeight& j : cj.nodes) {
    Mat3<double> mean = Mat3<double>::Zero();
    for (const PatchWeight& i : ci.nodes)
      for (std::size_t l = 0; l < 3; ++l)
        mean.col(Eigen::Index(l)) += i.weight * field.at(i.node, j.node, 3 + l);
    for (std::size_t l = 0; l < 3; ++l)
      out.col(Eigen::Index(l)) +=
          ci.share * cj.share * j.weight * mean * loads_of_node(field, j.node, l == 0 ? 1 : 0, tilt[l]);
  }
  return out;
}
/// By its unit twist about its m.
[[nodiscard]] inline Vec3<double> coupling_of_twist(const ResponseField& field, const PlacedContact& ci,
                                                    const PlacedContact& cj) noexcept {
  const double near = ci.carried * cj.carried / (4 * std::numbers::pi);
  const Vec3<double> r = ci.x - cj.x, p = tangential(r, cj.m);
  Vec3<double> out = near * mean_disc(cj, r, p, std::hypot(ci.a, cj.a)).torsional_couple() * cj.m.cross(p);
  for (const PatchWeight& i : ci.nodes)
    for (const PatchWeight& j : cj.nodes)
      out += ci.share * cj.share * i.weight * j.weight * field.at(i.node, j.node, 6);
  return out;
}

}  // namespace palpate::detail
