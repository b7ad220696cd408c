// SPDX-License-Identifier: MIT

/// @file Right answers at the ends of the range: lengths from 1e-6 to 1e3 m, forces from 1e-12 to 1e6 N,
/// moduli from 1 to 1e12 Pa, needles and slivers, contact at positions that are no ordinary ones, numbers too
/// small to be normal. Every check has a value: a closed form, or the same answer in other units.

#include <palpate/device/gate.hpp>
#include <palpate/elasticity/disc.hpp>
#include <palpate/elasticity/half_space.hpp>
#include <palpate/elasticity/isotropic.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/extremal_points.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/geometry/superellipsoid.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/hertz.hpp>
#include <palpate/law/force/plastic.hpp>
#include <palpate/law/force/power_law.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/solver/make_solver.hpp>

#include <support/check.hpp>
#include <support/joined.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

using namespace palpate;

namespace {
using V = Vec3<double>;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Units by powers of two, which round nothing: a metre is `length` of the scene's, a newton `force`.
struct Units {
  double length, force;
};
/// 1e-6 to 1e3 m and 1e-12 to 1e6 N.
std::vector<Units> all_units() {
  std::vector<Units> all;
  for (const int l : {-20, -14, -7, 0, 5, 10})
    for (const int f : {-40, -20, -3, 0, 10, 20}) all.push_back({std::ldexp(1, l), std::ldexp(1, f)});
  return all;
}

/// A face of 5 x 5 points, and two of them 6 lengths apart: one or two regions.
ToolPoints<double> tool(double length) {
  std::vector<V> points;
  for (const double side : {-3.0, 3.0})
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j) points.push_back(length * V(side + 0.5 * i, 0, 0.5 * j));
  const std::vector<double> areas(points.size(), 0.25 * length * length);
  return ToolPoints<double>(points, areas,
                            {.contact_area = 4 * length * length, .centre_of_mass = length * V(0, 8, 0)});
}

/// Poses that come down onto a body of height 4, rock, slide, turn and leave; lengths as of the units.
template <class Tick>
void along(const Units& units, const Tick& tick) {
  for (int i = 0; i < 200; ++i) {
    const double t = i / 200.0;
    Pose<double> X;
    X.translation = units.length * V(std::sin(9 * t), 4.2 - 0.9 * std::sin(3.14 * t), 0.5 * std::sin(14 * t));
    X.rotation = (Eigen::AngleAxisd(0.05 * std::sin(20 * t), V::UnitZ()) *
                  Eigen::AngleAxisd(0.3 * std::sin(7 * t), V::UnitY()))
                     .toRotationMatrix();
    tick(X);
  }
}

/// The wrenches along the path, in newtons and metres of units (1, 1).
template <class Solver, class Make>
std::vector<double> path(const Units& units, const Make& make) {
  Solver solver(make(units));
  std::vector<double> all;
  along(units, [&](const Pose<double>& X) {
    const Wrench<double> w = solver.tick(X, 1e-3).wrench;
    for (int k = 0; k < 3; ++k) {
      all.push_back(w.force[k] / units.force);
      all.push_back(w.torque[k] / units.force / units.length);
    }
  });
  return all;
}

/// The same scene in all units has the same answer; a power of two rounds nothing, so `tolerance` is for what
/// a C library rounds otherwise at other sizes.
template <class Solver, class Make>
void check_units(const Make& make, double tolerance) {
  const std::vector<double> reference = path<Solver>({1, 1}, make);
  double most = 0;
  for (const double x : reference) most = (std::max)(most, std::abs(x));
  CHECK(most > 1);  // there was contact
  for (const Units& units : all_units()) {
    const std::vector<double> scaled = path<Solver>(units, make);
    double worst = 0;
    for (std::size_t i = 0; i < scaled.size(); ++i) {
      REQUIRE(is_finite(scaled[i]));
      worst = (std::max)(worst, std::abs(scaled[i] - reference[i]));
    }
    INFO("metre ", units.length, ", newton ", units.force);
    CHECK(worst <= tolerance * most);
  }
}

DuffingForce<double> spring(const Units& u, double c3 = 3) {
  return DuffingForce<double>(
      {.c1 = 10 * u.force / u.length, .c3 = c3 * u.force / (u.length * u.length * u.length)});
}
const CoulombFriction<double> dry({.mu_static = 0.5, .mu_dynamic = 0.3});

/// A point alone on a body with F = k D.
template <class Body>
auto point_on(const Body& body, double k) {
  return make_solver(body, PointTool<double>{}, DuffingForce<double>({.c1 = k}));
}
template <class Solver>
V force_at(Solver& solver, const V& x) {
  Pose<double> X;
  X.translation = x;
  solver.reset();
  return solver.tick(X).wrench.force;
}

#if defined(__SSE2__)
/// Numbers too small to be normal count as 0, as engines set it.
class FlushToZero {
 public:
  FlushToZero() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }
  ~FlushToZero() { _mm_setcsr(before_); }
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;

 private:
  unsigned before_;
};
#endif
}  // namespace

TEST_CASE("conditioning: a point on an ellipsoid has one answer from 1e-6 to 1e3 m, from 1e-12 to 1e6 N") {
  using Solver = ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>>;
  check_units<Solver>(
      [](const Units& u) {
        return Solver::Parts{Ellipsoid<double>({.axes = u.length * V(6, 4, 4)}),
                             {.tip = V::Zero(), .centre_of_mass = u.length * V(0, 8, 0)},
                             spring(u),
                             dry};
      },
      0);
}

TEST_CASE("conditioning: regions on boxes and round bodies have one answer in all units") {
  using Boxes =
      ContactSolver<Box<double>, DuffingForce<double>, CoulombFriction<double>, Regions<4, AreaSharing>>;
  check_units<Boxes>(
      [](const Units& u) {
        return Boxes::Parts{
            Box<double>({.half = u.length * V(6, 4, 4)}), tool(u.length), spring(u, -0.5), dry, {u.length}};
      },
      0);
  using Cylinders = ContactSolver<Cylinder<double>, PlasticForce<DuffingForce<double>>,
                                  CoulombFriction<double>, SingleRegion<AreaSharing>>;
  check_units<Cylinders>(
      [](const Units& u) {
        return Cylinders::Parts{Cylinder<double>({.radius = 6 * u.length, .half_height = 4 * u.length}),
                                tool(u.length),
                                PlasticForce<DuffingForce<double>>(
                                    spring(u), {.yield_force = 4 * u.force, .extent = 0.5 * u.length}),
                                dry};
      },
      0);
}

TEST_CASE("conditioning: under a mesh's pressure, coupled regions have one answer in all units") {
  using Solver = ContactSolver<MeshSurface<double>, DuffingForce<double>, CoulombFriction<double>, Regions<4>,
                               NoDeformation<double>, AtContact, CompliantRegions<>>;
  check_units<Solver>(
      [](const Units& u) {
        const TriangleMesh<double> body(Ellipsoid<double>({.axes = u.length * V(6, 4, 4)}).mesh(200));
        MeshData<double> pins =
            Box<double>({.half = u.length * V(1.5, 2, 1.5), .centre = u.length * V(-3, 2, 0)}).mesh(26);
        test::append<double>(pins, pins, u.length * V(6, 0, 0));
        return Solver::Parts{
            MeshSurface<double>(body),
            ToolPoints<double>(TriangleMesh<double>(pins), {.contact_area = u.length * u.length}),
            spring(u),
            dry,
            {u.length},
            {},
            {}};
      },
      1e-12);  // atan2 and acos in normals; the path amplifies a last digit by the number of its ticks
}

TEST_CASE("conditioning: E from 1 to 1e12, nu to 1/2: forces in proportion to E/(1 - nu^2), strain exact") {
  for (const double E : {1.0, 1e3, 1e6, 1e9, 1e12}) {
    for (const double nu : {0.0, 0.3, 0.49, 0.499999999, 0.5}) {
      const auto sphere = PowerLawForce<double>::hertz_sphere(E, nu, 0.01);
      for (const double D : {1e-12, 1e-6, 1e-3}) {
        const long double F =
            4.0L / 3 * E / (1 - static_cast<long double>(nu) * nu) * sqrtl(0.01L) * D * sqrtl(D);
        CHECK_RELATIVE(sphere.force(D), F, test::ulps<double>(16));
        CHECK_RELATIVE(sphere.depth(sphere.force(D)), D, test::ulps<double>(16));
      }
      // Under pressure p from all sides: strain -(1 - 2 nu) p/E, 0 at nu = 1/2.
      const IsotropicElasticity<double> material({.E = E, .nu = nu, .rho = 1000});
      const auto strain = material.strain({-3 * E, -3 * E, -3 * E, 0, 0, 0});
      for (int k = 0; k < 3; ++k) CHECK_ABSOLUTE(strain[std::size_t(k)], -3 * (1 - 2 * nu), 16 * epsilon);
      CHECK_RELATIVE(material.shear_modulus(), E / 2 / (1 + static_cast<long double>(nu)),
                     test::ulps<double>(4));
    }
  }
}

TEST_CASE("conditioning: laws from 1e-12 to 1e6 N give the depth back that gave the force") {
  for (const double k : {1e-9, 1e-3, 1.0, 1e6, 1e12}) {
    for (const double D : {1e-9, 1e-6, 1e-3, 1.0, 1e3}) {
      const DuffingForce<double> stiffens({.c1 = k, .c3 = k / (D * D)});
      CHECK_RELATIVE(stiffens.force(D), 2 * static_cast<long double>(k) * D, test::ulps<double>(4));
      CHECK_RELATIVE(stiffens.depth(stiffens.force(D)), D, test::ulps<double>(8));
      CHECK_RELATIVE(stiffens.energy(D), 0.75L * k * D * D, test::ulps<double>(4));
      const HertzForce<double> soft({.k = k, .compliance = 0.3 / (k * std::sqrt(D))});
      // e = C k sqrt(D) = 0.3; F is the root of F = k (D - C F)^(3/2).
      const long double F = soft.force(D);
      const long double C = 0.3L / (static_cast<long double>(k) * sqrtl(D));
      CHECK_RELATIVE(k * powl(D - C * F, 1.5L), F, test::ulps<double>(16));
    }
  }
}

TEST_CASE("conditioning: needles: depth at the tip and at the waist is the closed form's") {
  // 1 : 1000, the longest allowed. At the tip depth is measured along the axis down to the centre of
  // curvature, b^2/a below it; at the waist along the radius.
  for (const double a : {1e-3, 1.0, 1e3}) {
    const double b = a / 1000;
    const Ellipsoid<double> needle({.axes = V(a, b, b)});
    for (const double part : {1.0, 0.5, 1e-3}) {
      const double d = part * (b * b / a) * 0.999;
      const auto tip = needle.closest(V(a - d, 0, 0));
      CHECK_RELATIVE(tip.distance, -d, 1e-15 * a / d);  // a - d has rounded the depth to epsilon a
      CHECK((tip.normal - V::UnitX()).norm() <= 1e-6);  // next to the centre of curvature: sqrt(epsilon)
      const auto waist = needle.closest(V(0, b * (1 - part / 2), 0));
      CHECK_RELATIVE(waist.distance, -b * part / 2, 8 * epsilon / part);
      CHECK(waist.normal == V::UnitY());
    }
  }
}

TEST_CASE("conditioning: a mesh of slivers is the box that it covers") {
  // Every face a fan about a vertex 1e-7 off one of its corners: triangles of aspect 1e7.
  MeshData<double> mesh;
  const double h[3] = {0.5, 0.25, 0.125};
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? h[0] : -h[0], i & 2 ? h[1] : -h[1], i & 4 ? h[2] : -h[2]);
  const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    const V corner = mesh.vertices[f[0]], towards = mesh.vertices[f[2]] - corner;
    const auto hub = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(corner + 1e-7 * towards);
    for (int k = 0; k < 4; ++k) mesh.triangles.push_back({f[k], f[(k + 1) % 4], hub});
  }
  const TriangleMesh<double> checked(mesh);
  CHECK_RELATIVE(checked.volume(), 8 * h[0] * h[1] * h[2], test::ulps<double>(16));
  CHECK_RELATIVE(checked.area(), 8 * (h[0] * h[1] + h[1] * h[2] + h[2] * h[0]), test::ulps<double>(16));
  const MeshSurface<double> slivers(checked);
  const Box<double> box({.half = V(h[0], h[1], h[2])});
  for (int i = 0; i < 1000; ++i) {
    const V x(0.7 * std::sin(1.7 * i), 0.4 * std::sin(2.3 * i), 0.2 * std::sin(3.1 * i));
    CHECK_ABSOLUTE(slivers.closest(x).distance, box.closest(x).distance, 8 * epsilon);
  }
}

TEST_CASE("conditioning: touching to the last bit: 0 at the surface, k ulp one step below, on all bodies") {
  // h is a power of two: one step below it depth is h epsilon/2 and k of it without a rounding.
  const double h = 0.25, k = 1000, step = h * epsilon / 2;
  const auto check = [&](auto solver, const V& out, double tolerance) {
    const V at = h * out, below = (h - step) * out, above = (h + 2 * step) * out;
    CHECK(force_at(solver, at) == V::Zero());
    CHECK(force_at(solver, above) == V::Zero());
    const V F = force_at(solver, below);
    CHECK((F - k * step * out).norm() <= tolerance * k * step);
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const V out = side * V::Unit(axis);
      check(point_on(Sphere<double>({.radius = h}), k), out, 0);
      check(point_on(Box<double>({.half = V::Constant(h)}), k), out, 0);
      check(point_on(
                MeshSurface<double>(TriangleMesh<double>(Box<double>({.half = V::Constant(h)}).mesh(26))), k),
            out, 0);
      check(point_on(Cylinder<double>({.radius = h, .half_height = h}), k), out, 0);
      check(point_on(Ellipsoid<double>({.axes = V::Constant(h)}), k), out, 0);
    }
}

TEST_CASE("conditioning: centres, corners and edges have the answers that are stated for them") {
  // From a sphere's centre: out along +x, as deep as the radius.
  auto ball = point_on(Sphere<double>({.radius = 0.25}), 1000);
  CHECK(force_at(ball, V::Zero()) == V(250, 0, 0));
  // From an ellipsoid's centre, and from the tip's centre of curvature b^2/a: the + side of the smallest
  // axis, and along the axis.
  const Ellipsoid<double> egg({.axes = V(0.5, 0.25, 0.375)});
  CHECK(egg.closest(V::Zero()).position == V(0, 0.25, 0));
  CHECK(egg.closest(V::Zero()).distance == -0.25);
  const double centre = 0.5 - 0.25 * 0.25 / 0.5;                        // 0.375, exact
  CHECK_RELATIVE(egg.closest(V(centre, 0, 0)).distance, -0.125, 1e-8);  // the root is threefold there
  // Extremal points: no depth there, and k D below them along their normals.
  auto on_egg = point_on(egg, 1000);
  for (const auto& end : extremal_points(egg)) {
    CHECK(force_at(on_egg, end.position).norm() <= 1000 * 4 * epsilon);
    CHECK((force_at(on_egg, end.position - 0.0625 * end.normal) - 62.5 * end.normal).norm() <=
          62.5 * 16 * epsilon);
  }
  // A box's corner and the middle of its edge, from outside: no contact, and the distance is that to them.
  const Box<double> box({.half = V(0.5, 0.25, 0.125)});
  const MeshSurface<double> mesh(TriangleMesh<double>(box.mesh(8)));
  for (const V& on : {V(0.5, 0.25, 0.125), V(0.5, 0.25, 0), V(0.5, 0.25, -0.125), V(0.5, 0, 0)}) {
    auto on_box = point_on(box, 1000);
    auto on_mesh = point_on(mesh, 1000);
    CHECK(force_at(on_box, on) == V::Zero());
    CHECK(force_at(on_mesh, on) == V::Zero());
    CHECK(box.closest(on).distance == 0);
    CHECK(mesh.closest(on).distance == 0);
    const V off = on + V(0.0625, on.y(), on.z());
    const V foot = off.cwiseMin(V(0.5, 0.25, 0.125)).cwiseMax(-V(0.5, 0.25, 0.125));
    CHECK_RELATIVE(box.closest(off).distance, (off - foot).norm(), test::ulps<double>(4));
    CHECK_RELATIVE(mesh.closest(off).distance, (off - foot).norm(), test::ulps<double>(4));
  }
}

TEST_CASE("conditioning: numbers too small to be normal are as good as 0, flushed or not") {
  const double tiny = std::numeric_limits<double>::denorm_min(), small = std::numeric_limits<double>::min();
  const auto check = [&] {
    // A pose off by next to nothing has the force of the pose itself.
    const Ellipsoid<double> egg({.axes = V(0.06, 0.04, 0.04)});
    auto solver = make_solver(egg, PointTool<double>{}, DuffingForce<double>({.c1 = 300, .c3 = 1e6}), dry);
    const V there = force_at(solver, V(0, 0.039, 0));
    for (const double off : {tiny, 1000 * tiny, small})
      CHECK((force_at(solver, V(off, 0.039, -off)) - there).norm() <= 8 * epsilon * there.norm());
    // A law so soft that its force is too small: 0, or within a step of it.
    const DuffingForce<double> soft({.c1 = 1e-300});
    CHECK_RELATIVE(soft.force(1e-3), 1e-303, 4 * epsilon);
    CHECK_ABSOLUTE(soft.force(1e-20), 0, 1e-320 * (1 + 1e-3));
    CHECK(soft.depth(1e-303) > 0.99e-3);
    CHECK(soft.depth(1e-303) < 1.01e-3);
    // A depth too small: no force to speak of.
    const DuffingForce<double> usual({.c1 = 300, .c3 = 1e6});
    CHECK_ABSOLUTE(usual.force(tiny), 0, 301 * tiny);
    CHECK_ABSOLUTE(usual.force(small), 300 * small, 300 * small * epsilon);
    // The gate passes a demand too small, and a step too short is a step.
    Gate<double> gate({.arm_after = 0, .ramp_time = 0});
    CHECK_ABSOLUTE(gate.pass({V(tiny, 0, 0), V::Zero()}, false, 1e-3).force.norm(), 0, 2 * tiny);
    CHECK(gate.pass({V(1, 0, 0), V::Zero()}, false, tiny).force == V(1, 0, 0));
    CHECK(gate.pass({V(0.25, 0, 0), V::Zero()}, false, 1e-3).force == V(0.25, 0, 0));
  };
  check();
#if defined(__SSE2__)
  const FlushToZero flush;
  check();
#endif
}
