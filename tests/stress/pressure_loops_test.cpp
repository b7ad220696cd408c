// SPDX-License-Identifier: MIT

// Energy over closed loops of a pin, without friction: pressed in, rocked and shifted, drawn out. The
// pressure on the tool's surface is the gradient of an integral, so what is left is the points' quadrature.

#include <palpate/geometry/sphere.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/check.hpp>
#include <support/joined.hpp>

#include <array>
#include <numbers>
#include <vector>

using namespace palpate;

namespace {

using V = Vec3<double>;
constexpr double radius = 0.003, k = 400, area = std::numbers::pi * radius * radius;

struct Flat {  // the half space y < 0
  using Scalar = double;
  SurfacePoint<double> closest(const V& x) const noexcept { return {V(x.x(), 0, x.z()), V::UnitY(), x.y()}; }
  Penetration<double> penetration(const V& x) const noexcept { return {-x.y(), V::UnitY()}; }
  bool separated(const V& centre, double r) const noexcept { return centre.y() > r; }
  double reach() const noexcept { return std::numeric_limits<double>::infinity(); }
};

struct Ball {  // of radius 20 mm, its top at the origin
  using Scalar = double;
  Sphere<double> sphere{{.radius = 0.02}};
  V down{0, 0.02, 0};
  SurfacePoint<double> closest(const V& x) const noexcept {
    SurfacePoint<double> p = sphere.closest(x + down);
    p.position -= down;
    return p;
  }
  Penetration<double> penetration(const V& x) const noexcept { return sphere.penetration(x + down); }
  bool separated(const V& centre, double r) const noexcept { return sphere.separated(centre + down, r); }
  double reach() const noexcept { return sphere.reach(); }
};

/// A pin of rings, `spacing` [m] apart, its face at the origin and looking down.
TriangleMesh<double> pin(double spacing) {
  constexpr double height = 0.02;
  const auto around = static_cast<std::uint32_t>(std::lround(2 * std::numbers::pi * radius / spacing));
  const int across = static_cast<int>(std::lround(radius / spacing)),
            up = static_cast<int>(std::lround(height / spacing));
  MeshData<double> mesh;
  std::vector<std::uint32_t> rings;  // first vertices; a ring of one vertex at both ends
  const auto ring = [&](double r, double y) {
    rings.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    for (std::uint32_t i = 0; i < (r > 0 ? around : 1); ++i) {
      const double a = 2 * std::numbers::pi * i / around;
      mesh.vertices.emplace_back(r * std::cos(a), y, r * std::sin(a));
    }
  };
  for (int i = 0; i <= across; ++i) ring(radius * i / across, 0);
  for (int i = 1; i <= up; ++i) ring(radius, height * i / up);
  for (int i = across - 1; i >= 0; --i) ring(radius * i / across, height);
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::size_t j = 0; j + 1 < rings.size(); ++j) {
    const std::uint32_t a = rings[j], b = rings[j + 1];
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t n = (i + 1) % around;
      if (j > 0) mesh.triangles.push_back({a + n, a + i, b == last - 1 ? b : b + i});
      if (b != last - 1) mesh.triangles.push_back({j > 0 ? a + n : a, b + i, b + n});
    }
  }
  return TriangleMesh<double>(std::move(mesh));
}

/// Two such pins, 8 mm from axis to axis along x.
TriangleMesh<double> two_pins(double spacing) {
  const TriangleMesh<double> one = pin(spacing);
  MeshData<double> mesh;
  for (const double x : {-0.004, 0.004}) test::append<double>(mesh, one.data(), V(x, 0, 0));
  return TriangleMesh<double>(std::move(mesh));
}

/// A loop in height, tilt about z and shift along x.
struct Corner {
  double down, tilt, aside;
};
using Loop = std::array<Corner, 5>;
const Loop shallow{{{0, -0.1, 0}, {0.003, -0.1, 0}, {0.003, 0.2, 0.001}, {0, 0.2, 0.001}, {0, -0.1, 0}}};
const Loop deep{{{0, 0.5, 0}, {0.006, 0.5, 0}, {0.006, 1.2, 0.001}, {0, 1.2, 0.001}, {0, 0.5, 0}}};

/// What the wrench gains on the loop, as a share of the most that the stroke takes.
template <class Felt>
double gain(const Loop& loop, const Felt& felt) {
  double work = 0, least = 0;
  for (std::size_t leg = 0; leg + 1 < loop.size(); ++leg) {
    const Corner& a = loop[leg];
    const Corner& b = loop[leg + 1];
    constexpr int steps = 400;
    for (int i = 0; i < steps; ++i) {
      const double u = (i + 0.5) / steps, tilt = a.tilt + (b.tilt - a.tilt) * u;
      Pose<double> X;
      X.rotation = Eigen::AngleAxisd(tilt, V::UnitZ()).toRotationMatrix();
      X.translation = V(a.aside + (b.aside - a.aside) * u, -a.down - (b.down - a.down) * u, 0);
      const Wrench<double> w = felt(X);
      work += (w.force.x() * (b.aside - a.aside) - w.force.y() * (b.down - a.down) +
               w.torque.z() * (b.tilt - a.tilt)) /
              steps;
      least = (std::min)(least, work);
    }
  }
  return work / -least;
}

template <class Object>
double pressure(const Loop& loop, double spacing) {
  ContactSolver<Object, LinearForce<double>, Frictionless<double>, SingleRegion<>> solver(
      {.object = {},
       .tool = ToolPoints<double>(pin(spacing), {.contact_area = area}),
       .force = LinearForce<double>({.k = k}),
       .friction = {}});
  return gain(loop, [&](const Pose<double>& X) { return solver.tick(X).wrench; });
}

/// The same of two pins.
template <class Object, class Coupling>
double pressure_of_two(const Loop& loop, double spacing, std::size_t& regions) {
  ContactSolver<Object, LinearForce<double>, Frictionless<double>, Regions<4>, NoDeformation<double>,
                AtContact, Coupling>
      solver({.object = {},
              .tool = ToolPoints<double>(two_pins(spacing), {.contact_area = area}),
              .force = LinearForce<double>({.k = k}),
              .friction = {},
              .contacts = {.distance = 1.3 * spacing}});
  return gain(loop, [&](const Pose<double>& X) {
    const Wrench<double> w = solver.tick(X).wrench;
    regions = (std::max)(regions, solver.contacts().size());
    return w;
  });
}

/// A_i max(0, - n_i.g_i) along g_i: the projected area, clipped. Here only: it is not from a potential.
template <class Object>
double clipped(const Loop& loop, double spacing) {
  const TriangleMesh<double> mesh = pin(spacing);
  const Object object;
  return gain(loop, [&](const Pose<double>& X) {
    Wrench<double> w;
    for (std::size_t i = 0; i < mesh.vertices().size(); ++i) {
      const V arm = X.rotation * mesh.vertices()[i], a = X.rotation * mesh.vertex_vector_areas()[i];
      const Penetration<double> in = object.penetration(arm + X.translation);
      if (!(in.depth > 0)) continue;
      const V f = k * in.depth / area * (std::max)(0.0, -a.dot(in.gradient)) * in.gradient;
      w.force += f;
      w.torque += arm.cross(f);
    }
    return w;
  });
}

}  // namespace

TEST_CASE("halving the spacing quarters what a loop of the pressure gains") {
  double before = 0;
  for (const double spacing : {1.5e-3, 0.75e-3, 0.375e-3}) {
    const double made = std::abs(pressure<Flat>(shallow, spacing));
    MESSAGE("spacing ", spacing * 1e3, " mm: pressure ", made, ", clipped along the exit ",
            clipped<Flat>(shallow, spacing));
    CHECK(made < 0.004 * std::pow(spacing / 1.5e-3, 2));
    if (before > 0) CHECK(made < 0.35 * before);  // second order: a quarter, and its scatter
    before = made;
  }
  // The clipped form does not converge to nothing.
  CHECK(clipped<Flat>(shallow, 0.375e-3) > 0.01);
}

TEST_CASE("two pins that feel each other gain on a loop what their mesh leaves, a quarter on half of it") {
  double before = 0;
  for (const double spacing : {1.5e-3, 0.75e-3, 0.375e-3}) {
    std::size_t regions = 0;
    double made = 0, alone = 0;
    for (const double turned : {0.6, 0.8, 1.0, 1.2}) {  // one loop alone may end near a change of sign
      Loop loop = shallow;
      for (Corner& corner : loop) corner.tilt *= turned;
      made = (std::max)(made, std::abs(pressure_of_two<Flat, CompliantRegions<>>(loop, spacing, regions)));
      alone = (std::max)(alone, std::abs(pressure_of_two<Flat, IndependentRegions>(loop, spacing, regions)));
    }
    MESSAGE("two pins, spacing ", spacing * 1e3, " mm: coupled ", made, ", independent ", alone);
    CHECK(regions == 2);
    CHECK(made < 0.004 * std::pow(spacing / 1.5e-3, 2));  // as of one pin
    if (before > 0) CHECK(made < 0.35 * before);          // second order: a quarter, and its scatter
    before = made;
  }
}

TEST_CASE("on a curved body a loop gains a thousandth: the turning of the exit, left out of the backs") {
  const double made = std::abs(pressure<Ball>(shallow, 0.375e-3));
  MESSAGE("pressure ", made, ", clipped ", clipped<Ball>(shallow, 0.375e-3));
  CHECK(made < 0.001);
  CHECK(std::abs(clipped<Ball>(shallow, 0.375e-3)) > 8 * made);
}

TEST_CASE("a pin that lies deep in the body gains nothing on a flat one, half a percent on a curved one") {
  const double flat = std::abs(pressure<Flat>(deep, 0.5e-3)), curved = std::abs(pressure<Ball>(deep, 0.5e-3));
  MESSAGE("flat ", flat, ", curved ", curved, "; clipped ", clipped<Flat>(deep, 0.5e-3), ", ",
          clipped<Ball>(deep, 0.5e-3));
  CHECK(flat < 0.0005);   // of second order in the spacing, as above
  CHECK(curved < 0.005);  // 6 mm below a ball of 20 mm, tilted by 30 to 70 degrees
}
