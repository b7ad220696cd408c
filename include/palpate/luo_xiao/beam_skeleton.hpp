// SPDX-License-Identifier: MIT
#pragma once

/// @file  The paper's deformation model (V, VI): skeleton, released ends, interpolation, local neighbourhood,
/// written to vertices.

#include <palpate/luo_xiao/beam/end_release.hpp>
#include <palpate/luo_xiao/beam/region_skeletons.hpp>
#include <palpate/luo_xiao/displacement_field.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace palpate {

/// Contacts to vertices (V, VI): each contact's force is shared among its beams, the released ends give the
/// displacements u_i of the extremal points, and a `DisplacementField` interpolates u_i and D.
///
/// | parameter | role                                                       | default            |
/// |-----------|------------------------------------------------------------|--------------------|
/// | `R`       | `RegionSkeletons<...>`: beams and how contacts couple      |                    |
/// | `I`       | interpolation; its scalar may be narrower than the scene's |                    |
/// | `N`       | local neighbourhood                                        | `AreaNeighbourhood` |
///
/// | symbol | name              | unit | range                                                             |
/// |--------|-------------------|------|-------------------------------------------------------------------|
/// | o      | `Params::fixed`   | m    | finite: the bottom centre, which does not move                    |
///
/// Set-up reports extremal points of skeleton and partition that are not the same, in the same order. Source:
/// [luo2005], V and VI.
template <SkeletonSystem R, Interpolation I, Neighbourhood N = AreaNeighbourhood<typename I::Scalar>>
class BeamSkeletonDeformation {
 public:
  using Scalar = typename R::Scalar;
  using S = Scalar;
  using Regions = R;
  using D = typename I::Scalar;  ///< the display's scalar
  static constexpr bool active = true;
  static constexpr std::size_t max_contacts = decltype(R::Result::loads)::capacity;

  struct Params {
    Vec3<S> fixed = Vec3<S>::Zero();  ///< o [m]
    bool normals{true};               ///< see DisplacementField
  };

  BeamSkeletonDeformation(R regions, BlocksOf<I> interpolation, N neighbourhood, const MeshData<D>& mesh,
                          const Params& params)
      : p_(params),
        regions_(std::move(regions)),
        field_(std::move(interpolation), std::move(neighbourhood), mesh,
               {.contacts = max_contacts, .normals = params.normals}) {
    const auto points = field_.partition().points();
    const auto& ends = regions_.skeleton().points();
    if (!is_finite(p_.fixed)) fail(name, "fixed must be finite");
    const bool has_fixed = points.size() == ends.size() + 1;
    if (ends.size() != points.size() && !has_fixed)
      fail(name, "skeleton and partition must have the same extremal points",
           static_cast<double>(ends.size()));
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (ends[i].template cast<D>() != points[i].position)
        fail_at(name, "skeleton and partition must have the same position", "extremal point", i);
    }
    if (has_fixed && p_.fixed.template cast<D>() != points.back().position)
      fail(name, "the partition's further corner must be at fixed");
    released_.assign(points.size(), Vec3<S>::Zero());  // no beam ends at a further corner: it stays
    corners_.resize(points.size() * max_contacts);
  }

  template <Real T>
  void write_rest(const VertexBuffer<T>& out) noexcept {
    field_.write_rest(out);
    result_ = {};
    loaded_.clear();
    shown_.clear();
  }

  /// Writes what moved since the last call. More contacts than the skeleton takes: the surplus is left out,
  /// reported. With the same contacts as in the last call nothing is done.
  template <Real T>
  Moved<S> write(std::span<const ContactState<S>> contacts, const VertexBuffer<T>& out) noexcept {
    Moved<S> result;
    if (contacts.size() > max_contacts) result.status |= Status::region_overflow;
    if (out.positions == nullptr || !take(contacts.first((std::min)(contacts.size(), max_contacts))))
      return result;
    const std::size_t count = loaded_.size(), points = released_.size();
    regions_.share(std::span<const SkeletonContact<S>>(loaded_.begin(), count), result_);
    for (std::size_t j = 0; j < count; ++j) {
      release(regions_.skeleton(), result_.loads[j], p_.fixed, loaded_[j].displacement,
              std::span<Vec3<S>>(released_));
      for (std::size_t i = 0; i < points; ++i) corners_[j * points + i] = released_[i].template cast<D>();
    }
    const Moved<D> moved = field_.write(std::span<const ContactDisplacement<D>>(shown_.begin(), count),
                                        std::span<const Vec3<D>>(corners_.data(), count * points), out);
    result.vertices = moved.vertices;
    result.lower = moved.lower.template cast<S>();
    result.upper = moved.upper.template cast<S>();
    result.status |= moved.status;
    return result;
  }

  /// Skeleton loads of the last write(): forces, lengths and axes of all beams.
  [[nodiscard]] const typename R::Result& loads() const noexcept { return result_; }
  [[nodiscard]] const DisplacementField<I, N>& field() const noexcept { return field_; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  static constexpr const char* name = "BeamSkeletonDeformation";

  // Takes the contacts; false when they are those of the last write, in all that is drawn.
  bool take(std::span<const ContactState<S>> contacts) noexcept {
    bool same = contacts.size() == loaded_.size();
    for (std::size_t j = 0; same && j < contacts.size(); ++j)
      same = loaded_[j] == loaded(contacts[j]) && shown_[j] == shown(contacts[j]);
    if (same) return false;
    loaded_.clear();
    shown_.clear();
    for (const ContactState<S>& c : contacts) {
      loaded_.push_back(loaded(c));
      shown_.push_back(shown(c));
    }
    return true;
  }
  [[nodiscard]] static SkeletonContact<S> loaded(const ContactState<S>& c) noexcept {
    return {c.origin(), -c.force, c.own_displacement(), c.normal_force};
  }
  [[nodiscard]] static ContactDisplacement<D> shown(const ContactState<S>& c) noexcept {
    return {
        c.origin().template cast<D>(), c.normal.template cast<D>(), c.own_displacement().template cast<D>(),
        static_cast<D>(c.area),        static_cast<D>(c.points),    static_cast<D>(c.depth - c.dent)};
  }

  Params p_;
  R regions_;
  DisplacementField<I, N> field_;
  typename R::Result result_{};
  FixedVector<SkeletonContact<S>, max_contacts> loaded_;     // of the last write, as the skeleton sees them
  FixedVector<ContactDisplacement<D>, max_contacts> shown_;  // and as they are drawn
  std::vector<Vec3<S>> released_;
  std::vector<Vec3<D>> corners_;
};

template <SkeletonSystem R, BlockInterpolation I, Neighbourhood N>
BeamSkeletonDeformation(R, I, N, const MeshData<typename I::Scalar>&,
                        const typename BeamSkeletonDeformation<R, I, N>::Params&)
    -> BeamSkeletonDeformation<R, I, N>;

}  // namespace palpate
