// SPDX-License-Identifier: MIT
#pragma once

/// @file Definitions of bvh.hpp. Set-up only.

#include <palpate/core/error.hpp>
#include <palpate/geometry/bvh.hpp>

#include <utility>

namespace palpate {

template <Real S>
TriangleBvh<S>::TriangleBvh(const MeshData<S>& mesh) : vertices_(mesh.vertices), triangles_(mesh.triangles) {
  const std::size_t n = triangles_.size();
  if (n == 0) fail("TriangleBvh", "needs at least one triangle");
  if (n > 1000000000u) fail("TriangleBvh", "takes at most 1e9 triangles", static_cast<double>(n));
  for (std::size_t t = 0; t < n; ++t)
    for (const std::uint32_t v : triangles_[t])
      if (v >= vertices_.size())
        fail_at("TriangleBvh", "vertex does not exist", "triangle", t, static_cast<double>(v));
  for (std::size_t v = 0; v < vertices_.size(); ++v)
    if (!usable(vertices_[v])) fail_at("TriangleBvh", "position must be finite and below 1e6 m", "vertex", v);
  std::vector<Box> boxes(n);
  Box all;
  for (std::size_t t = 0; t < n; ++t) {
    for (const std::uint32_t v : triangles_[t]) boxes[t].add(vertices_[v], vertices_[v]);
    all.add(boxes[t].low, boxes[t].high);
  }
  origin_ = all.low + (all.high - all.low) / S(2);
  nodes_ = std::move(detail::BvhBuild<S>(boxes).nodes);
  link();
  refit_all();
}

}  // namespace palpate
