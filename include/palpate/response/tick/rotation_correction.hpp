// SPDX-License-Identifier: MIT
#pragma once

/// @file Second order in depth where the body rotates: what rotates with it moves along a circle, not along
/// the tangent. Per tick.
///
///     q = 1/2 f (k_t omega(w) x w + k_c (omega(w) x n + omega(n) x w + sum omega(n_i) x n_j)) ,   i != j
///
/// | symbol   | name                                                                             | unit |
/// |----------|----------------------------------------------------------------------------------|------|
/// | n, n_i   | near fields of all contacts, of one; w: the rest of the field                    | m    |
/// | omega(u) | rotation of the field u (rotation_table.hpp)                                     | rad  |
/// | f        | 0 on the patch of an active contact, 1 from one and a half radii on              | -    |
/// | k_t, k_c | `SecondOrder::rotated`, `crossed`; a body that rotates as a whole has k_t = 1    | -    |
///
/// What a contact's near field does with itself is in its own terms of second order (near_field.hpp).

#include <palpate/core/simd_shuffle.hpp>
#include <palpate/response/second_order.hpp>
#include <palpate/response/tick/stages.hpp>

#include <span>

namespace palpate::detail {

/// Holds the buffers; the field must outlive it.
template <std::size_t Capacity>
class RotationCorrection {
 public:
  explicit RotationCorrection(const ResponseField& field)
      : field_(&field), fields_(numbers(Capacity) * field.stride()) {}

  /// q at the mesh's vertices to `out`, by coordinate, from the field `total` and the near fields of the
  /// contacts, one after the other, likewise. Returns the largest q^2 [m^2].
  float find(const float* total, const float* near, std::span<const DrawnContact> contacts,
             const SecondOrder& constants, float* out) noexcept {
    const std::size_t n = field_->stride(), count = contacts.size(), step = numbers(count);
    const auto rotated = static_cast<float>(0.5 * constants.rotated),
               crossed = static_cast<float>(0.5 * constants.crossed);
    const auto own = [this, near, n](std::size_t c, std::size_t v) { return from(near + 3 * n * c + v); };
    for (std::size_t v = 0; v < n; v += Simd4::size()) {
      float* const to = &fields_[step * v];
      SimdVec3<Simd4> w = from(total + v);
      for (std::size_t c = 0; c < count; ++c) {
        const SimdVec3<Simd4> u = own(c, v);
        w = w - u;
        store_by_fours(to + 4 * (c + 1), u.x, u.y, u.z, step);
      }
      store_by_fours(to, w.x, w.y, w.z, step);
    }
    Simd4 largest{};
    for (std::size_t v = 0; v < n; v += Simd4::size()) {
      const SimdVec3<Simd4> u = from(total + v);
      SimdVec3<Simd4> all{}, q{};
      Simd4 share = 1.f;
      Rotations omega(*this, v, step);
      for (std::size_t c = 0; c < count; ++c) {
        const SimdVec3<Simd4> near_c = own(c, v);
        all += near_c;
        share *= outside(contacts[c], v);
        q += cross(omega(c + 1), crossed * (u - near_c));
      }
      q += cross(omega(0), rotated * (u - all) + crossed * all);
      q = share * q;
      largest = (max)(largest, dot(q, q));
      store(out + v, q.x);
      store(out + n + v, q.y);
      store(out + 2 * n + v, q.z);
    }
    return reduce_max(largest);
  }

 private:
  using Wide = simd_at_most<float, 8>;
  static constexpr std::size_t pair = 8;  // two fields at a vertex, in one register or two
  [[nodiscard]] static constexpr std::size_t numbers(std::size_t count) noexcept {
    return (count + 2) / 2 * pair;
  }

  // The rotations of all fields at four vertices.
  class Rotations {
   public:
    Rotations(const RotationCorrection& of, std::size_t v, std::size_t step) noexcept {
      const RotationTable& table = of.field_->rotation();
      for (std::size_t a = 0; a < 3; ++a)
        axis_[a] = {Simd4(table.frame(a, 0) + v), Simd4(table.frame(a, 1) + v), Simd4(table.frame(a, 2) + v)};
      for (std::size_t k = 0; k < Simd4::size(); ++k)
        for (std::size_t first = 0; first < step; first += pair) {
          Wide low[2] = {}, high[2] = {};
          for (const RotationTable::Weight& w : table[v + k]) {
            const float* const u = &of.fields_[step * w.vertex + first];
            const Wide x = load<Wide>(u);
            low[0] += w.along[0] * x;
            low[1] += w.along[1] * x;
            if constexpr (Wide::size() < pair) {
              const Wide y = load<Wide>(u + Wide::size());
              high[0] += w.along[0] * y;
              high[1] += w.along[1] * y;
            }
          }
          for (std::size_t i = 0; i < 2; ++i) {
            store(&slope_[i][k][first], low[i]);
            if constexpr (Wide::size() < pair) store(&slope_[i][k][first + Wide::size()], high[i]);
          }
        }
    }
    [[nodiscard]] PALPATE_INLINE SimdVec3<Simd4> operator()(std::size_t field) const noexcept {
      const auto along = [this, field](std::size_t i) -> SimdVec3<Simd4> {
        Simd4 x = Simd4(&slope_[i][0][4 * field]), y = Simd4(&slope_[i][1][4 * field]),
              z = Simd4(&slope_[i][2][4 * field]), none = Simd4(&slope_[i][3][4 * field]);
        transpose(x, y, z, none);
        return {x, y, z};
      };
      const SimdVec3<Simd4> d1 = along(0), d2 = along(1);
      const auto& [t1, t2, n] = axis_;
      return dot(n, d2) * t1 - dot(n, d1) * t2 + (0.5f * (dot(t2, d1) - dot(t1, d2))) * n;
    }

   private:
    std::array<SimdVec3<Simd4>, 3> axis_;
    float slope_[2][Simd4::size()][numbers(Capacity)];
  };

  [[nodiscard]] PALPATE_INLINE SimdVec3<Simd4> from(const float* at) const noexcept {
    return {Simd4(at), Simd4(at + field_->stride()), Simd4(at + 2 * field_->stride())};
  }
  // f of one contact.
  [[nodiscard]] PALPATE_INLINE Simd4 outside(const DrawnContact& c, std::size_t v) const noexcept {
    constexpr double width = tick::rotation_to - tick::rotation_from;
    const auto away = [this, v, &c](int axis) -> Simd4 {
      return Simd4(field_->coordinate(axis) + v) - c.near.x[axis];
    };
    const SimdVec3<Simd4> r{away(0), away(1), away(2)};
    const Simd4 within = clamp(Simd4(static_cast<float>(tick::rotation_to / width) -
                                     sqrt(dot(r, r)) * static_cast<float>(1 / (width * c.tool.a))),
                               0, 1);
    return 1.f - c.near.activation * within;
  }

  const ResponseField* field_;
  std::vector<float> fields_;  // by vertex: w, then the near fields, four numbers each, by twos
};

}  // namespace palpate::detail
