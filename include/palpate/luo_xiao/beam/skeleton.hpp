// SPDX-License-Identifier: MIT
#pragma once

/// @file  The beam skeleton of one contact: beams from the contact to every extremal point (V.A.1).

#include <palpate/core/error.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/luo_xiao/beam/concept.hpp>
#include <palpate/luo_xiao/beam/euler_bernoulli.hpp>
#include <palpate/luo_xiao/beam/load_sharing.hpp>
#include <palpate/luo_xiao/beam/volume_preserving.hpp>

#include <algorithm>
#include <span>
#include <type_traits>

namespace palpate {

/// What a skeleton needs of a contact. Object coordinates.
template <Real S>
struct SkeletonContact {
  Vec3<S> position = Vec3<S>::Zero();      ///< on the undeformed surface [m]
  Vec3<S> force = Vec3<S>::Zero();         ///< F on the elastic object: minus the force on the tool [N]
  Vec3<S> displacement = Vec3<S>::Zero();  ///< D [m]
  S normal_force = 0;                      ///< F_cn >= 0 [N]: the contact's part in `CoupledRegions`

  [[nodiscard]] bool operator==(const SkeletonContact&) const noexcept = default;
};

/// What the beams carry, for a scene of scalar S; the numbers come from a solve in double.
template <Real S, std::size_t N>
struct SkeletonLoad {
  struct Beam {
    Vec3<S> axis;   ///< unit, extremal point to contact; any where they coincide
    S length;       ///< l_i [m]
    Vec3<S> force;  ///< F_i [N]; sum F_i = F
  };
  FixedVector<Beam, N, Spare::undefined> beams;  ///< one per extremal point, in their order
  Vec3<S> displacement = Vec3<S>::Zero();        ///< d of the common end [m]
  double total_length = 0;                       ///< sum l_i [m]: gives the section
  bool shared = false;  ///< false: bad input, or no unique answer (`PlanarRatios`); all F_i are 0
};

/// Straight beams from a contact to the n extremal points, fixed there and loaded at their common end.
///
/// | parameter | role                                            | default              |
/// |-----------|-------------------------------------------------|----------------------|
/// | `S`       | scalar of the scene; the solve is in double     |                      |
/// | `T`       | beam theory                                     | `EulerBernoulli`     |
/// | `R`       | section rule                                    | `VolumePreserving`   |
/// | `P`       | sharing of F                                    | `CommonEnd`          |
/// | `N`       | max extremal points                             | 64                   |
///
/// Reported at set-up: no point, more than N, a coordinate beyond 1e6 m. Points may coincide.
/// The servo tick calls `share`. Source: [luo2005], V.A.1.
template <Real S, BeamTheory T = EulerBernoulli<double>, SectionRule R = VolumePreserving<double>,
          LoadSharing P = CommonEnd, std::size_t N = 64>
class Skeleton {
  static_assert(std::is_same_v<typename T::Scalar, double> &&
                    std::is_same_v<typename R::Section::Scalar, double>,
                "palpate::Skeleton: theory and section are of double, whatever the scene's scalar");

 public:
  using Scalar = S;
  using Theory = T;
  using Section = typename R::Section;
  using Load = SkeletonLoad<S, N>;
  using Beams = FixedVector<SkeletonBeam, N, Spare::undefined>;

  /// Lengths are at least this part of the longest: such a beam takes the whole load to rounding.
  static constexpr double min_length = 1e-15;
  /// kt is at most this times ka; Euler-Bernoulli's reaches it at l = r/1155, Timoshenko's never. Both grow
  /// without bound as l -> 0, but their ratio does not, and no digits are lost. Chosen: far from any real
  /// beam.
  static constexpr double max_ratio = 1e6;
  static constexpr double max_coordinate = 1e6;  ///< [m]: a contact further out is bad input

  /// `extremal_points` [m], in object coordinates.
  Skeleton(std::span<const Vec3<S>> extremal_points, const T& theory, const R& rule)
      : theory_(theory), rule_(rule) {
    if (extremal_points.empty()) fail("Skeleton", "needs at least one extremal point");
    if (extremal_points.size() > N) {
      fail("Skeleton", "more extremal points than its capacity", static_cast<double>(extremal_points.size()));
    }
    for (std::size_t i = 0; i < extremal_points.size(); ++i) {
      if (!is_usable_position(extremal_points[i])) {
        fail_at("Skeleton", "coordinates must be finite and below 1e6 m", "extremal point", i);
      }
      points_.push_back(extremal_points[i]);
    }
  }

  /// Shares the contact's force among the beams. Deterministic; independent of the order of points to
  /// rounding.
  void share(const SkeletonContact<S>& contact, Load& load) const noexcept {
    Beams beams;
    begin(contact, beams, load);
    Vec3<double> d = Vec3<double>::Zero();
    const bool shared =
        is_usable(contact) && is_finite(contact.displacement) &&
        P::share(std::span<SkeletonBeam>(beams.begin(), beams.size()), contact.force.template cast<double>(),
                 contact.displacement.template cast<double>(), d);
    finish(beams, d, shared, load);
  }

  [[nodiscard]] const FixedVector<Vec3<S>, N>& points() const noexcept { return points_; }
  [[nodiscard]] const T& theory() const noexcept { return theory_; }
  /// The section of the beams of a load.
  [[nodiscard]] Section section(const Load& load) const noexcept { return rule_.section(load.total_length); }

  [[nodiscard]] static bool is_usable(const SkeletonContact<S>& contact) noexcept {
    return is_usable_position(contact.position) && is_finite(contact.force);
  }

  /// Beams of a contact with their stiffnesses and no force. A contact whose position is not usable is taken
  /// at the origin. For systems of several contacts, as `RegionSkeletons`.
  void begin(const SkeletonContact<S>& contact, Beams& beams, Load& load) const noexcept {
    const Vec3<double> position = is_usable_position(contact.position)
                                      ? Vec3<double>(contact.position.template cast<double>())
                                      : Vec3<double>::Zero();
    double sum = 0, max_length = 0;
    beams.clear();
    for (const Vec3<S>& point : points_) {
      const Vec3<double> axis = position - point.template cast<double>();
      const double length = axis.norm();  // coordinates are below 1e6 m
      sum += length;
      max_length = (std::max)(max_length, length);
      beams.push_back({axis, length, 0, 0, Vec3<double>::Zero()});
    }
    load.total_length = sum;
    const Section section = rule_.section(sum);
    const double floor = max_length > 0 ? min_length * max_length : 1.0;  // all lengths 0: equal shares
    for (SkeletonBeam& beam : beams) {
      if (beam.length >= floor) {
        beam.axis /= beam.length;
      } else {
        beam.axis = Vec3<double>::UnitX();
        beam.length = floor;
      }
      beam.axial = theory_.axial_stiffness(section, beam.length);
      beam.transverse =
          (std::min)(theory_.transverse_stiffness(section, beam.length), max_ratio * beam.axial);
    }
  }

  /// Writes solved beams to a load in the scene's scalar; zeros unless `shared` and all is finite.
  void finish(const Beams& beams, const Vec3<double>& d, bool shared, Load& load) const noexcept {
    load.beams.clear();
    load.displacement = d.cast<S>();
    shared = shared && is_finite(load.displacement);
    for (const SkeletonBeam& beam : beams) {
      load.beams.push_back(
          {beam.axis.template cast<S>(), static_cast<S>(beam.length), beam.force.template cast<S>()});
      shared = shared && is_finite(load.beams[load.beams.size() - 1].force);
    }
    load.shared = shared;
    if (shared) return;
    load.displacement.setZero();
    for (auto& beam : load.beams) beam.force.setZero();
  }

 private:
  [[nodiscard]] static bool is_usable_position(const Vec3<S>& x) noexcept {
    return is_finite(x) && x.cwiseAbs().maxCoeff() <= S(max_coordinate);
  }

  FixedVector<Vec3<S>, N> points_;
  T theory_;
  R rule_;
};

template <class K>  // what it is made of
concept HasBeams = Real<typename K::Scalar> && BeamTheory<typename K::Theory> &&
                   BeamSection<typename K::Section> && requires(const K& skeleton) {
                     { skeleton.points().size() } noexcept -> std::same_as<std::size_t>;
                     { skeleton.theory() } noexcept -> std::same_as<const typename K::Theory&>;
                     { K::max_ratio } -> std::convertible_to<double>;
                   };

template <class K>  // one contact: beams, their section, a solve elsewhere, and the load that it gives
concept HasBeamLoad = requires(const K& skeleton, const SkeletonContact<typename K::Scalar>& contact,
                               typename K::Beams& beams, const Vec3<double>& d, typename K::Load& load) {
  { K::is_usable(contact) } noexcept -> std::same_as<bool>;
  { skeleton.begin(contact, beams, load) } noexcept;
  { skeleton.section(load) } noexcept -> std::same_as<typename K::Section>;
  { skeleton.finish(beams, d, true, load) } noexcept;
  { load.beams[0].force } -> std::convertible_to<Vec3<typename K::Scalar>>;
};

/// The beams of one contact, as `RegionSkeletons` and `release` take them. `Skeleton` is the one shipped.
template <class K>
concept ContactSkeleton = HasBeams<K> && HasBeamLoad<K> && std::copyable<K>;

}  // namespace palpate
