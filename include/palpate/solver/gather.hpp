// SPDX-License-Identifier: MIT
#pragma once

/// @file  From the tool's pose to the sums of its regions: one collector per topology, all with the same interface.
///
///     Status collect(object, tool, force, X, sums)   finds what touches and adds it up, one sum per slot
///     slot(k), changed(), reset()                     the regions' identity

#include <palpate/core/absent.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/core/status.hpp>
#include <palpate/detection/candidates.hpp>
#include <palpate/equivalent/region_sum.hpp>
#include <palpate/region/region_tracker.hpp>
#include <palpate/region/slot.hpp>
#include <palpate/region/topology.hpp>
#include <palpate/solver/force_map.hpp>
#include <palpate/surface/concept.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace palpate {

namespace detail {
/// Status bits of a point at `depth` [m].
template <ContactSurface Object, ForceModel Force>
[[nodiscard]] inline Status depth_status(const Object& object, const Force& force,
                                         typename Object::Scalar depth) noexcept {
  Status status = Status::ok;
  if (depth > object.reach()) status |= Status::beyond_reach;
  if (depth > force.max_depth()) status |= Status::beyond_stable;
  return status;
}

/// Penetration of the first `count` of eight points, at once where the surface can; depth 0 for the others. How many touch.
template <ContactSurface Object, Real S>
inline std::uint32_t penetrate(const Object& object, const PointLanes<S>& x, std::uint32_t count,
                               PenetrationLanes<S>& in) noexcept {
  if constexpr (HasPenetrationLanes<Object>) {
    object.penetration(x, in);
  } else {
    for (std::uint32_t i = 0; i < count; ++i) {
      const Penetration<S> one = object.penetration(Vec3<S>(x.x[i], x.y[i], x.z[i]));
      in.depth[i] = one.depth;
      in.gradient_x[i] = one.gradient.x();
      in.gradient_y[i] = one.gradient.y();
      in.gradient_z[i] = one.gradient.z();
    }
  }
  for (std::uint32_t i = count; i < x.x.size(); ++i)
    in.depth[i] = in.gradient_x[i] = in.gradient_y[i] = in.gradient_z[i] = S(0);
  std::uint32_t touching = 0;
  for (const S depth : in.depth) touching += depth > S(0) ? 1u : 0u;
  return touching;
}

/// Calls visit(begin, x, in) for every leaf of the tool with a point inside the surface: eight points from `begin` on, depth
/// <= 0 for those that do not touch.
template <ContactSurface Object, Real S, class Visit>
inline void for_each_touching_leaf(const ToolPoints<S>& tool, const Pose<S>& X, const Object& object,
                                   const Visit& visit) noexcept {
  for_each_candidate_leaf(tool, X, object,
                          [&](std::uint32_t begin, std::uint32_t count, const PointLanes<S>& x) noexcept {
                            PenetrationLanes<S> in;
                            if (penetrate(object, x, count, in) > 0) visit(begin, x, in);
                          });
}

template <Real S>
[[nodiscard]] inline Vec3<S> mean(const PointLanes<S>& x) noexcept {
  Vec3<S> sum = Vec3<S>::Zero();
  for (std::size_t i = 0; i < x.x.size(); ++i) sum += Vec3<S>(x.x[i], x.y[i], x.z[i]);
  return sum / static_cast<S>(x.x.size());
}

/// Adds to `sum` the points of a leaf that begins at `begin`, each with its share of the law's force. A map's law is that at
/// the leaf's middle, a point of the tool.
template <class Sharing, Real S, ForceModel Force>
inline void add_leaf(const ToolPoints<S>& tool, const Force& force, std::uint32_t begin,
                     const PointLanes<S>& x, const PenetrationLanes<S>& in, LaneSum<S>& sum) noexcept {
  std::array<S, 8> f, area;
  for (std::size_t i = 0; i < f.size(); ++i) area[i] = tool.area((std::min)(begin + i, tool.size() - 1));
  if constexpr (ForceMap<Force>) {
    const Vec3<S> middle = mean(x);
    const auto law = force.at(middle);
    Vec3<S> configurational = Vec3<S>::Zero();
    for (std::size_t i = 0; i < f.size(); ++i) {
      const S weight = Sharing::weight(area[i], tool.contact_area());
      f[i] = weight * law.force(in.depth[i]);
      configurational += weight * law.configurational_force(in.depth[i]);
    }
    sum.add(middle, configurational);
  } else {
    for (std::size_t i = 0; i < f.size(); ++i)
      f[i] = in.depth[i] > S(0) ? Sharing::weight(area[i], tool.contact_area()) * force.force(in.depth[i])
                                : S(0);
  }
  sum.add(x, in, f, area);
}
}  // namespace detail

template <class Contacts, Real S>
class Collector;

template <Real S>
class Collector<SinglePoint, S> {
 public:
  Collector(const SinglePoint&, const PointTool<S>&) noexcept {}

  template <ContactSurface Object, ForceModel Force>
  Status collect(const Object& object, const PointTool<S>& tool, const Force& force, const Pose<S>& X,
                 std::array<RegionSum<S>, 1>& sums) noexcept {
    const Vec3<S> x = X * tool.tip;
    const Penetration<S> in = object.penetration(x);
    const bool touching = in.depth > S(0);
    slot_.update(touching);
    if (!touching) return Status::ok;
    const auto& law = detail::law_at(force, x);
    const Vec3<S> arm = X.rotation * (tool.tip - tool.centre_of_mass);
    sums[0].add(x, arm, in.gradient, in.depth, law.force(in.depth), S(0));
    if constexpr (ForceMap<Force>) sums[0].add(arm, law.configurational_force(in.depth));
    return Status::contact | detail::depth_status(object, force, in.depth);
  }
  [[nodiscard]] const RegionSlot& slot(std::size_t) const noexcept { return slot_.slot(); }
  [[nodiscard]] static constexpr bool changed() noexcept { return false; }
  void reset() noexcept { slot_.reset(); }

 private:
  SingleSlot slot_;
};

template <MassSharing Sharing, Real S>
class Collector<SingleRegion<Sharing>, S> {
 public:
  Collector(const SingleRegion<Sharing>&, const ToolPoints<S>&) noexcept {}

  template <ContactSurface Object, ForceModel Force>
  Status collect(const Object& object, const ToolPoints<S>& tool, const Force& force, const Pose<S>& X,
                 std::array<RegionSum<S>, 1>& sums) noexcept {
    LaneSum<S> lanes(X * tool.centre_of_mass());
    bool touching = false;
    detail::for_each_touching_leaf(
        tool, X, object,
        [&](std::uint32_t begin, const PointLanes<S>& x, const PenetrationLanes<S>& in) noexcept {
          detail::add_leaf<Sharing>(tool, force, begin, x, in, lanes);
          touching = true;
        });
    slot_.update(touching);
    if (!touching) return Status::ok;
    RegionSum<S>& sum = sums[0];
    sum = lanes.total();
    sum.scale(Sharing::norm(static_cast<S>(sum.points)));
    return Status::contact | detail::depth_status(object, force, sum.deepest);
  }
  [[nodiscard]] const RegionSlot& slot(std::size_t) const noexcept { return slot_.slot(); }
  [[nodiscard]] static constexpr bool changed() noexcept { return false; }
  void reset() noexcept { slot_.reset(); }

 private:
  SingleSlot slot_;
};

template <std::size_t N, MassSharing Sharing, Real S>
class Collector<Regions<N, Sharing>, S> {
 public:
  Collector(const Regions<N, Sharing>& regions, const ToolPoints<S>& tool)
      : tracker_(ProximityGraph<S>(tool, static_cast<S>(regions.distance)), tool.size()),
        leaf_((tool.size() + lanes - 1) / lanes),
        point_(tool.size()),
        place_(tool.size()) {}

  template <ContactSurface Object, ForceModel Force>
  Status collect(const Object& object, const ToolPoints<S>& tool, const Force& force, const Pose<S>& X,
                 std::array<RegionSum<S>, N>& sums) noexcept {
    std::size_t leaves = 0, count = 0;
    S deepest = S(0);
    detail::for_each_touching_leaf(
        tool, X, object,
        [&](std::uint32_t begin, const PointLanes<S>& x, const PenetrationLanes<S>& in) noexcept {
          leaf_[leaves++] = {begin, 0, x, in};
          for (std::uint32_t i = 0; i < lanes; ++i) {
            if (!(in.depth[i] > S(0))) continue;
            point_[count] = begin + i;
            place_[count++] = Vec3<S>(x.x[i], x.y[i], x.z[i]);
            deepest = (std::max)(deepest, in.depth[i]);
          }
        });
    Status status = tracker_.update({point_.data(), count}, [&](std::size_t i) { return place_[i]; });
    if (count == 0) return Status::ok;
    std::uint64_t met = 0;  // slots, as bits
    std::size_t next = 0;   // touching point
    for (std::size_t k = 0; k < leaves; ++k) {
      Leaf& leaf = leaf_[k];
      for (; next < count && point_[next] < leaf.begin + lanes; ++next)
        leaf.slots |= std::uint64_t(1) << tracker_.slot_of()[next];
      met |= leaf.slots;
    }
    const Vec3<S> centre_of_mass = X * tool.centre_of_mass();
    for (std::size_t slot = 0; slot < N; ++slot) {
      const std::uint64_t bit = std::uint64_t(1) << slot;
      if ((met & bit) == 0) continue;
      LaneSum<S> sum(centre_of_mass);
      next = 0;
      for (std::size_t k = 0; k < leaves; ++k) {
        const Leaf& leaf = leaf_[k];
        if (leaf.slots == bit) detail::add_leaf<Sharing>(tool, force, leaf.begin, leaf.x, leaf.in, sum);
        if (leaf.slots == bit || (leaf.slots & bit) == 0) continue;
        PenetrationLanes<S> own = leaf.in;
        for (std::uint32_t i = 0; i < lanes; ++i) {
          while (next < count && point_[next] < leaf.begin + i) ++next;
          if (next == count || point_[next] != leaf.begin + i || tracker_.slot_of()[next] != slot)
            own.depth[i] = S(0);
        }
        detail::add_leaf<Sharing>(tool, force, leaf.begin, leaf.x, own, sum);
      }
      sums[slot] = sum.total();
      sums[slot].scale(Sharing::norm(static_cast<S>(sums[slot].points)));
    }
    return status | Status::contact | detail::depth_status(object, force, deepest);
  }
  [[nodiscard]] const RegionSlot& slot(std::size_t k) const noexcept { return tracker_.slots()[k]; }
  [[nodiscard]] bool changed() const noexcept { return tracker_.changed(); }
  void reset() noexcept { tracker_.reset(); }

 private:
  static constexpr std::uint32_t lanes = PointLanes<S>::size;
  struct Leaf {
    std::uint32_t begin;
    std::uint64_t slots;  // of its touching points, as bits
    PointLanes<S> x;
    PenetrationLanes<S> in;
  };

  RegionTracker<S, N> tracker_;
  std::vector<Leaf> leaf_;            // of this tick, those with touching points
  std::vector<std::uint32_t> point_;  // touching tool points of this tick, in order
  std::vector<Vec3<S>> place_;        // where they are
};

}  // namespace palpate
