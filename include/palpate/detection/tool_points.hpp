// SPDX-License-Identifier: MIT
#pragma once

/// @file  The tool as the force sees it: points with areas, in a tree of bounding spheres; or one point.

#include <palpate/core/pose.hpp>
#include <palpate/detection/detail/position_order.hpp>
#include <palpate/detection/resample.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

namespace palpate {

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
  ToolPoints(const SurfaceSamples<S>& samples, const Params& params)
      : ToolPoints(samples.points, samples.areas, params) {
    constexpr const char* where = "ToolPoints";
    if (samples.vector_areas.empty()) return;
    if (samples.vector_areas.size() != size())
      fail(where, "needs one vector area for each point, points minus vector areas must be 0",
           static_cast<double>(size()) - static_cast<double>(samples.vector_areas.size()));
    for (const std::uint32_t i : original_) {
      const Vec3<S>& a = samples.vector_areas[i];
      for (int k = 0; k < 3; ++k) {
        if (!is_finite(a[k]))
          fail_at(where, "vector area [m^2] must be finite", "point", i, static_cast<double>(a[k]));
      }
      vector_areas_.push_back(a);
    }
  }

  /// Points and areas as given, n x 3 and n: without vector areas.
  ToolPoints(const std::vector<Vec3<S>>& points, const std::vector<S>& areas, const Params& params)
      : contact_area_(params.contact_area), centre_of_mass_(params.centre_of_mass) {
    constexpr const char* where = "ToolPoints";
    require_positive(contact_area_, where, "contact_area [m^2] must be > 0");
    for (int i = 0; i < 3; ++i)
      require_finite(centre_of_mass_[i], where, "centre_of_mass [m] must be finite");
    if (points.empty()) fail(where, "needs at least one point");
    if (points.size() > max_tool_points)
      fail(where, "takes at most 10 million points", static_cast<double>(points.size()));
    if (areas.size() != points.size())
      fail(where, "needs one area for each point, points minus areas must be 0",
           static_cast<double>(points.size()) - static_cast<double>(areas.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        if (!is_finite(points[i][k]) || !(std::abs(points[i][k]) <= S(1e6L)))
          fail_at(where, "coordinates [m] must be finite and below 1e6", "point", i,
                  static_cast<double>(points[i][k]));
      }
      if (!is_finite(areas[i]) || !(areas[i] > S(0)))
        fail_at(where, "area [m^2] must be > 0", "point", i, static_cast<double>(areas[i]));
    }
    original_.resize(points.size());
    std::iota(original_.begin(), original_.end(), 0u);
    build(points, detail::PositionOrder<S>(points, areas), 0, static_cast<std::uint32_t>(points.size()));
    points_.reserve(points.size());
    areas_.reserve(points.size());
    for (const std::uint32_t i : original_) {
      points_.push_back(points[i]);
      areas_.push_back(areas[i]);
    }
    // Leaves are full but for the last, so leaf k begins at point k leaf_size.
    batches_.resize((points_.size() + leaf_size - 1) / leaf_size);
    for (std::size_t i = 0; i < batches_.size() * leaf_size; ++i) {
      const Vec3<S>& p = points_[(std::min)(i, points_.size() - 1)];
      PointBatch<S>& leaf = batches_[i / leaf_size];
      leaf.x[i % leaf_size] = p.x();
      leaf.y[i % leaf_size] = p.y();
      leaf.z[i % leaf_size] = p.z();
    }
  }

  /// The mesh's vertices and vertex areas.
  ToolPoints(const TriangleMesh<S>& mesh, const Params& params)
      : ToolPoints(SurfaceSamples<S>{mesh.vertices(), mesh.vertex_areas(), mesh.vertex_vector_areas()},
                   params) {}

  /// Even points on the mesh about `spacing` [m] apart.
  ToolPoints(const TriangleMesh<S>& mesh, const Params& params, S spacing)
      : ToolPoints(resample(mesh, spacing), params) {}

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
             std::uint32_t end) {
    const std::size_t index = nodes_.size();
    Vec3<S> low = points[original_[begin]], high = low;
    for (std::uint32_t i = begin; i < end; ++i) {
      low = low.cwiseMin(points[original_[i]]);
      high = high.cwiseMax(points[original_[i]]);
    }
    const Vec3<S> centre = low + (high - low) / S(2);
    S radius = S(0);
    for (std::uint32_t i = begin; i < end; ++i)
      radius = (std::max)(radius, (points[original_[i]] - centre).norm());
    nodes_.push_back({centre, radius * (S(1) + S(8) * std::numeric_limits<S>::epsilon()), begin, end, 0});
    if (end - begin > leaf_size) {
      const std::size_t axis = order.longest_axis(std::span(original_).subspan(begin, end - begin));
      // Whole leaves to the left, so that leaves are full.
      const std::uint32_t middle = begin + ((end - begin + 2 * leaf_size - 1) / (2 * leaf_size)) * leaf_size;
      std::nth_element(original_.begin() + begin, original_.begin() + middle, original_.begin() + end,
                       [&](std::uint32_t l, std::uint32_t r) { return order.less(l, r, axis); });
      build(points, order, begin, middle);
      build(points, order, middle, end);
    } else {
      std::sort(original_.begin() + begin, original_.begin() + end,
                [&](std::uint32_t l, std::uint32_t r) { return order.less(l, r, 0); });
    }
    nodes_[index].skip = static_cast<std::uint32_t>(nodes_.size());
  }

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
