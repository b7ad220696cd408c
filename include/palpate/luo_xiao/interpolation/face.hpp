// SPDX-License-Identifier: MIT
#pragma once

/// @file  A face of a partition, and weights of a point over it: plain values.

#include <palpate/core/vector.hpp>
#include <palpate/geometry/extremal_points.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate {

/// Corners of a face at most; flat facets of more corners are cut into triangles.
inline constexpr std::size_t max_face_corners = 8;

/// A face: a polygon of extremal points, and the run of sorted vertices ("slots") over it.
template <Real S>
struct Face {
  std::size_t first = 0, count = 0;  ///< slots first .. first + count - 1
  std::size_t row = 0;               ///< where its slots begin in an AlignedList of all faces
  std::size_t length = 0;            ///< of its part there: count, in whole `simd_group`s
  std::size_t weights = 0;           ///< where its weights start, corner by corner
  std::size_t corners = 0;           ///< 3 .. max_face_corners
  std::array<std::uint32_t, max_face_corners> corner{};  ///< extremal points, counter-clockwise from outside
  std::uint64_t members = 0;                             ///< the same as bits
  Vec3<S> centre = Vec3<S>::Zero();                      ///< of a ball around its vertices [m]
  S radius = 0;                                          ///< of that ball [m]
};

/// Barycentric weights of a point of the surface, one per extremal point; all zero but its face's corners.
template <Real S>
struct PointWeights {
  bool valid = false;  ///< false for a point that is not finite or is the centre
  std::uint32_t face = 0;
  std::array<S, max_extremal_points> weight{};
};

/// How a contact splits a face: what the weights of the face's vertices need, corner by corner. `V`: numbers,
/// or the same in vector registers.
template <class V>
struct FaceSplit {
  std::size_t corners;
  V share;                                ///< max weight of the contact in the face; 0: not split
  std::array<V, max_face_corners> P;      ///< weights of the contact's position
  std::array<V, max_face_corners> per_P;  ///< 1 / max(P, h)
  std::array<V, max_face_corners> lift;   ///< max(0, h - P) / max(P, h)
};

}  // namespace palpate
