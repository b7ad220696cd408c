// SPDX-License-Identifier: MIT
#pragma once

/// @file Mid-edge corrections near the contacts, for quadratic display. Per tick.
///
/// Over a triangle with corners' weights b_0, b_1, b_2 a field is drawn as sum b_c u_c + 4 sum b_c b_{c+1}
/// e_c, e_c the mid-edge correction of edge c (mid_edge_table.hpp). It is largest for the regular part next
/// to an edge of the body, where linear display makes half of the error of first order. Far away the
/// corrections are left out, and their mean is added to u_c instead.

#include <palpate/core/simd_shuffle.hpp>
#include <palpate/response/tick/mid_edge_table.hpp>
#include <palpate/response/tick/stages.hpp>

#include <limits>
#include <span>

namespace palpate {
namespace detail {

/// The mid-edge corrections of one tick's field within `reach` of the contacts' patches, fading over the last
/// quarter of it: those of the near fields, which are known at the edges' middles, and those of the rest.
template <std::size_t Capacity, class Contact = DrawnContact>
class MidEdgeCorrection {
 public:
  /// Four times the corrections of a triangle's edges.
  struct OfTriangle {
    Simd4 edge[3];
    template <class V>
    [[nodiscard]] PALPATE_INLINE SimdVec3<V> operator()(const V& b1, const V& b2) const noexcept {
      const V b0 = 1.f - b1 - b2, q0 = b0 * b1, q1 = b1 * b2, q2 = b2 * b0;
      return {q0 * edge[0][0] + q1 * edge[1][0] + q2 * edge[2][0],
              q0 * edge[0][1] + q1 * edge[1][1] + q2 * edge[2][1],
              q0 * edge[0][2] + q1 * edge[1][2] + q2 * edge[2][2]};
    }
  };

  MidEdgeCorrection(const MidEdgeTable& table, std::size_t stride)
      : table_(&table), rest_(4 * stride), all_(table) {
    for (std::size_t c = 0; c < Capacity; ++c) own_.emplace_back(table);
  }

  /// `total`: the field at the mesh's vertices, by coordinate, `stride` numbers each; `own`: of it the near
  /// fields of the contacts, one after the other, likewise.
  void read(const float* total, const float* own, std::size_t stride, std::span<const Contact> contacts,
            float reach) noexcept {
    const std::size_t count = contacts.size();
    find_rest(total, own, stride, count);
    find_shares(contacts, reach);
    all_.list();
    for (const std::uint32_t edge : all_.edges) store(&all_.value[4 * edge], correction(edge));
    for (std::size_t c = 0; c < count; ++c) {
      own_[c].list();
      correct_near(contacts[c].near, own + 3 * stride * c, stride, own_[c]);
    }
  }
  /// Adds to `field`, at the vertices, four numbers each, the mean r of the corrections, as far as those of
  /// the edges are left out. `vertices`: coordinates. What is added is r max^2 / (max^2 + r^2), at most `max`
  /// / 2: the mesh does not resolve more.
  void correct_vertices(const std::array<const float*, 3>& vertices, const float* field,
                        std::span<const Contact> contacts, float reach, float max,
                        float* out) const noexcept {
    const MidEdgeTable::Rows& rows = table_->vertex_rows();
    const float max2 = max * max + (std::numeric_limits<float>::min)();
    for (std::size_t first = 0; first < rows.size(); first += Simd4::size()) {
      const SimdVec3<Simd4> at{Simd4(vertices[0] + first), Simd4(vertices[1] + first),
                               Simd4(vertices[2] + first)};
      Simd4 left = 1.f;
      for (const Contact& c : contacts) left *= 1.f - share(c.near, at, reach);
      Simd4 by[Simd4::size()];
      for (std::size_t k = 0; k < Simd4::size(); ++k)
        by[k] = left[k] > 0 && first + k < rows.size() ? sum(rows[first + k], field) : Simd4{};
      Simd4 x = by[0], y = by[1], z = by[2], none = by[3];
      transpose(x, y, z, none);
      const SimdVec3<Simd4> r{x, y, z};
      const Simd4 kept = left * max2 / (max2 + dot(r, r));
      for (std::size_t k = 0; k < Simd4::size() && first + k < rows.size(); ++k) {
        const std::size_t v = 4 * (first + k);
        store(out + v, Simd4(Simd4(field + v) + kept[k] * by[k]));
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
  using Wide = simd_at_most<float, 8>;
  struct Corrections {
    std::vector<float> share;          // by edge, padded: 1 near the contact, 0 beyond its reach
    std::vector<float> value;          // by edge, four numbers each; 0 without a share
    std::vector<std::uint32_t> edges;  // edges with a share; never more than reserved

    explicit Corrections(const MidEdgeTable& table)
        : share(table.middles()[0].size()), value(4 * table.edge_rows().size()) {
      edges.reserve(table.edge_rows().size());
    }
    // After the shares: lists the edges that have one, all without a correction yet.
    void list() noexcept {
      for (const std::uint32_t edge : edges) store(&value[4 * edge], Simd4{});
      edges.clear();
      constexpr std::uint32_t four = Simd4::size();
      const auto count = static_cast<std::uint32_t>(value.size() / four);
      for (std::uint32_t e = 0; e < count; e += four) {
        if (!(reduce_max(Simd4(&share[e])) > 0)) continue;
        for (std::uint32_t k = e; k < (std::min)(e + four, count); ++k)
          if (share[k] > 0) edges.push_back(k);
      }
    }
    [[nodiscard]] PALPATE_INLINE bool find(const MidEdgeTable::Edges& of, OfTriangle& out) const noexcept {
      const auto& [a, b, c] = of;
      if (!(share[a] + share[b] + share[c] > 0)) return false;
      out = {{Simd4(&value[4 * a]), Simd4(&value[4 * b]), Simd4(&value[4 * c])}};
      return true;
    }
  };

  void find_rest(const float* total, const float* own, std::size_t stride, std::size_t count) noexcept {
    for (std::size_t v = 0; v < stride; v += Simd4::size()) {
      Simd4 x{}, y{}, z{};
      for (std::size_t c = 0; c < count; ++c) {
        const float* const near = own + 3 * stride * c + v;
        x += Simd4(near), y += Simd4(near + stride), z += Simd4(near + 2 * stride);
      }
      store_by_fours(&rest_[4 * v], Simd4(total + v) - x, Simd4(total + stride + v) - y,
                     Simd4(total + 2 * stride + v) - z);
    }
  }
  // How much of the corrections at a point is drawn for one contact: 1 near it, 0 beyond its reach or if it
  // is inactive.
  [[nodiscard]] static PALPATE_INLINE Simd4 share(const auto& near, const SimdVec3<Simd4>& at,
                                                  float reach) noexcept {
    const SimdVec3<Simd4> r{at.x - near.x.x(), at.y - near.x.y(), at.z - near.x.z()};
    const Simd4 inside = reach + near.a - sqrt(dot(r, r));
    return near.activation * clamp(Simd4(inside * (1 / (tick::reach_fade * reach))), 0.f, 1.f);
  }
  void find_shares(std::span<const Contact> contacts, float reach) noexcept {
    const auto& [x, y, z] = table_->middles();
    for (std::size_t e = 0; e < x.size(); e += Simd4::size()) {
      const SimdVec3<Simd4> at{Simd4(&x[e]), Simd4(&y[e]), Simd4(&z[e])};
      Simd4 without = 1.f, largest{};
      for (std::size_t c = 0; c < contacts.size(); ++c) {
        const Simd4 own = share(contacts[c].near, at, reach);
        store(&own_[c].share[e], own);
        without *= 1.f - own;
        largest = (max)(largest, own);
      }
      store(&all_.share[e], (max)(1.f - without, largest));  // above 0 where one is, whatever the rounding
    }
  }
  void correct_near(const auto& near, const float* own, std::size_t stride, Corrections& out) noexcept {
    constexpr std::size_t wide = Wide::size();
    const auto& middle = table_->middles();
    for (std::size_t i = 0; i < out.edges.size(); i += wide) {
      std::array<std::array<float, wide>, 3> at, mean;
      for (std::size_t k = 0; k < wide; ++k) {
        const std::uint32_t edge = out.edges[(std::min)(i + k, out.edges.size() - 1)];
        const auto [p, q] = table_->ends(edge);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          at[axis][k] = middle[axis][edge];
          mean[axis][k] = 0.5f * (own[axis * stride + p] + own[axis * stride + q]);
        }
      }
      const auto from = [](const auto& list) { return load<Wide>(list.data()); };
      const SimdVec3<Wide> u = near(SimdVec3<Wide>{from(at[0]), from(at[1]), from(at[2])});
      const Wide x = u.x - from(mean[0]), y = u.y - from(mean[1]), z = u.z - from(mean[2]);
      for (std::size_t k = 0; k < wide && i + k < out.edges.size(); ++k) {
        const std::uint32_t edge = out.edges[i + k];
        const Simd4 correction = 4 * out.share[edge] * Simd4(x[k], y[k], z[k], 0.f);
        store(&out.value[4 * edge], correction);
        store(&all_.value[4 * edge], Simd4(Simd4(&all_.value[4 * edge]) + correction));
      }
    }
  }
  // Four partial sums: with one, each of some 25 additions would wait for the one before.
  [[nodiscard]] static PALPATE_INLINE Simd4 sum(std::span<const MidEdgeTable::Weight> weights,
                                                const float* field) noexcept {
    const auto part = [&](std::size_t i) { return weights[i].weight * Simd4(field + 4 * weights[i].vertex); };
    Simd4 sum{}, sum1{}, sum2{}, sum3{};
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
  [[nodiscard]] Simd4 correction(std::uint32_t edge) const noexcept {
    return 4 * all_.share[edge] * sum(table_->edge_rows()[edge], rest_.data());
  }

  const MidEdgeTable* table_;
  std::vector<float> rest_;  // what the near fields leave, by vertex, four numbers each
  Corrections all_;
  std::vector<Corrections> own_;  // near fields, by contact
};

}  // namespace detail
}  // namespace palpate
