// SPDX-License-Identifier: MIT
#pragma once

/// @file Candidates from FCL, the Flexible Collision Library: the tree that a host has over the object's
/// mesh. Optional: not in palpate.hpp, and the host finds and links FCL itself. Tested with FCL 0.7.

#include <palpate/adapters/detail/near_triangle.hpp>
#include <palpate/core/error.hpp>
#include <palpate/detection/candidates_from.hpp>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/AABB.h>
#include <fcl/math/bv/OBBRSS.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace palpate {

namespace detail {
/// Squared distance from c to a box, and the largest coordinate of the box, or more.
template <Real S>
[[nodiscard]] inline S distance2(const fcl::AABB<S>& box, const Vec3<S>& c) noexcept {
  S d2 = S(0);
  for (int k = 0; k < 3; ++k) {
    const S away = (std::max)((std::max)(box.min_[k] - c[k], c[k] - box.max_[k]), S(0));
    d2 += away * away;
  }
  return d2;
}
template <Real S>
[[nodiscard]] inline S extent(const fcl::AABB<S>& box) noexcept {
  return (std::max)(box.min_.cwiseAbs().maxCoeff(), box.max_.cwiseAbs().maxCoeff());
}
template <Real S>
[[nodiscard]] inline S distance2(const fcl::OBBRSS<S>& both, const Vec3<S>& c) noexcept {
  const fcl::OBB<S>& box = both.obb;
  const S x = c[0] - box.To[0], y = c[1] - box.To[1], z = c[2] - box.To[2];
  S d2 = S(0);
  for (int k = 0; k < 3; ++k) {
    const S along = box.axis(0, k) * x + box.axis(1, k) * y + box.axis(2, k) * z;
    const S away = (std::max)(std::abs(along) - box.extent[k], S(0));
    d2 += away * away;
  }
  return d2;
}
template <Real S>
[[nodiscard]] inline S extent(const fcl::OBBRSS<S>& both) noexcept {
  return both.obb.To.cwiseAbs().maxCoeff() + both.obb.extent.norm();
}
}  // namespace detail

/// A host's fcl::BVHModel<BV> of the object as a CandidateTree. BV is fcl::AABB or fcl::OBBRSS of float or
/// double, vertices in object coordinates [m], where the mesh is now.
///
/// Real time: FCL's tree is walked here, from its boxes and triangles; no heap, lock, exception or I/O, and
/// at most one visit to every box. fcl::collide() with a ball for each question would give the same answers,
/// but takes the heap wherever it finds a contact, and a search tens of times as long (docs/meshes.md).
/// Building and refitting are FCL's own: they write to std::cerr when called out of order, and the first
/// beginUpdateModel() takes the heap.
///
/// Deformed meshes: beginReplaceModel(), replaceSubModel(), endReplaceModel(true, bottomup), between ticks.
/// With OBBRSS give `false` for bottomup: its default, the bottom-up merge of FCL 0.7, makes boxes that do
/// not hold all below them (by 1.4 mm on a mesh of 6 cm), and 0.05 to 0.3 % of the surface is lost, in
/// fcl::collide() as here. With AABB either is right. beginUpdateModel() keeps the last frame in the boxes as
/// well: right, and slower to search. makeParentRelative() must not have been called.
///
/// Precision: questions are answered in BV's scalar, widened by 16 ulp of the largest coordinate. FCL's types
/// hold Eigen's by value: compile with the vector flags that your FCL was compiled with.
template <class BV>
class FclTree {
 public:
  using F = typename BV::S;

  /// Keeps a reference. @throws SetupError where the model is not finished, or has no triangles.
  explicit FclTree(const fcl::BVHModel<BV>& model) : model_(&model) {
    if (model.build_state != fcl::BVH_BUILD_STATE_PROCESSED &&
        model.build_state != fcl::BVH_BUILD_STATE_UPDATED)
      fail("FclTree", "the model must be finished by endModel()");
    if (model.getModelType() != fcl::BVH_MODEL_TRIANGLES) fail("FclTree", "the model must be of triangles");
  }

  template <Real S>
  [[nodiscard]] bool touches(const Vec3<S>& centre, S radius) const noexcept {
    const Vec3<F> c = centre.template cast<F>();
    constexpr F epsilon =
        (std::max)(std::numeric_limits<F>::epsilon(), static_cast<F>(std::numeric_limits<S>::epsilon()));
    const F size = detail::extent(model_->getBV(0).bv) + c.cwiseAbs().maxCoeff() + static_cast<F>(radius);
    const F r = static_cast<F>(radius) + F(16) * epsilon * size;
    std::array<int, 64> stack;  // of right children; deeper trees than this are never separated
    std::size_t top = 0;
    for (int n = 0;;) {
      const auto& node = model_->getBV(n);
      if (!(detail::distance2(node.bv, c) > r * r)) {
        if (!node.isLeaf()) {
          if (top == stack.size()) return true;
          stack[top++] = node.rightChild();
          n = node.leftChild();
          continue;
        }
        const fcl::Triangle& t = model_->tri_indices[node.primitiveId()];
        const auto& v = model_->vertices;
        if (detail::is_near<F>(c, r, v[t[0]], v[t[1]], v[t[2]])) return true;
      }
      if (top == 0) return false;
      n = stack[--top];
    }
  }

 private:
  const fcl::BVHModel<BV>* model_;
};

}  // namespace palpate
