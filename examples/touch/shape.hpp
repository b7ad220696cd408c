// SPDX-License-Identifier: MIT
#pragma once

/// @file  The shape beside the servo loop: contacts from the triple buffer to the vertices of a display mesh, and the
/// frames that are kept of it.

#include <palpate/deformation/beam_skeleton.hpp>
#include <palpate/interpolation/phong.hpp>

#include <chrono>

#include "felt.hpp"

namespace touch {

/// One kept moment.
struct Frame {
  double t;               ///< [s]
  palpate::Pose<S> pose;  ///< of the tool
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

/// The paper's shape over an exact surface, fixed at its lowest point.
class Shape {
 public:
  using Interpolation = palpate::PhongInterpolation<S>;
  using Model = palpate::BeamSkeletonDeformation<Beams, Interpolation>;

  template <class Body>
  Shape(const Body& body, std::size_t vertices)
      : Shape(body, body.mesh(vertices), body.raycast(V(0, -1, 0), V::UnitY()).position) {}

  /// Takes over the newest contacts.
  void update(const Felt& felt) noexcept {
    const auto begin = std::chrono::steady_clock::now();
    const auto moved = model_.write(std::span(felt.contacts.begin(), felt.contacts.size()), buffer());
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    if (moved.vertices == 0) return;
    seconds_ += spent.count();
    ++updates_;
  }
  [[nodiscard]] Frame frame(double t, const palpate::Pose<S>& pose, const Felt& felt) const {
    return {t, pose, felt, position_, normal_};
  }

  [[nodiscard]] const palpate::MeshData<S>& rest() const noexcept { return mesh_; }
  /// w, the local neighbourhood's factor of D.
  [[nodiscard]] S factor(const palpate::ContactState<S>& contact) const noexcept {
    return neighbourhood_.factor({.area = contact.area, .points = static_cast<S>(contact.points)});
  }
  [[nodiscard]] std::size_t updates() const noexcept { return updates_; }
  /// Mean time of an update that moved something [s].
  [[nodiscard]] double mean_time() const noexcept { return updates_ > 0 ? seconds_ / static_cast<double>(updates_) : 0; }

 private:
  using Neighbourhood = palpate::AreaNeighbourhood<S>;

  template <class Body>
  Shape(const Body& body, palpate::MeshData<S> mesh, const V& fixed)
      : mesh_(std::move(mesh)),
        position_(mesh_.vertices.size()),
        normal_(mesh_.vertices.size()),
        neighbourhood_({.reference_area = 1e-4}),  // up to 1 cm^2 a contact counts as a point
        model_(make_beams(body), Interpolation(palpate::make_partition(body, mesh_)), neighbourhood_, mesh_,
               {.fixed = fixed}) {
    model_.write_rest(buffer());
  }

  [[nodiscard]] palpate::VertexBuffer<S> buffer() noexcept {
    return {.positions = position_.front().data(),
            .position_stride = sizeof(V),
            .normals = normal_.front().data(),
            .normal_stride = sizeof(V)};
  }

  palpate::MeshData<S> mesh_;
  std::vector<V> position_, normal_;
  Neighbourhood neighbourhood_;
  Model model_;
  double seconds_ = 0;
  std::size_t updates_ = 0;
};

}  // namespace touch
