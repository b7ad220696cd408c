// SPDX-License-Identifier: MIT
#pragma once

/// @file  The tool as the force sees it: points with areas, in a tree of bounding spheres; or one point.

#include <palpate/core/pose.hpp>
#include <palpate/detection/resample.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate {

namespace detail {
template <Real S>
class PositionOrder;
}

/// Tool that touches with its tip only. Tool coordinates.
template <Real S>
struct PointTool {
  Vec3<S> tip = Vec3<S>::Zero();             ///< [m]
  Vec3<S> centre_of_mass = Vec3<S>::Zero();  ///< [m]
};

/// Points of a rigid tool, each with the area that it stands for, IV.C of [luo2005].
///
/// | symbol | name                | unit | range                                             |
/// |--------|---------------------|------|---------------------------------------------------|
/// | x_i    | `point(i)`          | m    | finite, below 1e6; 1 to 10 million points         |
/// | A_i    | `area(i)`           | m^2  | > 0                                               |
/// | a_i    | `vector_areas()[i]` | m^2  | finite, outward; empty where they are not known   |
/// | A_0    | `contact_area`      | m^2  | > 0; the law's stiffness is that of this area     |
/// |        | `centre_of_mass`    | m    | finite; torques are about it                      |
///
/// A_0 belongs to the tool (a mallet's face, a pin's tip), not to the tick: a point carries A_i / A_0 of the
/// force law. a_i is the outward area vector, the sum of a third of the adjacent triangles': of length A_i on
/// a flat face, shorter over an edge. It is known where the tool is a mesh; `SurfacePressure` needs it
/// (contact/mass_sharing.hpp).
///
/// Points are sorted by position: `original(i)` is the number that point i had when it was given. In what
/// order they were given changes nothing, unless two stand at the same position; nor does the unit of
/// length (detail/position_order.hpp). The tree's nodes are in pre-order, a node's points are contiguous,
/// leaves have at most `batch_size`; a walk needs no stack (candidates.hpp). Constructors report what is
/// out of range; `spacing` as resample().
template <Real S>
class ToolPoints {
 public:
  using Scalar = S;

  struct Params {
    S contact_area{};                          ///< A_0 [m^2]
    Vec3<S> centre_of_mass = Vec3<S>::Zero();  ///< tool coordinates [m]
  };

  /// Ball that holds points [begin, end). After a node comes its first child; `skip` is the next node outside
  /// it.
  struct Node {
    Vec3<S> centre;
    S radius;
    std::uint32_t begin, end, skip;
  };

  /// Points, areas and, unless empty, vector areas as given: n x 3, n, n x 3.
  ToolPoints(const SurfaceSamples<S>& samples, const Params& params);
  /// Points and areas as given, n x 3 and n: without vector areas.
  ToolPoints(const std::vector<Vec3<S>>& points, const std::vector<S>& areas, const Params& params);
  /// The mesh's vertices and vertex areas.
  ToolPoints(const TriangleMesh<S>& mesh, const Params& params);
  /// Even points on the mesh about `spacing` [m] apart.
  ToolPoints(const TriangleMesh<S>& mesh, const Params& params, S spacing);

  [[nodiscard]] std::size_t size() const noexcept { return points_.size(); }
  [[nodiscard]] const Vec3<S>& point(std::size_t i) const noexcept { return points_[i]; }
  [[nodiscard]] S area(std::size_t i) const noexcept { return areas_[i]; }
  [[nodiscard]] std::uint32_t original(std::size_t i) const noexcept { return original_[i]; }
  [[nodiscard]] std::span<const Vec3<S>> points() const noexcept { return points_; }
  [[nodiscard]] std::span<const S> areas() const noexcept { return areas_; }
  /// a_i [m^2]; empty where they are not known.
  [[nodiscard]] std::span<const Vec3<S>> vector_areas() const noexcept { return vector_areas_; }
  [[nodiscard]] S contact_area() const noexcept { return contact_area_; }
  [[nodiscard]] Vec3<S> centre_of_mass() const noexcept { return centre_of_mass_; }
  /// The `batch_size` points from `begin` on, where a leaf begins; the last leaf is filled up with its last
  /// point.
  [[nodiscard]] const PointBatch<S>& batch(std::size_t begin) const noexcept {
    return batches_[begin / leaf_size];
  }
  /// The tree; the first node's ball holds all points.
  [[nodiscard]] std::span<const Node> nodes() const noexcept { return nodes_; }

 private:
  static constexpr std::uint32_t leaf_size = static_cast<std::uint32_t>(batch_size);

  void build(const std::vector<Vec3<S>>& points, const detail::PositionOrder<S>& order, std::uint32_t begin,
             std::uint32_t end);

  std::vector<Vec3<S>> points_;
  std::vector<PointBatch<S>> batches_;  // the same points, leaf by leaf
  std::vector<S> areas_;
  std::vector<Vec3<S>> vector_areas_;  // or none
  std::vector<std::uint32_t> original_;
  std::vector<Node> nodes_;
  S contact_area_;
  Vec3<S> centre_of_mass_;
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/detection/setup/tool_points_impl.hpp>
#endif
