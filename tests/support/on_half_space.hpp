// SPDX-License-Identifier: MIT
#pragma once

/// @file A tool that is resolved at its points on a half-space: the scene of the closed forms.

#include <palpate/geometry/box.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/solver/contact_solver.hpp>

namespace palpate::test {

inline constexpr double half_space_E = 1e6, half_space_nu = 0.5;  // Pa, -

/// Its top is y = 0.
inline Box<double> ground() {
  return Box<double>({.half = Vec3<double>(0.5, 0.5, 0.5), .centre = Vec3<double>(0, -0.5, 0)});
}

template <FrictionLaw F, ContactSurface Body = Box<double>>
using OnHalfSpace = ContactSolver<Body, ElasticContact<double, HalfSpace>, F, ContactPoints<512>>;

/// `body`: of another shape, as compliant as the half-space.
template <FrictionLaw F = Frictionless<double>, ContactSurface Body = Box<double>>
OnHalfSpace<F, Body> on_half_space(const MeshData<double>& tool, double spacing, const F& friction = {},
                                   const Body& body = ground()) {
  return OnHalfSpace<F, Body>(
      {.object = body,
       .tool =
           ToolPoints<double>(contact_samples(TriangleMesh<double>(tool), spacing), {.contact_area = 1e-4}),
       .force = ElasticContact<double, HalfSpace>(
           {.compliance = HalfSpace({.E = half_space_E, .nu = half_space_nu})}),
       .friction = friction});
}

}  // namespace palpate::test
