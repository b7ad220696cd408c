// SPDX-License-Identifier: MIT
#pragma once

/// @file Meshes of tools.hpp. Set-up only.

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/touch/tools.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace palpate {

namespace detail {

inline constexpr double points_on_contact_area = 40;  // chosen: within 2 % (docs/resolved.md), 30 us
inline constexpr double most_points = 1500;           // chosen: Touch takes 256 beneath the surface
inline constexpr double capsule_points = 512;         // of them half beneath the surface
inline constexpr std::size_t tool_vertices = 1500;    // chosen: chords of a circle 0.2 % below it

/// Surface of revolution about y: half a circle of `radius` at each end, `length` between their centres.
[[nodiscard]] inline MeshData<double> capsule_mesh(double radius, double length) {
  constexpr std::uint32_t rings = 12, around = 48;  // of each end; chosen as tool_vertices
  // Of the side twice as far apart, at most 64 (chosen): where triangles are uneven the side bulges.
  const double along = 4 * std::numbers::pi * radius / around;
  const auto side = static_cast<std::uint32_t>(std::clamp(std::ceil(length / along), 1., 64.));
  MeshData<double> mesh;
  mesh.vertices.push_back({0, length / 2 + radius, 0});
  const auto ring = [&](double angle, double shift) {
    for (std::uint32_t k = 0; k < around; ++k) {
      const double turn = 2 * std::numbers::pi * k / around, r = radius * std::cos(angle);
      mesh.vertices.push_back({r * std::sin(turn), shift + radius * std::sin(angle), r * std::cos(turn)});
    }
  };
  for (std::uint32_t i = 1; i <= rings; ++i) ring(std::numbers::pi / 2 * (1 - double(i) / rings), length / 2);
  for (std::uint32_t i = 1; i < side; ++i) ring(0, length * (0.5 - double(i) / side));
  for (std::uint32_t i = 0; i < rings; ++i) ring(-std::numbers::pi / 2 * i / rings, -length / 2);
  mesh.vertices.push_back({0, -length / 2 - radius, 0});
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size()) - 1;
  for (std::uint32_t k = 0; k < around; ++k) {
    const std::uint32_t next = (k + 1) % around;
    mesh.triangles.push_back({0, 1 + k, 1 + next});
    for (std::uint32_t i = 0; i + 2 < 2 * rings + side; ++i) {
      const std::uint32_t a = 1 + i * around + k, b = 1 + i * around + next;
      mesh.triangles.push_back({a, a + around, b + around});
      mesh.triangles.push_back({a, b + around, b});
    }
    mesh.triangles.push_back({last, last - around + next, last - around + k});
  }
  return mesh;
}

[[nodiscard]] inline MeshTool mesh_tool(const char* where, MeshData<double> data, double nominal,
                                        const ToolParams& params) {
  require_non_negative(params.contact_area, where, "contact_area [m^2] must be >= 0");
  require_non_negative(params.spacing, where, "spacing [m] must be >= 0");
  const TriangleMesh<double> mesh(std::move(data));
  MeshTool tool{mesh.data(), params.spacing, params.centre_of_mass};
  if (tool.spacing > 0) return tool;
  const double finest = std::sqrt(mesh.area() / most_points);
  double area = params.contact_area;
  if (!(area > 0)) area = nominal > 0 ? nominal : 0.1 * mesh.area(), tool.finest = finest;  // 0.1: chosen
  tool.spacing = (std::max)(std::sqrt(area / points_on_contact_area), finest);
  return tool;
}

}  // namespace detail

PALPATE_COMPILED_INLINE MeshTool ball(double radius, const ToolParams& params) {
  require_positive(radius, "ball", "radius [m] must be > 0");
  return detail::mesh_tool("ball", Sphere<double>({.radius = radius}).mesh(detail::tool_vertices), 0, params);
}

PALPATE_COMPILED_INLINE MeshTool capsule(double radius, double length, const ToolParams& params) {
  require_positive(radius, "capsule", "radius [m] must be > 0");
  require_positive(length, "capsule", "length [m] must be > 0");
  constexpr double deep = 0.25;  // d / r, chosen; Hertz's contact has the area pi r d
  const double end = std::numbers::pi * deep * radius * radius;
  // Lying on its side a capsule has up to half of its surface in a soft body. At an end 10 points stay.
  const double side = 2 * std::numbers::pi * radius * (2 * radius + length) *
                      (detail::points_on_contact_area / detail::capsule_points);
  return detail::mesh_tool("capsule", detail::capsule_mesh(radius, length), std::clamp(side, end, 4 * end),
                           params);
}

PALPATE_COMPILED_INLINE MeshTool cylinder(double radius, double length, const ToolParams& params) {
  require_positive(length, "cylinder", "length [m] must be > 0");
  const Cylinder<double> shape({.radius = radius, .half_height = length / 2});
  return detail::mesh_tool("cylinder", shape.mesh(detail::tool_vertices), std::numbers::pi * radius * radius,
                           params);
}

PALPATE_COMPILED_INLINE MeshTool box(const Vec3<double>& size, const ToolParams& params) {
  const Box<double> shape({.half = size / 2});
  return detail::mesh_tool("box", shape.mesh(detail::tool_vertices), size.x() * size.z(), params);
}

PALPATE_COMPILED_INLINE MeshTool tool_mesh(const MeshData<double>& mesh, const ToolParams& params) {
  return detail::mesh_tool("tool_mesh", mesh, 0, params);
}

}  // namespace palpate
