// SPDX-License-Identifier: MIT
#pragma once

/// @file  Deformation model from a response field: displacement of the whole surface by boundary elements.

#include <palpate/elasticity/concept.hpp>
#include <palpate/response/response_contact.hpp>
#include <palpate/response/tick/shape_writer.hpp>

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
      : p_(params),
        field_(std::move(field)),
        writer_(*field_, mesh, p_.normals),
        tick_(*field_, params.tick) {
    require_non_negative(p_.least_radius, name, "least_radius [m] must be >= 0 and finite");
    if (p_.least_radius == S(0)) p_.least_radius = static_cast<S>(0.25 * field_->mesh().length);
  }

  template <Real T>
  void write_rest(const VertexBuffer<T>& out) noexcept {
    last_count_ = 0;
    writer_.write_rest(out);
  }

  /// Writes the shape under `contacts`, unless it is the one already there.
  template <Real T>
  Moved<S> write(std::span<const ContactState<S>> contacts, const VertexBuffer<T>& out) noexcept {
    Status status = Status::ok;
    std::array<ResponseContact<S>, Contacts> pressed;
    std::size_t count = 0;
    for (const ContactState<S>& c : contacts) {
      const ResponseContact<S> patch = patch_of(c);
      if (!is_usable(patch)) {
        status |= Status::invalid_pose;
      } else if (count == Contacts) {
        status |= Status::region_overflow;
      } else {
        pressed[count++] = patch;
      }
    }
    Moved<S> moved;
    if (out.positions != nullptr && is_new(pressed, count)) {
      tick_.solve(pressed.data(), count, forces_.data());
      moved = writer_.template write<S>(out, [this](auto& put) { tick_.each(writer_.display(), put); });
    }
    moved.status = status;
    return moved;
  }

  /// Forces that the tool exerts on the object in the contacts of the last write, by the field [N].
  [[nodiscard]] std::span<const Vec3<S>> forces() const noexcept { return {forces_.data(), last_count_}; }
  [[nodiscard]] const ResponseField& field() const noexcept { return *field_; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  static constexpr const char* name = "ResponseFieldDeformation";

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

  Params p_;
  std::shared_ptr<const ResponseField> field_;
  detail::ShapeWriter writer_;
  ResponseTick<Contacts> tick_;
  std::array<ResponseContact<S>, Contacts> last_{};
  std::size_t last_count_ = 0;
  std::array<Vec3<S>, Contacts> forces_{};
};

}  // namespace palpate
