// SPDX-License-Identifier: MIT
#pragma once

/// @file  What the points of a leaf weigh under each sharing, and their force under each kind of law.

#include <palpate/contact/mass_sharing.hpp>
#include <palpate/contact/pressure_sum.hpp>
#include <palpate/contact/region_sum.hpp>
#include <palpate/core/error.hpp>
#include <palpate/detection/candidates.hpp>
#include <palpate/detection/tool_points.hpp>
#include <palpate/law/map/concept.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace palpate::detail {

template <Real S>
[[nodiscard]] inline Vec3<S> mean(const PointBatch<S>& x) noexcept {
  Vec3<S> sum = Vec3<S>::Zero();
  for (std::size_t i = 0; i < x.x.size(); ++i) sum += Vec3<S>(x.x[i], x.y[i], x.z[i]);
  return sum / static_cast<S>(x.x.size());
}

/// What is left of the forces of a leaf's points where nothing takes any of them off (relief.hpp): all.
struct AllLeft {};
/// Multiplies a leaf's forces by what is left of them.
template <Real S>
inline void leave(std::array<S, batch_size>& list, const std::array<S, batch_size>& left) noexcept {
  for (std::size_t i = 0; i < batch_size; ++i) list[i] *= left[i];
}
template <Real S>
inline void leave(std::array<S, batch_size>&, AllLeft) noexcept {}

/// What a leaf's points weigh: m_i/m up to the sharing's norm [-], and 1/A_i [1/m^2].
template <Real S>
struct alignas(64) LeafShare {
  std::array<S, batch_size> weight, per_area;
};

/// The points of a tool, leaf by leaf, as a region of this sharing adds them up.
template <MassSharing Sharing, Real S>
class Leaves {
 public:
  using Sum = LeafSum<S>;

  explicit Leaves(const ToolPoints<S>& tool) : shares_((tool.size() + batch_size - 1) / batch_size) {
    for (std::size_t i = 0; i < batch_size * shares_.size(); ++i) {
      const S area = tool.area((std::min)(i, tool.size() - 1));
      shares_[i / batch_size].weight[i % batch_size] = Sharing::weight(area, tool.contact_area());
      shares_[i / batch_size].per_area[i % batch_size] = S(1) / area;
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return shares_.size(); }

  /// An empty sum, the tool at X.
  [[nodiscard]] static Sum begin(const ToolPoints<S>& tool, const Pose<S>& X) noexcept {
    return Sum(X * tool.centre_of_mass());
  }

  /// The leaf's points, object coordinates.
  [[nodiscard]] static PointBatch<S> placed(const ToolPoints<S>& tool, std::uint32_t begin,
                                            const Pose<S>& X) noexcept {
    return transformed(X, tool.batch(begin));
  }

  /// Adds to `sum` the points of the leaf at `begin`, each with what is left of its share of the law's force;
  /// x: object coordinates. A map's law is that at the leaf's middle, a point of the tool.
  template <ForceModel Force, class Left = AllLeft>
  void add(const ToolPoints<S>&, std::uint32_t begin, const Force& force, const PointBatch<S>& x,
           const PenetrationBatch<S>& in, Sum& sum, const Left& left = {}) const noexcept {
    const LeafShare<S>& share = shares_[begin / batch_size];
    std::array<S, batch_size> f;
    using V = batch_group<S>;
    if constexpr (HasForces<Force, V>) {
      for (std::size_t i = 0; i < batch_size; i += V::size()) {
        const V depth = (min)((max)(V(&in.depth[i]), S(0)), force.max_depth());
        (V(&share.weight[i]) * force.forces(depth)).copy_to(&f[i]);
      }
    } else if constexpr (ForceMap<Force>) {
      const Vec3<S> middle = mean(x);
      const auto law = force.at(middle);
      Vec3<S> configurational = Vec3<S>::Zero();
      std::array<S, batch_size> weight = share.weight;
      leave(weight, left);
      for (std::size_t i = 0; i < batch_size; ++i) {
        f[i] = share.weight[i] * law.force(in.depth[i]);
        configurational += weight[i] * law.configurational_force(in.depth[i]);
      }
      sum.add(middle, configurational);
    } else {
      for (std::size_t i = 0; i < batch_size; ++i)
        f[i] = in.depth[i] > S(0) ? share.weight[i] * force.force(in.depth[i]) : S(0);
    }
    leave(f, left);
    sum.add(x, in, f, share.per_area);
  }

  /// Energy [J] and |force| [N] of each point of the leaf alone, 0 outside.
  template <ForceModel Force>
  void alone(const ToolPoints<S>& tool, std::uint32_t begin, const Force& force, const Pose<S>& X,
             const PenetrationBatch<S>& in, std::array<S, batch_size>& energy,
             std::array<S, batch_size>& f) const noexcept {
    const auto& law = law_at(force, Vec3<S>(X * mean(tool.batch(begin))));
    const LeafShare<S>& share = shares_[begin / batch_size];
    for (std::size_t i = 0; i < batch_size; ++i) {
      energy[i] = in.depth[i] > S(0) ? share.weight[i] * law.energy(in.depth[i]) : S(0);
      f[i] = in.depth[i] > S(0) ? share.weight[i] * law.force(in.depth[i]) : S(0);
    }
  }

 private:
  std::vector<LeafShare<S>> shares_;
};

template <Real S>
class Leaves<SurfacePressure, S> {
 public:
  using Sum = PressureSum<S>;

  /// @throws SetupError where the tool's vector areas are not known.
  explicit Leaves(const ToolPoints<S>& tool)
      : shares_((tool.size() + batch_size - 1) / batch_size), per_contact_area_(S(1) / tool.contact_area()) {
    if (tool.vector_areas().empty())
      fail("SurfacePressure",
           "needs the tool's vector areas: make ToolPoints of a mesh or of SurfaceSamples that have them, or "
           "say AreaSharing, as in SingleRegion<AreaSharing>");
    for (std::size_t i = 0; i < batch_size * shares_.size(); ++i) {
      const std::size_t k = (std::min)(i, tool.size() - 1), lane = i % batch_size;
      const Vec3<S>& a = tool.vector_areas()[k];
      const Vec3<S> m = (tool.point(k) - tool.centre_of_mass()).cross(a);
      PressureShare<S>& share = shares_[i / batch_size];
      share.x[lane] = a.x(), share.y[lane] = a.y(), share.z[lane] = a.z();
      share.mx[lane] = m.x(), share.my[lane] = m.y(), share.mz[lane] = m.z();
      const S length = a.norm();
      share.per_area[lane] = length > (std::numeric_limits<S>::min)() ? S(1) / length : S(0);
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return shares_.size(); }

  [[nodiscard]] static Sum begin(const ToolPoints<S>& tool, const Pose<S>& X) noexcept {
    return Sum(X, tool.centre_of_mass());
  }

  /// The leaf's points as they are: the sum is in tool coordinates.
  [[nodiscard]] static const PointBatch<S>& placed(const ToolPoints<S>& tool, std::uint32_t begin,
                                                   const Pose<S>&) noexcept {
    return tool.batch(begin);
  }

  /// As of the other sharings. The pressure of a map needs no force of its own: its integral over the part of
  /// the tool that is inside is a potential whatever the pressure depends on. The term of backs does.
  template <ForceModel Force, class Left = AllLeft>
  void add(const ToolPoints<S>& tool, std::uint32_t begin, const Force& force, const PointBatch<S>&,
           const PenetrationBatch<S>& in, Sum& sum, const Left& left = {}) const noexcept {
    const PressureShare<S>& share = shares_[begin / batch_size];
    const PointBatch<S>& x = tool.batch(begin);
    const Vec3<S> middle = ForceMap<Force> ? Vec3<S>(sum.pose() * mean(x)) : Vec3<S>::Zero();
    const auto& law = law_at(force, middle);
    std::array<S, batch_size> p;
    using V = batch_group<S>;
    if constexpr (HasForces<Force, V>) {
      for (std::size_t i = 0; i < batch_size; i += V::size()) {
        const V depth = (min)((max)(V(&in.depth[i]), S(0)), force.max_depth());
        (per_contact_area_ * force.forces(depth)).copy_to(&p[i]);
      }
    } else {
      for (std::size_t i = 0; i < batch_size; ++i)
        p[i] = in.depth[i] > S(0) ? per_contact_area_ * law.force(in.depth[i]) : S(0);
    }
    leave(p, left);
    if (sum.add(x, in, share, p)) add_backs(law, middle, x, in, share, p, left, sum);
  }

  /// As of the other sharings: by the area projected on the push, less where a face looks out of the body.
  /// The sum over a closed surface is the energy of its inside, on a flat body exactly.
  template <ForceModel Force>
  void alone(const ToolPoints<S>& tool, std::uint32_t begin, const Force& force, const Pose<S>& X,
             const PenetrationBatch<S>& in, std::array<S, batch_size>& energy,
             std::array<S, batch_size>& f) const noexcept {
    const auto& law = law_at(force, Vec3<S>(X * mean(tool.batch(begin))));
    const PressureShare<S>& share = shares_[begin / batch_size];
    for (std::size_t i = 0; i < batch_size; ++i) {
      energy[i] = f[i] = S(0);
      if (!(in.depth[i] > S(0))) continue;
      const Vec3<S> a = X.rotation * Vec3<S>(share.x[i], share.y[i], share.z[i]);
      const S w = a.dot(Vec3<S>(in.gradient_x[i], in.gradient_y[i], in.gradient_z[i]));
      const S t = (std::max)(w * share.per_area[i], S(0));
      energy[i] = per_contact_area_ * law.energy(in.depth[i]) * (w * t * (S(2) - t) - w);
      f[i] = per_contact_area_ * law.force(in.depth[i]) * (std::max)(-w, S(0));
    }
  }

 private:
  template <class Law, class Left>
  void add_backs(const Law& law, const Vec3<S>& middle, const PointBatch<S>& x, const PenetrationBatch<S>& in,
                 const PressureShare<S>& share, const std::array<S, batch_size>& p, const Left& left,
                 Sum& sum) const noexcept {
    std::array<S, batch_size> energy;
    for (std::size_t i = 0; i < batch_size; ++i)
      energy[i] = p[i] > S(0) ? per_contact_area_ * law.energy(in.depth[i]) : S(0);
    leave(energy, left);
    std::array<S, batch_size> backs = sum.add_backs(x, in, share, p, energy);
    if constexpr (requires { law.configurational_force(S(0)); }) {
      leave(backs, left);
      Vec3<S> configurational = Vec3<S>::Zero();
      for (std::size_t i = 0; i < batch_size; ++i) {
        if (backs[i] > S(0))
          configurational += per_contact_area_ * backs[i] * law.configurational_force(in.depth[i]);
      }
      sum.add(middle, configurational);
    }
  }

  std::vector<PressureShare<S>> shares_;
  S per_contact_area_;  // 1/A_0 [1/m^2]
};

}  // namespace palpate::detail
