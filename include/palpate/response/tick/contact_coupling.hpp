// SPDX-License-Identifier: MIT
#pragma once

/// @file Coupling of two contacts: mean displacements of one's patch by the other's unit forces and unit
/// loads. Per tick.
///
///     K_ij = u_near(x_i - x_j; disc of radius sqrt(a_i^2 + a_j^2)) + sum_kl g_ik g_jl w_kl
///
/// The near field of the force on patch j, averaged over patch i, is that of a disc with the square sum of
/// the radii: exact to second moments, and never singular when patches meet. g: the contacts' weights at the
/// nodes.

#include <palpate/response/tick/placement.hpp>

namespace palpate::detail {

/// A dipole and a couple in the axes of node k.
[[nodiscard]] PALPATE_COMPILED_INLINE Vec3<double> loads_of_node(const ResponseField& field, std::uint32_t k,
                                                                 double dipole,
                                                                 const Vec3<double>& couple) noexcept {
  const Vec3<double>& n = field.load_mesh().nodes()[k].normal;
  const Vec3<double> t1 = perpendicular(n);
  return {dipole, couple.dot(t1), couple.dot(n.cross(t1))};
}

/// The disc of radius a that stands for a mean over a patch, seen at r from contact j, p along it. A disc's
/// own field has an infinite slope at its edge, such a mean has not: the disc is taken a twentieth of a
/// deeper.
[[nodiscard]] inline Disc<double> mean_disc(const PlacedContact& cj, const Vec3<double>& r,
                                            const Vec3<double>& p, double a) noexcept {
  return {p.squaredNorm(), std::hypot(edge_depth(r, cj.tool.m, a, cj.sagitta), tick::mean_disc_depth * a), a};
}

/// Near field at r from contact j of unit forces on a disc of radius a, times mu; columns: their directions
/// [1/m].
[[nodiscard]] inline Mat3<double> near_of_forces(const PlacedContact& cj, const Vec3<double>& r, double a,
                                                 double nu) noexcept {
  constexpr double scale = 1 / (4 * std::numbers::pi);
  const Vec3<double> p = tangential(r, cj.tool.m);
  const Disc<double> disc = mean_disc(cj, r, p, a);
  Mat3<double> out;
  for (int l = 0; l < 3; ++l) {
    const double fn = cj.tool.m[l];
    const Vec3<double> t = Vec3<double>::Unit(l) - fn * cj.tool.m;
    const auto u = disc.flat_punch(fn, t.dot(p), nu);
    out.col(l) = scale * (u.in_plane * p + u.normal * cj.tool.m + u.along * t);
  }
  return out;
}

/// Mean displacement of patch i by unit forces on patch j, times mu [1/m].
[[nodiscard]] PALPATE_COMPILED_INLINE Mat3<double> coupling(const ResponseField& field,
                                                            const PlacedContact& ci,
                                                            const PlacedContact& cj) noexcept {
  Mat3<double> out =
      ci.carried * cj.carried *
      near_of_forces(cj, Vec3<double>(ci.tool.x - cj.tool.x), std::hypot(ci.tool.a, cj.tool.a), field.nu());
  for (const NodeWeight& i : ci.nodes)
    for (const NodeWeight& j : cj.nodes) {
      const double g = ci.regular * cj.regular * i.weight * j.weight;
      for (std::size_t l = 0; l < 3; ++l) out.col(Eigen::Index(l)) += g * field.at(i.node, j.node, l);
    }
  return out;
}
/// Mean displacement of patch i by contact j's unit loads: radial dipole, bending couples along its t1 and t2
/// [1/m^2]. By reciprocity its transpose is the spread and the slopes along t1 and t2 beneath patch j by unit
/// forces on patch i.
[[nodiscard]] PALPATE_COMPILED_INLINE Mat3<double> coupling_of_moments(const ResponseField& field,
                                                                       const PlacedContact& ci,
                                                                       const PlacedContact& cj) noexcept {
  const double nu = field.nu(), a = std::hypot(ci.tool.a, cj.tool.a),
               near = ci.carried * cj.carried / (4 * std::numbers::pi);
  const Vec3<double> r = ci.tool.x - cj.tool.x, p = tangential(r, cj.tool.m);
  const Disc<double> disc = mean_disc(cj, r, p, a);
  const auto d = disc.force_dipole(nu);
  const std::array<Vec3<double>, 3> couple{Vec3<double>::Zero(), cj.tool.t1(), cj.tool.t2()};
  Mat3<double> out;
  out.col(0) = near * (d.in_plane * p + d.normal * cj.tool.m);
  for (std::size_t l = 1; l < 3; ++l) {
    const auto t = disc.bending_couple(couple[l].dot(p), nu);
    out.col(Eigen::Index(l)) = near * (t.in_plane * p + t.normal * cj.tool.m + t.along * couple[l]);
  }
  for (const NodeWeight& j : cj.nodes) {
    Mat3<double> mean = Mat3<double>::Zero();
    for (const NodeWeight& i : ci.nodes)
      for (std::size_t l = 0; l < 3; ++l)
        mean.col(Eigen::Index(l)) += i.weight * field.at(i.node, j.node, 3 + l);
    for (std::size_t l = 0; l < 3; ++l)
      out.col(Eigen::Index(l)) +=
          ci.regular * cj.regular * j.weight * mean * loads_of_node(field, j.node, l == 0 ? 1 : 0, couple[l]);
  }
  return out;
}
/// Mean displacement of patch i by contact j's unit torsional couple about its m [1/m^2].
[[nodiscard]] PALPATE_COMPILED_INLINE Vec3<double> coupling_of_torsion(const ResponseField& field,
                                                                       const PlacedContact& ci,
                                                                       const PlacedContact& cj) noexcept {
  const double near = ci.carried * cj.carried / (4 * std::numbers::pi);
  const Vec3<double> r = ci.tool.x - cj.tool.x, p = tangential(r, cj.tool.m);
  Vec3<double> out =
      near * mean_disc(cj, r, p, std::hypot(ci.tool.a, cj.tool.a)).torsional_couple() * cj.tool.m.cross(p);
  for (const NodeWeight& i : ci.nodes)
    for (const NodeWeight& j : cj.nodes)
      out += ci.regular * cj.regular * i.weight * j.weight * field.at(i.node, j.node, 6);
  return out;
}

}  // namespace palpate::detail
