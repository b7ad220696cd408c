// SPDX-License-Identifier: MIT
#pragma once

/// @file Set-up of touch_parts.hpp: samples, fitted laws. Set-up only.

#include <palpate/calibrate/response_map.hpp>
#include <palpate/geometry/mesh_extremal_points.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/setup/centroidal_cells.hpp>
#include <palpate/touch/touch_parts.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::detail {

// Chosen: samples of a body, half a second of set-up; below, w of them to a ball's radius.
inline constexpr double surface_samples = 3e5;
inline constexpr double samples_on_radius = 4;
// A ball is pressed in by at most this part of its radius when its law is fitted: where the field has been
// compared with finite elements (docs/accuracy.md).
inline constexpr double ball_depth = 0.6;
// Chosen: with twice as many forces differ by less than 0.1 %.
inline constexpr std::size_t law_points = 10;
// Of the positions at which a law is fitted, over the boundary element mesh's edge.
inline constexpr double law_spacing = 0.5;
// Mean curvature is averaged over this many radii of the tool, and edges of the mesh at least.
inline constexpr double curvature_radii = 1, curvature_edges = 2.5;

/// Distance of samples of a box [m], at least `finest`.
[[nodiscard]] inline double sample_spacing(const Vec3<double>& lower, const Vec3<double>& upper,
                                           double finest) {
  return (std::max)(finest, std::cbrt((upper - lower).prod() / surface_samples));
}

[[nodiscard]] inline CurvedSurface curved_surface(const ElasticBody& body, double radius) {
  const TriangleMesh<double> mesh(
      MeshData<double>{{body.surface()->bvh().vertices().begin(), body.surface()->bvh().vertices().end()},
                       {body.surface()->bvh().triangles().begin(), body.surface()->bvh().triangles().end()}});
  const double edge = std::sqrt(4 / std::numbers::sqrt3 * mesh.area() / double(mesh.triangles().size()));
  return {body.surface(), mean_curvature(mesh, (std::max)(curvature_radii * radius, curvature_edges * edge)),
          0};
}

template <ForceMap Map>
[[nodiscard]] Map taken(ResponseMap<Map> made, TouchFit& fit) {
  fit.worst_rms = made.worst_rms;
  fit.where = made.where;
  fit.law_spacing = made.map.spacing();
  return std::move(made.map);
}

PALPATE_COMPILED_INLINE TouchParts<PointBall>::TouchParts(const ElasticBody& body, const PointBall& ball)
    : TouchParts(body, ball, curved_surface(body, ball.radius)) {}

PALPATE_COMPILED_INLINE TouchParts<PointBall>::TouchParts(const ElasticBody& body, const PointBall& ball,
                                                          const CurvedSurface& curved)
    : tool{.tip = Vec3<double>::Zero(), .centre_of_mass = ball.centre_of_mass},
      object(GrownSurface(SharedSurface(body.surface()), ball.radius),
             {.spacing = sample_spacing(body.surface()->lower(), body.surface()->upper(),
                                        ball.radius / samples_on_radius)}),
      force(taken(ball_response_map(*body.field(), curved,
                                    {.radius = ball.radius,
                                     .depth = ball_depth * ball.radius,
                                     .spacing = law_spacing * body.field()->mesh().length,
                                     .points = law_points,
                                     .threads = body.threads()}),
                  fit)),
      shape(body.field(), body.mesh().data(), curved, {.radius = ball.radius}) {
  fit.depth = ball_depth * ball.radius;
}

/// Of a tool's points on that body: half of its surface has as many as are taken beneath it.
[[nodiscard]] inline double point_spacing(const ElasticBody& body, const MeshTool& tool) {
  if (!(tool.finest > 0)) return tool.spacing;
  constexpr double most = 2 * TouchParts<MeshTool>::Contacts::max_points;
  return (std::min)(tool.spacing, (std::max)(tool.finest, std::sqrt(body.mesh().area() / most)));
}

/// The fine points' spacing: half the coarse one, but for tools of so many points that contact_samples(),
/// which counts cells beyond edges, too, would refuse it.
[[nodiscard]] inline double fine_spacing(const TriangleMesh<double>& mesh, double spacing) {
  return std::clamp(std::sqrt(2 * mesh.area() / max_contact_samples), spacing / 2, spacing);
}
[[nodiscard]] inline AdaptiveTool<double> adaptive_tool(const MeshTool& tool, double spacing) {
  const TriangleMesh<double> mesh(tool.mesh);
  const auto points = [&](double apart) {
    return ToolPoints<double>(contact_samples(mesh, apart),
                              {.contact_area = apart * apart, .centre_of_mass = tool.centre_of_mass});
  };
  return {points(spacing), points(fine_spacing(mesh, spacing))};
}

PALPATE_COMPILED_INLINE TouchParts<MeshTool>::TouchParts(const ElasticBody& body, const MeshTool& mesh)
    : spacing(point_spacing(body, mesh)),
      tool(adaptive_tool(mesh, spacing)),
      object(SharedSurface(body.surface()),
             {.spacing = sample_spacing(body.surface()->lower(), body.surface()->upper(),
                                        std::sqrt(tool.fine().contact_area()))}),
      force({.compliance = ResponseCompliance(body.field())}),
      shape(body.field(), body.mesh().data()) {}

}  // namespace palpate::detail
