// SPDX-License-Identifier: MIT
#pragma once

/// @file  The tick of a response field: contacts in; forces and the surface's displacement out.

#include <palpate/core/status.hpp>
#include <palpate/display/vertex_writer.hpp>
#include <palpate/response/tick/contact_system.hpp>
#include <palpate/response/tick/drawing.hpp>
#include <palpate/response/tick/pressed_sphere.hpp>
#include <palpate/response/tick/turned_field.hpp>

namespace palpate {

/// Solves up to `Capacity` coupled contacts (contact_system.hpp) and writes the field. Holds the buffers; no
/// heap after construction. The field must outlive it.
template <std::size_t Capacity = 4>
class ResponseTick {
 public:
  using Settings = typename detail::ContactSystem<Capacity>::Settings;
  explicit ResponseTick(const ResponseField& field, const Settings& settings = {})
      : field_(&field),
        contact_(field, settings),
        total_(3 * field.stride(), 0.f),
        second_(3 * field.stride(), 0.f),
        near_(Capacity * 3 * field.stride(), 0.f),
        weight_(field.touch().solved(), 0.f),
        moment_(3 * field.touch().solved(), 0.f),
        turned_(field),
        drawing_(field) {
    patch_.reserve(weight_.size());
  }

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
      auto& k = contact_[c];
      k.x = contacts[c].place.template cast<double>();
      k.m = -contacts[c].normal.template cast<double>().normalized();
      k.d = contacts[c].displacement.template cast<double>();
      k.rotation = contacts[c].rotation.template cast<double>();
      k.a = double(contacts[c].radius);
      k.ball = 0;
      contact_.locate(k);
    }
    if (count_ == 0) return status;
    contact_.solve(count_);
    const double mu = field_->shear_modulus();
    for (std::size_t c = 0; c < count_; ++c)
      forces[c] = (mu * (contact_[c].P + contact_[c].extra)).template cast<S>();
    for (std::size_t c = 0; c < count_ && torques != nullptr; ++c)
      torques[c] = (mu * contact_.torque(c, count_)).template cast<S>();
    return status | Status::contact;
  }

  /// One sphere alone; then `displace` writes its field.
  template <Real S>
  [[nodiscard]] PressedSphere solve(const SphereContact<S>& in) noexcept {
    count_ = 0;
    if (!is_usable(ResponseContact<S>{in.place, in.normal, in.radius, Vec3<S>(in.normal * in.depth)}) ||
        !is_finite(in.curvature) || !(in.depth > S(0)))
      return {};
    auto& c = contact_[0];
    c.x = in.place.template cast<double>();
    c.m = -in.normal.template cast<double>().normalized();
    c.d = double(in.depth) * c.m;
    c.rotation.setZero();
    c.ball = double(in.radius);
    count_ = 1;
    return detail::press_sphere(*field_, contact_, c, double(in.curvature));
  }

  /// Displacement of every bound vertex, after `solve`: component i of vertex v at out[v * stride + i].
  template <Real S>
  void displace(const ResponseDisplay& display, S* out, std::size_t stride) noexcept {
    Put<S> put{detail::VertexWriter<S>(out, stride * sizeof(S)), display.vertex()};
    each(display, put);
  }

  /// The same, handed out: emit(slot, u) with a lane of displacements from that slot on; a vertex may have
  /// several slots, all the same. An `emit` that can be assigned is copied and put back.
  ///
  /// How: response_drawing.hpp.
  template <class Emit>
  void each(const ResponseDisplay& display, Emit& emit) noexcept {
    combine();
    drawing_.each(display, drawn(), emit);
  }

 private:
  using Wide = detail::FloatRegister;
  template <Real S>
  struct Put {
    detail::VertexWriter<S> to;
    const std::uint32_t* vertex;
    PALPATE_INLINE void operator()(std::size_t slot, const detail::Lane3& u) const noexcept {
      to.put_apart([this, slot](std::size_t k) { return vertex[slot + k]; }, u.x, u.y, u.z);
    }
  };

  // Near fields and columns of all contacts, summed at the solve mesh's vertices.
  void combine() noexcept {
    using Row = Eigen::Map<const Eigen::ArrayXf>;
    const std::size_t n = field_->stride();
    const auto size = static_cast<Eigen::Index>(total_.size());
    Eigen::Map<Eigen::ArrayXf> sum(total_.data(), size);
    sum.setZero();
    for (std::size_t c = 0; c < count_; ++c) {
      const auto& k = contact_[c];
      const double carried = contact_.find_patch(k, weight_.data(), patch_);
      const auto column = [&](std::uint32_t node, std::size_t l) {
        return Row(field_->column(node, l), size);
      };
      const bool wide = k.moments.share > 0;
      Mat3<float> held = Mat3<float>::Zero();
      if (wide) {
        contact_.find_moments(k, weight_.data(), moment_.data());
        held = k.moments.tensor(k.held).template cast<float>();
      }
      for (auto node : patch_) {
        Vec3<float> f = weight_[node] * k.P.template cast<float>();
        if (wide) {
          Eigen::Map<Vec3<float>> q(&moment_[3 * node]);
          f += held * q;
          q.setZero();
        }
        sum += f[0] * column(node, 0) + f[1] * column(node, 1) + f[2] * column(node, 2);
      }
      for (auto node : patch_) weight_[node] = 0;
      if (k.has_loads()) add_second(k);
      detail::ContactNear& near = near_field_[c] = contact_.near_of(k);
      if (carried < 1) near.scale(static_cast<float>(carried));
      float* own = &near_[c * 3 * n];
      for (std::size_t v = 0; v < n; v += detail::entries<Wide>) {
        const auto at = [this, v](int axis) {
          return detail::load_vector<Wide>(field_->coordinate(axis) + v);
        };
        const auto u = near(detail::Axes<Wide>{at(0), at(1), at(2)});
        detail::store_vector(own + v, u.x);
        detail::store_vector(own + n + v, u.y);
        detail::store_vector(own + 2 * n + v, u.z);
      }
      sum += Row(own, size);
    }
    const Row free(field_->is_free(), static_cast<Eigen::Index>(n));
    for (std::size_t axis = 0; axis < 3; ++axis) sum.segment(Eigen::Index(axis * n), Eigen::Index(n)) *= free;
    turn();
    hold_back();
    drawing_.read(total_.data(), drawn());
  }
  [[nodiscard]] detail::DrawnContacts<Capacity> drawn() const noexcept {
    return {contact_, near_field_, near_.data(), count_};
  }

  // What the body's rotation adds, as far as the contacts keep second order; held to twice d.
  void turn() noexcept {
    double kept = 1;
    for (std::size_t c = 0; c < count_; ++c)
      kept = (std::min)(kept, std::lerp(1., contact_[c].kept, contact_[c].grip));
    if (count_ == 0 || kept == 0) return;
    const float most =
        turned_.find(total_.data(), near_.data(), contact_, count_, contact_.constants(), second_.data());
    kept *= detail::smooth_limit(double(most), 4 * contact_.deepest2(count_));
    const auto size = static_cast<Eigen::Index>(total_.size());
    Eigen::Map<Eigen::ArrayXf>(total_.data(), size) +=
        static_cast<float>(kept) * Eigen::Map<const Eigen::ArrayXf>(second_.data(), size);
  }

  // A body may move farther than the tool by its levers; a field beyond 4 d is one that the mesh does not
  // resolve. It is drawn smaller: never a spike.
  void hold_back() noexcept {
    const auto share = static_cast<float>(detail::smooth_limit(largest(total_), 16 * contact_.deepest2(count_)));
    if (!(share < 1)) return;
    const std::size_t n = field_->stride();
    Eigen::Map<Eigen::ArrayXf>(total_.data(), static_cast<Eigen::Index>(total_.size())) *= share;
    Eigen::Map<Eigen::ArrayXf>(near_.data(), static_cast<Eigen::Index>(3 * count_ * n)) *= share;
    for (std::size_t c = 0; c < count_; ++c) near_field_[c].scale(share);
  }
  // Largest u^2 of a field at the solve mesh's vertices.
  [[nodiscard]] double largest(const std::vector<float>& field) const noexcept {
    const auto n = static_cast<Eigen::Index>(field_->stride());
    const Eigen::Map<const Eigen::ArrayXf> u(field.data(), 3 * n);
    return double((u.head(n).square() + u.segment(n, n).square() + u.tail(n).square()).maxCoeff());
  }

  // The body's answer to the loads of second order. Where the mesh does not resolve it, it can be any size:
  // held to about twice d.
  void add_second(const detail::PlacedContact& c) noexcept {
    using Row = Eigen::Map<const Eigen::ArrayXf>;
    const auto n = static_cast<Eigen::Index>(field_->stride()), size = 3 * n;
    Eigen::Map<Eigen::ArrayXf> second(second_.data(), size);
    second.setZero();
    for (const detail::PatchWeight& at : c.nodes) {
      const Vec3<float> g = (c.share * at.weight * detail::loads_of_node(*field_, at.node, c.dipole, c.tilt))
                                .template cast<float>();
      const auto column = [&](std::size_t l) { return Row(field_->column(at.node, l), size); };
      if (c.tilt.squaredNorm() > 0)
        second += g[0] * column(3) + g[1] * column(4) + g[2] * column(5);
      else
        second += g[0] * column(3);
      if (c.twist != 0) second += static_cast<float>(c.share * at.weight * c.twist) * column(6);
    }
    const double share = detail::smooth_limit(largest(second_), 4 * c.way2());
    Eigen::Map<Eigen::ArrayXf>(total_.data(), size) += static_cast<float>(share) * second;
  }

  const ResponseField* field_;
  detail::ContactSystem<Capacity> contact_;
  std::array<detail::ContactNear, Capacity> near_field_{};
  std::size_t count_ = 0;
  std::vector<float> total_;          // the field at the solve mesh's vertices, by coordinate
  std::vector<float> second_;         // scratch
  std::vector<float> near_;           // near field per contact, likewise
  std::vector<float> weight_;         // per solved node: its part of a contact's force; 0 between uses
  std::vector<float> moment_;         // three numbers each, likewise
  std::vector<std::uint32_t> patch_;  // nodes with a part; never more than reserved
  detail::TurnedField<Capacity> turned_;
  detail::ResponseDrawing<Capacity> drawing_;
};

}  // namespace palpate
