// SPDX-License-Identifier: MIT
#pragma once

/// @file  Skeletons of several contact regions, and the forces that they transmit to each other (VI).

#include <palpate/luo_xiao/beam/skeleton.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <utility>

namespace palpate {

/// One system for all contacts, each two of which share one beam:
///
///     K d = F  (3m x 3m, positive definite)
///     K_jj = sum_i K_ji + sum_k a_jk K_jk,   block (j, k) of K = -a_jk K_jk
///     a_jk = min(N_j, N_k) / max(N_j, N_k),  N the regions' normal forces
///
/// The system is symmetric, so d_j under a force at k equals d_k under that force at j (for given a_jk). The
/// share a_jk of the beam is this library's choice: a region that appears with zero force then changes
/// nothing and receives no more than its own force's order. With whole beams, as in the paper, it would
/// receive a finite force at once.
struct CoupledRegions {
  static constexpr bool coupled = true;
  [[nodiscard]] static double share_of_beam(double a, double b) noexcept {
    const double high = (std::max)(a, b), low = (std::min)(a, b);
    return low > 0 ? low / high : 0.0;
  }
};

/// The paper's form: one skeleton per contact, in which the other contacts are fixed ends; each is solved
/// alone. The beam between two contacts has each one's own section in its skeleton, so the compliance is not
/// reciprocal, and a second region appears with a jump (docs/beams.md has both figures).
struct SuperposedRegions {
  static constexpr bool coupled = false;
  [[nodiscard]] static double share_of_beam(double, double) noexcept { return 1.0; }
};

template <class G>
concept RegionCoupling = requires(double a) {
  { G::coupled } -> std::convertible_to<bool>;
  { G::share_of_beam(a, a) } noexcept -> std::same_as<double>;
};

/// Skeletons of up to M contacts over one set of extremal points.
///
///     F_S,j = own force + f_j,   f_j = sum_k a_jk K_jk d_k
///
/// K_jk is the stiffness of the beam between contacts j and k (V.A.1), its section the mean of theirs when
/// coupled. Each contact's skeleton has the body's whole volume, so its sections do not depend on the others.
/// A beam between contacts is at least `min_distance` (chosen) of the sum of a contact's beam lengths long,
/// because closer regions are about to merge. Source: [luo2005], VI.
template <ContactSkeleton K, RegionCoupling G = CoupledRegions, std::size_t M = 8>
class RegionSkeletons {
  static_assert(M >= 1 && M <= 32, "palpate::RegionSkeletons: 1 <= M <= 32, the system is on the stack");

 public:
  using Scalar = typename K::Scalar;
  using Load = typename K::Load;
  using Contact = SkeletonContact<Scalar>;
  static constexpr bool active = true;  // as a coupling of ContactSolver

  static constexpr double min_distance = 1e-3;

  struct Result {
    FixedVector<Load, M, Spare::undefined> loads;  ///< per contact: its beams to the extremal points, and d_j
    FixedVector<Vec3<Scalar>, M> from_others;      ///< f_j [N]: to be added to the force on the tool at j
    bool shared = false;                           ///< false: bad input; all forces are 0
  };

  explicit RegionSkeletons(const K& skeleton) : skeleton_(skeleton) {}

  /// Solves for at most M contacts; those beyond are left out.
  void share(std::span<const SkeletonContact<Scalar>> contacts, Result& result) const noexcept {
    const std::size_t m = (std::min)(contacts.size(), M);
    result.loads.set_size(m);
    result.from_others.set_size(m);
    std::array<typename K::Beams, M> beams;
    std::array<detail::BeamScale, M> scale;
    bool usable = true;
    for (std::size_t j = 0; j < m; ++j) {
      result.from_others[j].setZero();
      skeleton_.begin(contacts[j], beams[j], result.loads[j]);
      scale[j] = detail::shortest(std::span<const SkeletonBeam>(beams[j].begin(), beams[j].size()));
      usable = usable && K::is_usable(contacts[j]) && is_finite(contacts[j].normal_force);
    }

    std::array<Vec3<double>, M> d;
    usable = usable && solve(contacts, beams, scale, m, result, d);
    for (std::size_t j = 0; j < m; ++j)
      usable = usable && balance(contacts, scale[j], j, m, result, d, beams[j]);
    for (std::size_t j = 0; j < m; ++j) {
      skeleton_.finish(beams[j], usable ? d[j] : Vec3<double>::Zero(), usable, result.loads[j]);
      usable = usable && result.loads[j].shared && is_finite(result.from_others[j]);
    }
    result.shared = usable;
    if (usable) return;
    for (std::size_t j = 0; j < m; ++j) {
      skeleton_.finish(beams[j], Vec3<double>::Zero(), false, result.loads[j]);
      result.from_others[j].setZero();
    }
  }

  [[nodiscard]] const K& skeleton() const noexcept { return skeleton_; }

 private:
  using Contacts = std::span<const SkeletonContact<Scalar>>;

  // The beam of contact j's skeleton to contact k, its stiffness already multiplied by a_jk.
  [[nodiscard]] SkeletonBeam between(Contacts contacts, const Result& result, std::size_t j,
                                     std::size_t k) const noexcept {
    const double reach = (std::max)(result.loads[j].total_length, result.loads[k].total_length);
    const Vec3<double> apart =
        contacts[j].position.template cast<double>() - contacts[k].position.template cast<double>();
    SkeletonBeam beam{unit_or<double>(apart, Vec3<double>::UnitX()),
                      (std::max)(apart.norm(), min_distance * reach), 0, 0, Vec3<double>::Zero()};
    const double share = G::share_of_beam(static_cast<double>(contacts[j].normal_force),
                                          static_cast<double>(contacts[k].normal_force));
    const auto& theory = skeleton_.theory();
    const auto a = skeleton_.section(result.loads[j]),
               b = skeleton_.section(result.loads[G::coupled ? k : j]);
    beam.axial =
        share * (theory.axial_stiffness(a, beam.length) + theory.axial_stiffness(b, beam.length)) / 2;
    beam.transverse =
        share * (theory.transverse_stiffness(a, beam.length) + theory.transverse_stiffness(b, beam.length)) /
        2;
    beam.transverse = (std::min)(beam.transverse, K::max_ratio * beam.axial);
    return beam;
  }
  // K d = F in the scaled unknowns W^-1 d.
  [[nodiscard]] bool solve(Contacts contacts, const std::array<typename K::Beams, M>& beams,
                           const std::array<detail::BeamScale, M>& scale, std::size_t m, const Result& result,
                           std::array<Vec3<double>, M>& d) const noexcept {
    detail::SpdSystem<3 * M> system;
    for (std::size_t j = 0; j < m; ++j) {
      Mat3<double> own = Mat3<double>::Identity();
      for (std::size_t i = 0; i < beams[j].size(); ++i) {
        if (i != scale[j].index) detail::add_scaled(beams[j][i], scale[j], scale[j], 1.0, own);
      }
      for (std::size_t k = 0; k < m; ++k) {
        if (k == j) continue;
        const SkeletonBeam beam = between(contacts, result, j, k);
        detail::add_scaled(beam, scale[j], scale[j], 1.0, own);
        if (k > j) continue;
        Mat3<double> block = Mat3<double>::Zero();
        if constexpr (G::coupled) detail::add_scaled(beam, scale[j], scale[k], -1.0, block);
        set_block(system, j, k, block);
      }
      set_block(system, j, j, own);
      const Vec3<double> right = scale[j].root(contacts[j].force.template cast<double>());
      for (std::size_t c = 0; c < 3; ++c) system.b[3 * j + c] = right[static_cast<int>(c)];
    }
    if (!system.solve(3 * m)) return false;
    for (std::size_t j = 0; j < m; ++j) {
      d[j] = scale[j].root(Vec3<double>(system.b[3 * j], system.b[3 * j + 1], system.b[3 * j + 2]));
      if (!is_finite(d[j])) return false;
    }
    return true;
  }

  static void set_block(detail::SpdSystem<3 * M>& system, std::size_t j, std::size_t k,
                        const Mat3<double>& block) noexcept {
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c)
        system.at(3 * j + r, 3 * k + c) = block(static_cast<int>(r), static_cast<int>(c));
    }
  }

  // Forces of contact j's beams, and those that the others transmit to it; its shortest beam carries the
  // rest.
  [[nodiscard]] bool balance(Contacts contacts, const detail::BeamScale& scale, std::size_t j, std::size_t m,
                             Result& result, const std::array<Vec3<double>, M>& d,
                             typename K::Beams& beams) const noexcept {
    Vec3<double> rest = contacts[j].force.template cast<double>(), passed = Vec3<double>::Zero();
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (i == scale.index) continue;
      beams[i].force = end_force(beams[i], d[j]);
      rest -= beams[i].force;
    }
    for (std::size_t k = 0; k < m; ++k) {
      if (k == j) continue;
      const SkeletonBeam beam = between(contacts, result, j, k);
      rest -= end_force(beam, G::coupled ? Vec3<double>(d[j] - d[k]) : d[j]);
      passed += end_force(G::coupled ? beam : between(contacts, result, k, j), d[k]);
    }
    beams[scale.index].force = rest;
    result.from_others[j] = passed.template cast<Scalar>();
    return is_finite(rest) && is_finite(passed);
  }

  K skeleton_;
};

/// The skeletons of all contacts, as `BeamSkeletonDeformation` takes them. `RegionSkeletons` is the one
/// shipped.
template <class R>
concept SkeletonSystem =
    ContactSkeleton<std::remove_cvref_t<decltype(std::declval<const R&>().skeleton())>> &&
    requires(const R& regions, std::span<const SkeletonContact<typename R::Scalar>> contacts,
             typename R::Result& result) {
      { regions.skeleton() } noexcept;
      { regions.share(contacts, result) } noexcept;
      { decltype(result.loads)::capacity } -> std::convertible_to<std::size_t>;
    } &&
    std::copyable<R>;

static_assert(RegionCoupling<CoupledRegions> && RegionCoupling<SuperposedRegions>);

}  // namespace palpate
