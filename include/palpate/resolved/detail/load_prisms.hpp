// SPDX-License-Identifier: MIT
#pragma once

/// @file Where points are among the nodes of a load mesh, a register of them at a time.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/core/simd_vec3.hpp>
#include <palpate/resolved/detail/vector_list.hpp>
#include <palpate/response/tick/load_mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace palpate::detail {

/// The prisms over the triangles of a load mesh, by its nodes' normals: LoadMesh::locate() for points that
/// have hardly moved, in float. A tenth of its instructions; weights to 1e-5.
class LoadPrisms {
 public:
  using V = VectorList::V;

  explicit LoadPrisms(const LoadMesh& mesh) : centre_(mesh.nodes().front().source) {
    prisms_.reserve(mesh.triangles().size());
    for (const auto& t : mesh.triangles()) {
      const LoadNode &p = mesh.nodes()[t[0]], &q = mesh.nodes()[t[1]], &r = mesh.nodes()[t[2]];
      Prism& prism = prisms_.emplace_back();
      std::size_t at = 0;
      for (const Vec3<double>& v :
           {Vec3<double>(p.source - centre_), Vec3<double>(q.source - p.source),
            Vec3<double>(r.source - p.source), p.normal, Vec3<double>(q.normal - p.normal),
            Vec3<double>(r.normal - p.normal), Vec3<double>(p.size, q.size, r.size)})
        for (Eigen::Index k = 0; k < 3; ++k) prism[at++] = static_cast<float>(v[k]);
    }
  }
  /// Positions that locate() takes are relative to it [m].
  [[nodiscard]] const Vec3<double>& centre() const noexcept { return centre_; }

  struct Places {
    alignas(64) std::array<float, V::size()> q, r;   ///< weights of a triangle's second and third node
    alignas(64) std::array<float, V::size()> far2;   ///< squared distance, over size squared
    alignas(64) std::array<float, V::size()> found;  ///< 1 if the triangle's prism contains the point, or 0
  };
  /// Points x over these triangles.
  [[nodiscard]] Places locate(const SimdVec3<V>& x,
                              const std::array<std::uint32_t, V::size()>& triangle) const noexcept {
    alignas(64) std::array<std::array<float, V::size()>, entries> rows;
    for (std::size_t k = 0; k < V::size(); ++k) {
      const Prism& prism = prisms_[triangle[k]];
      for (std::size_t c = 0; c < entries; ++c) rows[c][k] = prism[c];
    }
    const auto vector = [&rows](std::size_t c) PALPATE_INLINE_LAMBDA {
      return SimdVec3<V>{V(rows[c].data()), V(rows[c + 1].data()), V(rows[c + 2].data())};
    };
    const SimdVec3<V> from_p = x - vector(0), q = vector(3), r = vector(6), n = vector(9), dq = vector(12),
                      dr = vector(15), size = vector(18);
    const V third(1.f / 3), tiny((std::numeric_limits<float>::min)());
    // The offset d of the triangle whose plane contains x, by Newton's method from its middle.
    V d = dot(from_p - third * (q + r), n + third * (dq + dr)), step(0.f), slope(0.f);
    SimdVec3<V> eq, er, to, area;
    for (int newton = 0; newton < 3; ++newton) {
      eq = q + d * dq, er = r + d * dr, to = from_p - d * n, area = cross(eq, er);
      if (newton == 2) break;
      slope = dot(cross(dq, er) + cross(eq, dr), to) - dot(area, n);
      step = dot(area, to) / (min)(slope, -tiny);
      d -= step;
    }
    const V per_a2 = V(1.f) / (max)(dot(area, area), tiny), wq = per_a2 * dot(cross(to, er), area),
            wr = per_a2 * dot(cross(eq, to), area), wp = V(1.f) - wq - wr;
    // On the rim to rounding it is in both prisms; Newton has settled if its last step is 1e-3 of an edge
    // (chosen: the next one would be of the order of 1e-6).
    const auto found =
        (min)((min)(wp, wq), wr) > V(-1e-5f) && slope < V(0.f) && step * step < V(1e-6f) * dot(eq, eq);
    const SimdVec3<V> normal = n + wq * dq + wr * dr;
    const V length = wp * size.x + wq * size.y + wr * size.z;
    Places out;
    clamp(wq, 0.f, 1.f).copy_to(out.q.data()), clamp(wr, 0.f, 1.f).copy_to(out.r.data());
    (d * d * dot(normal, normal) / (max)(length * length, tiny)).copy_to(out.far2.data());
    select(found, V(1.f), V(0.f)).copy_to(out.found.data());
    return out;
  }

 private:
  static constexpr std::size_t entries = 21;  // p, q - p, r - p; their normals likewise; their sizes
  using Prism = std::array<float, entries>;
  std::vector<Prism> prisms_;
  Vec3<double> centre_;
};

}  // namespace palpate::detail
