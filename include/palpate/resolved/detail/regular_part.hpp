// SPDX-License-Identifier: MIT
#pragma once

/// @file The regular part w of a response field between the points of a contact: gathered to the nodes
/// beneath them, a small matrix, and back. Per tick.

#include <palpate/core/fixed_vector.hpp>
#include <palpate/resolved/detail/bounded_list.hpp>
#include <palpate/resolved/detail/load_prisms.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/response/response_field.hpp>
#include <palpate/response/tick/solved_nodes.hpp>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace palpate::detail {

/// w_kl between nodes is read from the influence functions when a node comes in, and kept.
class RegularPart {
 public:
  using V = VectorList::V;
  static constexpr bool active = true;
  /// Nodes beneath a contact of so many points; points beyond them have no regular part. Where a tool rests
  /// on a face of the body there may be more nodes than points. Chosen: 128 take 1.4 MB, 512 take 22.
  [[nodiscard]] static constexpr std::size_t most_nodes(std::size_t points) noexcept {
    return std::clamp<std::size_t>(points, 128, 512);
  }

  template <class Body>
  RegularPart(const Body& body, std::size_t capacity)
      : prisms_(body.field().load_mesh()),
        slot_of_(body.field().load_mesh().nodes().size(), none),
        most_((std::min)(most_nodes(capacity), slot_of_.size())),
        node_(most_, 0),
        tick_of_(most_, 0),
        index_(most_, 0),
        kept_(most_ * most_, Mat3<float>::Zero()),
        used_(most_),
        was_used_(most_),
        beside_(most_) {
    weights_.resize(capacity);
    for (auto* list : {&w_, &w_step_}) list->resize(capacity);
    const std::size_t padded = AlignedList<float>::padded(4 * most_);
    for (auto* list : {&load_, &u_, &u_of_all_, &u_beside_, &u_sway_}) list->resize(padded);
    matrix_.resize(padded * 3 * most_);
  }

  void clear() noexcept {
    ++tick_;
    size_ = 0;
    std::swap(used_, was_used_);
    used_.clear();
    has_all_ = true, sways_ = false;
    beside_.clear();
  }
  static constexpr std::uint32_t anywhere = ~0u;
  /// Points at feet, relative to `origin`. `triangle(i)` of the load mesh: where point i was, or anywhere;
  /// then where it is.
  template <class Body, class Triangle>
  void place_points(const Body& body, const Vec3<double>& origin, const VectorList& feet, std::size_t n,
                    const Triangle& triangle) noexcept {
    constexpr std::size_t many = LoadPrisms::V::size();
    const SimdVec3<LoadPrisms::V> shift = each((origin - prisms_.centre()).cast<float>());
    for (size_ = 0; size_ < n;) {
      const std::size_t first = size_, count = (std::min)(many, n - first);
      std::array<std::uint32_t, many> beneath{};
      for (std::size_t k = 0; k < count; ++k)
        if (triangle(first + k) != anywhere) beneath[k] = triangle(first + k);
      const LoadPrisms::Places at = prisms_.locate(shift + feet.load(first), beneath);
      for (std::size_t k = 0; k < count; ++k, ++size_) {
        std::uint32_t& t = triangle(size_);
        if (t != anywhere && at.found[k] > 0) {
          const float rest = (std::max)(1 - at.q[k] - at.r[k], 0.f);
          put(body.field(), t, {rest, at.q[k], at.r[k]}, share_at(at.far2[k]), weights_[size_], true);
        } else {
          place(body.field(), origin + feet[size_].template cast<double>(), t, weights_[size_], true);
        }
      }
    }
    nodes_ = used_.size();
  }
  /// One point, at x in object coordinates; `triangle` likewise.
  template <class Body>
  void place_point(const Body& body, const Vec3<double>& x, std::uint32_t& triangle) noexcept {
    place(body.field(), x, triangle, weights_[0], true);
    size_ = 1;
  }
  /// A load P of another tool, at x in object coordinates; `triangle` likewise.
  template <class Body>
  void add_beside(const Body& body, const Vec3<double>& x, std::uint32_t& triangle,
                  const Vec3<float>& P) noexcept {
    Weights weights;
    place(body.field(), x, triangle, weights, true);
    for (const Weight& w : weights) {
      while (beside_.size() <= w.node) beside_.push_back(Four{});
      beside_[w.node] += Four(w.value) * Four(P.x(), P.y(), P.z(), 0.f);
    }
  }
  /// The matrix between the nodes in use.
  void build() noexcept {
    stride_ = padded<Group>(4 * used_.size());
    if (!changed_ && std::equal(used_.begin(), used_.end(), was_used_.begin(), was_used_.end())) return;
    changed_ = false;
    common_.setZero();
    for (std::size_t l = 0; l < nodes_; ++l)
      for (std::size_t k = 0; k < nodes_; ++k) common_ += kept(used_[k], used_[l]);
    if (nodes_ > 0) common_ /= static_cast<float>(nodes_ * nodes_);
    for (std::size_t l = 0; l < used_.size(); ++l)
      for (std::size_t c = 0; c < 3; ++c) {
        float* const column = &matrix_[(3 * l + c) * stride_];
        for (std::size_t k = 0; k < used_.size(); ++k) {
          const Mat3<float>& w = kept(used_[k], used_[l]);
          for (std::size_t r = 0; r < 3; ++r) column[4 * k + r] = w(Eigen::Index(r), Eigen::Index(c));
          column[4 * k + 3] = 0;
        }
        for (std::size_t i = 4 * used_.size(); i < stride_; ++i) column[i] = 0;
      }
  }

  /// What all loads do to all points: w's mean over the points' nodes [1/m].
  [[nodiscard]] Mat3<float> common() const noexcept {
    return is_left_out_ ? Mat3<float>(Mat3<float>::Zero()) : common_;
  }
  /// False where nodes were left out.
  [[nodiscard]] bool has_all() const noexcept { return has_all_; }

  /// After a tick's solve: what the loads q have moved the contact by.
  void keep(const float* q) noexcept {
    if (is_left_out_) return;
    V loads{};
    SimdVec3<V> moved{};
    for (std::size_t i = 0; i < size_; i += V::size()) {
      const V qi(q + i);
      loads += qi, moved += qi * w_.load(i);
    }
    const float load = reduce(loads);
    if (load > 0)
      moved_ = sum_of(moved) / load;
    else
      moved_.setZero();
  }
  /// Until take_in() loads have no response: K + W was not positive definite, as it is not where a body is
  /// fixed at few elements, or too thin for them. The contact stays where the last tick moved it, so that its
  /// force goes on. False if W was left out before.
  bool leave_out() noexcept {
    begin_response();
    return !std::exchange(is_left_out_, true);
  }
  void take_in() noexcept {
    is_left_out_ = false;
    moved_.setZero();
  }
  /// Goes on from the last tick of `other`, of the same body.
  void take_over(const RegularPart& other) noexcept {
    is_left_out_ = other.is_left_out_;
    moved_ = other.moved_;
  }
  [[nodiscard]] bool is_left_out() const noexcept { return is_left_out_; }
  /// By what the contact is moved without its loads [m].
  [[nodiscard]] Vec3<float> moved() const noexcept {
    return is_left_out_ ? moved_ : Vec3<float>(Vec3<float>::Zero());
  }

  /// u += w along the directions of pressing, by loads q along them.
  void add(const PointSystem& system, const float* q, float* u) noexcept {
    if (is_left_out_) return;
    gather([&](std::size_t i) { return Vec3<float>(q[i] * system.direction(i)); }, u_);
    for (std::size_t i = 0; i < size_; ++i) u[i] += system.direction(i).dot(of(i));
  }
  /// No loads yet that response() and normal_at() tell of.
  void begin_response() noexcept {
    for (std::size_t i = 0; i < size_; i += V::size()) w_.store(i, {});
    std::fill_n(u_of_all_.data(), stride_, 0.f);
  }
  /// u += w by loads P, which come to those of response().
  void add(const PointSystem&, const VectorList& P, VectorList& u) noexcept {
    if (is_left_out_) return;
    extend(P);
    for (std::size_t i = 0; i < size_; i += V::size()) u.store(i, u.load(i) + w_step_.load(i));
  }
  /// Of loads P alone.
  void respond(const VectorList& P) noexcept {
    begin_response();
    if (!is_left_out_) extend(P);
  }
  [[nodiscard]] const VectorList& response() const noexcept { return w_; }  ///< w at the points
  /// The nodes' displacements by what other tools push with.
  void gather_beside() noexcept {
    std::fill_n(load_.data(), stride_, 0.f);
    for (std::size_t k = 0; k < beside_.size(); ++k) store(&load_[4 * k], beside_[k]);
    multiply(u_beside_);
  }
  /// w at point i of that.
  [[nodiscard]] Vec3<float> beside(std::size_t i) const noexcept { return at(weights_[i], u_beside_); }
  /// Until clear() the body sways under loads q(i) p at the points, which are not those of response(): the
  /// mean by q of what it does to the points, which is returned, and the nodes by what is not in it.
  template <class Load>
  Vec3<float> sway(const Load& q, const Vec3<float>& p) noexcept {
    gather([&](std::size_t i) -> Vec3<float> { return q(i) * p; }, u_sway_);
    float load = 0;
    Vec3<float> sum = Vec3<float>::Zero();
    for (std::size_t i = 0; i < size_; ++i) load += q(i), sum += q(i) * swayed(i);
    const Vec3<float> mean = load > 0 ? sum / load : sum;
    for (std::size_t i = 0; i < stride_; i += 4)
      store(&u_sway_[i], Four(&u_sway_[i]) - Four(mean.x(), mean.y(), mean.z(), 0.f));
    sways_ = true;
    return mean;
  }
  /// Then what point i is displaced by beyond the mean.
  [[nodiscard]] Vec3<float> swayed(std::size_t i) const noexcept { return at(weights_[i], u_sway_); }
  /// w along m at a further point, by the loads of response(), with others' loads and sway if there are any.
  template <class Body>
  [[nodiscard]] float normal_at(const Body& body, const Vec3<double>& x, std::uint32_t& triangle,
                                const Vec3<float>& m) noexcept {
    Weights weights;
    place(body.field(), x, triangle, weights, false);
    Vec3<float> w = moved() + at(weights, u_of_all_);
    if (!beside_.empty()) w += at(weights, u_beside_);
    if (sways_) w += at(weights, u_sway_);
    return m.dot(w);
  }

 private:
  using Group = simd_group<float>;
  using Four = Simd<float, 4>;  // a vector of space in a register
  static constexpr std::uint16_t none = 0xffff;
  struct Weight {
    std::uint16_t node;  // among those in use
    float value;
  };
  using Weights = FixedVector<Weight, LoadMesh::most_beneath>;

  [[nodiscard]] Mat3<float>& kept(std::size_t k, std::size_t l) noexcept { return kept_[k * most_ + l]; }

  // Weights at the solved nodes around x. Nodes that are not in use come in if `take_in`.
  void place(const ResponseField& field, const Vec3<double>& x, std::uint32_t& triangle, Weights& weights,
             bool take_in) noexcept {
    const LoadMesh& mesh = field.load_mesh();
    const LoadPosition position = triangle == anywhere ? mesh.locate(x) : mesh.locate(x, triangle);
    triangle = position.triangle;
    const double share = regular_share(position, mean_of(&LoadNode::size, field, position));
    put(field, triangle, position.weight.cast<float>(), static_cast<float>(share), weights, take_in);
  }
  // Weights of the solved nodes beneath a triangle, of its corners' weights.
  void put(const ResponseField& field, std::uint32_t triangle, const Vec3<float>& corners, float share,
           Weights& weights, bool take_in) noexcept {
    weights.clear();
    for (const LoadMesh::Beneath& b : field.load_mesh().beneath(triangle)) {
      const float weight = b.part.dot(corners);
      if (!(weight > 0)) continue;
      const std::uint16_t index = take_in ? use(field, b.node) : in_use(b.node);
      if (index != none) weights.push_back({index, weight * share});
    }
  }
  // The node's index among those in use, or none.
  [[nodiscard]] std::uint16_t in_use(std::uint32_t node) const noexcept {
    const std::uint16_t slot = slot_of_[node];
    return slot != none && tick_of_[slot] == tick_ ? index_[slot] : none;
  }
  std::uint16_t use(const ResponseField& field, std::uint32_t node) noexcept {
    std::uint16_t slot = slot_of_[node];
    if (slot == none) {
      if (used_.full()) {
        has_all_ = false;
        return none;
      }
      slot = 0;  // the one that was in use longest ago
      for (std::uint16_t k = 1; k < most_; ++k)
        if (tick_of_[k] < tick_of_[slot]) slot = k;
      if (tick_of_[slot] != 0) slot_of_[node_[slot]] = none;
      slot_of_[node] = slot;
      node_[slot] = node;
      tick_of_[slot] = tick_ - 1;
      read(field, slot);
    }
    if (tick_of_[slot] != tick_) {
      tick_of_[slot] = tick_;
      index_[slot] = static_cast<std::uint16_t>(used_.size());
      used_.push_back(slot);
    }
    return index_[slot];
  }
  // 4 pi mu w between a node and all that are kept, sharpened at both (InfluenceFunctions): by reciprocity
  // the mean of both ways.
  void read(const ResponseField& field, std::size_t k) noexcept {
    changed_ = true;
    for (std::size_t l = 0; l < most_; ++l) {
      if (tick_of_[l] == 0) continue;
      Mat3<double> kl, lk;
      for (std::size_t c = 0; c < 3; ++c) {
        kl.col(Eigen::Index(c)) = field.at(node_[k], node_[l], ResponseField::sharpened + c);
        lk.col(Eigen::Index(c)) = field.at(node_[l], node_[k], ResponseField::sharpened + c);
      }
      const Mat3<float> w = (2 * std::numbers::pi * (kl + lk.transpose())).cast<float>();
      kept(k, l) = w;
      kept(l, k) = w.transpose();
    }
  }

  // The nodes' displacements u by load(i) at the points.
  template <class Load>
  void gather(const Load& load, AlignedList<float>& u) noexcept {
    float* const f = load_.data();
    std::fill_n(f, stride_, 0.f);
    for (std::size_t i = 0; i < size_; ++i) {
      const Vec3<float> P = load(i);
      const Four P4(P.x(), P.y(), P.z(), 0.f);
      for (const Weight& w : weights_[i]) store(f + 4 * w.node, Four(f + 4 * w.node) + Four(w.value) * P4);
    }
    multiply(u);
  }
  // Takes loads P into the response.
  void extend(const VectorList& P) noexcept {
    gather([&](std::size_t i) { return P[i]; }, u_);
    for (std::size_t i = 0; i < stride_; i += V::size())
      (V(&u_of_all_[i]) + V(&u_[i])).copy_to(&u_of_all_[i]);
    for (std::size_t i = 0; i < size_; ++i) w_step_.set(i, of(i));
    for (std::size_t i = size_; i < padded<V>(size_); ++i) w_step_.set(i, Vec3<float>::Zero());
    for (std::size_t i = 0; i < size_; i += V::size()) w_.store(i, w_.load(i) + w_step_.load(i));
  }
  // w at point i, of what was gathered last.
  [[nodiscard]] Vec3<float> of(std::size_t i) const noexcept { return at(weights_[i], u_); }
  // u = w load_ at the nodes.
  void multiply(AlignedList<float>& u) noexcept {
    const float* const f = load_.data();
    for (std::size_t i = 0; i < stride_; i += Group::size()) {  // some of u at a time through all columns
      Group sum{};
      const float* column = &matrix_[i];
      for (std::size_t j = 0; j < used_.size(); ++j)
        for (std::size_t c = 0; c < 3; ++c, column += stride_)
          sum += simd_factor<float>(f[4 * j + c]) * Group(column);
      store(&u[i], sum);
    }
  }
  [[nodiscard]] static Vec3<float> at(const Weights& weights, const AlignedList<float>& u) noexcept {
    Four sum{};
    for (const Weight& w : weights) sum += Four(w.value) * Four(&u[4 * w.node]);
    return {sum[0], sum[1], sum[2]};
  }

  LoadPrisms prisms_;
  std::vector<std::uint16_t> slot_of_;  // of a load mesh's node, or none
  std::size_t most_;                    // slots
  std::vector<std::uint32_t> node_;     // of a slot
  std::vector<std::uint32_t> tick_of_;  // when a slot was in use last; 0: never
  std::vector<std::uint16_t> index_;    // of a slot, among those in use
  std::vector<Mat3<float>> kept_;       // between slots
  std::vector<Weights> weights_;        // of the points
  VectorList w_, w_step_;               // at the points: of all loads, of those that came last
  BoundedList<std::uint16_t> used_, was_used_;
  AlignedList<float> load_, u_;                      // of the nodes in use, four numbers each
  AlignedList<float> u_of_all_, u_beside_, u_sway_;  // likewise: of response(), by others' loads, of sway()
  BoundedList<Four> beside_;                         // loads of other tools, likewise
  AlignedList<float> matrix_;                        // by column
  Mat3<float> common_ = Mat3<float>::Zero();
  std::size_t size_ = 0, stride_ = 0, nodes_ = 0;  // nodes_: in use by points
  std::uint32_t tick_ = 2;
  bool changed_ = true, has_all_ = true, is_left_out_ = false, sways_ = false;
  Vec3<float> moved_ = Vec3<float>::Zero();
};

}  // namespace palpate::detail
