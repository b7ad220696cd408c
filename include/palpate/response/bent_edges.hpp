// SPDX-License-Identifier: MIT
#pragma once

/// @file  Bends of the solve mesh's edges near the contacts (edge_bend.hpp), for quadratic display. Per tick.
///
/// Over a triangle with corners' weights b_0, b_1, b_2 a field is drawn as sum b_c u_c + 4 sum b_c b_{c+1} bend_c. What bends most is
/// the body's correction next to an edge of the body: linear display is half of the error of first order there.

#include <palpate/response/contact_near.hpp>
#include <palpate/response/edge_bend.hpp>

#include <span>

namespace palpate {

/// Where each edge is, and weights with bend = sum weight u(vertex); none where both ends are fixed. From the solve mesh alone.
class BendTable {
 public:
  struct Weight {
    std::uint32_t vertex;
    float weight;
  };
  using Edges = std::array<std::uint32_t, 3>;  ///< from corner c to c + 1

  BendTable() = default;
  BendTable(const SolveMesh& mesh, const detail::EdgeBend& bend) {
    of_triangle_.resize(mesh.triangles.size());
    std::vector<std::uint8_t> rests(bend.size());
    for (std::size_t t = 0; t < of_triangle_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t e = of_triangle_[t][c] = bend.edge(t, c);
        rests[e] =
            mesh.fixed_vertex[mesh.triangles[t][c]] && mesh.fixed_vertex[mesh.triangles[t][(c + 1) % 3]];
      }
    for (std::size_t e = 0; e < bend.size(); ++e) {
      if (!rests[e])
        for (const detail::VertexWeight& w : bend[e])
          weights_.push_back({w.vertex, static_cast<float>(w.weight)});
      begin_.push_back(static_cast<std::uint32_t>(weights_.size()));
    }
    find_middles(mesh);
  }
  /// From saved parts.
  BendTable(const SolveMesh& mesh, std::vector<Edges> of_triangle, std::vector<std::uint32_t> begin,
            std::vector<Weight> weights)
      : of_triangle_(std::move(of_triangle)), begin_(std::move(begin)), weights_(std::move(weights)) {
    find_middles(mesh);
  }

  [[nodiscard]] std::span<const Weight> operator[](std::size_t edge) const noexcept {
    return {weights_.data() + begin_[edge], begin_[edge + 1] - begin_[edge]};
  }
  [[nodiscard]] std::size_t size() const noexcept { return middle_.size(); }
  [[nodiscard]] const Vec3<float>& middle(std::size_t edge) const noexcept { return middle_[edge]; }
  [[nodiscard]] const std::vector<Edges>& of_triangle() const noexcept { return of_triangle_; }
  /// First weight of each edge, and one more.
  [[nodiscard]] const std::vector<std::uint32_t>& begin() const noexcept { return begin_; }
  [[nodiscard]] const std::vector<Weight>& weights() const noexcept { return weights_; }
  [[nodiscard]] std::size_t memory() const noexcept {
    return of_triangle_.size() * sizeof(Edges) + middle_.size() * sizeof(middle_[0]) + begin_.size() * 4 +
           weights_.size() * sizeof(Weight);
  }

 private:
  void find_middles(const SolveMesh& mesh) {
    middle_.resize(begin_.size() - 1);
    for (std::size_t t = 0; t < of_triangle_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        middle_[of_triangle_[t][c]] =
            (0.5 * (mesh.vertices[mesh.triangles[t][c]] + mesh.vertices[mesh.triangles[t][(c + 1) % 3]]))
                .cast<float>();
  }

  std::vector<Edges> of_triangle_;
  std::vector<Vec3<float>> middle_;
  std::vector<std::uint32_t> begin_{0};
  std::vector<Weight> weights_;
};

namespace detail {

/// The bends of one tick's field within `reach` of the contacts' patches, from three quarters of it on fading; found for the
/// triangles that are asked for, each edge once.
class BentEdges {
 public:
  /// Four times the bends of a triangle's edges.
  struct OfTriangle {
    Lane edge[3];
    [[nodiscard]] PALPATE_INLINE Lane3 operator()(const Lane& b1, const Lane& b2) const noexcept {
      const Lane b0 = 1.f - b1 - b2, q0 = b0 * b1, q1 = b1 * b2, q2 = b2 * b0;
      return {q0 * edge[0][0] + q1 * edge[1][0] + q2 * edge[2][0],
              q0 * edge[0][1] + q1 * edge[1][1] + q2 * edge[2][1],
              q0 * edge[0][2] + q1 * edge[1][2] + q2 * edge[2][2]};
    }
  };

  BentEdges(const BendTable& table, std::size_t stride)
      : table_(&table), field_(4 * stride), edge_(table.size()) {}

  /// A new field at the solve mesh's vertices, by coordinate, `stride` numbers each.
  void read(const float* field, std::size_t stride) noexcept {
    ++now_;
    float* out = field_.data();
    for (std::size_t v = 0; v < stride; ++v, out += 4) {
      out[0] = field[v];
      out[1] = field[stride + v];
      out[2] = field[2 * stride + v];
      out[3] = 0;
    }
  }
  /// False where none of a triangle's edges is near one of `count` contacts.
  template <class Contacts>
  [[nodiscard]] bool find(std::size_t triangle, const Contacts& near, std::size_t count, float reach,
                          OfTriangle& out) noexcept {
    bool any = false;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t e = table_->of_triangle()[triangle][c];
      Edge& edge = edge_[e];
      if (edge.found != now_) {
        float without = 1;
        for (std::size_t i = 0; i < count; ++i) {
          const float inside = reach + near[i].a - (table_->middle(e) - near[i].place).norm();
          without *= 1 - std::clamp(inside * (4 / reach), 0.f, 1.f);
        }
        edge = {now_, without < 1, without < 1 ? bend(e, 1 - without) : Lane{}};
      }
      any = any || edge.near;
      out.edge[c] = edge.bend;
    }
    return any;
  }

 private:
  struct Edge {
    std::uint64_t found = 0;
    bool near = false;
    Lane bend;
  };
  [[nodiscard]] Lane bend(std::uint32_t edge, float share) const noexcept {
    Lane sum{};
    for (const BendTable::Weight& w : (*table_)[edge])
      sum += w.weight * lane_at(&field_[4 * w.vertex]);
    return 4 * share * sum;
  }

  const BendTable* table_;
  std::vector<float> field_;  // by vertex, four numbers each
  std::vector<Edge> edge_;
  std::uint64_t now_ = 0;
};

}  // namespace detail
}  // namespace palpate
