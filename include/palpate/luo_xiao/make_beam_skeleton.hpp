// SPDX-License-Identifier: MIT
#pragma once

/// @file The paper's body from a shape and its display mesh: extremal points, beams, partition and bottom
/// centre are found once for all. Set-up only.

#include <palpate/geometry/extremal_points.hpp>
#include <palpate/luo_xiao/beam_skeleton.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>

#include <vector>

namespace palpate {

/// The paper's deformation model by its four roles (V, VI): beam theory, section rule, interpolation, local
/// neighbourhood. `S` is the scene's scalar, `Contacts` how many are drawn at once.
template <BeamTheory Beam = EulerBernoulli<double>, SectionRule Section = VolumePreserving<double>,
          Interpolation I = PhongInterpolation<double>,
          Neighbourhood N = AreaNeighbourhood<typename I::Scalar>, Real S = typename I::Scalar,
          std::size_t Contacts = 4>
using BeamSkeleton =
    BeamSkeletonDeformation<RegionSkeletons<Skeleton<S, Beam, Section>, CoupledRegions, Contacts>, I, N>;

/// The bottom centre o [m]: the surface's lowest point under the middle of its box, y being up (II).
template <class Body>
[[nodiscard]] Vec3<typename Body::Scalar> bottom_centre(const Body& body) {
  using V = Vec3<typename Body::Scalar>;
  const V low = body.lower(), size = body.upper() - low, middle = low + size / 2;
  return body.raycast(V(middle.x(), low.y() - size.y(), middle.z()), V::UnitY()).position;
}

/// A `BeamSkeleton` for `body`, fixed at its bottom centre, drawn on `mesh`. The body offers extremal_points
/// (geometry/extremal_points.hpp), its box and raycast(). Reports what its parts report.
template <template <class> class I = PhongInterpolation, std::size_t Contacts = 4, class Body,
          BeamTheory Beam, SectionRule Section, Neighbourhood N>
[[nodiscard]] auto make_beam_skeleton(const Body& body, const MeshData<typename Body::Scalar>& mesh,
                                      const Beam& beam, const Section& section, const N& neighbourhood,
                                      bool normals = true) {
  using S = typename Body::Scalar;
  using Model = BeamSkeleton<Beam, Section, I<S>, N, S, Contacts>;
  const Vec3<S> fixed = bottom_centre(body);
  std::vector<Vec3<S>> ends;
  for (const auto& point : extremal_points(body)) ends.push_back(point.position);
  return Model(typename Model::Regions(Skeleton<S, Beam, Section>(ends, beam, section)),
               I<S>(make_partition(body, mesh, fixed)), neighbourhood, mesh,
               {.fixed = fixed, .normals = normals});
}

}  // namespace palpate
