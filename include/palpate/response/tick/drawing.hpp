// SPDX-License-Identifier: MIT
#pragma once

/// @file From the vertices of the boundary element mesh to those of a display, under solved contacts. Per
/// tick.
///
/// The field is quadratic over the mesh's triangles within 2.5 edges of a contact. Elsewhere it is linear,
/// with the mean of the mid-edge corrections added at the vertices (mid_edge_correction.hpp). Within one edge
/// of a patch the contact's own near field is evaluated at the display's vertex itself, not interpolated.

#include <palpate/response/response_display.hpp>
#include <palpate/response/tick/mid_edge_correction.hpp>

#include <type_traits>

namespace palpate::detail {

/// Puts the surface on the sphere within the contact, and keeps it outside the sphere beside the contact.
/// `at`: an undeformed position; u: its displacement, changed along m by less than 0.4 d: what is farther off
/// is another side of the body. `reach`: where that ends, from the contact's rim [m].
inline void rest_on_sphere(const DrawnContact& c, const Vec3<double>& at, double reach,
                           Vec3<double>& u) noexcept {
  const Indenter& tool = c.tool;
  const Vec3<double> moved = at + u - c.first;
  const double depth = tool.d.dot(tool.m),
               rest = tool.sphere * tool.sphere - tangential(moved, tool.m).squaredNorm();
  if (!(rest > 0)) return;
  const double inside = depth - tool.sphere + std::sqrt(rest) - moved.dot(tool.m), off = inside / depth,
               r = (at - tool.x).norm();
  // A point inside the sphere is moved out: wholly up to half of a radius (or of `reach`, if less) from the
  // rim, not at all from all of it on. A point below is drawn up, towards the rim less and less over a tenth
  // of the radius.
  const double share = inside > 0 ? 2 - 2 * (r - tool.a) / (std::min)(tool.a, reach) : 10 * (1 - r / tool.a);
  // The shift fades to nothing towards the sphere's equator, from a quarter of R_s^2 down, and where the
  // point is off by d.
  u += std::clamp(share, 0.0, 1.0) * (std::min)(4 * rest / (tool.sphere * tool.sphere), 1.0) *
       (std::max)(1 - off * off, 0.0) * inside * tool.m;
}

/// The patch moves by d and rotates with the tool, as far as the contact is active; beneath a sphere the
/// surface lies on it. `at`, u, `reach`: as above.
template <class V>
void follow_tool(const DrawnContact& c, const SimdVec3<V>& at, float reach, SimdVec3<V>& u) noexcept {
  const NearField& near = c.near;
  const V rx = at.x - near.x.x(), ry = at.y - near.x.y(), rz = at.z - near.x.z(),
          r2 = rx * rx + ry * ry + rz * rz;
  // A sphere moves what lies within two radii (rest_on_sphere), a patch what lies within one.
  if (reduce_min(r2) >= 5 * near.a * near.a) return;
  if (near.is_sphere) {
    for (std::uint32_t l = 0; l < V::size(); ++l) {
      if (r2[l] > 4 * near.a * near.a) continue;
      Vec3<double> v(double(u.x[l]), double(u.y[l]), double(u.z[l]));
      rest_on_sphere(c, Vec3<double>(double(at.x[l]), double(at.y[l]), double(at.z[l])), double(reach), v);
      u.x.set(l, static_cast<float>(v[0]));
      u.y.set(l, static_cast<float>(v[1]));
      u.z.set(l, static_cast<float>(v[2]));
    }
    return;
  }
  // Over the last fiftieth of the radius to the field outside: a vertex that comes in moves fast, and does
  // not jump.
  constexpr float per_edge = 1 / tick::patch_edge;
  const Vec3<float> d = c.tool.d.template cast<float>();
  const V inside = clamp(V(1.f + per_edge - per_edge / near.a * sqrt(r2)), 0.f, 1.f) * near.activation;
  SimdVec3<V> to{d.x(), d.y(), d.z()};
  if (c.tool.is_rotated()) {
    const Mat3<float>& t = near.rotation;
    to.x += t(0, 0) * rx + t(0, 1) * ry + t(0, 2) * rz;
    to.y += t(1, 0) * rx + t(1, 1) * ry + t(1, 2) * rz;
    to.z += t(2, 0) * rx + t(2, 1) * ry + t(2, 2) * rz;
  }
  u.x += inside * (to.x - u.x);
  u.y += inside * (to.y - u.y);
  u.z += inside * (to.z - u.z);
}

/// What is drawn: contacts, and their near fields at the mesh's vertices, one contact after the other, by
/// coordinate.
template <class Contact>
struct DrawnList {
  std::span<const Contact> contact;
  const float* own;
};
using DrawnContacts = DrawnList<DrawnContact>;

/// Holds the buffers; the field must outlive it.
template <std::size_t Capacity, class Contact = DrawnContact>
class ResponseDrawing {
 public:
  using Contacts = DrawnList<Contact>;

  explicit ResponseDrawing(const ResponseField& field)
      : field_(&field),
        total_(4 * field.stride(), 0.f),
        raised_(total_),
        close_(padded<Simd4>(field.mesh().triangles.size())),
        corrections_(field.mid_edges(), field.stride()) {}

  /// `total`: the field at the boundary element mesh's vertices, by coordinate.
  void read(const float* total, const Contacts& contacts) noexcept;

  /// Calls emit(slot, u) with a SIMD vector of displacements from that slot on, until all of a display have
  /// theirs. An `emit` that can be assigned is copied and put back.
  template <class Emit>
  void each(const ResponseDisplay& display, const Contacts& contacts, Emit& emit) noexcept {
    find_close(display, contacts);
    spread(display, emit);
    for (std::size_t i = 0; i < display.spans().size(); ++i)
      if (is_close(display, i)) refine(display, i, contacts, emit);
  }

 private:
  using Wide = simd_at_most<float, 8>;
  using Correction = typename MidEdgeCorrection<Capacity, Contact>::OfTriangle;
  static constexpr std::uint32_t wide = Wide::size(), four = Simd4::size();

  // Where near fields are exact.
  [[nodiscard]] float reach() const noexcept {
    return static_cast<float>(tick::near_field_reach * field_->mesh().length);
  }
  // Above 0 for a sphere that comes within reach of a contact. `S`: a number or a `Simd`.
  template <class S>
  [[nodiscard]] PALPATE_INLINE S within_reach(const S& x, const S& y, const S& z, const S& radius,
                                              const auto& k) const noexcept {
    const S rx = x - k.x.x(), ry = y - k.x.y(), rz = z - k.x.z(), most = radius + (k.a + reach());
    return most * most - (rx * rx + ry * ry + rz * rz);
  }
  // Marks the spans that may have vertices within reach of a contact.
  void find_close(const ResponseDisplay& display, const Contacts& contacts) noexcept;
  [[nodiscard]] PALPATE_INLINE bool is_close(const ResponseDisplay& display,
                                             std::size_t span) const noexcept {
    return close_[span] > 0 && !field_->mesh().fixed_triangle[display.spans()[span].triangle];
  }

  // Linear over one triangle of the boundary element mesh: x, y, z at corner 0, and along the edges from it.
  struct Linear {
    Simd4 at0, edge1, edge2;
    Linear() = default;
    PALPATE_INLINE Linear(const Simd4& corner0, const Simd4& corner1, const Simd4& corner2) noexcept
        : at0(corner0), edge1(corner1 - corner0), edge2(corner2 - corner0) {}
    template <class V>
    [[nodiscard]] PALPATE_INLINE SimdVec3<V> operator()(const V& b1, const V& b2) const noexcept {
      return {at0[0] + b1 * edge1[0] + b2 * edge2[0], at0[1] + b1 * edge1[1] + b2 * edge2[1],
              at0[2] + b1 * edge1[2] + b2 * edge2[2]};
    }
  };
  // The same with mid-edge corrections, where there are any.
  struct Interpolant {
    Linear linear;
    Correction correction;
    bool corrected;
    template <class V>
    [[nodiscard]] PALPATE_INLINE SimdVec3<V> operator()(const V& b1, const V& b2) const noexcept {
      SimdVec3<V> u = linear(b1, b2);
      if (corrected) u += correction(b1, b2);
      return u;
    }
  };
  [[nodiscard]] PALPATE_INLINE Interpolant total_over(std::size_t triangle) const noexcept {
    const auto& [p, q, r] = field_->mesh().triangles[triangle];
    Interpolant u;
    u.linear = {Simd4(&raised_[4 * p]), Simd4(&raised_[4 * q]), Simd4(&raised_[4 * r])};
    u.corrected = !field_->mesh().fixed_triangle[triangle] && corrections_.find(triangle, u.correction);
    return u;
  }
  // The same of contact c's near field.
  [[nodiscard]] Interpolant own_over(std::size_t triangle, const Contacts& contacts,
                                     std::size_t c) const noexcept {
    const std::size_t n = field_->stride();
    const auto at = [n, own = contacts.own + 3 * n * c](std::uint32_t v) {
      return Simd4(own[v], own[n + v], own[2 * n + v], 0.f);
    };
    const auto& [p, q, r] = field_->mesh().triangles[triangle];
    Interpolant u;
    u.linear = {at(p), at(q), at(r)};
    u.corrected = corrections_.find_near(c, triangle, u.correction);
    return u;
  }

  // All spans that are not close to a contact.
  template <class Emit>
  void spread(const ResponseDisplay& display, Emit& emit) const noexcept {
    using Out = std::conditional_t<std::is_copy_assignable_v<Emit>, Emit, Emit&>;
    Out out = emit;  // a copy stays in registers: else each write might change it
    const float *const weight1 = display.b1(), *const weight2 = display.b2();
    const std::span<const ResponseDisplay::Span> spans(display.spans());
    for (std::size_t s = 0; s < spans.size(); ++s) {
      if (is_close(display, s)) continue;
      const ResponseDisplay::Span span = spans[s];
      const Interpolant total = total_over(span.triangle);
      if (total.corrected) {
        for (std::uint32_t i = span.begin; i < span.end; i += four)
          out(i, total(Simd4(weight1 + i), Simd4(weight2 + i)));
      } else {  // most spans: a loop without the test
        for (std::uint32_t i = span.begin; i < span.end; i += four)
          out(i, total.linear(Simd4(weight1 + i), Simd4(weight2 + i)));
      }
    }
    if constexpr (std::is_copy_assignable_v<Emit>) emit = out;
  }

  // A span that is close to a contact: the same with the near fields exact, fading to their interpolants at
  // the end of their reach.
  template <class Emit>
  void refine(const ResponseDisplay& display, std::size_t s, const Contacts& contacts,
              Emit& emit) const noexcept {
    const ResponseDisplay::Span& span = display.spans()[s];
    const Refined refined(*this, display, s, contacts);
    std::uint32_t i = span.begin;
    for (; i + wide <= span.end; i += wide) refine_at<Wide>(display, i, refined, contacts, emit);
    if constexpr (!std::is_same_v<Wide, Simd4>)
      if (i < span.end) refine_at<Simd4>(display, i, refined, contacts, emit);
  }
  // What is the same all over a span.
  struct Refined {
    Interpolant total;
    FixedVector<std::uint32_t, Capacity> close;
    std::array<Interpolant, Capacity> own;

    Refined(const ResponseDrawing& drawing, const ResponseDisplay& display, std::size_t s,
            const Contacts& contacts) noexcept {
      const std::uint32_t triangle = display.spans()[s].triangle;
      total = drawing.total_over(triangle);
      const ResponseDisplay::Spheres& around = display.around();
      for (std::uint32_t c = 0; c < contacts.contact.size(); ++c) {
        if (!(drawing.within_reach(around.x[s], around.y[s], around.z[s], around.radius[s],
                                   contacts.contact[c].near) > 0))
          continue;
        close.push_back(c);
        own[c] = drawing.own_over(triangle, contacts, c);
      }
    }
  };
  // One SIMD vector of slots from i on.
  template <class V, class Emit>
  PALPATE_INLINE void refine_at(const ResponseDisplay& display, std::uint32_t i, const Refined& span,
                                const Contacts& contacts, Emit& emit) const noexcept {
    const auto from = [i](const float* list) { return load<V>(list + i); };
    const V b1 = from(display.b1()), b2 = from(display.b2());
    const SimdVec3<V> at{from(display.x()), from(display.y()), from(display.z())};
    SimdVec3<V> u = span.total(b1, b2);
    const float reach = this->reach();
    for (auto c : span.close) {
      const auto& k = contacts.contact[c].near;
      const V rx = at.x - k.x.x(), ry = at.y - k.x.y(), rz = at.z - k.x.z(), r2 = rx * rx + ry * ry + rz * rz;
      if (reduce_min(r2) >= (reach + k.a) * (reach + k.a)) continue;
      const V weight = clamp(V((reach + k.a - sqrt(r2)) * (1 / (tick::reach_fade * reach))), 0.f, 1.f);
      const SimdVec3<V> exact = k(at), drawn = span.own[c](b1, b2);
      u.x += weight * (exact.x - drawn.x);
      u.y += weight * (exact.y - drawn.y);
      u.z += weight * (exact.z - drawn.z);
    }
    for (auto c : span.close) follow_tool(contacts.contact[c], at, reach, u);
    for_each_chunk<4>(u.x, [&](auto k, const Simd4& x) PALPATE_INLINE_LAMBDA {
      emit(i + k, SimdVec3<Simd4>{x, chunk<4, k>(u.y), chunk<4, k>(u.z)});
    });
  }

  const ResponseField* field_;
  std::vector<float> total_;   // the field at the mesh's vertices, four numbers each
  std::vector<float> raised_;  // the same, with the mean of the mid-edge corrections where they are left out
  std::vector<float> close_;   // by span of the display: above 0 within reach of a contact
  MidEdgeCorrection<Capacity, Contact> corrections_;
};

template <std::size_t Capacity, class Contact>
void ResponseDrawing<Capacity, Contact>::read(const float* total, const Contacts& contacts) noexcept {
  const std::size_t n = field_->stride();
  for (std::size_t v = 0; v < n; v += Simd4::size())
    store_by_fours(&total_[4 * v], Simd4(total + v), Simd4(total + n + v), Simd4(total + 2 * n + v));
  double d2 = 0;
  for (const Contact& c : contacts.contact) d2 = (std::max)(d2, c.displacement2());
  const auto reach = static_cast<float>(tick::mid_edge_reach * field_->mesh().length);
  corrections_.read(total, contacts.own, n, contacts.contact, reach);
  corrections_.correct_vertices(
      {field_->coordinate(0), field_->coordinate(1), field_->coordinate(2)}, total_.data(), contacts.contact,
      reach, static_cast<float>(tick::max_vertex_correction * std::sqrt(d2)), raised_.data());
}

template <std::size_t Capacity, class Contact>
void ResponseDrawing<Capacity, Contact>::find_close(const ResponseDisplay& display,
                                                    const Contacts& contacts) noexcept {
  const ResponseDisplay::Spheres& around = display.around();
  for (std::size_t i = 0; i < around.radius.size(); i += Simd4::size()) {
    const auto from = [i](const std::vector<float>& list) { return Simd4(&list[i]); };
    const Simd4 x = from(around.x), y = from(around.y), z = from(around.z), radius = from(around.radius);
    Simd4 inside = Simd4(-1.f);
    for (std::size_t c = 0; c < contacts.contact.size(); ++c)
      inside = (max)(inside, within_reach(x, y, z, radius, contacts.contact[c].near));
    store(&close_[i], inside);
  }
}

}  // namespace palpate::detail
