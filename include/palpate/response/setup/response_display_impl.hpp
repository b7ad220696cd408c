// SPDX-License-Identifier: MIT
#pragma once

/// @file Set-up of response_display.hpp: vertices sorted by the element they lie on. Set-up only.

#include <palpate/core/error.hpp>
#include <palpate/core/simd_shuffle.hpp>
#include <palpate/geometry/bvh.hpp>
#include <palpate/response/response_display.hpp>

#include <algorithm>

namespace palpate {

PALPATE_COMPILED_INLINE void ResponseDisplay::bind(const ElementMesh& mesh,
                                                   const std::vector<Vec3<double>>& points) {
  const TriangleBvh<double> tree(MeshData<double>{mesh.vertices, mesh.triangles});
  std::vector<TriangleBvh<double>::Nearest> at(points.size());
  std::uint32_t start = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) fail_at("ResponseDisplay", "points must be finite", "point", i);
    at[i] = tree.closest(points[i], start);
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
    const Vec3<float> p = points[order[i]].cast<float>();
    around_.radius.back() = (std::max)(around_.radius.back(), (p - centre).norm());
    const bool last = i + 1 == order.size() || at[order[i + 1]].triangle != bound.triangle;
    do {  // the last one again until the register is full
      x_.push_back(p.x());
      y_.push_back(p.y());
      z_.push_back(p.z());
      b1_.push_back(static_cast<float>(bound.weight[1]));
      b2_.push_back(static_cast<float>(bound.weight[2]));
      vertex_.push_back(order[i]);
    } while (last && vertex_.size() % detail::Simd4::size() != 0);
    spans_.back().end = static_cast<std::uint32_t>(vertex_.size());
  }
  for (auto* list : {&around_.x, &around_.y, &around_.z, &around_.radius})
    list->resize(detail::padded<detail::Simd4>(spans_.size()));
  size_ = points.size();
}

}  // namespace palpate
