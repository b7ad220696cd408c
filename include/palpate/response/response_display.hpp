// SPDX-License-Identifier: MIT
#pragma once

/// @file  Vertices of any mesh bound to a response field: the shape that is drawn.

#include <palpate/response/response_field.hpp>

namespace palpate {

/// Display vertices sorted by the solve mesh's triangles, each with its weights. It belongs to no tick and
/// serves any number of them. Reports points that are not finite.
///
/// Memory: 24 bytes per vertex and 28 per triangle of the solve mesh. Set-up: about a microsecond per vertex.
class ResponseDisplay {
 public:
  struct Span {
    std::uint32_t triangle, begin, end;
  };
  /// Around each span's vertices: by span, whole lanes.
  struct Spheres {
    std::vector<float> x, y, z, radius;
  };

  template <Real S>
  ResponseDisplay(const ResponseField& field, const std::vector<Vec3<S>>& points) {
    const SolveMesh& mesh = field.mesh();
    const TriangleBvh<double> tree(MeshData<double>{mesh.vertices, mesh.triangles});
    std::vector<TriangleBvh<double>::Nearest> at(points.size());
    std::uint32_t start = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!is_finite(points[i])) fail_at("ResponseDisplay", "points must be finite", "point", i);
      at[i] = tree.closest(points[i].template cast<double>(), start);
      start = at[i].triangle;
    }
    std::vector<std::uint32_t> order(points.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](auto l, auto r) { return at[l].triangle < at[r].triangle; });
    Vec3<float> centre = Vec3<float>::Zero();
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto& bound = at[order[i]];
      if (spans_.empty() || spans_.back().triangle != bound.triangle) {
        const auto& t = mesh.triangles[bound.triangle];
        const Vec3<double> c = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
        const auto n = static_cast<std::uint32_t>(vertex_.size());
        spans_.push_back({bound.triangle, n, n});
        centre = c.cast<float>();
        around_.x.push_back(centre.x());
        around_.y.push_back(centre.y());
        around_.z.push_back(centre.z());
        around_.radius.push_back(0);
      }
      const Vec3<float> p = points[order[i]].template cast<float>();
      around_.radius.back() = (std::max)(around_.radius.back(), (p - centre).norm());
      const bool last = i + 1 == order.size() || at[order[i + 1]].triangle != bound.triangle;
      do {  // the last one again until the lane is whole
        x_.push_back(p.x());
        y_.push_back(p.y());
        z_.push_back(p.z());
        b1_.push_back(static_cast<float>(bound.weight[1]));
        b2_.push_back(static_cast<float>(bound.weight[2]));
        vertex_.push_back(order[i]);
      } while (last && vertex_.size() % detail::lane_size != 0);
      spans_.back().end = static_cast<std::uint32_t>(vertex_.size());
    }
    for (auto* list : {&around_.x, &around_.y, &around_.z, &around_.radius})
      list->resize(detail::whole<detail::Lane>(spans_.size()));
    size_ = points.size();
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const std::vector<Span>& spans() const noexcept { return spans_; }
  [[nodiscard]] const Spheres& around() const noexcept { return around_; }
  /// Slots: the sorted order, each span filled up to whole lanes by repeating its last vertex.
  [[nodiscard]] std::size_t slots() const noexcept { return vertex_.size(); }
  /// By slot: rest position [m], weights of corners 1 and 2.
  [[nodiscard]] const float* x() const noexcept { return x_.data(); }
  [[nodiscard]] const float* y() const noexcept { return y_.data(); }
  [[nodiscard]] const float* z() const noexcept { return z_.data(); }
  [[nodiscard]] const float* b1() const noexcept { return b1_.data(); }
  [[nodiscard]] const float* b2() const noexcept { return b2_.data(); }
  /// The caller's number of each slot's vertex.
  [[nodiscard]] const std::uint32_t* vertex() const noexcept { return vertex_.data(); }

 private:
  std::size_t size_ = 0;
  std::vector<Span> spans_;
  Spheres around_;
  std::vector<float> x_, y_, z_, b1_, b2_;
  std::vector<std::uint32_t> vertex_;
};

}  // namespace palpate
