// SPDX-License-Identifier: MIT
#pragma once

/// @file Second order in depth where the body turns: what turns with it moves along a circle, not along the
/// tangent. Per tick.
///
///     q = 1/2 f (k_t omega(w) x w + k_c (omega(w) x n + omega(n) x w + sum omega(n_i) x n_j)) ,   i != j
///
/// | symbol   | name                                                                          | unit |
/// |----------|-------------------------------------------------------------------------------|------|
/// | n, n_i   | near fields of the contacts, of one; w the rest of the field                  | m    |
/// | omega(u) | rotation (rotation_table.hpp)                                                 | rad  |
/// | f        | 0 on a patch that grips, 1 from one and a half radii on                       | -    |
/// | k_t, k_c | `SecondOrder::turned`, `crossed`; a body that turns as a whole has k_t = 1    | -    |
///
/// What a contact's near field does with itself is in its own terms of second order, fitted on a half-space
/// (contact_near.hpp).

#include <palpate/response/tick/contact_system.hpp>

namespace palpate::detail {

/// Holds the buffers; the field must outlive it.
template <std::size_t Capacity>
class TurnedField {
 public:
  explicit TurnedField(const ResponseField& field)
      : field_(&field), fields_(numbers(Capacity) * field.stride()) {}

  /// q at the solve mesh's vertices to `out`, by coordinate, from the field `total` and the near fields of
  /// `count` contacts, one after the other, likewise. Returns the largest q^2.
  float find(const float* total, const float* near, const ContactSystem<Capacity>& contact, std::size_t count,
             const SecondOrder& constants, float* out) noexcept {
    const std::size_t n = field_->stride(), step = numbers(count);
    const auto turned = static_cast<float>(0.5 * constants.turned),
               crossed = static_cast<float>(0.5 * constants.crossed);
    const auto own = [this, near, n](std::size_t c, std::size_t v) { return from(near + 3 * n * c + v); };
    for (std::size_t v = 0; v < n; v += lane_size) {
      float* const to = &fields_[step * v];
      Lane3 w = from(total + v);
      for (std::size_t c = 0; c < count; ++c) {
        const Lane3 u = own(c, v);
        w = w - u;
        store_by_fours(to + 4 * (c + 1), u.x, u.y, u.z, step);
      }
      store_by_fours(to, w.x, w.y, w.z, step);
    }
    Lane most{};
    for (std::size_t v = 0; v < n; v += lane_size) {
      const Lane3 u = from(total + v);
      Lane3 all{}, q{};
      Lane share = four(1);
      Turning turning(*this, v, step);
      for (std::size_t c = 0; c < count; ++c) {
        const Lane3 near_c = own(c, v);
        all += near_c;
        share *= beyond(contact[c], v);
        q += cross(turning(c + 1), crossed * (u - near_c));
      }
      q += cross(turning(0), turned * (u - all) + crossed * all);
      q = share * q;
      most = larger(most, dot(q, q));
      store_vector(out + v, q.x);
      store_vector(out + n + v, q.y);
      store_vector(out + 2 * n + v, q.z);
    }
    return -least_of(-most);
  }

 private:
  using Wide = FloatRegister;
  static constexpr std::size_t pair = 8;  // two fields at a vertex, in one register or two
  [[nodiscard]] static constexpr std::size_t numbers(std::size_t count) noexcept {
    return (count + 2) / 2 * pair;
  }

  // The rotations of all fields at four vertices.
  class Turning {
   public:
    Turning(const TurnedField& of, std::size_t v, std::size_t step) noexcept {
      const RotationTable& table = of.field_->rotation();
      for (std::size_t a = 0; a < 3; ++a)
        axis_[a] = {lane_at(table.frame(a, 0) + v), lane_at(table.frame(a, 1) + v),
                    lane_at(table.frame(a, 2) + v)};
      for (std::size_t k = 0; k < lane_size; ++k)
        for (std::size_t first = 0; first < step; first += pair) {
          Wide low[2] = {}, high[2] = {};
          for (const RotationTable::Weight& w : table[v + k]) {
            const float* const u = &of.fields_[step * w.vertex + first];
            const Wide x = load_vector<Wide>(u);
            low[0] += w.along[0] * x;
            low[1] += w.along[1] * x;
            if constexpr (entries<Wide> < pair) {
              const Wide y = load_vector<Wide>(u + entries<Wide>);
              high[0] += w.along[0] * y;
              high[1] += w.along[1] * y;
            }
          }
          for (std::size_t i = 0; i < 2; ++i) {
            store_vector(&slope_[i][k][first], low[i]);
            if constexpr (entries<Wide> < pair) store_vector(&slope_[i][k][first + entries<Wide>], high[i]);
          }
        }
    }
    [[nodiscard]] PALPATE_INLINE Lane3 operator()(std::size_t field) const noexcept {
      const auto along = [this, field](std::size_t i) -> Lane3 {
        Lane x = lane_at(&slope_[i][0][4 * field]), y = lane_at(&slope_[i][1][4 * field]),
             z = lane_at(&slope_[i][2][4 * field]), none = lane_at(&slope_[i][3][4 * field]);
        transpose(x, y, z, none);
        return {x, y, z};
      };
      const Lane3 d1 = along(0), d2 = along(1);
      const auto& [t1, t2, n] = axis_;
      return dot(n, d2) * t1 - dot(n, d1) * t2 + (0.5f * (dot(t2, d1) - dot(t1, d2))) * n;
    }

   private:
    std::array<Lane3, 3> axis_;
    float slope_[2][lane_size][numbers(Capacity)];
  };

  [[nodiscard]] PALPATE_INLINE Lane3 from(const float* at) const noexcept {
    return {lane_at(at), lane_at(at + field_->stride()), lane_at(at + 2 * field_->stride())};
  }
  [[nodiscard]] PALPATE_INLINE Lane beyond(const PlacedContact& c, std::size_t v) const noexcept {
    const auto away = [this, v, &c](int axis) -> Lane {
      return lane_at(field_->coordinate(axis) + v) - static_cast<float>(c.x[axis]);
    };
    const Lane3 r{away(0), away(1), away(2)};
    const Lane within = between(Lane(3.f - root(dot(r, r)) * static_cast<float>(2 / c.a)), 0, 1);
    return 1 - static_cast<float>(c.grip) * within;
  }

  const ResponseField* field_;
  std::vector<float> fields_;  // by vertex: w, then the near fields, four numbers each, by twos
};

}  // namespace palpate::detail
