// SPDX-License-Identifier: MIT
#pragma once

/// @file Bends of the solve mesh's edges near the contacts (edge_bend.hpp), for quadratic display. Per tick.
///
/// Over a triangle with corners' weights b_0, b_1, b_2 a field is drawn as sum b_c u_c + 4 sum b_c b_{c+1}
/// bend_c. What bends most is the body's correction next to an edge of the body: linear display is half of
/// the error of first order there. Far away the bends are left out, and u_c raised instead (edge_bend.hpp).

#include <palpate/response/tick/contact_near.hpp>
#include <palpate/response/tick/edge_bend.hpp>

#include <limits>
#include <span>

namespace palpate {

/// Where each edge is, and weights with bend = sum weight u(vertex), none where both ends are fixed; by
/// vertex, those with raise = sum weight u(vertex), none where it is fixed. From the solve mesh alone.
class BendTable {
 public:
  struct Weight {
    std::uint32_t vertex;
    float weight;
  };
  struct Rows {
    std::vector<std::uint32_t> begin{0};  ///< first weight of each, and one more
    std::vector<Weight> weights;

    [[nodiscard]] std::span<const Weight> operator[](std::size_t i) const noexcept {
      return {weights.data() + begin[i], begin[i + 1] - begin[i]};
    }
    [[nodiscard]] std::size_t size() const noexcept { return begin.size() - 1; }
    [[nodiscard]] std::size_t memory() const noexcept {
      return begin.size() * sizeof(begin[0]) + weights.size() * sizeof(Weight);
    }
    void push_back(const std::vector<detail::VertexWeight>& row) {
      for (const auto& w : row) weights.push_back({w.vertex, static_cast<float>(w.weight)});
      begin.push_back(static_cast<std::uint32_t>(weights.size()));
    }
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
    for (std::size_t e = 0; e < bend.size(); ++e)
      bends_.push_back(rests[e] ? std::vector<detail::VertexWeight>{} : bend[e]);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) raises_.push_back(bend.raise(v));
    find_middles(mesh);
  }
  /// From saved parts.
  BendTable(const SolveMesh& mesh, std::vector<Edges> of_triangle, Rows bends, Rows raises)
      : of_triangle_(std::move(of_triangle)), bends_(std::move(bends)), raises_(std::move(raises)) {
    find_middles(mesh);
  }

  [[nodiscard]] const Rows& bends() const noexcept { return bends_; }    ///< by edge
  [[nodiscard]] const Rows& raises() const noexcept { return raises_; }  ///< by vertex
  [[nodiscard]] const std::array<std::uint32_t, 2>& ends(std::size_t edge) const noexcept {
    return ends_[edge];
  }
  /// Middles of all edges, by coordinate, whole lanes; out of reach where an edge never bends.
  [[nodiscard]] const std::array<std::vector<float>, 3>& middles() const noexcept { return middle_; }
  [[nodiscard]] const std::vector<Edges>& of_triangle() const noexcept { return of_triangle_; }
  [[nodiscard]] std::size_t memory() const noexcept {
    return of_triangle_.size() * sizeof(Edges) + ends_.size() * sizeof(ends_[0]) +
           3 * middle_[0].size() * sizeof(float) + bends_.memory() + raises_.memory();
  }

 private:
  void find_middles(const SolveMesh& mesh) {
    ends_.resize(bends_.size());
    for (std::size_t t = 0; t < of_triangle_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        ends_[of_triangle_[t][c]] = {mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3]};
    for (auto& list : middle_) list.assign(detail::whole<detail::Lane>(bends_.size()), 1e9f);
    for (std::size_t e = 0; e < bends_.size(); ++e) {
      if (bends_[e].empty()) continue;
      Vec3<double> x = 0.5 * (mesh.vertices[ends_[e][0]] + mesh.vertices[ends_[e][1]]);
      for (const Weight& w : bends_[e]) x += double(w.weight) * mesh.vertices[w.vertex];
      for (std::size_t axis = 0; axis < 3; ++axis)
        middle_[axis][e] = static_cast<float>(x[static_cast<Eigen::Index>(axis)]);
    }
  }

  std::vector<Edges> of_triangle_;
  std::vector<std::array<std::uint32_t, 2>> ends_;
  std::array<std::vector<float>, 3> middle_;
  Rows bends_, raises_;
};

namespace detail {

/// The bends of one tick's field within `reach` of the contacts' patches, from three quarters of it on
/// fading: of the near fields, known at the edges' middles, and of the rest.
template <std::size_t Capacity>
class BentEdges {
 public:
  /// Four times the bends of a triangle's edges.
  struct OfTriangle {
    Lane edge[3];
    template <class V>
    [[nodiscard]] PALPATE_INLINE Axes<V> operator()(const V& b1, const V& b2) const noexcept {
      const V b0 = 1.f - b1 - b2, q0 = b0 * b1, q1 = b1 * b2, q2 = b2 * b0;
      return {q0 * edge[0][0] + q1 * edge[1][0] + q2 * edge[2][0],
              q0 * edge[0][1] + q1 * edge[1][1] + q2 * edge[2][1],
              q0 * edge[0][2] + q1 * edge[1][2] + q2 * edge[2][2]};
    }
  };

  BentEdges(const BendTable& table, std::size_t stride) : table_(&table), rest_(4 * stride), all_(table) {
    for (std::size_t c = 0; c < Capacity; ++c) own_.emplace_back(table);
  }

  /// `total`: the field at the solve mesh's vertices, by coordinate, `stride` numbers each; `own`: of it the
  /// near fields of `count` contacts, one after the other, likewise.
  void read(const float* total, const float* own, std::size_t stride,
            const std::array<ContactNear, Capacity>& near, std::size_t count, float reach) noexcept {
    find_rest(total, own, stride, count);
    find_shares(near, count, reach);
    all_.list();
    for (const std::uint32_t edge : all_.bent) store_vector(&all_.bend[4 * edge], bend(edge));
    for (std::size_t c = 0; c < count; ++c) {
      own_[c].list();
      bend_near(near[c], own + 3 * stride * c, stride, own_[c]);
    }
  }
  /// Raises `field`, at the vertices, four numbers each, as far as the bends of its edges are left out.
  /// `vertices`: coordinates. By `most` / 2 at most, smoothly: more is what the mesh does not resolve.
  void raise(const std::array<const float*, 3>& vertices, const float* field,
             const std::array<ContactNear, Capacity>& near, std::size_t count, float reach, float most,
             float* raised) const noexcept {
    const BendTable::Rows& raises = table_->raises();
    const float most2 = most * most + (std::numeric_limits<float>::min)();
    for (std::size_t first = 0; first < raises.size(); first += lane_size) {
      const Lane3 at{lane_at(vertices[0] + first), lane_at(vertices[1] + first),
                     lane_at(vertices[2] + first)};
      Lane left = four(1);
      for (std::size_t c = 0; c < count; ++c) left *= 1 - share(near[c], at, reach);
      Lane by[lane_size];
      for (std::size_t k = 0; k < lane_size; ++k)
        by[k] = left[k] > 0 && first + k < raises.size() ? sum(raises[first + k], field) : Lane{};
      Lane x = by[0], y = by[1], z = by[2], none = by[3];
      transpose(x, y, z, none);
      const Lane3 r{x, y, z};
      const Lane kept = left * most2 / (most2 + dot(r, r));
      for (std::size_t k = 0; k < lane_size && first + k < raises.size(); ++k) {
        const std::size_t v = 4 * (first + k);
        store_vector(raised + v, Lane(lane_at(field + v) + kept[k] * by[k]));
      }
    }
  }
  /// False where none of a triangle's edges is near a contact.
  [[nodiscard]] PALPATE_INLINE bool find(std::size_t triangle, OfTriangle& out) const noexcept {
    return all_.find(table_->of_triangle()[triangle], out);
  }
  /// The same of contact c's near field alone.
  [[nodiscard]] PALPATE_INLINE bool find_near(std::size_t c, std::size_t triangle,
                                              OfTriangle& out) const noexcept {
    return own_[c].find(table_->of_triangle()[triangle], out);
  }

 private:
  using Wide = FloatRegister;
  struct Bends {
    std::vector<float> share;         // by edge, whole lanes: 1 near the contact, 0 beyond its reach
    std::vector<float> bend;          // by edge, four numbers each; 0 without a share
    std::vector<std::uint32_t> bent;  // edges with a share; never more than reserved

    explicit Bends(const BendTable& table)
        : share(table.middles()[0].size()), bend(4 * table.bends().size()) {
      bent.reserve(table.bends().size());
    }
    // After the shares: the edges, none of which has a bend yet.
    void list() noexcept {
      for (const std::uint32_t edge : bent) store_vector(&bend[4 * edge], Lane{});
      bent.clear();
      for (std::uint32_t e = 0; e < share.size(); e += lane_size) {
        if (!(-least_of(-lane_at(&share[e])) > 0)) continue;
        for (std::uint32_t k = e; k < e + lane_size; ++k)
          if (share[k] > 0) bent.push_back(k);
      }
    }
    [[nodiscard]] PALPATE_INLINE bool find(const BendTable::Edges& edges, OfTriangle& out) const noexcept {
      const auto& [a, b, c] = edges;
      if (!(share[a] + share[b] + share[c] > 0)) return false;
      out = {{lane_at(&bend[4 * a]), lane_at(&bend[4 * b]), lane_at(&bend[4 * c])}};
      return true;
    }
  };

  void find_rest(const float* total, const float* own, std::size_t stride, std::size_t count) noexcept {
    for (std::size_t v = 0; v < stride; v += lane_size) {
      Lane x{}, y{}, z{};
      for (std::size_t c = 0; c < count; ++c) {
        const float* const near = own + 3 * stride * c + v;
        x += lane_at(near), y += lane_at(near + stride), z += lane_at(near + 2 * stride);
      }
      store_by_fours(&rest_[4 * v], lane_at(total + v) - x, lane_at(total + stride + v) - y,
                     lane_at(total + 2 * stride + v) - z);
    }
  }
  // How much of the bends at a place is drawn for one contact: 1 near it, 0 beyond its reach, or if it has
  // let go.
  [[nodiscard]] static PALPATE_INLINE Lane share(const ContactNear& near, const Lane3& at,
                                                 float reach) noexcept {
    const Lane3 r{at.x - near.place.x(), at.y - near.place.y(), at.z - near.place.z()};
    const Lane inside = reach + near.a - root(dot(r, r));
    return near.grip * between(Lane(inside * (4 / reach)), 0, 1);
  }
  void find_shares(const std::array<ContactNear, Capacity>& near, std::size_t count, float reach) noexcept {
    const auto& [x, y, z] = table_->middles();
    for (std::size_t e = 0; e < x.size(); e += lane_size) {
      const Lane3 at{lane_at(&x[e]), lane_at(&y[e]), lane_at(&z[e])};
      Lane without = four(1), most{};
      for (std::size_t c = 0; c < count; ++c) {
        const Lane own = share(near[c], at, reach);
        store_vector(&own_[c].share[e], own);
        without *= 1 - own;
        most = larger(most, own);
      }
      store_vector(&all_.share[e], larger(1 - without, most));  // above 0 where one is, whatever the rounding
    }
  }
  void bend_near(const ContactNear& near, const float* own, std::size_t stride, Bends& out) noexcept {
    constexpr std::size_t wide = entries<Wide>;
    const auto& middle = table_->middles();
    for (std::size_t i = 0; i < out.bent.size(); i += wide) {
      std::array<std::array<float, wide>, 3> at, mean;
      for (std::size_t k = 0; k < wide; ++k) {
        const std::uint32_t edge = out.bent[(std::min)(i + k, out.bent.size() - 1)];
        const auto [p, q] = table_->ends(edge);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          at[axis][k] = middle[axis][edge];
          mean[axis][k] = 0.5f * (own[axis * stride + p] + own[axis * stride + q]);
        }
      }
      const auto from = [](const auto& list) { return load_vector<Wide>(list.data()); };
      const Axes<Wide> u = near(Axes<Wide>{from(at[0]), from(at[1]), from(at[2])});
      const Wide x = u.x - from(mean[0]), y = u.y - from(mean[1]), z = u.z - from(mean[2]);
      for (std::size_t k = 0; k < wide && i + k < out.bent.size(); ++k) {
        const std::uint32_t edge = out.bent[i + k];
        const Lane bend = 4 * out.share[edge] * Lane{x[k], y[k], z[k], 0};
        store_vector(&out.bend[4 * edge], bend);
        store_vector(&all_.bend[4 * edge], Lane(lane_at(&all_.bend[4 * edge]) + bend));
      }
    }
  }
  // Four sums: one alone would wait for each of some 25 additions.
  [[nodiscard]] static PALPATE_INLINE Lane sum(std::span<const BendTable::Weight> weights,
                                               const float* field) noexcept {
    const auto part = [&](std::size_t i) {
      return weights[i].weight * lane_at(field + 4 * weights[i].vertex);
    };
    Lane sum{}, sum1{}, sum2{}, sum3{};
    std::size_t i = 0;
    for (; i + 4 <= weights.size(); i += 4) {
      sum += part(i);
      sum1 += part(i + 1);
      sum2 += part(i + 2);
      sum3 += part(i + 3);
    }
    for (; i < weights.size(); ++i) sum += part(i);
    return (sum + sum1) + (sum2 + sum3);
  }
  [[nodiscard]] Lane bend(std::uint32_t edge) const noexcept {
    return 4 * all_.share[edge] * sum(table_->bends()[edge], rest_.data());
  }

  const BendTable* table_;
  std::vector<float> rest_;  // what the near fields leave, by vertex, four numbers each
  Bends all_;
  std::vector<Bends> own_;  // near fields, by contact
};

}  // namespace detail
}  // namespace palpate
