// SPDX-License-Identifier: MIT
#pragma once

/// @file  Several meshes as one, for tools and bodies of parts.

#include <palpate/geometry/triangle_mesh.hpp>

#include <cstdint>

namespace palpate::test {

/// Adds `part`, moved by `offset`, to `mesh`. They may be one and the same.
template <Real S>
void append(MeshData<S>& mesh, MeshData<S> part, const Vec3<S>& offset) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3<S>& p : part.vertices) mesh.vertices.push_back(p + offset);
  for (const auto& t : part.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

}  // namespace palpate::test
