// SPDX-License-Identifier: MIT
#pragma once

/// @file The shape: contacts to the vertices of a display mesh by a deformation model, beside the servo loop
/// for the pictures and within it for detection against the shape as it is now; and the frames that are kept
/// of it.

#include <palpate/geometry/deformed_surface.hpp>
#include <palpate/geometry/mesh_extremal_points.hpp>
#include <palpate/luo_xiao/beam/region_skeletons.hpp>
#include <palpate/luo_xiao/interpolation/partition.hpp>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "felt.hpp"

namespace palpate {
class ResponseField;
}

namespace touch {

/// One kept moment.
struct Frame {
  double t;  ///< [s]
  Felt felt;
  std::vector<V> position, normal;  ///< of the display mesh's vertices [m], [-]

  /// All that the tool feels [N].
  [[nodiscard]] V force() const { return felt.wrench.force; }
};

/// A very soft rubber; the paper does not give E.
inline const palpate::IsotropicElasticity<S> rubber({.E = 1e5, .nu = 0.5});

/// Beams from each contact to the extremal points and to the other contacts.
using Beams = palpate::RegionSkeletons<palpate::Skeleton<S>, palpate::CoupledRegions, most_regions>;

template <class Body>
[[nodiscard]] Beams make_beams(const Body& body) {
  std::vector<V> ends;
  for (const auto& point : extremal_points(body)) ends.push_back(point.position);
  return Beams(palpate::Skeleton<S>(ends, palpate::EulerBernoulli<S>(rubber),
                                    palpate::VolumePreserving<S>({.volume = body.volume()})));
}

/// Where the paper's model is fixed: the body's lowest point under its middle [m].
template <class Body>
[[nodiscard]] V bottom(const Body& body) {
  const V middle = (body.lower() + body.upper()) / 2;
  return body.raycast(V(middle.x(), body.lower().y() - 1, middle.z()), V::UnitY()).position;
}

/// A display mesh that a deformation model moves; the model's type is forgotten here. A copy is a shape of
/// its own.
class Shape {
 public:
  using Contacts = std::span<const palpate::ContactState<S>>;

  template <palpate::DeformationModel Model>
  Shape(palpate::MeshData<S> mesh, Model model,
        std::optional<palpate::AreaNeighbourhood<S>> neighbourhood = {})
      : mesh_(std::move(mesh)),
        position_(mesh_.vertices.size()),
        normal_(mesh_.vertices.size()),
        neighbourhood_(std::move(neighbourhood)) {
    model.write_rest(buffer());
    write_ = [model = std::move(model)](Contacts contacts, const Buffer& out) mutable {
      return model.write(contacts, out).vertices;
    };
  }

  /// What the shape was worked out with, where it was: a force can be had from it too.
  std::shared_ptr<const palpate::ResponseField> field;

  /// Takes over the newest contacts. False: nothing moved. No heap, no locks: a servo loop may call it.
  bool update(const Felt& felt) noexcept {
    const auto begin = std::chrono::steady_clock::now();
    const std::size_t moved = write_(Contacts(felt.contacts.begin(), felt.contacts.size()), buffer());
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    if (moved == 0) return false;
    seconds_ += spent.count();
    ++updates_;
    return true;
  }
  [[nodiscard]] std::span<const V> positions() const noexcept { return position_; }
  /// From now on only positions are written, for those who do not draw it.
  void drop_normals() noexcept { with_normals_ = false; }
  [[nodiscard]] Frame frame(double t, const Felt& felt) const { return {t, felt, position_, normal_}; }

  [[nodiscard]] const palpate::MeshData<S>& rest() const noexcept { return mesh_; }
  /// w, the local neighbourhood's factor of D; 1 where the model has none.
  [[nodiscard]] S factor(const palpate::ContactState<S>& contact) const noexcept {
    if (!neighbourhood_) return 1;
    return neighbourhood_->factor({.area = contact.area, .points = static_cast<S>(contact.points)});
  }
  [[nodiscard]] std::size_t updates() const noexcept { return updates_; }
  /// Mean time of an update that moved something [s].
  [[nodiscard]] double mean_time() const noexcept {
    return updates_ > 0 ? seconds_ / static_cast<double>(updates_) : 0;
  }

 private:
  using Buffer = palpate::VertexBuffer<S>;

  [[nodiscard]] Buffer buffer() noexcept {
    return {.positions = position_.front().data(),
            .position_stride = sizeof(V),
            .normals = with_normals_ ? normal_.front().data() : nullptr,
            .normal_stride = sizeof(V)};
  }

  palpate::MeshData<S> mesh_;
  std::vector<V> position_, normal_;
  std::optional<palpate::AreaNeighbourhood<S>> neighbourhood_;
  std::function<std::size_t(Contacts, const Buffer&)> write_;
  bool with_normals_ = true;
  double seconds_ = 0;
  std::size_t updates_ = 0;
};

/// After each tick a DeformedSurface takes the shape of that tick.
struct FollowShape {
  Shape shape;
  S highest = 0;  ///< bulge so far [m]

  explicit FollowShape(const Shape& drawn) : shape(drawn) { shape.drop_normals(); }
  template <class Solver>
  void operator()(const Felt& felt, Solver& solver) noexcept {
    if (!shape.update(felt)) return;
    auto& object = solver.mutable_object();
    object.update(shape.positions());
    highest = (std::max)(highest, object.highest_bulge());
  }
};

/// The paper's model: skeleton, released ends, interpolation. `fixed`: a point that stays where it is [m].
[[nodiscard]] Shape skeleton_shape(const Beams& beams, palpate::FacePartition<S> partition, const V& fixed,
                                   const palpate::MeshData<S>& mesh);

/// The models that need the mesh alone: half-space and response. Everything below y = `fixed_below` [m] is
/// fixed.
[[nodiscard]] Shape mesh_shape(const std::string& model, const palpate::MeshData<S>& mesh, S fixed_below);

/// By the model's name. The lowest tenth of the body is fixed, for the models that need a region.
template <class Body>
[[nodiscard]] Shape make_shape(const std::string& model, const Body& body, const palpate::MeshData<S>& mesh) {
  if (model == "skeleton")
    return skeleton_shape(make_beams(body), palpate::make_partition(body, mesh, bottom(body)), bottom(body),
                          mesh);
  return mesh_shape(model, mesh, body.lower().y() + S(0.1) * (body.upper().y() - body.lower().y()));
}

}  // namespace touch
