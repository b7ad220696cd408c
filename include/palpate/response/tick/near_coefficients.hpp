// SPDX-License-Identifier: MIT
#pragma once

/// @file From a solved contact to the coefficients of its near field: the drawn stage. Per tick.

#include <palpate/response/tick/second_order_loads.hpp>

namespace palpate::detail {

/// e of the near term k_r asin(1/s) / (s sqrt(s^2 - 1 + e^2)), such that at the patch's edge, where the
/// dipole's disc moves -dipole (2 - 2 nu) 3 / (32 a^2), the term cancels that: e = k_r pi / 2 over that
/// displacement by d_n delta_n / a.
[[nodiscard]] inline double near_term_pole(double radial, double a, double nu) noexcept {
  const double per_depth = 1 / (a * flat_punch_compliance(a, nu).normal),
               moved = (std::max)(dipole_ratio(nu), tick::min_dipole_ratio) * per_depth * (2 - 2 * nu);
  return radial * 16 / (3 * moved) * std::numbers::pi;
}

/// Sets the terms of second order: products of their constants with d_n delta_n / a and beta^2 delta_t.
inline void set_near_terms(const SecondOrder& k, const SecondOrderContact& second, double a, double nu,
                           NearField& out) noexcept {
  const NearTerms& q = second.near;
  const double dn2 = q.dn2 / a, beta = (std::min)(q.beta, 1.0), pole = near_term_pole(k.radial, a, nu);
  out.radial = static_cast<float>(out.is_sphere ? q.spread : k.radial * dn2);
  out.raised = static_cast<float>(q.raised);
  out.radial_4 = static_cast<float>(k.radial_4.at(q.beta) * dn2 / a);
  out.radial_6 = static_cast<float>(k.radial_6.at(q.beta) * dn2 / a);
  out.normal_4 = static_cast<float>(k.normal_4.at(q.beta) * dn2);
  out.normal_6 = static_cast<float>(k.normal_6.at(q.beta) * dn2);
  out.slide = (k.slide.at(beta) * beta * beta / (a * a) * q.delta_t).template cast<float>();
  out.pole2 = static_cast<float>(pole * pole);
  out.push = q.push.template cast<float>();
  // Slope of a rigid disc by its couple: 3 (1 - nu) / (8 a^3).
  out.slope = (0.375 * (1 - nu) / (a * a * a) * q.couple).template cast<float>();
}

/// The near field of a solved contact.
[[nodiscard]] inline NearField near_field_of(const SecondOrder& k, double nu, const PlacedContact& c,
                                             const BondedContact& bonded, const SecondOrderContact& second,
                                             const SolvedContact& solved) noexcept {
  constexpr double scale = 1 / (4 * std::numbers::pi);
  const Indenter& tool = c.tool;
  const double normal = solved.P.dot(tool.m);
  NearField out;
  out.x = solved.x.template cast<float>();
  out.m = tool.m.template cast<float>();
  out.a = static_cast<float>(solved.a);
  out.nu = static_cast<float>(nu);
  out.sagitta = static_cast<float>(c.sagitta);
  out.activation = static_cast<float>(bonded.activation);
  out.is_sphere = tool.is_sphere();
  out.along = (scale * (solved.P - normal * tool.m)).template cast<float>();
  out.normal = static_cast<float>(scale * normal);
  Vec3<double> couple = second.couple;
  double dipole = second.dipole;
  out.shear.setZero();
  out.has_shear = bonded.moments.share > 0;
  if (out.has_shear) {
    couple += bonded.moments.couple(solved.y);
    dipole += solved.y[0];
    out.shear = (scale * bonded.moments.shear(solved.y)).template cast<float>();
  }
  out.couple = (scale * couple).template cast<float>();
  out.dipole = static_cast<float>(scale * dipole);
  out.torsion = static_cast<float>(scale * bonded.rotation.torsion);
  out.has_loads = dipole != 0 || out.is_sphere;
  out.has_couple = couple.squaredNorm() > 0;
  out.has_torsion = bonded.rotation.torsion != 0;
  set_near_terms(k, second, solved.a, nu, out);
  if (tool.is_rotated()) {
    const double angle = tool.rotation.norm();
    const Eigen::AngleAxis<double> rotation(angle, tool.rotation / angle);
    out.rotation = (rotation.toRotationMatrix() - Mat3<double>::Identity()).template cast<float>();
  }
  return out;
}

/// The drawn stage.
[[nodiscard]] PALPATE_COMPILED_INLINE DrawnContact draw_contact(const SecondOrder& k, double nu,
                                                                const PlacedContact& c,
                                                                const BondedContact& bonded,
                                                                const SecondOrderContact& second,
                                                                const SolvedContact& solved) noexcept {
  DrawnContact out{c.tool, c.tool.x, near_field_of(k, nu, c, bonded, second, solved)};
  out.tool.x = solved.x;
  out.tool.a = solved.a;
  return out;
}

}  // namespace palpate::detail
