// SPDX-License-Identifier: MIT
#pragma once

/// @file  The tick of a response field: contacts in; forces and the surface's displacement out.

#include <palpate/core/status.hpp>
#include <palpate/display/vertex_writer.hpp>
#include <palpate/response/tick/contact_system.hpp>
#include <palpate/response/tick/drawing.hpp>
#include <palpate/response/tick/field_sum.hpp>
#include <palpate/response/tick/instances.hpp>

namespace palpate {

/// Solves up to `Capacity` coupled contacts (contact_system.hpp) and writes the field. Holds the buffers; no
/// heap after construction. The field must outlive it.
template <std::size_t Capacity = 4>
class ResponseTick {
 public:
  using Settings = typename detail::ContactSystem<Capacity>::Settings;
  explicit ResponseTick(const ResponseField& field, const Settings& settings = {})
      : field_(&field), contact_(field, settings), sum_(field), drawing_(field) {}

  /// Forces that the tool exerts on the object, one per contact [N]; with `torques` its torques about the
  /// patches' middles, where they have moved to [N m]. More than `Capacity` contacts: the surplus gets no
  /// force, region_overflow. A contact that is not finite, or whose radius or normal is absurd: no forces and
  /// no field for any, invalid_pose.
  template <Real S>
  Status solve(const ResponseContact<S>* contacts, std::size_t count, Vec3<S>* forces,
               Vec3<S>* torques = nullptr) noexcept {
    for (std::size_t c = 0; c < count; ++c) forces[c].setZero();
    for (std::size_t c = 0; c < count && torques != nullptr; ++c) torques[c].setZero();
    count_ = (std::min)(count, Capacity);
    Status status = count > Capacity ? Status::region_overflow : Status::ok;
    for (std::size_t c = 0; c < count_; ++c) {
      if (!is_usable(contacts[c])) {
        count_ = 0;
        return status | Status::invalid_pose;
      }
      contact_.place(c, indenter(contacts[c]));
    }
    if (count_ == 0) return status;
    contact_.solve(count_);
    const double mu = field_->shear_modulus();
    for (std::size_t c = 0; c < count_; ++c) forces[c] = (mu * contact_.force(c)).template cast<S>();
    for (std::size_t c = 0; c < count_ && torques != nullptr; ++c)
      torques[c] = (mu * contact_.torque(c, count_)).template cast<S>();
    return status | Status::contact;
  }

  /// One sphere alone; then `displace` writes its field.
  template <Real S>
  [[nodiscard]] PressedSphere solve(const SphereContact<S>& in) noexcept {
    count_ = 0;
    if (!is_usable(ResponseContact<S>{in.position, in.normal, in.radius, Vec3<S>(in.normal * in.depth)}) ||
        !is_finite(in.curvature) || !(in.depth > S(0)))
      return {};
    const Vec3<double> m = -in.normal.template cast<double>().normalized();
    count_ = 1;
    return contact_.solve_sphere({.x = in.position.template cast<double>(),
                                  .m = m,
                                  .d = double(in.depth) * m,
                                  .rotation = Vec3<double>::Zero(),
                                  .sphere = double(in.radius)},
                                 double(in.curvature));
  }

  /// Displacement of every bound vertex, after `solve`: component i of vertex v at out[v * stride + i].
  template <Real S>
  void displace(const ResponseDisplay& display, S* out, std::size_t stride) noexcept {
    Put<S> put{detail::VertexWriter<S>(out, stride * sizeof(S)), display.vertex()};
    each(display, put);
  }

  /// The same by calls of emit(slot, u), with a SIMD vector of displacements from that slot on; a vertex may
  /// have several slots, all the same. An `emit` that can be assigned is copied and put back.
  ///
  /// How: tick/field_sum.hpp, tick/drawing.hpp.
  template <class Emit>
  void each(const ResponseDisplay& display, Emit& emit) noexcept {
    sum_.add_up(contact_, count_);
    drawing_.read(sum_.total(), sum_.drawn());
    drawing_.each(display, sum_.drawn(), emit);
  }

 private:
  template <Real S>
  [[nodiscard]] static detail::Indenter indenter(const ResponseContact<S>& in) noexcept {
    return {.x = in.position.template cast<double>(),
            .m = -in.normal.template cast<double>().normalized(),
            .d = in.displacement.template cast<double>(),
            .rotation = in.rotation.template cast<double>(),
            .a = double(in.radius)};
  }
  template <Real S>
  struct Put {
    detail::VertexWriter<S> to;
    const std::uint32_t* vertex;
    PALPATE_INLINE void operator()(std::size_t slot,
                                   const detail::SimdVec3<detail::Simd4>& u) const noexcept {
      to.put_apart([this, slot](std::size_t k) { return vertex[slot + k]; }, u.x, u.y, u.z);
    }
  };

  const ResponseField* field_;
  detail::ContactSystem<Capacity> contact_;
  std::size_t count_ = 0;
  detail::FieldSum<Capacity> sum_;
  detail::ResponseDrawing<Capacity> drawing_;
};

}  // namespace palpate
