// SPDX-License-Identifier: MIT
#pragma once

/// @file  Contact with the shape as it is now: what has bulged out is touched where it is seen.

#include <palpate/geometry/detail/near_batch.hpp>
#include <palpate/geometry/detail/near_blend.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

#include <span>
#include <utility>

namespace palpate {

/// An elastic object whose mesh follows the deformation of the last tick; hand it to ContactSolver in place
/// of the undeformed body, and call update() after the shape has been written. Section III of [luo2005],
/// third phase.
///
///     depth(x) = depth_0(x - b(y)),        b = max(0, u . n) n
///
/// y is the point of the deformed mesh closest to x, u its displacement since set-up and n the undeformed
/// normal; b is interpolated from the vertices and blended over the triangles next to y
/// (geometry/detail/near_blend.hpp), because y itself jumps below a convex edge; depth_0 is the undeformed
/// body's. Where the surface has moved inwards, as under a tool, b = 0 and depth is measured from the
/// undeformed surface, as D is everywhere (section IV). Where it has bulged out, the undeformed shape has no
/// contact at x; the deformed mesh finds it, and the depth below the bulge is measured on the undeformed
/// shape with the bulge taken off. Continuous in x as far as the closest point is, and in u.
///
/// The paper's detection uses the deformed shape as well but does not say from where depth is then measured:
/// this is our reading. The bulge is one tick old, so a stiff bulge raised by the contact itself can lag
/// behind by a tick.
///
/// Without a bulge it costs nothing but the test; with one, a search of the mesh for each leaf of the tool,
/// or each candidate. `mesh` is the undeformed surface in the object's frame, closed and oriented (checked by
/// TriangleMesh); it need not be the body's own, so an exact body keeps its exact depth.
template <ContactSurface B>
class DeformedSurface {
 public:
  using Scalar = typename B::Scalar;
  using S = Scalar;

  DeformedSurface(B body, const TriangleMesh<S>& mesh)
      : body_(std::move(body)),
        tree_(mesh.data()),
        rest_(mesh.vertices()),
        normal_(mesh.vertex_normals()),
        height_(rest_.size(), S(0)),
        blend_(detail::mean_edge(mesh.area(), mesh.triangles().size())) {}

  /// Every vertex's position [m], in the mesh's order; linear. One that is not finite stays where it was.
  void update(std::span<const Vec3<S>> vertices) noexcept {
    tree_.move_all(vertices);
    highest_ = S(0);
    for (std::size_t v = 0; v < rest_.size(); ++v) raise(v);
  }

  /// The positions [m] of some vertices; the others stay. Refits only the boxes above them.
  void update(std::span<const std::uint32_t> which, std::span<const Vec3<S>> positions) noexcept {
    tree_.move(which, positions);
    for (const std::uint32_t v : which) raise(v);
    highest_ = S(0);
    for (const S h : height_) highest_ = (std::max)(highest_, h);
  }

  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept { return body_.closest(x); }

  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept {
    if (!(highest_ > S(0)) || body_.separated(x, highest_)) return body_.penetration(x);
    detail::Seen<S> seen;
    const auto near = blend_.search(tree_, x, 0, seen);
    return body_.penetration(x - blend_.mean(
                                     tree_, x, std::sqrt(near.distance2), seen,
                                     [](std::uint32_t) { return true; },
                                     [this](const auto& at) { return bulge(at); }, bulge(near)));
  }

  /// The same of a batch; below a bulge, where they are close together, by one walk of the tree.
  void penetration(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept {
    if (!(highest_ > S(0))) return undeformed(x, in);
    using V = detail::Simd<S, static_cast<int>(batch_size)>;
    const V px(x.x.data()), py(x.y.data()), pz(x.z.data());
    if (is_finite(reduce(px) + reduce(py) + reduce(pz))) {
      const Vec3<S> low(reduce_min(px), reduce_min(py), reduce_min(pz)),
          high(reduce_max(px), reduce_max(py), reduce_max(pz)), middle = low + (high - low) / S(2);
      const S spread = (high - low).norm() / S(2);
      if (body_.separated(middle, spread + highest_)) return undeformed(x, in);
      PointBatch<S> lowered;
      const auto lower = [&](const detail::NearBatch<S>& batch) {
        std::array<std::array<S, batch_size>, 3> b;
        const std::array<S, batch_size> weight = batch.mean(
            blend_, [this](std::uint32_t triangle, std::size_t corner) { return bulge_at(triangle, corner); },
            b);
        for (std::size_t i = 0; i < batch_size; ++i) {
          const bool on_mesh = !(weight[i] > S(0));
          const Vec3<S> here = on_mesh ? bulge(batch.nearest(i)) : Vec3<S>(b[0][i], b[1][i], b[2][i]);
          lowered.x[i] = x.x[i] - here.x();
          lowered.y[i] = x.y[i] - here.y();
          lowered.z[i] = x.z[i] - here.z();
        }
      };
      if (blend_.shares(spread)) {
        const S far = std::sqrt(tree_.closest(middle).distance2) + spread;
        if (detail::with_near_batch(tree_, blend_, x, middle, spread, far, lower))
          return undeformed(lowered, in);
      }
    }
    detail::penetrate_one_by_one(*this, x, in);
  }

  /// True only if no point of the ball is inside the undeformed body or below a bulge.
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept {
    return body_.separated(c, r + highest_);
  }

  [[nodiscard]] S reach() const noexcept { return body_.reach(); }

  [[nodiscard]] const B& body() const noexcept { return body_; }
  /// The deformed mesh of the last update.
  [[nodiscard]] const TriangleBvh<S>& tree() const noexcept { return tree_; }
  /// max u . n over the vertices, or 0 [m].
  [[nodiscard]] S highest_bulge() const noexcept { return highest_; }

 private:
  void raise(std::size_t v) noexcept {
    height_[v] = (std::max)(S(0), (tree_.vertices()[v] - rest_[v]).dot(normal_[v]));
    highest_ = (std::max)(highest_, height_[v]);
  }

  [[nodiscard]] Vec3<S> bulge(const typename TriangleBvh<S>::Nearest& at) const noexcept {
    return at.weight[0] * bulge_at(at.triangle, 0) + at.weight[1] * bulge_at(at.triangle, 1) +
           at.weight[2] * bulge_at(at.triangle, 2);
  }
  [[nodiscard]] Vec3<S> bulge_at(std::uint32_t triangle, std::size_t corner) const noexcept {
    const std::uint32_t v = tree_.triangles()[triangle][corner];
    return height_[v] * normal_[v];
  }

  void undeformed(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept {
    if constexpr (HasPenetrationBatch<B>)
      body_.penetration(x, in);
    else
      detail::penetrate_one_by_one(body_, x, in);
  }

  B body_;
  TriangleBvh<S> tree_;
  std::vector<Vec3<S>> rest_, normal_;
  std::vector<S> height_;  // max(0, u . n) of each vertex
  S highest_ = S(0);
  detail::NearBlend<S> blend_;
};

}  // namespace palpate
