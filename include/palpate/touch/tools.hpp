// SPDX-License-Identifier: MIT
#pragma once

/// @file Rigid tools for Touch: what touches, how finely, its centre of mass. Set-up only.
///
/// | tool                       | tool coordinates [m]        | contact area to resolve A_0           |
/// |----------------------------|-----------------------------|---------------------------------------|
/// | `ball(radius)`             | about the origin            | a tenth of its surface                |
/// | `point_ball(radius)`       | about the origin            | none: one point with a law            |
/// | `capsule(radius, length)`  | about the origin, along y   | 1/13 of it; 1 to 4 times an end's     |
/// | `cylinder(radius, length)` | about the origin, along y   | an end's face                         |
/// | `box(size)`                | about the origin            | the face across y                     |
/// | `tool_mesh(mesh)`          | the mesh's own              | a tenth of the surface                |
///
/// A capsule's half then has 256 points, as many as Touch takes beneath the surface, a ball's 200. An end's
/// contact area is that where it is in by a quarter of its radius: it has 10 points at least. Where nothing
/// is told Touch takes A_0 as 1/13 of the body's surface at most: half of that then has 256 points.

#include <palpate/core/error.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

namespace palpate {

/// A ball about the tool's origin, felt as one point with a law: no torque about its centre, no rolling, and
/// no other tool on the body is felt.
struct PointBall {
  double radius = 0;                                   ///< [m], > 0
  Vec3<double> centre_of_mass = Vec3<double>::Zero();  ///< [m]
};

/// Any closed mesh, felt at even points on it.
struct MeshTool {
  MeshData<double> mesh;
  double spacing = 0;  ///< of the points [m], > 0; where few of them touch others feel, half as far apart
  Vec3<double> centre_of_mass = Vec3<double>::Zero();  ///< [m]
  double finest = 0;  ///< how near Touch may put them on a small body [m], at most `spacing`; 0: no nearer
};

/// What a tool made here may be told.
struct ToolParams {
  Vec3<double> centre_of_mass = Vec3<double>::Zero();  ///< torques are about it [m]
  double contact_area = 0;  ///< A_0 [m^2]: what is pressed on the body; 0: see above
  double spacing = 0;       ///< MeshTool's [m]; 0: 40 points on A_0, but at most 1,500 in all
};

[[nodiscard]] inline PointBall point_ball(double radius,
                                          const Vec3<double>& centre_of_mass = Vec3<double>::Zero()) {
  require_positive(radius, "point_ball", "radius [m] must be > 0");
  return {radius, centre_of_mass};
}
[[nodiscard]] MeshTool ball(double radius, const ToolParams& params = {});
[[nodiscard]] MeshTool capsule(double radius, double length, const ToolParams& params = {});
[[nodiscard]] MeshTool cylinder(double radius, double length, const ToolParams& params = {});
[[nodiscard]] MeshTool box(const Vec3<double>& size, const ToolParams& params = {});
/// Reports a mesh that is not closed and oriented.
[[nodiscard]] MeshTool tool_mesh(const MeshData<double>& mesh, const ToolParams& params = {});

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/touch/setup/tools_impl.hpp>
#endif
