// SPDX-License-Identifier: MIT
#pragma once

/// @file  Any closed triangle mesh as the elastic object: exact distance, a force direction without clicks.

#include <palpate/core/fixed_vector.hpp>
#include <palpate/geometry/detail/crease_normals.hpp>
#include <palpate/geometry/detail/distance_grid.hpp>
#include <palpate/geometry/detail/near_batch.hpp>
#include <palpate/geometry/detail/near_blend.hpp>
#include <palpate/geometry/detail/shape_tools.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

namespace palpate {

/// Undeformed elastic object given by a checked mesh.
///
/// | symbol | name     | unit | range, default                                                       |
/// |--------|----------|------|----------------------------------------------------------------------|
/// | alpha  | `crease` | rad  | [0, pi], 0.7: an edge that turns by more is sharp, others are smooth |
///
/// Depth is the exact distance d to the triangles, so it is continuous everywhere. Its derivative is not: it
/// jumps by the dihedral angle theta across the bisector of every convex edge, all the way up to the edge,
/// and a force along it clicks. The direction given here is continuous for every path below the surface:
///
///     g = sum_p W_p n_p / sum_p W_p,                 W_p = (2 - d_p / d)_+^2          over smooth patches p
///     n_p = sum_i w_i n(x_i) / sum_i w_i,            w_i = (1 + e - d_i / d_p)_+^2    over triangles i of p
///
/// x_i is the point of triangle i closest to x and d_i its distance; projection on a triangle is continuous,
/// so every term is. n(x_i) interpolates the corners' normals as Phong shading does, d_p = min d_i, and e =
/// min(1/4, (h / 4 d_p)^2), h the mean edge length, takes in only the triangles next to the closest one.
/// Between patches, at a crease, the direction turns as it does in Box. Own choice: the interpolated normal
/// alone still jumps by about theta d / R, R the radius of curvature; with flat normals alone the jump is
/// theta.
///
/// What this costs: g is a shading direction, not the derivative of d, so the force has a small curl (about
/// theta); |g| < 1 at creases and near the medial axis. At most 8 patches count; further ones are left out,
/// farthest first.
///
/// Sign: angle-weighted pseudonormal of the closest face, edge or vertex [baerentzen2005]. Accuracy: a few
/// ulp of the largest coordinate. A query that is not finite: closest() gives vertex 0 at the largest finite
/// distance, penetration() no contact, separated() false, raycast() no hit. Self-intersecting meshes have no
/// inside; they are not refused.
template <Real S>
class MeshSurface {
 public:
  using Scalar = S;

  struct Params {
    S crease = S(0.7L);  ///< alpha [rad]; chosen: 40 degrees
  };

  explicit MeshSurface(const TriangleMesh<S>& mesh) : MeshSurface(mesh, Params{}) {}
  MeshSurface(const TriangleMesh<S>& mesh, const Params& params);

  /// Closest point of the mesh; the normal is the interpolated one there.
  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept {
    if (!is_finite(x)) return detail::nowhere<S>(bvh_.vertices()[0], vertex_normals_[0]);
    // A far point is brought near first: squares of its coordinates may overflow. Chosen: 1e4 sizes away the
    // whole body is within 1e-4 of one direction.
    const Vec3<S> middle = lower_ + (upper_ - lower_) / S(2);
    const S limit = S(1e4L) * (upper_ - lower_).maxCoeff(), size = (x - middle).cwiseAbs().maxCoeff();
    if (!is_finite(size)) return detail::nowhere<S>(bvh_.vertices()[0], vertex_normals_[0]);
    if (size > limit) {
      // In two steps: 1 / size may be no normal number, and the host's flags may multiply by it.
      const S shrink = size > S(1e15L) ? S(1e-15L) : S(1);
      const Vec3<S> e = (x - middle) * shrink / (size * shrink);
      const Nearest near = bvh_.closest(middle + limit * e);
      const S d = size * (e + (middle - near.position) / size).norm();
      return {near.position, normal(near), is_finite(d) ? d : (std::numeric_limits<S>::max)()};
    }
    const Nearest near = bvh_.closest(x, within(x) ? grid_.at(x).triangle : 0);
    return {near.position, normal(near), distance(x, near)};
  }

  /// Distance to the surface from inside and a continuous outward direction; outside {0, 0}.
  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept {
    std::uint32_t start;
    if (!may_be_inside(x, start)) return {S(0), Vec3<S>::Zero()};
    Seen seen;
    const Nearest near = blend_.search(bvh_, x, start, seen);
    const S d = -distance(x, near);
    if (!(d > S(0))) return {S(0), Vec3<S>::Zero()};
    return {d, normals_.patches == 1 ? patch_direction(x, near, d, seen) : direction(x, near, d)};
  }

  /// The same of a batch; where they are close together, by one walk of the tree.
  void penetration(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept {
    PointBatch<S> points = x;
    std::array<bool, batch_size> open;
    Vec3<S> low = upper_, high = lower_;
    for (std::size_t i = 0; i < batch_size; ++i) {
      const Vec3<S> p(x.x[i], x.y[i], x.z[i]);
      open[i] = within(p);
      if (open[i]) low = low.cwiseMin(p), high = high.cwiseMax(p);
      in.set(i, {S(0), Vec3<S>::Zero()});
    }
    if (!(low.array() <= high.array()).all()) return;  // none
    const Vec3<S> middle = low + (high - low) / S(2);
    const S spread = (high - low).norm() / S(2);
    const auto bounds = grid_.at(middle);
    if (bounds.lower > spread) return;
    for (std::size_t i = 0; i < batch_size; ++i)
      if (!open[i]) points.x[i] = middle.x(), points.y[i] = middle.y(), points.z[i] = middle.z();
    const auto at_once = [&](const detail::NearBatch<S>& batch) {
      std::array<std::array<S, batch_size>, 3> mean;
      if (normals_.patches == 1)
        batch.mean_direction(
            blend_,
            [this](std::uint32_t triangle, std::uint32_t corner) -> const Vec3<S>& {
              return normals_.normal[normals_.corner[3 * triangle + corner]];
            },
            mean);
      for (std::size_t i = 0; i < batch_size; ++i) {
        const Nearest near = batch.nearest(i);
        if (!open[i] || !(batch.along(i, pseudonormal(near)) < S(0))) continue;
        const S d = batch.distance()[i];
        in.set(i, {d, normals_.patches == 1 ? Vec3<S>(mean[0][i], mean[1][i], mean[2][i])
                                            : direction(Vec3<S>(x.x[i], x.y[i], x.z[i]), near, d)});
      }
    };
    if (blend_.shares(spread)) {
      // No point is farther from the mesh than the middle is and its own distance from there.
      const S far = std::sqrt(bvh_.on_triangle(middle, bounds.triangle).distance2) + spread;
      if (detail::with_near_batch(bvh_, blend_, points, middle, spread, far, at_once)) return;
    }
    for (std::size_t i = 0; i < batch_size; ++i)
      if (open[i]) in.set(i, penetration(Vec3<S>(x.x[i], x.y[i], x.z[i])));
  }

  [[nodiscard]] bool inside(const Vec3<S>& x) const noexcept {
    if (!within(x)) return false;
    const auto bounds = grid_.at(x);
    if (bounds.lower > S(0) || bounds.upper < S(0)) return bounds.upper < S(0);
    return distance(x, bvh_.closest(x, bounds.triangle)) < S(0);
  }

  /// True only if no point of the ball (c, r) is inside; false when anything is not finite or r < 0.
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept {
    if (!is_finite(c) || !is_finite(r) || r < S(0)) return false;
    // More than the rounding of a distance.
    constexpr S guard = S(16) * std::numeric_limits<S>::epsilon();
    const S grown = r + guard * (r + (std::max)(lower_.cwiseAbs().maxCoeff(), upper_.cwiseAbs().maxCoeff()));
    const Vec3<S> away = (lower_ - c).cwiseMax(c - upper_).cwiseMax(S(0));
    if (away.maxCoeff() > grown) return true;
    if (!within(c)) {
      // Outside the box it is outside the body: only the distance counts.
      if (away.squaredNorm() > grown * grown) return true;
      return bvh_.closest(c).distance2 > grown * grown;
    }
    const auto bounds = grid_.at(c);
    if (bounds.lower > grown || bounds.upper <= grown) return bounds.lower > grown;
    if (bvh_.on_triangle(c, bounds.triangle).distance2 <= grown * grown) return false;
    return distance(c, bvh_.closest(c, bounds.triangle)) > grown;
  }

  /// First hit at t >= 0, from either side; no ray passes between triangles [woop2013]. Direction of any
  /// length; zero or not finite: no hit.
  [[nodiscard]] RayHit<S> raycast(const Vec3<S>& origin, const Vec3<S>& d) const noexcept {
    const auto hit = bvh_.raycast(origin, d);
    if (hit.triangle == bvh_.none) return detail::no_hit<S>();
    const auto& t = bvh_.triangles()[hit.triangle];
    const auto& v = bvh_.vertices();
    return {true, hit.weight[0] * v[t[0]] + hit.weight[1] * v[t[1]] + hit.weight[2] * v[t[2]], hit.t};
  }

  /// An estimate: half the thickness below the middle of a triangle, measured inwards along its normal; a
  /// twentieth of 2,000 triangles spread over the list is thinner. The depth's derivative, not the direction
  /// given here, already jumps at edges.
  [[nodiscard]] S reach() const noexcept { return reach_; }
  [[nodiscard]] S volume() const noexcept { return volume_; }
  [[nodiscard]] Vec3<S> centroid() const noexcept { return centroid_; }
  [[nodiscard]] Vec3<S> lower() const noexcept { return lower_; }
  [[nodiscard]] Vec3<S> upper() const noexcept { return upper_; }
  [[nodiscard]] std::size_t patches() const noexcept { return normals_.patches; }
  [[nodiscard]] const TriangleBvh<S>& bvh() const noexcept { return bvh_; }

 private:
  using Nearest = typename TriangleBvh<S>::Nearest;
  using Seen = detail::Seen<S>;
  static constexpr std::uint32_t mixed = TriangleBvh<S>::none;

  [[nodiscard]] static S checked(const Params& p) {
    // 3.15: pi, however it was rounded.
    if (!is_finite(p.crease) || !(p.crease >= S(0) && p.crease <= S(3.15L)))
      fail("MeshSurface", "crease [rad] must be in [0, pi]", static_cast<double>(p.crease));
    return p.crease;
  }

  [[nodiscard]] bool within(const Vec3<S>& x) const noexcept {
    return is_finite(x) && (x.array() >= lower_.array()).all() && (x.array() <= upper_.array()).all();
  }

  /// False: outside. True: unknown; `start` is a triangle near x.
  [[nodiscard]] bool may_be_inside(const Vec3<S>& x, std::uint32_t& start) const noexcept {
    if (!within(x)) return false;
    const auto bounds = grid_.at(x);
    start = bounds.triangle;
    return !(bounds.lower > S(0));
  }

  /// Interpolated normal at a point of the mesh.
  [[nodiscard]] Vec3<S> normal(const Nearest& at) const noexcept {
    Vec3<S> n = Vec3<S>::Zero();
    for (std::uint32_t k = 0; k < 3; ++k)
      n += at.weight[static_cast<int>(k)] * normals_.normal[normals_.corner[3 * at.triangle + k]];
    return unit_or<S>(n, normals_.face[at.triangle]);
  }

  /// Signed distance of x, whose closest point is `near`.
  [[nodiscard]] S distance(const Vec3<S>& x, const Nearest& near) const noexcept {
    const S d = std::sqrt(near.distance2);
    return (x - near.position).dot(pseudonormal(near)) < S(0) ? -d : d;
  }

  [[nodiscard]] Vec3<S> pseudonormal(const Nearest& at) const noexcept {
    std::uint32_t zeros = 0, zero = 0, one = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (at.weight[static_cast<int>(k)] == S(0))
        ++zeros, zero = k;
      else
        one = k;
    }
    if (zeros == 0) return normals_.face[at.triangle];
    if (zeros == 2) return vertex_normals_[bvh_.triangles()[at.triangle][one]];
    // The edge across from corner `zero`.
    return normals_.face[at.triangle] + normals_.face[normals_.twin[3 * at.triangle + (zero + 1) % 3] / 3];
  }

  /// n_p of the patch of `near`; d = |x - near|.
  [[nodiscard]] Vec3<S> patch_direction(const Vec3<S>& x, const Nearest& near, S d,
                                        const Seen& seen) const noexcept {
    const std::uint32_t patch = normals_.patch[near.triangle];
    return blend_.mean(
        bvh_, x, d, seen, [&](std::uint32_t triangle) { return normals_.patch[triangle] == patch; },
        [&](const Nearest& here) { return normal(here); }, normal(near));
  }

  /// g: over all patches nearer than twice the nearest.
  [[nodiscard]] Vec3<S> direction(const Vec3<S>& x, const Nearest& near, S d) const noexcept {
    const Feet feet = patch_feet(x, near);
    Vec3<S> sum = Vec3<S>::Zero();
    S total = S(0);
    for (const Nearest& foot : feet) {
      const S d_p = std::sqrt(foot.distance2), w = S(2) - d_p / d;
      if (!(w > S(0))) continue;
      Seen none;
      none.count = none.nearest.size() + 1;  // incomplete: walk
      sum += w * w * patch_direction(x, foot, d_p, none);
      total += w * w;
    }
    return total > S(0) ? Vec3<S>(sum / total) : normal(near);
  }

  /// Closest point on each patch nearer than twice the nearest.
  using Feet = FixedVector<Nearest, 8>;
  [[nodiscard]] Feet patch_feet(const Vec3<S>& x, const Nearest& near) const noexcept {
    Feet feet;
    feet.push_back(near);
    const S limit = S(4) * near.distance2;
    const auto foot_of = [&](std::uint32_t patch) {
      std::size_t i = 0;
      while (i < feet.size() && normals_.patch[feet[i].triangle] != patch) ++i;
      return i;
    };
    const auto cull = bvh_.cull(x);
    bvh_.walk(
        cull, cull.limit(limit),
        [&](std::uint32_t node, std::size_t child, float away) {
          const std::uint32_t patch = node_patch_[node][child];
          if (patch == mixed) return true;
          const std::size_t i = foot_of(patch);
          return i == feet.size() || away <= cull.limit(feet[i].distance2);
        },
        [&](std::uint32_t triangle) {
          const Nearest here = bvh_.on_triangle(x, triangle);
          if (!(here.distance2 < limit)) return;
          std::size_t i = foot_of(normals_.patch[triangle]);
          if (i == feet.size() && !feet.full()) {
            feet.push_back(here);
            return;
          }
          if (i == feet.size()) {  // full: the farthest is replaced
            i = 0;
            for (std::size_t j = 1; j < feet.size(); ++j)
              if (feet[j].distance2 > feet[i].distance2) i = j;
          }
          if (here.distance2 < feet[i].distance2) feet[i] = here;
        });
    return feet;
  }

  void mark_patches();
  [[nodiscard]] S estimate_reach() const;

  S crease_;
  TriangleBvh<S> bvh_;
  detail::CreaseNormals<S> normals_;
  std::vector<Vec3<S>> vertex_normals_;  // angle weighted over all faces: decide the sign
  Vec3<S> lower_, upper_, centroid_;
  S volume_, edge_, reach_{};
  detail::NearBlend<S> blend_;
  detail::DistanceGrid<S> grid_;
  std::vector<std::array<std::uint32_t, TriangleBvh<S>::Node::width>>
      node_patch_;  // per child; mixed: several
};

static_assert(ContactSurface<MeshSurface<float>> && ContactSurface<MeshSurface<double>>);

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/geometry/setup/mesh_surface_impl.hpp>
#endif
