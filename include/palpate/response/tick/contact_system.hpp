// SPDX-License-Identifier: MIT
#pragma once

/// @file The contacts of one tick of a response field as a linear system: which force moves which contact by
/// how much. Per tick.
///
///     C P = d + C_near q - w_2,   C_ii = C_near + w_ii,   C_ij = u_near(sqrt(a_i^2 + a_j^2)) + w_ij
///
/// | symbol | name                                                                              | unit   |
/// |--------|-----------------------------------------------------------------------------------|--------|
/// | C_near | compliance of the bonded flat punch on a half-space, times mu                     | 1/m    |
/// | w      | regular part of the Green's function, times mu                                    | 1/m    |
/// | q, w_2 | second order in depth: universal forces, displacement by the loads beside the force | m^2, m |
///
/// Stages of a contact: stages.hpp. Where the boundary element mesh does not resolve the body, a mode of the
/// system may be too stiff or even pull: its compliance is bounded from below, continuously
/// (bounded_compliance.hpp).

#include <palpate/core/cholesky.hpp>
#include <palpate/response/contact_types.hpp>
#include <palpate/response/tick/make_stages.hpp>

#include <algorithm>
#include <limits>

namespace palpate::detail {

template <std::size_t Capacity>
class ContactSystem {
 public:
  struct Settings {
    bool second_order = true;
    SecondOrder constants = {};
  };
  ContactSystem(const ResponseField& field, const Settings& settings) : field_(&field), settings_(settings) {
    settings_.constants = settings.constants.at(field.nu());
  }

  /// As they are for this body's nu.
  [[nodiscard]] const SecondOrder& constants() const noexcept { return settings_.constants; }
  [[nodiscard]] const PlacedContact& placed(std::size_t c) const noexcept { return placed_[c]; }
  [[nodiscard]] const BondedContact& bonded(std::size_t c) const noexcept { return bonded_[c]; }
  [[nodiscard]] const SecondOrderContact& second(std::size_t c) const noexcept { return second_[c]; }
  [[nodiscard]] const SolvedContact& solved(std::size_t c) const noexcept { return solved_[c]; }
  /// The drawn stage of contact c.
  [[nodiscard]] DrawnContact drawn(std::size_t c) const noexcept {
    return draw_contact(constants(), field_->nu(), placed_[c], bonded_[c], second_[c], solved_[c]);
  }
  /// Largest square of a displacement of the first `count` contacts [m^2].
  [[nodiscard]] double max_displacement2(std::size_t count) const noexcept {
    double max = 0;
    for (std::size_t c = 0; c < count; ++c) max = (std::max)(max, placed_[c].displacement2);
    return max;
  }

  /// Places contact c.
  void place(std::size_t c, const Indenter& tool) noexcept {
    construct(placed_[c], [&] { return place_contact(*field_, tool); });
  }

  /// All further stages of the first `count` contacts, all placed. The forces alone come first; they give the
  /// loads beside the force; with these the forces are solved again.
  void solve(std::size_t count) noexcept;

  /// All stages of one sphere alone. `curvature`: k1 + k2 of the surface.
  PressedSphere solve_sphere(const Indenter& tool, double curvature) noexcept {
    construct(bonded_[0], [] { return BondedContact{}; });
    return press_sphere(*field_, second_order(), tool, curvature, placed_[0], second_[0], solved_[0]);
  }

  /// Force that the tool exerts in contact c / mu.
  [[nodiscard]] Vec3<double> force(std::size_t c) const noexcept { return solved_[c].P + second_[c].extra; }

  /// Torque of the tool on patch i of `count`, about the patch's moved middle, / mu: the felt bending couple,
  /// and the couple that keeps the patch from rotating about m with w. The field leaves out the latter. In
  /// theory it takes less than all of a compliance; it is bounded by half of one, for patches that are wide
  /// for a thin part.
  [[nodiscard]] Vec3<double> torque(std::size_t i, std::size_t count) const noexcept;

 private:
  // Mean displacement of patch i by contact j: by unit forces, by unit loads beside them.
  struct Coupling {
    Mat3<double> forces, moments;
  };
  [[nodiscard]] Coupling& by(std::size_t i, std::size_t j) noexcept { return coupling_[i * Capacity + j]; }
  [[nodiscard]] const SecondOrder* second_order() const noexcept {
    return settings_.second_order ? &settings_.constants : nullptr;
  }
  [[nodiscard]] Vec3<double> felt_couple(std::size_t i) const noexcept {
    const PatchMoments& moments = bonded_[i].moments;
    return moments.share > 0 ? Vec3<double>(second_[i].felt_couple + moments.couple(solved_[i].y))
                             : second_[i].felt_couple;
  }

  // Couplings between contacts. By energy their own compliances bound them: with K = L_i N L_j^T, C = L L^T,
  // all singular values of N are below 1, so |N|^2 = tr(S_i K S_j K^T) < 3. Where the trace exceeds 3 the
  // mesh does not resolve K, and K is multiplied by 3 over the trace.
  void couple(std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const PlacedContact &ci = placed_[i], &cj = placed_[j];
        const Mat3<double> K = 0.5 * (coupling(*field_, ci, cj) + coupling(*field_, cj, ci).transpose());
        const Mat3<double> one = ci.S * K, other = K * cj.S;
        const double share =
            tick::max_coupling / (std::max)(one.cwiseProduct(other).sum(), tick::max_coupling);
        by(i, j) = {share * K, share * coupling_of_moments(*field_, ci, cj)};
        by(j, i) = {share * K.transpose(), share * coupling_of_moments(*field_, cj, ci)};
      }
  }

  // Activation of contacts. A contact comes in with d = 0 where deeper contacts may have moved the surface by
  // u; bonded there it would pull. So its activation grows with what is left of d, 1 - u.d/d^2, to 1 at a
  // quarter. It is 0 while d is small against u, whatever the direction of u. Only deeper contacts count,
  // wholly from twice the depth on, so that two equal contacts do not release each other. As a contact comes
  // in, the moments of the others' patches are released (PatchMoments).
  void activate(std::size_t count, std::array<double, Capacity>& activation,
                std::array<double, Capacity>& wide) noexcept {
    constexpr double tiny = (std::numeric_limits<double>::min)();
    for (std::size_t i = 0; i < count; ++i) {
      const Indenter& tool = placed_[i].tool;
      const double d2 = placed_[i].displacement2;
      Vec3<double> u = Vec3<double>::Zero();
      for (std::size_t j = 0; j < count; ++j) {
        const double deeper = placed_[j].displacement2;
        if (!(deeper > d2)) continue;
        u += smooth_step(std::sqrt(deeper / (d2 + tiny)) - 1) *
             (by(i, j).forces * (placed_[j].S * placed_[j].tool.d));
      }
      activation[i] = smooth_step((1 - u.dot(tool.d) / (d2 + tiny)) / tick::active_from) *
                      smooth_limit(tick::moved_share2 * u.squaredNorm(), d2);
    }
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j)
        if (i != j) wide[i] *= 1 - activation[j];
  }

  // d of contact i less the displacement of its patch by rotated tools: by its own, and by the others'
  // torsional couples, which do not depend on the forces. The others' bending couples come with the loads
  // beside the force.
  [[nodiscard]] Vec3<double> linear_rhs(std::size_t i, std::size_t count) const noexcept {
    Vec3<double> rhs = placed_[i].tool.d;
    for (std::size_t j = 0; j < count; ++j) {
      if (!placed_[j].tool.is_rotated()) continue;
      const RotationLoads& loads = bonded_[j].rotation;
      const Vec3<double> u =
          j == i ? loads.displacement
                 : Vec3<double>(loads.torsion * coupling_of_torsion(*field_, placed_[i], placed_[j]));
      rhs -= series_share(u.norm(), placed_[j].displacement2) * u;
    }
    return rhs;
  }

  void solve_linear(std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i)
      construct(linear_[i], [&] { return LinearContact{{}, Vec3<double>::Zero(), linear_rhs(i, count)}; });
    solve_forces(
        count, [this](std::size_t i) -> const Vec3<double>& { return linear_[i].rhs; },
        [this](std::size_t i) -> Vec3<double>& { return linear_[i].P; });
    if constexpr (Capacity > 1)
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count; ++j)
          if (i != j) linear_[i].imposed += by(j, i).moments.transpose() * linear_[j].P;
  }

  // Forces with all loads, and the loads that bond wide patches.
  void solve_second(std::size_t count, bool any) noexcept {
    std::array<Vec3<double>, Capacity> rhs;
    for (std::size_t i = 0; i < count; ++i) {
      solved_[i].x = placed_[i].tool.x;
      solved_[i].a = placed_[i].tool.a;
      if (any)
        rhs[i] = second_rhs(i, count);
      else
        solved_[i].P = linear_[i].P;
    }
    if (any)
      solve_forces(
          count, [&rhs](std::size_t i) -> const Vec3<double>& { return rhs[i]; },
          [this](std::size_t i) -> Vec3<double>& { return solved_[i].P; });
    for (std::size_t i = 0; i < count; ++i) {
      const PatchMoments& moments = bonded_[i].moments;
      if (moments.share > 0)
        solved_[i].y =
            moments.bonding(placed_[i].tool.slope(), solved_[i].P, second_[i].dipole, second_[i].couple);
    }
  }
  // The displacement that is left for the force of contact i: less that by the others' dipoles and couples.
  [[nodiscard]] Vec3<double> second_rhs(std::size_t i, std::size_t count) noexcept {
    Vec3<double> rhs = second_[i].rhs;
    if constexpr (Capacity > 1)
      for (std::size_t j = 0; j < count; ++j) {
        if (i == j || !has_loads(placed_[j].tool, second_[j])) continue;
        const Indenter& tool = placed_[j].tool;
        const SecondOrderContact& second = second_[j];
        const Mat3<double>& moved = by(i, j).moments;
        const Vec3<double> loads(second.dipole, second.couple.dot(tool.t1()), second.couple.dot(tool.t2()));
        rhs -= series_share(size_of_both(moved.col(0).norm(), second.dipole, moved.rightCols<2>().norm(),
                                         second.couple),
                            placed_[j].displacement2) *
               (moved * loads);
      }
    return rhs;
  }

  // Solves C P = rhs; rhs(i) and P(i) are those of contact i.
  template <class Rhs, class Force>
  void solve_forces(std::size_t count, const Rhs& rhs, const Force& P) noexcept {
    if constexpr (Capacity > 1)
      if (count > 1) return solve_coupled(count, rhs, P);
    if (count == 1) P(0) = bonded_[0].S * rhs(0);
  }
  // Unknowns P / sqrt(activation): without activation a contact has no force, and the system stays symmetric.
  template <class Rhs, class Force>
  void solve_coupled(std::size_t count, const Rhs& rhs, const Force& P) noexcept {
    SpdSystem<3 * Capacity> system{};
    const std::size_t n = 3 * count;
    std::array<double, Capacity> root;
    for (std::size_t i = 0; i < count; ++i) {
      root[i] = std::sqrt(bonded_[i].activation);
      put(system, i, i, bonded_[i].C);
      for (std::size_t j = 0; j < i; ++j) put(system, i, j, root[i] * root[j] * by(i, j).forces);
    }
    for (std::size_t i = 0; i < n; ++i) system.b[i] = root[i / 3] * rhs(i / 3)[Eigen::Index(i % 3)];
    bound_modes(system, count);
    const bool ok = system.solve(n);
    for (std::size_t i = 0; i < count; ++i) {
      P(i).setZero();
      if (ok) P(i) = root[i] * Vec3<double>(system.b[3 * i], system.b[3 * i + 1], system.b[3 * i + 2]);
    }
  }
  // Bounds the system's modes from below, in units of each contact's least compliance.
  template <class System>
  void bound_modes(System& system, std::size_t count) const noexcept {
    const std::size_t n = 3 * count;
    std::array<double, Capacity> min;
    double whole = 0;
    for (std::size_t i = 0; i < count; ++i) whole += bonded_[i].C.trace();
    for (std::size_t i = 0; i < count; ++i)
      min[i] = tick::min_coupled_compliance * placed_[i].min_near() + tick::min_resolved_compliance * whole;
    System test = system;
    for (std::size_t i = 0; i < n; ++i) test.at(i, i) -= min[i / 3];
    if (test.factor(n)) return;
    using Square = Eigen::Matrix<double, 3 * int(Capacity), 3 * int(Capacity)>;
    Square C = Square::Identity();  // beyond n
    const auto unit = [&min](std::size_t r, std::size_t c) { return std::sqrt(min[r / 3] * min[c / 3]); };
    for (std::size_t r = 0; r < n; ++r)
      for (std::size_t c = 0; c < n; ++c)
        C(Eigen::Index(r), Eigen::Index(c)) = system.at((std::max)(r, c), (std::min)(r, c)) / unit(r, c);
    bound_below(C, 1);
    for (std::size_t r = 0; r < n; ++r)
      for (std::size_t c = 0; c <= r; ++c) system.at(r, c) = C(Eigen::Index(r), Eigen::Index(c)) * unit(r, c);
  }
  template <class System>
  static void put(System& system, std::size_t i, std::size_t j, const Mat3<double>& block) noexcept {
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        system.at(3 * i + r, 3 * j + c) = block(Eigen::Index(r), Eigen::Index(c));
  }

  const ResponseField* field_;
  Settings settings_;
  std::array<PlacedContact, Capacity> placed_{};
  std::array<BondedContact, Capacity> bonded_{};
  std::array<LinearContact, Capacity> linear_{};
  std::array<SecondOrderContact, Capacity> second_{};
  std::array<SolvedContact, Capacity> solved_{};
  std::array<Coupling, Capacity == 1 ? 0 : Capacity * Capacity> coupling_{};
};

template <std::size_t Capacity>
void ContactSystem<Capacity>::solve(std::size_t count) noexcept {
  std::array<double, Capacity> activation, wide;
  for (std::size_t i = 0; i < count; ++i) activation[i] = 1, wide[i] = placed_[i].wide;
  if constexpr (Capacity > 1)
    if (count > 1) {
      couple(count);
      activate(count, activation, wide);
    }
  for (std::size_t i = 0; i < count; ++i)
    construct(bonded_[i], [&] { return bond_contact(*field_, placed_[i], activation[i], wide[i]); });
  solve_linear(count);
  bool any = false;
  for (std::size_t i = 0; i < count; ++i) {
    construct(second_[i], [&] {
      return second_order_loads(*field_, second_order(), placed_[i], bonded_[i], linear_[i]);
    });
    any = any || has_loads(placed_[i].tool, second_[i]);
  }
  solve_second(count, any);
}

template <std::size_t Capacity>
Vec3<double> ContactSystem<Capacity>::torque(std::size_t i, std::size_t count) const noexcept {
  const PlacedContact& c = placed_[i];
  const double stiffness = torsional_stiffness(*field_, c, bonded_[i].activation);
  const auto rotated = [this, stiffness](const Vec3<double>& by_force, std::size_t j) {
    const double taken = stiffness * by_force.squaredNorm(), whole = bonded_[j].C.trace();
    return smooth_limit(taken * taken, tick::max_bonded_part2 * whole * whole) * by_force.dot(solved_[j].P);
  };
  double angle = rotated(moved_by_torsion(*field_, c), i);
  for (std::size_t j = 0; j < count; ++j)
    if (j != i) angle += rotated(coupling_of_torsion(*field_, placed_[j], c), j);
  return felt_couple(i).cross(c.tool.m) + (bonded_[i].rotation.torsion - stiffness * angle) * c.tool.m;
}

}  // namespace palpate::detail
