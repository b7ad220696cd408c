// SPDX-License-Identifier: MIT

// Pressure on the tool's surface: which part of it pushes, against closed forms and finer points.

#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/map/concept.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/check.hpp>

#include <numbers>
#include <string>

#include "unit/solver/scene.hpp"

using namespace palpate;
using test::V;

namespace {

constexpr double k = 400;  // N/m

/// The half space y < 0.
template <class Scalar_>
struct FlatBody {
  using Scalar = Scalar_;
  using W = Vec3<Scalar>;
  SurfacePoint<Scalar> closest(const W& x) const noexcept { return {W(x.x(), 0, x.z()), W::UnitY(), x.y()}; }
  Penetration<Scalar> penetration(const W& x) const noexcept { return {-x.y(), W::UnitY()}; }
  bool separated(const W& centre, Scalar radius) const noexcept { return centre.y() > radius; }
  Scalar reach() const noexcept { return std::numeric_limits<Scalar>::infinity(); }
};

using Flat = FlatBody<double>;

template <class Object, class Sharing = SurfacePressure>
using Pressed = ContactSolver<Object, LinearForce<double>, Frictionless<double>, SingleRegion<Sharing>>;

TriangleMesh<double> pin(double radius, std::size_t vertices = 4000) {
  return TriangleMesh<double>(Cylinder<double>({.radius = radius, .half_height = 0.01}).mesh(vertices));
}

double circle(double radius) { return std::numbers::pi * radius * radius; }

/// Both meshes as one tool, the second turned by a right angle about x and moved by z.
MeshData<double> joined(MeshData<double> one, const MeshData<double>& other, double z) {
  const auto n = static_cast<std::uint32_t>(one.vertices.size());
  for (const V& v : other.vertices) one.vertices.emplace_back(v.x(), -v.z(), v.y() + z);
  for (const auto& t : other.triangles) one.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return one;
}

/// The tool `depth` [m] below y = 0, turned by `angle` about `axis`.
Pose<double> pressed(const TriangleMesh<double>& mesh, double depth, double angle = 0,
                     const V& axis = V::UnitX()) {
  Pose<double> X;
  X.rotation = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  double lowest = 1;
  for (const V& v : mesh.vertices()) lowest = (std::min)(lowest, (X.rotation * v).y());
  X.translation.y() = -lowest - depth;
  return X;
}

}  // namespace

TEST_CASE("a flat-faced pin pressed flat has the force of its face, however deep and however it is meshed") {
  for (const double radius : {0.001, 0.005}) {
    const TriangleMesh<double> mesh = pin(radius);
    const ToolPoints<double>::Params params{.contact_area = circle(radius)};
    for (const double spacing : {0.0, 0.2 * radius, 0.5 * radius}) {
      Pressed<Flat> solver(
          {.object = {},
           .tool = spacing > 0 ? ToolPoints<double>(mesh, params, spacing) : ToolPoints<double>(mesh, params),
           .force = LinearForce<double>({.k = k}),
           .friction = {}});
      for (const double depth : {0.001, 0.008}) {
        const Wrench<double> felt = solver.tick(pressed(mesh, depth)).wrench;
        // The mesh's face is a polygon in the circle, by 1 % smaller.
        CHECK_RELATIVE(felt.force.y(), k * depth, 0.01);
        // The walls cancel: to rounding on the mesh; resampled, to the shares of a wall of 13 points around.
        CHECK_ABSOLUTE(std::hypot(felt.force.x(), felt.force.z()), 0,
                       (spacing > 0 ? 5e-3 : 1e-12) * k * depth);
        CHECK_RELATIVE(solver.contacts()[0].area, circle(radius), 0.01);
      }
    }
  }
}

TEST_CASE("a cube pressed flat has the force of its face with 1, 4 and 16 squares a face") {
  for (const std::size_t vertices : {8u, 26u, 98u}) {
    const TriangleMesh<double> cube(Box<double>({.half = V::Constant(0.005)}).mesh(vertices));
    REQUIRE(cube.vertices().size() == vertices);
    Pressed<Flat> solver({.object = {},
                          .tool = ToolPoints<double>(cube, {.contact_area = 1e-4}),
                          .force = LinearForce<double>({.k = k}),
                          .friction = {}});
    for (const double depth : {0.001, 0.008})
      CHECK_RELATIVE(solver.tick(pressed(cube, depth)).wrench.force.y(), k * depth, test::ulps<double>(16));
  }
}

TEST_CASE("a cube pressed flat is pushed at the middle of its face, and turned about its centre of mass") {
  const TriangleMesh<double> cube(Box<double>({.half = V::Constant(0.005)}).mesh(98));
  const V centre_of_mass(3e-3, 1e-3, -2e-3);
  Pressed<Flat> solver(
      {.object = {},
       .tool = ToolPoints<double>(cube, {.contact_area = 1e-4, .centre_of_mass = centre_of_mass}),
       .force = LinearForce<double>({.k = k}),
       .friction = {}});
  for (const double depth : {0.001, 0.008}) {
    Pose<double> X = pressed(cube, depth, 0.3, V::UnitY());
    X.translation += V(0.01, 0, -0.02);
    const V face(0.01, -depth, -0.02), force(0, k * depth, 0);
    const Wrench<double> felt = solver.tick(X).wrench;
    // Rounding of sums of 98 points, 2 cm from the origin.
    CHECK((felt.torque - (face - X * centre_of_mass).cross(force)).norm() < 1e-13 * force.norm());
    CHECK((solver.contacts()[0].centre - face).norm() < 1e-13);
  }
}

TEST_CASE("force and torque of tilted tools are those of a fine mesh, from 50 points on") {
  struct Scene {
    const char* name;
    TriangleMesh<double> mesh;
    double area, depth;
  };
  const Scene scenes[] = {
      {"cube", TriangleMesh<double>(Box<double>({.half = V::Constant(0.005)}).mesh(8)), 1e-4, 0.004},
      {"pin", pin(0.003), circle(0.003), 0.002},
      {"mallet",
       TriangleMesh<double>(joined(Cylinder<double>({.radius = 0.008, .half_height = 0.012}).mesh(4000),
                                   Cylinder<double>({.radius = 0.002, .half_height = 0.02}).mesh(2000),
                                   -0.03)),
       circle(0.008), 0.005},
      {"ball", TriangleMesh<double>(Sphere<double>({.radius = 0.005}).mesh(4000)), circle(0.005), 0.002}};
  for (const Scene& s : scenes) {
    const auto solver = [&](double spacing) {
      return Pressed<Flat>({.object = {},
                            .tool = ToolPoints<double>(s.mesh, {.contact_area = s.area}, spacing),
                            .force = LinearForce<double>({.k = k}),
                            .friction = {}});
    };
    Pressed<Flat> fine = solver(0.2e-3);
    double worst_force = 0, worst_torque = 0;
    std::size_t most = 0;
    for (int degrees = 0; degrees <= 90; degrees += 10) {
      const Pose<double> X = pressed(s.mesh, s.depth, degrees * std::numbers::pi / 180);
      const Wrench<double> reference = fine.tick(X).wrench;
      // As many points as just give 50 in contact.
      double spacing = 0.004;
      Pressed<Flat> coarse = solver(spacing);
      Wrench<double> felt = coarse.tick(X).wrench;
      while (coarse.contacts()[0].points < 50) {
        spacing *= 0.93;
        coarse = solver(spacing);
        felt = coarse.tick(X).wrench;
      }
      most = (std::max)(most, std::size_t(coarse.contacts()[0].points));
      const double size = reference.force.norm();
      const double arm = std::sqrt(s.area / std::numbers::pi);
      const double force = (felt.force - reference.force).norm() / size;
      const double torque = (felt.torque - reference.torque).norm() / (reference.torque.norm() + arm * size);
      INFO(std::string(s.name), " at ", degrees, " degrees: ", coarse.contacts()[0].points, " points, force ",
           force, ", torque ", torque);
      CHECK(force < 0.03);
      CHECK(torque < 0.03);
      worst_force = (std::max)(worst_force, force);
      worst_torque = (std::max)(worst_torque, torque);
    }
    MESSAGE(std::string(s.name), ": worst error of the force ", worst_force, ", of the torque ", worst_torque,
            ", at most ", most, " points");
  }
}

TEST_CASE("the force does not depend on the resampling's spacing") {
  const TriangleMesh<double> mesh = pin(0.003);
  const Pose<double> X = pressed(mesh, 0.003, 0.3);
  const auto felt = [&](double spacing) {
    Pressed<Flat> solver({.object = {},
                          .tool = ToolPoints<double>(mesh, {.contact_area = circle(0.003)}, spacing),
                          .force = LinearForce<double>({.k = k}),
                          .friction = {}});
    return solver.tick(X).wrench;
  };
  const Wrench<double> reference = felt(0.1e-3);
  for (const double spacing : {0.25e-3, 0.4e-3, 0.5e-3, 0.7e-3, 0.8e-3}) {
    const Wrench<double> w = felt(spacing);
    // Of second order in the spacing: 3 % at a quarter of the radius, so this of it.
    const double tolerance = 0.03 * std::pow(spacing / 0.75e-3, 2);
    CHECK((w.force - reference.force).norm() < (std::max)(tolerance, 0.003) * reference.force.norm());
    CHECK((w.torque - reference.torque).norm() <
          (std::max)(tolerance, 0.003) * (reference.torque.norm() + 0.003 * reference.force.norm()));
  }
}

TEST_CASE("a tool pressed deeper than it is tall is not let go: the force rises with depth") {
  const TriangleMesh<double> tools[] = {
      TriangleMesh<double>(Sphere<double>({.radius = 0.005}).mesh(2000)), pin(0.003),
      TriangleMesh<double>(Box<double>({.half = V(0.01, 0.0005, 0.01)}).mesh(2000))};  // a thin plate
  for (const TriangleMesh<double>& mesh : tools) {
    for (const double angle : {0.0, 0.4, 1.0, 1.5}) {
      Pressed<Flat> solver({.object = {},
                            .tool = ToolPoints<double>(mesh, {.contact_area = 1e-4}),
                            .force = LinearForce<double>({.k = k}),
                            .friction = {}});
      double before = 0, aside = 0;
      for (int i = 1; i <= 60; ++i) {
        const Wrench<double> felt = solver.tick(pressed(mesh, 0.0005 * i, angle)).wrench;
        CHECK(felt.force.y() > before);
        before = felt.force.y();
        if (i > 20) aside = (std::max)(aside, std::hypot(felt.force.x(), felt.force.z()) / before);
      }
      // Nothing pushes a tool along a flat body: to the quadrature of the part that is inside, of second
      // order.
      CHECK(aside < 0.003);
    }
  }
}

TEST_CASE(
    "where a flat face goes in by its edge, the pressure centre is a sixth of the width off the middle") {
  const TriangleMesh<double> cube(Box<double>({.half = V::Constant(0.005)}).mesh(8));
  const double angle = 0.02, width = 0.005;
  Pressed<Flat> solver({.object = {},
                        .tool = ToolPoints<double>(cube, {.contact_area = 1e-4}, 0.25e-3),
                        .force = LinearForce<double>({.k = k}),
                        .friction = {}});
  const Pose<double> X = pressed(cube, width * std::sin(angle), angle, V::UnitZ());
  (void)solver.tick(X);
  const V edge = X * V(-0.005, -0.005, 0), centre = solver.contacts()[0].centre;
  const double off_the_middle = width / 2 - std::abs(centre.x() - edge.x());
  // Even pressure would be at the middle, one that falls to 0 at a third. The points are 1/20 of the width
  // apart: their squares, 1/400, and the edge's wall, 2 % of the face in contact, at its end.
  CHECK_RELATIVE(off_the_middle, width / 6, 0.05);
}
