// SPDX-License-Identifier: MIT
#pragma once

/// @file  The paper's deformed shape on a display mesh, for the benchmarks.

#include "scenes.hpp"

#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/luo_xiao/beam_skeleton.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>

#include <bit>
#include <span>

namespace bench {

using Beams = RegionSkeletons<Skeleton<double>>;
inline const Vec3<double> bottom(0, -0.04, 0);

inline Beams beams() {
  std::vector<Vec3<double>> ends;
  for (const auto& point : extremal_points(ellipsoid<float>())) ends.push_back(point.position.cast<double>());
  return Beams(Skeleton<double>(ends,
                                EulerBernoulli<double>(IsotropicElasticity<double>({.E = 2e4, .nu = 0.5})),
                                VolumePreserving<double>({.volume = ellipsoid<double>().volume()})));
}

/// Force in double, display in float. The buffers are the caller's side: packed positions, and packed normals
/// if asked for.
template <Interpolation I = PhongInterpolation<float>>
class Shape {
 public:
  using Model = BeamSkeletonDeformation<Beams, I>;

  Shape(const MeshData<float>& mesh, bool normals)
      : model_(beams(), I(make_partition(ellipsoid<float>(), mesh)), AreaNeighbourhood<float>({}), mesh,
               {.fixed = bottom, .normals = normals}),
        positions_(3 * mesh.vertices.size()),
        normals_(normals ? positions_.size() : 0) {
    model_.write_rest(buffer());
  }

  Moved<double> write(std::span<const ContactState<double>> contacts) noexcept {
    return model_.write(contacts, buffer());
  }
  [[nodiscard]] const Model& model() const noexcept { return model_; }
  [[nodiscard]] const std::vector<float>& positions() const noexcept { return positions_; }
  [[nodiscard]] const std::vector<float>& normals() const noexcept { return normals_; }

 private:
  [[nodiscard]] VertexBuffer<float> buffer() noexcept {
    return {.positions = positions_.data(), .normals = normals_.empty() ? nullptr : normals_.data()};
  }

  Model model_;
  std::vector<float> positions_, normals_;
};

/// FNV-1a over the bits of what was computed.
class Hash {
 public:
  void add(double x) noexcept { add_word(std::bit_cast<std::uint64_t>(x)); }
  void add(std::span<const float> values) noexcept {
    for (const float x : values) add_word(std::bit_cast<std::uint32_t>(x));
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  void add_word(std::uint64_t word) noexcept { value_ = (value_ ^ word) * 1099511628211u; }
  std::uint64_t value_ = 14695981039346656037u;
};

/// The tool of the whole-loop scenes: up to 4 regions, the paper's law with friction.
template <class Object>
using Touch = ContactSolver<Object, DuffingForce<double>, PowerLawFriction<double>, Regions<4, AreaSharing>>;
template <class Object>
Touch<Object> make_touch(const Object& object, int points) {
  return Touch<Object>({object, face<double>(points, 1), duffing<double>(), fibre<double>(), {joining}});
}

}  // namespace bench
