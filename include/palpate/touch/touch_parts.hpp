// SPDX-License-Identifier: MIT
#pragma once

/// @file What Touch is made of, by the kind of tool: surface, law, regions and shape that suit it.
///
/// | tool        | surface             | force                           | shape                     |
/// |-------------|---------------------|---------------------------------|---------------------------|
/// | `PointBall` | samples, grown by R | Hertz's law, fitted to spheres' | `ResponseBallDeformation` |
/// | `MeshTool`  | samples             | resolved at the tool's points   | `ResponseLoadDeformation` |

#include <palpate/contact/topology.hpp>
#include <palpate/core/absent.hpp>
#include <palpate/geometry/grown_surface.hpp>
#include <palpate/geometry/shared_surface.hpp>
#include <palpate/law/map/hertz_map.hpp>
#include <palpate/resolved/adaptive_contact_points.hpp>
#include <palpate/resolved/elastic_contact.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/resolved/response_load_deformation.hpp>
#include <palpate/response/ball_deformation.hpp>
#include <palpate/touch/detail/curved_surface.hpp>
#include <palpate/touch/elastic_body.hpp>
#include <palpate/touch/tools.hpp>

namespace palpate {

/// How well a `point_ball`'s law fits the body's response field.
struct TouchFit {
  double worst_rms = 0;                       ///< of all positions: rms residual of F(D) over F's own rms [-]
  Vec3<double> where = Vec3<double>::Zero();  ///< there, on the undeformed surface [m]
  double depth = 0;                           ///< the law is fitted from 0 to here [m]
  double law_spacing = 0;                     ///< of the positions at which it is fitted [m]
};

namespace detail {

template <class Tool>
struct TouchParts;

template <>
struct TouchParts<PointBall> {
  using Object = SampledSurface<GrownSurface<SharedSurface<MeshSurface<double>>>>;
  using Force = HertzMap<double>;
  using Contacts = SinglePoint;
  using Shape = ResponseBallDeformation<double, CurvedSurface>;
  static constexpr std::size_t max_drawn = 1;

  TouchParts(const ElasticBody& body, const PointBall& ball);

  PointTool<double> tool;
  Contacts contacts{};
  TouchFit fit;
  Object object;
  Force force;
  Shape shape;

 private:
  TouchParts(const ElasticBody& body, const PointBall& ball, const CurvedSurface& curved);
};

template <>
struct TouchParts<MeshTool> {
  using Object = SampledSurface<SharedSurface<MeshSurface<double>>>;
  using Force = ElasticContact<double, ResponseCompliance>;
  using Contacts = AdaptiveContactPoints<256, 256>;
  static constexpr std::size_t max_drawn = Contacts::max_points + Contacts::max_beside;
  using Shape = ResponseLoadDeformation<double, max_drawn>;

  TouchParts(const ElasticBody& body, const MeshTool& mesh);

  double spacing;  ///< of the tool's coarse points [m]
  AdaptiveTool<double> tool;
  Contacts contacts{};
  Absent<0> fit;
  Object object;
  Force force;
  Shape shape;
};

}  // namespace detail

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/touch/setup/touch_parts_impl.hpp>
#endif
