// SPDX-License-Identifier: MIT
#pragma once

/// @file  Deformation model from a response field: displacement of the whole surface by boundary elements.

#include <palpate/display/mesh_normals.hpp>
#include <palpate/display/vertex_writer.hpp>
#include <palpate/elasticity/concept.hpp>
#include <palpate/response/response_contact.hpp>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace palpate {

/// Contacts to vertices: each contact is a bonded patch with the area of its region that moves by D
/// (response_contact.hpp); the contacts' fields are coupled. Accuracy: docs/accuracy.md.
///
/// | symbol | name                   | unit | range                                                        |
/// |--------|------------------------|------|--------------------------------------------------------------|
/// | a      | radius of the patch    | m    | sqrt(area / pi), at least `least_radius` and |D| / 2         |
/// |        | `Params::least_radius` | m    | > 0, or 0 for a quarter of the element mesh's edge length    |
///
/// The least radius |D| / 2 is where second order in depth ends; it keeps a point contact from drawing a
/// needle. `Contacts`: how many are drawn at once; more are left out, region_overflow. A contact that is not
/// finite is left out, invalid_pose. With the same contacts as in the last write nothing is read or written.
/// All vertices move: `Moved` counts them all.
///
/// Set-up reports a least radius < 0, and a mesh that is not finite or, with normals, not closed.
template <Real S, std::size_t Contacts = 4>
class ResponseFieldDeformation {
 public:
  using Scalar = S;
  static constexpr bool active = true;
  static constexpr std::size_t most_contacts = Contacts;

  struct Params {
    S least_radius = S(0);
    bool normals = true;
    typename ResponseTick<Contacts>::Settings tick = {};
  };

  /// `mesh`: what is drawn, bound to the field once; any mesh of the same body.
  template <Real M>
  ResponseFieldDeformation(std::shared_ptr<const ResponseField> field, const MeshData<M>& mesh,
                           const Params& params = {})
      : p_(params), field_(std::move(field)), display_(*field_, mesh.vertices), tick_(*field_, params.tick) {
    require_non_negative(p_.least_radius, name, "least_radius [m] must be >= 0 and finite");
    if (p_.least_radius == S(0)) p_.least_radius = static_cast<S>(0.25 * field_->mesh().length);
    if (!p_.normals) return;
    normals_ = MeshNormals(mesh.triangles, mesh.vertices.size());
    std::array<std::vector<float>, 3> rest;
    for (auto& axis : rest) axis.resize(mesh.vertices.size());
    each_at_rest([&rest](std::size_t v, float x, float y, float z) {
      rest[0][v] = x, rest[1][v] = y, rest[2][v] = z;
    });
    normals_.positions().set_row(0, rest[0].size(), rest[0].data(), rest[1].data(), rest[2].data());
    normals_.positions().pack(0);
    normals_.keep_rest();
  }

  template <Real T>
  void write_rest(const VertexBuffer<T>& out) noexcept {
    last_count_ = 0;
    each_at_rest([to = detail::VertexWriter<T>(out.positions, out.position_stride)](
                     std::size_t v, float x, float y, float z) { to.put(v, T(x), T(y), T(z)); });
    if (p_.normals && out.normals != nullptr) normals_.write_rest(out);
  }

  /// Writes the shape under `contacts`, unless it is the one already there.
  template <Real T>
  Moved<S> write(std::span<const ContactState<S>> contacts, const VertexBuffer<T>& out) noexcept {
    Moved<S> moved;
    std::array<ResponseContact<S>, Contacts> pressed;
    std::size_t count = 0;
    for (const ContactState<S>& c : contacts) {
      const ResponseContact<S> patch = patch_of(c);
      if (!is_usable(patch)) {
        moved.status |= Status::invalid_pose;
      } else if (count == Contacts) {
        moved.status |= Status::region_overflow;
      } else {
        pressed[count++] = patch;
      }
    }
    if (out.positions == nullptr || !is_new(pressed, count)) return moved;
    tick_.solve(pressed.data(), count, forces_.data());
    const bool with_normals = p_.normals && out.normals != nullptr;
    Put<T> put(display_, out, with_normals ? &normals_.positions() : nullptr);
    tick_.each(display_, put);
    moved.vertices = display_.size();
    if (moved.vertices > 0) {
      using detail::reduce_max, detail::reduce_min;
      const detail::SimdVec3<detail::Simd4>&low = put.low, &high = put.high;
      moved.lower = Vec3<float>(reduce_min(low.x), reduce_min(low.y), reduce_min(low.z)).template cast<S>();
      moved.upper =
          Vec3<float>(reduce_max(high.x), reduce_max(high.y), reduce_max(high.z)).template cast<S>();
    }
    if (with_normals) {
      normals_.write_positions(out);
      normals_.write(out);
    }
    return moved;
  }

  /// Forces that the tool exerts on the object in the contacts of the last write, by the field [N].
  [[nodiscard]] std::span<const Vec3<S>> forces() const noexcept { return {forces_.data(), last_count_}; }
  [[nodiscard]] const ResponseField& field() const noexcept { return *field_; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  static constexpr const char* name = "ResponseFieldDeformation";

  // Writes vertices to their slots, and finds the box around them. With normals they go to the buffer that
  // the normals are made from, and from there row by row to the caller.
  template <Real T>
  struct Put {
    using Simd = detail::Simd4;
    const float *at_x, *at_y, *at_z;  // at rest, by slot
    const std::uint32_t* vertex;
    detail::VertexWriter<T> to;
    VertexPositions* place;  // null: no normals
    detail::SimdVec3<detail::Simd4> low, high;

    Put(const ResponseDisplay& display, const VertexBuffer<T>& out, VertexPositions* places) noexcept
        : at_x(display.x()),
          at_y(display.y()),
          at_z(display.z()),
          vertex(display.vertex()),
          to(out.positions, out.position_stride),
          place(places) {
      const Simd far = (std::numeric_limits<float>::max)();
      low = {far, far, far};
      high = {-far, -far, -far};
    }
    PALPATE_INLINE void operator()(std::size_t slot, const detail::SimdVec3<detail::Simd4>& u) noexcept {
      const detail::SimdVec3<detail::Simd4> at{Simd(at_x + slot) + u.x, Simd(at_y + slot) + u.y,
                                               Simd(at_z + slot) + u.z};
      low = {(detail::min)(low.x, at.x), (detail::min)(low.y, at.y), (detail::min)(low.z, at.z)};
      high = {(detail::max)(high.x, at.x), (detail::max)(high.y, at.y), (detail::max)(high.z, at.z)};
      if (place != nullptr)
        place->set_four(vertex + slot, at.x, at.y, at.z);
      else
        to.put_apart([this, slot](std::size_t k) { return vertex[slot + k]; }, at.x, at.y, at.z);
    }
  };

  [[nodiscard]] ResponseContact<S> patch_of(const ContactState<S>& c) const noexcept {
    const S area = c.area > S(0) ? c.area : S(0);
    const S a =
        (std::max)({p_.least_radius, std::sqrt(area / std::numbers::pi_v<S>), c.displacement.norm() / S(2)});
    return {c.origin(), c.normal, a, c.displacement};
  }
  // Keeps the contacts; false when they are those of the last write, bit for bit.
  [[nodiscard]] bool is_new(const std::array<ResponseContact<S>, Contacts>& pressed,
                            std::size_t count) noexcept {
    bool same = count == last_count_;
    for (std::size_t c = 0; same && c < count; ++c)
      same = pressed[c].position == last_[c].position && pressed[c].normal == last_[c].normal &&
             pressed[c].radius == last_[c].radius && pressed[c].displacement == last_[c].displacement;
    last_ = pressed;
    last_count_ = count;
    return !same;
  }

  template <class Emit>
  void each_at_rest(const Emit& emit) const noexcept {
    for (std::size_t slot = 0; slot < display_.slots(); ++slot)
      emit(display_.vertex()[slot], display_.x()[slot], display_.y()[slot], display_.z()[slot]);
  }

  Params p_;
  std::shared_ptr<const ResponseField> field_;
  ResponseDisplay display_;
  ResponseTick<Contacts> tick_;
  MeshNormals normals_;
  std::array<ResponseContact<S>, Contacts> last_{};
  std::size_t last_count_ = 0;
  std::array<Vec3<S>, Contacts> forces_{};
};

}  // namespace palpate
