// SPDX-License-Identifier: MIT
#pragma once

/// @file The field of solved contacts at the vertices of the boundary element mesh. Per tick.
///
///     u = f (sum_c [sum_k (g_k P + A q_k) . w_k + share sum_k (other loads) . w_k + u_near,c] + q)
///
/// | symbol   | name                                                                        |
/// |----------|-----------------------------------------------------------------------------|
/// | w_k      | influence functions of load mesh's node k: regular part of unit loads there |
/// | g_k, q_k | node k's part of the contact's force, of its moments (placement.hpp)        |
/// | A        | tensor of the loads that bond a wide patch (patch_moments.hpp)              |
/// | u_near   | near field of the contact (near_field.hpp); q: rotation_correction.hpp      |
/// | share, f | bounds of what the mesh does not resolve (constants.hpp)                    |

#include <palpate/response/tick/contact_system.hpp>
#include <palpate/response/tick/drawing.hpp>
#include <palpate/response/tick/rotation_correction.hpp>
#include <palpate/response/tick/vertex_field.hpp>

namespace palpate::detail {

/// Holds the buffers; no heap after construction. The field must outlive it.
template <std::size_t Capacity>
class FieldSum {
 public:
  explicit FieldSum(const ResponseField& field)
      : field_(&field),
        total_(3 * field.stride(), 0.f),
        second_(3 * field.stride(), 0.f),
        near_(Capacity * 3 * field.stride(), 0.f),
        weight_(field.load_mesh().solved(), 0.f),
        moment_(3 * field.load_mesh().solved(), 0.f),
        rotation_(field) {
    patch_.reserve(weight_.size());
  }

  /// Adds up the field of the first `count` contacts, all solved.
  void add_up(const ContactSystem<Capacity>& contacts, std::size_t count) noexcept;
  /// The field, by coordinate, `stride()` numbers each [m].
  [[nodiscard]] const float* total() const noexcept { return total_.data(); }
  [[nodiscard]] DrawnContacts drawn() const noexcept { return {{drawn_.data(), count_}, near_.data()}; }

 private:
  using Row = Eigen::Map<const Eigen::ArrayXf>;
  [[nodiscard]] static Eigen::Map<Eigen::ArrayXf> all(std::vector<float>& list) noexcept {
    return {list.data(), static_cast<Eigen::Index>(list.size())};
  }
  // Influence function l of a solved node.
  [[nodiscard]] Row influence(std::uint32_t node, std::size_t l) const noexcept {
    return {field_->influence(node, l), static_cast<Eigen::Index>(total_.size())};
  }

  void add_contact(const ContactSystem<Capacity>& contacts, std::size_t c) noexcept {
    const double carried = add_force(contacts, c);
    if (has_loads(contacts.placed(c).tool, contacts.second(c))) add_loads(contacts, c);
    construct(drawn_[c], [&] { return contacts.drawn(c); });
    if (carried < 1) drawn_[c].near = drawn_[c].near.scaled(static_cast<float>(carried));
    add_near(c);
  }
  // Influence functions of the force and of a wide patch's moments. Returns the part of the force that is
  // carried.
  double add_force(const ContactSystem<Capacity>& contacts, std::size_t c) noexcept {
    const PlacedContact& placed = contacts.placed(c);
    const PatchMoments& moments = contacts.bonded(c).moments;
    const SolvedContact& solved = contacts.solved(c);
    const double loaded2 = placed.tool.loaded2(solved.a),
                 carried = spread_force(*field_, placed, loaded2, weight_.data(), patch_);
    const bool wide = moments.share > 0;
    Mat3<float> A = Mat3<float>::Zero();
    if (wide) {
      spread_moments(*field_, placed, loaded2, weight_.data(), moment_.data());
      A = moments.tensor(solved.y).template cast<float>();
    }
    auto sum = all(total_);
    for (auto node : patch_) {
      Vec3<float> f = weight_[node] * solved.P.template cast<float>();
      if (wide) {
        Eigen::Map<Vec3<float>> q(&moment_[3 * node]);
        f += A * q;
        q.setZero();
      }
      sum += f[0] * influence(node, 0) + f[1] * influence(node, 1) + f[2] * influence(node, 2);
    }
    for (auto node : patch_) weight_[node] = 0;
    return carried;
  }
  // Influence functions of the loads beside the force. Where the mesh does not resolve them they can have any
  // size, so they are bounded by about 2 d.
  void add_loads(const ContactSystem<Capacity>& contacts, std::size_t c) noexcept {
    const PlacedContact& placed = contacts.placed(c);
    const SecondOrderContact& loads = contacts.second(c);
    const double torsion = contacts.bonded(c).rotation.torsion;
    auto second = all(second_);
    second.setZero();
    for (const NodeWeight& at : placed.nodes) {
      const Vec3<float> g =
          (placed.regular * at.weight * loads_of_node(*field_, at.node, loads.dipole, loads.couple))
              .template cast<float>();
      if (loads.couple.squaredNorm() > 0)
        second += g[0] * influence(at.node, 3) + g[1] * influence(at.node, 4) + g[2] * influence(at.node, 5);
      else
        second += g[0] * influence(at.node, 3);
      if (torsion != 0)
        second += static_cast<float>(placed.regular * at.weight * torsion) * influence(at.node, 6);
    }
    const double share =
        smooth_limit(max2(*field_, second_.data()), tick::max_load_field2 * placed.displacement2);
    all(total_) += static_cast<float>(share) * second;
  }
  void add_near(std::size_t c) noexcept {
    const std::size_t n = field_->stride();
    float* const own = &near_[c * 3 * n];
    near_at_vertices(*field_, drawn_[c].near, own);
    all(total_) += Row(own, static_cast<Eigen::Index>(total_.size()));
  }

  // The rotation correction, times the contacts' share of second order; bounded by 2 d.
  void add_rotation(const ContactSystem<Capacity>& contacts) noexcept {
    double share = 1;
    for (std::size_t c = 0; c < count_; ++c)
      share = (std::min)(share, std::lerp(1., contacts.second(c).share, contacts.bonded(c).activation));
    if (count_ == 0 || share == 0) return;
    const float largest =
        rotation_.find(total_.data(), near_.data(), drawn().contact, contacts.constants(), second_.data());
    share *= smooth_limit(double(largest), tick::max_rotation_field2 * contacts.max_displacement2(count_));
    all(total_) += static_cast<float>(share) * all(second_);
  }
  // A field beyond 4 d is one that the mesh does not resolve. It is scaled down, so that no spike is drawn.
  void limit(const ContactSystem<Capacity>& contacts) noexcept {
    const auto share = static_cast<float>(
        smooth_limit(max2(*field_, total_.data()), tick::max_field2 * contacts.max_displacement2(count_)));
    if (!(share < 1)) return;
    all(total_) *= share;
    all(near_).head(static_cast<Eigen::Index>(3 * count_ * field_->stride())) *= share;
    for (std::size_t c = 0; c < count_; ++c) drawn_[c].near = drawn_[c].near.scaled(share);
  }

  const ResponseField* field_;
  std::array<DrawnContact, Capacity> drawn_{};
  std::size_t count_ = 0;
  std::vector<float> total_;          // the field at the mesh's vertices, by coordinate
  std::vector<float> second_;         // scratch
  std::vector<float> near_;           // near field per contact, likewise
  std::vector<float> weight_;         // per solved node: its part of a contact's force; 0 between uses
  std::vector<float> moment_;         // three numbers each, likewise
  std::vector<std::uint32_t> patch_;  // nodes with a part; never more than reserved
  RotationCorrection<Capacity> rotation_;
};

template <std::size_t Capacity>
void FieldSum<Capacity>::add_up(const ContactSystem<Capacity>& contacts, std::size_t count) noexcept {
  all(total_).setZero();
  count_ = count;
  for (std::size_t c = 0; c < count; ++c) add_contact(contacts, c);
  hold_fixed(*field_, total_.data());
  add_rotation(contacts);
  limit(contacts);
}

}  // namespace palpate::detail
