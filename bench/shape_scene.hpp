// SPDX-License-Identifier: MIT
#pragma once

/// @file  The paper's deformed shape on a display mesh, for the benchmarks.

#include "scenes.hpp"

#include <palpate/deformation/beam_skeleton.hpp>
#include <palpate/interpolation/phong.hpp>

namespace bench {

/// Force in double, display in float. The buffer is the caller's side: packed positions, then packed normals.
class Shape {
 public:
  using Beams = RegionSkeletons<Skeleton<double>>;
  using Model = BeamSkeletonDeformation<Beams, PhongInterpolation<float>>;

  Shape(std::size_t vertices, bool normals)
      : mesh_(ellipsoid<float>().mesh(vertices)),
        model_(Beams(Skeleton<double>(ends(), EulerBernoulli<double>(IsotropicElasticity<double>({.E = 2e4, .nu = 0.5})),
                                      VolumePreserving<double>({.volume = ellipsoid<double>().volume()}))),
               PhongInterpolation<float>(make_partition(ellipsoid<float>(), mesh_)), AreaNeighbourhood<float>({}), mesh_,
               {.fixed = Vec3<double>(0, -0.04, 0), .normals = normals}),
        positions_(3 * mesh_.vertices.size()),
        normals_(normals ? positions_.size() : 0) {
    model_.write_rest(buffer());
  }

  Moved<double> write(std::span<const ContactState<double>> contacts) noexcept { return model_.write(contacts, buffer()); }
  [[nodiscard]] std::size_t vertices() const noexcept { return mesh_.vertices.size(); }
  [[nodiscard]] std::size_t triangles() const noexcept { return mesh_.triangles.size(); }
  [[nodiscard]] const std::vector<float>& positions() const noexcept { return positions_; }
  /// Mean square coordinate [m^2]: shows what was written.
  [[nodiscard]] double check() const noexcept {
    double sum = 0;
    for (const float x : positions_) sum += double(x) * double(x);
    return sum / static_cast<double>(positions_.size());
  }

 private:
  static std::vector<Vec3<double>> ends() {
    std::vector<Vec3<double>> result;
    for (const auto& point : extremal_points(ellipsoid<float>())) result.push_back(point.position.cast<double>());
    return result;
  }
  [[nodiscard]] VertexBuffer<float> buffer() noexcept {
    return {.positions = positions_.data(), .normals = normals_.empty() ? nullptr : normals_.data()};
  }

  MeshData<float> mesh_;
  Model model_;
  std::vector<float> positions_, normals_;
};

/// The tool of the whole-loop scenes: 100 points, up to 4 regions, the paper's law with friction.
using Solver = ContactSolver<Ellipsoid<double>, DuffingForce<double>, PowerLawFriction<double>, Regions<4>>;
inline Solver make_solver(int points) {
  return Solver({ellipsoid<double>(), face<double>(points, 1), duffing<double>(), fibre<double>(), {joining}});
}

}  // namespace bench
