// SPDX-License-Identifier: MIT
// A contact resolved at the tool's points, as the one contact that the solver reports.
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

using namespace palpate;

TEST_CASE("a ball beside the origin: the contact is below it, with all of the normal force") {
  using V = Vec3<double>;
  using Elastic = ElasticContact<double, HalfSpace>;
  const double R = 0.015, depth = 0.001;
  const MeshData<double> ball = Sphere<double>({.radius = R}).mesh(2000);
  ContactSolver<Box<double>, Elastic, Frictionless<double>, ContactPoints<256>> solver(
      {.object = Box<double>({.half = V(0.5, 0.5, 0.5), .centre = V(0, -0.5, 0)}),
       .tool =
           ToolPoints<double>(contact_samples(TriangleMesh<double>(ball), 0.0012), {.contact_area = 1e-4}),
       .force = Elastic({.compliance = HalfSpace({.E = 1e6, .nu = 0.5})})});
  Pose<double> X;
  X.translation = V(0.1, R - depth, -0.2);
  const auto result = solver.tick(X);
  REQUIRE(solver.contacts().size() == 1);
  const auto& contact = solver.contacts()[0];
  // All normals are the plane's.
  CHECK_RELATIVE(contact.normal_force, result.wrench.force.norm(), 1e-6);
  CHECK(contact.normal_force > 0);
  // The ball's middle, within a tenth of a cell, as cells are not even around it.
  CHECK((contact.centre - V(0.1, contact.centre.y(), -0.2)).norm() < 1.2e-4);
  CHECK(std::abs(contact.centre.y()) < 2 * depth);
}
