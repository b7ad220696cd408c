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
#include <palpate/force/concept.hpp>
#include <palpate/region/region_tracker.hpp>
#include <palpate/region/slot.hpp>
#include <palpate/region/topology.hpp>
#include <palpate/surface/concept.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace palpate {

namespace detail {
/// Status bits of a point at `depth` [m].
template <ContactSurface Object, ForceLaw Force>
[[nodiscard]] inline Status depth_status(const Object& object, const Force& force,
                                         typename Object::Scalar depth) noexcept {
  Status status = Status::ok;
  if (depth > object.reach()) status |= Status::beyond_reach;
  if (depth > force.max_depth()) status |= Status::beyond_stable;
  return status;
}

/// Penetration of the first `count` of eight points; at once where the surface can.
template <ContactSurface Object, Real S>
inline void penetrate(const Object& object, const PointLanes<S>& x, [[maybe_unused]] std::uint32_t count,
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
}

/// Calls visit(point, x, penetration) for every point of the tool that is inside the surface, in order of the points.
template <ContactSurface Object, Real S, class Visit>
inline void for_each_touching(const ToolPoints<S>& tool, const Pose<S>& X, const Object& object,
                              const Visit& visit) noexcept {
  for_each_candidate_leaf(
      tool, X, object, [&](std::uint32_t begin, std::uint32_t count, const PointLanes<S>& x) noexcept {
        PenetrationLanes<S> in;
        penetrate(object, x, count, in);
        for (std::uint32_t i = 0; i < count; ++i) {
          if (!(in.depth[i] > S(0))) continue;
          visit(begin + i, Vec3<S>(x.x[i], x.y[i], x.z[i]),
                Penetration<S>{in.depth[i], Vec3<S>(in.gradient_x[i], in.gradient_y[i], in.gradient_z[i])});
        }
      });
}
}  // namespace detail

template <class Contacts, Real S>
class Collector;

template <Real S>
class Collector<SinglePoint, S> {
 public:
  Collector(const SinglePoint&, const PointTool<S>&) noexcept {}

  template <ContactSurface Object, ForceLaw Force>
  Status collect(const Object& object, const PointTool<S>& tool, const Force& force, const Pose<S>& X,
                 std::array<RegionSum<S>, 1>& sums) noexcept {
    const Vec3<S> x = X * tool.tip;
    const Penetration<S> in = object.penetration(x);
    const bool touching = in.depth > S(0);
    slot_.update(touching);
    if (!touching) return Status::ok;
    sums[0].add(x, X.rotation * (tool.tip - tool.centre_of_mass), in.gradient, in.depth, force.force(in.depth), S(0));
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

  template <ContactSurface Object, ForceLaw Force>
  Status collect(const Object& object, const ToolPoints<S>& tool, const Force& force, const Pose<S>& X,
                 std::array<RegionSum<S>, 1>& sums) noexcept {
    RegionSum<S>& sum = sums[0];
    const Vec3<S> centre_of_mass = X * tool.centre_of_mass();
    detail::for_each_touching(tool, X, object, [&](std::uint32_t point, const Vec3<S>& x, const Penetration<S>& in) noexcept {
      const S area = tool.area(point);
      const S f = Sharing::weight(area, tool.contact_area()) * force.force(in.depth);
      sum.add(x, x - centre_of_mass, in.gradient, in.depth, f, area);
    });
    const bool touching = sum.points > 0;
    slot_.update(touching);
    if (!touching) return Status::ok;
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
        point_(tool.size()),
        touch_(tool.size()) {}

  template <ContactSurface Object, ForceLaw Force>
  Status collect(const Object& object, const ToolPoints<S>& tool, const Force& force, const Pose<S>& X,
                 std::array<RegionSum<S>, N>& sums) noexcept {
    std::size_t count = 0;
    S deepest = S(0);
    detail::for_each_touching(tool, X, object, [&](std::uint32_t point, const Vec3<S>& x, const Penetration<S>& in) noexcept {
      point_[count] = point;
      touch_[count++] = {x, in};
      deepest = (std::max)(deepest, in.depth);
    });
    Status status = tracker_.update({point_.data(), count}, [&](std::size_t i) { return touch_[i].x; });
    if (count == 0) return Status::ok;
    const Vec3<S> centre_of_mass = X * tool.centre_of_mass();
    const auto slot_of = tracker_.slot_of();
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [x, in] = touch_[i];
      const S area = tool.area(point_[i]);
      const S f = Sharing::weight(area, tool.contact_area()) * force.force(in.depth);
      sums[slot_of[i]].add(x, x - centre_of_mass, in.gradient, in.depth, f, area);
    }
    for (RegionSum<S>& sum : sums) {
      if (sum.points > 0) sum.scale(Sharing::norm(static_cast<S>(sum.points)));
    }
    return status | Status::contact | detail::depth_status(object, force, deepest);
  }
  [[nodiscard]] const RegionSlot& slot(std::size_t k) const noexcept { return tracker_.slots()[k]; }
  [[nodiscard]] bool changed() const noexcept { return tracker_.changed(); }
  void reset() noexcept { tracker_.reset(); }

 private:
  struct Touch {
    Vec3<S> x;
    Penetration<S> in;
  };

  RegionTracker<S, N> tracker_;
  std::vector<std::uint32_t> point_;  // touching tool points of this tick
  std::vector<Touch> touch_;
};

}  // namespace palpate
