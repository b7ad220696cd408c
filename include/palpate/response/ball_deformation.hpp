// SPDX-License-Identifier: MIT
#pragma once

/// @file Deformation model from a response field for a ball: the contact area grows with depth.

#include <palpate/elasticity/concept.hpp>
#include <palpate/response/response_contact.hpp>
#include <palpate/response/tick/shape_writer.hpp>

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

/// The first contact to vertices, as a ball presses it: a frictionless sphere as deep as D_n
/// (response_contact.hpp), and added to its field that of a bonded patch with the sphere's contact radius
/// which moves by D_t. The contact is that of the ball's centre with the body grown by the ball's radius
/// (geometry/grown_surface.hpp).
///
/// | symbol | name             | unit | range                                                           |
/// |--------|------------------|------|-----------------------------------------------------------------|
/// | R      | `Params::radius` | m    | > 0: of the ball                                                |
/// | D      | `displacement`   | m    | of the contact; D_n, D_t: its parts along and across the normal |
/// |        | first touch      | m    | on the undeformed surface: `origin()` of the contact less R n   |
///
/// `Body` gives the surface's curvature there; without `curvature()` it counts as flat. Further contacts are
/// left out, region_overflow; one that is not finite is left out, invalid_pose. With the same contact as in
/// the last write nothing is read or written. Limit: the two fields are added, so what they do to each other
/// is left out, second order in depth. Set-up reports a radius that is not > 0, and a mesh that is not finite
/// or, with normals, not closed.
template <Real S, class Body>
class ResponseBallDeformation {
 public:
  using Scalar = S;
  static constexpr bool active = true;

  struct Params {
    S radius;             ///< R [m]
    bool normals = true;  ///< written where the buffer takes them
  };

  /// `mesh`: what is drawn, bound to the field once; any mesh of the same body.
  template <Real M>
  ResponseBallDeformation(std::shared_ptr<const ResponseField> field, const MeshData<M>& mesh, Body body,
                          const Params& params)
      : p_(params),
        field_(std::move(field)),
        body_(std::move(body)),
        writer_(*field_, mesh, p_.normals),
        tick_(*field_),
        dragged_(3 * writer_.display().slots()) {
    require_positive(p_.radius, "ResponseBallDeformation", "radius [m] must be > 0");
  }

  template <Real T>
  void write_rest(const VertexBuffer<T>& out) noexcept {
    last_ = {};
    writer_.write_rest(out);
  }

  /// Writes the shape under the first of `contacts`, unless it is the one already there.
  template <Real T>
  Moved<S> write(std::span<const ContactState<S>> contacts, const VertexBuffer<T>& out) noexcept {
    Status status = contacts.size() > 1 ? Status::region_overflow : Status::ok;
    Pressed now;
    if (!contacts.empty()) {
      const ContactState<S>& c = contacts.front();
      const S depth = -c.displacement.dot(c.normal);
      now = {{c.origin() - p_.radius * c.normal, c.normal, p_.radius, S(0), depth},
             tangential<S>(c.displacement, c.normal)};
      if (!is_usable(now.patch(p_.radius))) {
        now = {};
        status |= Status::invalid_pose;
      } else if constexpr (HasCurvature<Body>) {
        const Curvature<S> k = body_.curvature(now.ball.position);
        now.ball.curvature = k.k1 + k.k2;
      }
    }
    Moved<S> moved;
    if (out.positions != nullptr && !(now == last_)) {
      last_ = now;
      moved = draw(out);
    }
    moved.status = status;
    return moved;
  }

  /// The sphere of the last write, as the field has it.
  [[nodiscard]] const PressedSphere& pressed() const noexcept { return pressed_; }
  [[nodiscard]] const ResponseField& field() const noexcept { return *field_; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  struct Pressed {
    SphereContact<S> ball{};
    Vec3<S> across = Vec3<S>::Zero();  // D_t [m]

    [[nodiscard]] ResponseContact<S> patch(S radius) const noexcept {
      return {.position = ball.position, .normal = ball.normal, .radius = radius, .displacement = across};
    }
    [[nodiscard]] bool operator==(const Pressed& other) const noexcept {
      return ball.position == other.ball.position && ball.normal == other.ball.normal &&
             ball.depth == other.ball.depth && across == other.across;
    }
  };

  // Keeps displacements by slot.
  struct Keep {
    float *x, *y, *z;
    PALPATE_INLINE void operator()(std::size_t slot,
                                   const detail::SimdVec3<detail::Simd4>& u) const noexcept {
      detail::store(x + slot, u.x), detail::store(y + slot, u.y), detail::store(z + slot, u.z);
    }
  };
  // Adds those that were kept.
  template <class Put>
  struct Add {
    Keep kept;
    Put* put;
    PALPATE_INLINE void operator()(std::size_t slot,
                                   const detail::SimdVec3<detail::Simd4>& u) const noexcept {
      using Simd = detail::Simd4;
      (*put)(slot, detail::SimdVec3<Simd>{u.x + Simd(kept.x + slot), u.y + Simd(kept.y + slot),
                                          u.z + Simd(kept.z + slot)});
    }
  };

  template <Real T>
  Moved<S> draw(const VertexBuffer<T>& out) noexcept {
    const ResponseDisplay& display = writer_.display();
    pressed_ = tick_.solve(last_.ball);
    const S radius = static_cast<S>(pressed_.radius);
    const bool drags = last_.across.squaredNorm() > S(0) && is_usable(last_.patch(radius));
    if (!drags) return writer_.template write<S>(out, [&](auto& put) { tick_.each(display, put); });
    const std::size_t slots = display.slots();
    Keep keep{dragged_.data(), dragged_.data() + slots, dragged_.data() + 2 * slots};
    const ResponseContact<S> patch = last_.patch(radius);
    Vec3<S> force;
    tick_.solve(&patch, 1, &force);
    tick_.each(display, keep);
    pressed_ = tick_.solve(last_.ball);
    return writer_.template write<S>(out, [&](auto& put) {
      Add<std::remove_reference_t<decltype(put)>> add{keep, &put};
      tick_.each(display, add);
    });
  }

  Params p_;
  std::shared_ptr<const ResponseField> field_;
  Body body_;
  detail::ShapeWriter writer_;
  ResponseTick<1> tick_;
  std::vector<float> dragged_;  // displacements by D_t, by slot and axis
  Pressed last_;
  PressedSphere pressed_;
};

}  // namespace palpate
