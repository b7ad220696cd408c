// SPDX-License-Identifier: MIT
// What a resolved contact has beyond small displacements: the surface that friction carries along, the limit
// of friction at finite strain, finite strain.
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/detail/finite_strain.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/on_block.hpp>
#include <support/on_half_space.hpp>
#include <support/paths.hpp>
#include <support/response_fields.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <numbers>

using namespace palpate;
using namespace palpate::test;

namespace {

using V = Vec3<double>;
constexpr double R = 0.015;

/// A ball on the half-space, or on a body as compliant.
template <class Body = Box<double>>
auto ball_on(double mu, const Body& body = ground()) {
  return on_half_space(Sphere<double>({.radius = R}).mesh(2000), 0.0012,
                       CoulombFriction<double>({.mu_static = mu, .mu_dynamic = mu}), body);
}
/// On a block of 100 mm, 1 MPa; where the ball touches first is at the pose's origin.
auto sticking_ball() {
  const V size(0.1, 0.1, 0.1);
  return on_block(size, block_compliance(size, 400),
                  CoulombFriction<double>({.mu_static = 1, .mu_dynamic = 1}), cap_samples(R, 0.012, 0.0018));
}
Pose<double> at(double x, double y, double z = 0) {
  Pose<double> X;
  X.translation = V(x, y, z);
  return X;
}

}  // namespace

TEST_CASE("a contact that sticks takes its surface along: aside of a convex body's top it stays as deep") {
  // On a sphere of 20 mm, 2 mm aside: the undeformed surface is 57 um farther there, of a depth of 1 mm.
  auto solver = ball_on(10, Sphere<double>({.radius = 0.02}));
  const double top = 0.02 + R;
  double pressed = 0;
  for (int i = 1; i <= 100; ++i) pressed = solver.tick(at(0, top - 1e-5 * i)).wrench.force.y();
  double work = 0, spent = 0;
  V before = V(0, pressed, 0), x_before(0, top - 1e-3, 0);
  for (int i = 1; i <= 400; ++i) {
    const V x(0.002 * std::sin(std::numbers::pi * i / 400), top - 1e-3, 0);
    const V force = solver.tick(at(x.x(), x.y())).wrench.force;
    CHECK_RELATIVE(force.y(), pressed, 0.02);  // by the undeformed surface 8 % less
    const double w = 0.5 * (force + before).dot(x - x_before);
    work += w, spent += std::abs(w);
    before = force, x_before = x;
  }
  // Nothing slips, so the work is returned; points at the rim slip as they come in and go.
  CHECK(std::abs(work) <= 0.01 * spent);
  CHECK_ABSOLUTE(before.x(), 0, 0.01 * pressed);
}

TEST_CASE(
    "where a ball slides on rubber each point has mu times pressure, area of the ball, stretch and lift") {
  // On a large block, for the cones lean with the surface, too: it turns by 0.005 where the block is 0.1 m.
  constexpr double mu = 0.3, deep = 0.003, side = 0.4, E = 1e6;
  const SurfaceSamples<double> points =
      contact_samples(TriangleMesh<double>(Sphere<double>({.radius = R}).mesh(2000)), 0.0012);
  for (const double nu : {0.3, 0.49}) {
    CAPTURE(nu);
    using Elastic = ElasticContact<double, ResponseCompliance>;
    const auto field = std::make_shared<const ResponseField>(block_field(V(side, side, side), E, nu, 80));
    ContactSolver<Box<double>, Elastic, CoulombFriction<double>, ContactPoints<256>> solver(
        {.object = Box<double>({.half = V::Constant(side / 2), .centre = V(0, side / 2, 0)}),
         .tool = ToolPoints<double>(points, {.contact_area = 1e-4}),
         .force = Elastic({.compliance = ResponseCompliance(field)}),
         .friction = CoulombFriction<double>({.mu_static = mu, .mu_dynamic = mu})});
    const double height = side + R - deep;
    for (int i = 0; i <= 100; ++i) (void)solver.tick(at(0, height + deep * (100 - i) / 100), 1e-3);
    double x = 0;
    for (int i = 1; i <= 300; ++i) (void)solver.tick(at(x = 3e-5 * i, height), 1e-3);
    REQUIRE(solver.contacts()[0].mode == ContactMode::sliding);
    // Loads on the body, in the order of points.
    FixedVector<SurfaceLoad<double>, 256> loads;
    solver.state().loads(loads);
    const auto felt = solver.state().points();
    REQUIRE(loads.size() == felt.size());
    // Tractions are what is beside the pressure along the ball's normal, its share of friction_cones.hpp, and
    // none of that is left of all loads.
    const auto slope = [&](std::size_t i) {
      const V m = loads[i].direction, normal = loads[i].tool_normal;
      return V((std::min)(2 * (1 - 2 * nu), 1.) * (normal / normal.dot(m) - m));
    };
    V pushed_aside = V::Zero();
    double normal_force = 0;
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const double q = loads[i].force.dot(loads[i].direction);
      pushed_aside += q * slope(i), normal_force += q;
    }
    double steepest = 1;
    for (std::size_t i = 0; i < felt.size(); ++i) {
      const auto& point = felt[i];
      const double q = loads[i].force.dot(loads[i].direction),
                   t = (loads[i].force - q * (loads[i].direction + slope(i) - pushed_aside / normal_force))
                           .norm(),
                   cosine = (V(x, height, 0) - point.position).normalized().dot(point.normal);
      steepest = (std::min)(steepest, cosine);
      // sqrt(1 + g^2) of area, sqrt(1 + g^2/2) of stretch, 1 + mu^2 g^2/2 as friction lifts the surface before
      // the ball, g: slope; the surface is pressed together by (1 - 2 nu) p/(6 mu), E = 2 (1 + nu) mu.
      const double area = 1 / cosine, stretch = std::sqrt((1 + area * area) / 2),
                   lift = 1 + mu * mu * (area * area - 1) / 2,
                   strain = -(1 - 2 * nu) * point.pressure * (1 + nu) / (3 * E);
      // Points that have just come in have no tractions yet; normals are a cell's mean, pressures the last
      // tick's. Measured: 0.43 %.
      if (t > 0) CHECK_RELATIVE(t, mu * q * area * stretch * lift * (1 + strain), 0.01);
    }
    CHECK(steepest < 0.95);
  }
}

TEST_CASE("a ball by a block's edge, pushed towards it: finite elements' force within 2 %, held and slid") {
  // Forces on the body, of bench/truth/data/contact/ball_edge_pushed. Measured: 1.2 to 1.4 % of the force, to
  // the side 0.9 % at most; 1.2 and 1.1 % in steps 2 and 3 where points that hold feel the regular part's
  // gradient, by the square of their share of the limit.
  const V size(0.07, 0.05, 0.07);
  const auto field = std::make_shared<const ResponseField>(block_field(size, 1e6, 0.3, 400));
  auto solver = on_block(size, ResponseCompliance(field),
                         CoulombFriction<double>({.mu_static = 0.3, .mu_dynamic = 0.3}),
                         cap_samples(0.01, 0.009, 0.0012));
  struct Row {
    double x, depth;  // [m]
    V force;          // [N]
  };
  V now(0.025, 0, 0);
  for (const Row& row :
       {Row{0.025, 0.002, V(-1.54441, -12.8665, 0)}, Row{0.025, 0.004, V(-5.43253, -36.1112, 0)},
        Row{0.0255, 0.004, V(-1.90615, -34.9205, 0)}, Row{0.028, 0.004, V(7.43009, -30.5337, 0)}}) {
    const V from = now, to(row.x, row.depth, 0);
    V force;
    for (int i = 1; i <= 200; ++i) {
      now = from + i / 200. * (to - from);
      force = -solver.tick(at(now.x(), size.y() - now.y())).wrench.force;
    }
    CAPTURE(force.transpose());
    CHECK((force - row.force).norm() <= 0.02 * row.force.norm());
    CHECK_ABSOLUTE(force.x(), row.force.x(), 0.02 * row.force.norm());
  }
}

TEST_CASE("a ball pressed into rubber of any nu: finite elements' force within 3 %, frictionless or held") {
  // Where nu < 1/2 the surface is drawn in beneath the ball, to where that is deeper. A block of 90 x 60 x 90
  // mm, 1 MPa, 1, 2, 4, 7.5 mm deep (bench/truth/data/contact, ball_nu0, ball_nu0_stuck, and the former with
  // nu = 0.3). Measured, in the order below: 1.6, 0.8, 2.6 % at most; before, 7 to 17, 2 to 3, 5 to 9 % less.
  const V size(0.09, 0.06, 0.09);
  const auto pressed = [&size](double nu, const auto& friction, const std::array<double, 4>& wanted) {
    CAPTURE(nu);
    const auto field = std::make_shared<const ResponseField>(block_field(size, 1e6, nu, 400));
    auto solver = on_block(size, ResponseCompliance(field), friction, cap_samples(R, 0.0135, 0.0018));
    double deep = 0, force = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const double from = deep, to = std::array{1e-3, 2e-3, 4e-3, 7.5e-3}[k];
      for (int i = 1; i <= 100; ++i) {
        deep = from + (to - from) * i / 100;
        force = solver.tick(at(0, size.y() - deep)).wrench.force.y();
      }
      CAPTURE(deep);
      CHECK_RELATIVE(force, wanted[k], 0.03);
    }
  };
  pressed(0, Frictionless<double>(), {5.768, 17.087, 51.566, 143.231});
  pressed(0.3, Frictionless<double>(), {6.074, 17.644, 51.646, 137.490});
  pressed(0, CoulombFriction<double>({.mu_static = 1, .mu_dynamic = 1}), {5.946, 17.509, 52.277, 143.615});
}

TEST_CASE("a ball pushed aside on rubber of nu = 0.3: finite elements' force within 2 %") {
  // 3 mm deep and 0.5 mm aside, mu = 0.3: 3.671 N (bench/truth/data/contact, ball_slid_nu3). Measured: 0.7 %
  // more; 3.4 % less where cones are about m.
  const V size(0.1, 0.1, 0.1);
  const auto field = std::make_shared<const ResponseField>(block_field(size, 1e6, 0.3, 400));
  auto solver =
      on_block(size, ResponseCompliance(field),
               CoulombFriction<double>({.mu_static = 0.3, .mu_dynamic = 0.3}), cap_samples(R, 0.012, 0.0018));
  for (int i = 1; i <= 100; ++i) (void)solver.tick(at(0, 0.1 - 3e-5 * i));
  const double before = solver.tick(at(0, 0.097)).wrench.force.x();
  for (int i = 1; i <= 50; ++i) (void)solver.tick(at(1e-5 * i, 0.097));
  CHECK_RELATIVE(before - solver.tick(at(0.0005, 0.097)).wrench.force.x(), 3.671, 0.02);
}

TEST_CASE(
    "a ball that sticks resists a turn by 3/(4 pi) a/R more than on a half-space, a flat face by nothing") {
  // Against finite elements: bench/truth/data/contact, ball_twisted. The block itself gives way by 1.2 % of a
  // turn, as the last row has it. Measured: 0.4 and 1.6 % below; 8 and 11 % without the stiffening.
  const V size(0.1, 0.1, 0.1);
  const CoulombFriction<double> sticks({.mu_static = 10, .mu_dynamic = 10});
  struct Felt {
    double torque, area;
  };
  const auto turned = [](auto solver, double deep) {
    for (int i = 1; i <= 100; ++i) (void)solver.tick(at(0, 0.1 - deep * i / 100), 1e-3);
    Pose<double> X = at(0, 0.1 - deep);
    X.rotation = rotation_about<double>(V::UnitY(), 0.01);
    for (int i = 0; i < 20; ++i) (void)solver.tick(X, 1e-3);
    return Felt{-solver.tick(X, 1e-3).wrench.torque.y(), solver.contacts()[0].area};
  };
  struct Row {
    double radius, half, deep;  // of the ball and its cap [m]
  };
  for (const auto& [radius, half, deep] : {Row{R, 0.012, 2e-3}, Row{R, 0.012, 4e-3}, Row{10, 0.008, 1e-4}}) {
    CAPTURE(radius);
    const auto samples = cap_samples(radius, half, 0.0014);
    const Felt on_field = turned(on_block(size, block_compliance(size, 400), sticks, samples), deep),
               linear =
                   turned(on_block(size, HalfSpace({.E = block_E, .nu = block_nu}), sticks, samples), deep);
    const double kappa = 3 / (4 * std::numbers::pi) * std::sqrt(on_field.area / std::numbers::pi) / radius;
    CHECK_RELATIVE(on_field.torque / linear.torque, 1 + kappa, 0.02);
  }
}

TEST_CASE("a ball that slides round in circles hardly needs an iteration: the last tick's change goes on") {
  // With the share of what goes on from normal displacements alone, which do not change here, 4.
  auto solver = ball_on(0.3);
  for (int i = 0; i <= 100; ++i) (void)solver.tick(at(0.01, R - 1e-5 * i));
  int iterations = 0;
  for (int i = 0; i < 1200; ++i) {
    const double phi = 0.006 * i;
    (void)solver.tick(at(0.01 * std::cos(phi), R - 1e-3, 0.01 * std::sin(phi)));
    if (i >= 200) iterations += solver.state().residual().iterations;
  }
  CHECK(iterations <= 1000);
}

TEST_CASE("finite strain: Hertz's pressure has the strain d/R, and nu turns softer into stiffer") {
  constexpr float a = 0.004f, ball = 0.015f, width = a / 20;
  for (const double nu : {0.3, 0.49}) {
    CAPTURE(nu);
    detail::PointSystem system(2000, static_cast<float>(1 - 2 * nu), true);
    std::vector<float> q;
    system.begin_tick();
    system.clear();
    for (float x = -a; x <= a; x += width)
      for (float z = -a; z <= a; z += width) {
        const float s = 1 - (x * x + z * z) / (a * a);
        if (s <= 0) continue;
        const float volume = s * width * width;
        system.touch(0.004f * s, volume, volume * Vec3<float>(x, 0, z), -volume * Vec3<float>::UnitY());
        system.add(Vec3<float>(x, 0, z), -Vec3<float>::UnitY(), 0.001f * s, width * width);
        // p = 2 E' a/(pi R) sqrt(s), q = p A/(4 pi mu), E' = 2 mu/(1 - nu)
        const float per_modulus = 2 * a / (std::numbers::pi_v<float> * ball) * std::sqrt(s);
        q.push_back(per_modulus * width * width /
                    (2 * std::numbers::pi_v<float> * static_cast<float>(1 - nu)));
      }
    system.build();
    detail::FiniteStrain strain(nu);
    CHECK(strain.depth(0.001f) == 0.001f);
    // Points sink by 4 mm, of which the regular part is 1.
    q.resize(system.stride());
    std::vector<float> r(system.stride());
    detail::VectorList regular, none;
    for (auto* list : {&regular, &none}) list->resize(system.stride());
    for (std::size_t i = 0; i < system.size(); ++i) {
      r[i] = 0.004f - system.depth[i];
      regular.set(i, Vec3<float>(2e-6f, -0.001f, 0));
    }
    const Vec3<float> across(0.2f, 0, 0.1f);  // of the first point, a two hundredth of all
    detail::VectorList loads;
    loads.resize(system.stride());
    float load = 0;
    for (std::size_t i = 0; i < system.size(); ++i) load += q[i], loads.set(i, -q[i] * Vec3<float>::UnitY());
    loads.set(0, loads[0] + load / 200 * across);
    strain.measure(system, loads, q.data(), r.data(), regular, detail::NoLoadsBeside(0, 0, 0), 0, 0);
    // With friction 0.7 of what it is stiffer by, a surface that is drawn in. Softer by k e under a flat face,
    // half as much again under a ball.
    const double e = a * a / (ball * ball), bounded = e / std::sqrt(1 + e * e),
                 softer = SecondOrder{}.at(nu).sphere_softening * bounded,
                 stiffer = 0.7 * 1.5 * SecondOrder{}.at(nu).sphere_drawn_in * std::sqrt(e);
    const float softening = strain.beside(Vec3<float>::UnitY(), 1).y();
    CHECK_RELATIVE(softening, softer, 0.02);  // 1,257 cells
    const float deep = 0.002f;
    CHECK_RELATIVE(strain.depth(deep), deep / (1 + 0.75 * ((1 + softer) / (1 + stiffer) - 1)),
                   1e-4);  // 1,257 cells
    CHECK((nu < 0.4) == (strain.depth(deep) > deep));
    // Less soft by 2/5 of what stretches the surface.
    detail::FiniteStrain stretched = strain;
    stretched.measure(system, loads, q.data(), r.data(), regular, detail::NoLoadsBeside(0, 0, 0), 0, 0.1f);
    CHECK_RELATIVE(1 + stretched.beside(Vec3<float>::UnitY(), 1).y(), (1 + softening) / 1.04f,
                   1e-6);  // float
    CHECK_RELATIVE(stretched.depth(deep), deep / (1 + 0.75 * ((1 + softer) / (1 + stiffer) / 1.04 - 1)),
                   1e-4);  // 1,257 cells
    // All has sunk alike, as under a flat face. Where a ball's points have, 4 mm at most, what is less deep is
    // the deeper, and all is as much softer as leaves the force.
    detail::FiniteStrain round = strain;
    std::vector<float> r_of_ball(system.stride());
    for (std::size_t i = 0; i < system.size(); ++i) {
      const float share = system.foot(i).squaredNorm() / (a * a);
      r_of_ball[i] = 0.004f * (1 - share / 2) - system.depth[i];
    }
    round.measure(system, loads, q.data(), r_of_ball.data(), none, detail::NoLoadsBeside(0, 0, 0), 0, 0);
    const double d_0 = 0.004, s = 0.18 * (1 - 7 * (1 - 2 * nu)) * bounded;
    const auto drawn = [&](double wider) { return 1 + 1.5 * softer + 1.3 * wider * (1 - 0.6 * wider); };
    const auto by_strain = [&](double wider) { return drawn(wider) / (1 + stiffer); };
    const double c = by_strain(s) - 1;
    for (const double x : {0., 0.1, 0.5, 1., 2.}) {
      const double y = (std::min)(x, 1.), d = x * d_0;
      const double expected = (d + s * d_0 * y * (2 - y)) / by_strain(s);
      CHECK(std::abs(round.depth(static_cast<float>(d)) - expected) <=
            0.05 * std::abs(c) * (std::max)(d, d_0));  // measured 0.035, of 1,257 cells
    }
    // Where friction holds the surface by three quarters it is narrower by a quarter of that, wider by all.
    detail::FiniteStrain held = strain;
    held.measure(system, loads, q.data(), r_of_ball.data(), none, detail::NoLoadsBeside(0, 0, 0), 0.75f, 0);
    const double s_held = nu < 0.4 ? s / 4 : s, d = d_0 / 2;
    CHECK(std::abs(held.depth(static_cast<float>(d)) - (d + s_held * d_0 * 0.75) / by_strain(s_held)) <=
          0.05 * std::abs(c) * d_0);
    // Measured 6e-4: f is 0.195 of 1,257 cells.
    CHECK_RELATIVE(1 + round.beside(Vec3<float>::UnitY(), 1).y(), drawn(s) / (1 + 7. / 6 * s), 1e-3);
    // Drawn with that the surface would be deeper than the ball lets it sink: in the middle by X of the depth,
    // not where the pressure falls to nothing.
    struct Pressure {
      const std::vector<float>&q, &r;
    };
    struct Regular {
      const detail::VectorList& w;
      const detail::VectorList& response() const { return w; }
    };
    const auto raised = [&](std::size_t i) {
      return round.raised(i, system, Pressure{q, r_of_ball}, Regular{none});
    };
    std::size_t middle = 0, rim = 0;
    for (std::size_t i = 0; i < system.size(); ++i) {
      if (q[i] > q[middle]) middle = i;
      if (q[i] < q[rim]) rim = i;
    }
    const double near = r_of_ball[middle] + system.depth[middle];
    CHECK_RELATIVE(raised(middle), by_strain(s) / (1 + 7. / 6 * s) * stiffer * near, 5e-3);  // 1,257 cells
    CHECK(raised(rim) < 3 * q[rim] / q[middle] * raised(middle));  // 2, and 4/3 of p_0 for 1,257 cells
    CHECK((nu < 0.4) == (raised(middle) > 5e-5f));
    // Across: a bonded patch's drag, over its force 8 mu a delta_t/(2 - nu), at the depth of a punch of the
    // same mean pressure, 2 a/(3 R) of its radius.
    const double beta = 2 * double(a) / (3 * ball),
                 kappa = SecondOrder{}.at(nu).drag * (2 - nu) / 8 * beta / (1 + beta * beta),
                 disc = std::numbers::pi * (2 - nu) / (2 * a);
    const Mat3<float>& G = strain.common();
    CHECK_RELATIVE(G(0, 0), disc * kappa / (1 + kappa), 0.02);  // 1,257 cells
    CHECK(G(2, 2) == G(0, 0));
    CHECK((G * Vec3<float>::UnitY()).norm() <= 1e-6f * G(0, 0));  // single precision
    // The load moves with the body: half of 2 um, less half of 1 mm of F_t/F_n, a two hundredth of `across`;
    // half as far where the body moves by two radii.
    const Vec3<float> shift(0.5f * 2e-6f - 0.5f * 1e-6f, 0, -0.5f * 5e-7f);
    CHECK((strain.shift() - shift).norm() <= 1e-3f * shift.norm());  // (w/2a)^4 is 2e-4
    detail::FiniteStrain far = strain;
    detail::VectorList by_two_radii = regular;
    for (std::size_t i = 0; i < system.size(); ++i) by_two_radii.set(i, -2 * a * Vec3<float>::UnitY());
    far.measure(system, loads, q.data(), r.data(), by_two_radii, detail::NoLoadsBeside(0, 0, 0), 0, 0);
    const Vec3<float> half = -0.5f * a * across / 200;
    CHECK((far.shift() - half).norm() <= 0.02f * half.norm());  // a: 1,257 cells
    detail::VectorList moved;
    moved.resize(system.stride());
    for (std::size_t i = 0; i < system.stride(); ++i) moved.set(i, Vec3<float>::Zero());
    strain.add(system, loads, moved);
    const Vec3<float> given = load / 200 * G(0, 0) * across;
    for (const std::size_t i : {std::size_t(0), system.size() - 1})
      CHECK((moved[i] + given).norm() <= 1e-4f * given.norm());  // 1,257 loads summed in single precision
    // The near field of all loads is that of k e more of their normal part and kappa/(1 + kappa) less of the
    // other.
    Vec3<float> beside = Vec3<float>::Zero();
    for (std::size_t i = 0; i < system.size(); ++i) beside += strain.beside(system.direction(i), q[i]);
    const Vec3<float> wanted = -load * softening * Vec3<float>::UnitY() -
                               static_cast<float>(kappa / (1 + kappa)) * load / 200 * across;
    CHECK((beside - wanted).norm() <= 0.02f * wanted.norm());  // 1,257 cells
    strain.forget();
    CHECK(strain.depth(0.001f) == 0.001f);
    CHECK(strain.common().isZero(0));
    CHECK(strain.shift().isZero(0));
    CHECK(strain.beside(Vec3<float>::UnitY(), 1).isZero(0));
  }
}

TEST_CASE("a ball that sticks deep in a block: finite elements' force across within 2 %, torque within 3 %") {
  // 0.5 mm aside where it is 6 mm deep (bench/truth/data/contact, ball_stuck): 4.430 N, two meshes differ by
  // 0.1 %; 62.70 N mm about the ball's middle, by 1 %. Measured: 1.0 % more, without stiffening 3.0 % less;
  // 2.0 % less, where tractions act at the points 3.9 %.
  auto solver = sticking_ball();
  for (int i = 1; i <= 120; ++i) (void)solver.tick(at(0, 0.1 - 5e-5 * i));
  const Wrench<double> before = solver.tick(at(0, 0.094)).wrench;
  for (int i = 1; i <= 20; ++i) (void)solver.tick(at(2.5e-5 * i, 0.094));
  const Wrench<double> after = solver.tick(at(0.0005, 0.094)).wrench;
  const double across = before.force.x() - after.force.x(), about_pole = before.torque.z() - after.torque.z();
  CHECK_RELATIVE(across, 4.430, 0.02);
  CHECK_RELATIVE(R * across + about_pole, 0.06270, 0.03);
}

TEST_CASE("a ball that sticks, pushed aside at one depth and back at another, gives the hand nothing") {
  // 3 and 6 mm deep, 0.3 mm aside, deep first or shallow first. Measured: -0.1 mJ a round, of 377 mJ to and
  // fro and 0.2 mJ that lie in the push aside; the points at the rim slip as they come in and go.
  for (const bool deep_first : {false, true}) {
    CAPTURE(deep_first);
    auto solver = sticking_ball();
    V x(0, 0.1, 0), force = V::Zero();
    double work = 0;
    const auto go = [&](double aside, double depth, int ticks) {
      const V from = x, to(aside, 0.1 - depth, 0);
      for (int i = 1; i <= ticks; ++i) {
        const V next = from + double(i) / ticks * (to - from);
        const V felt = solver.tick(at(next.x(), next.y())).wrench.force;
        work += 0.5 * (force + felt).dot(next - x);
        force = felt, x = next;
      }
    };
    const double there = deep_first ? 0.006 : 0.003, back = 0.009 - there;
    go(0, there, 100);
    for (int round = 0; round < 4; ++round) {
      work = 0;
      go(0.0003, there, 50);
      go(0.0003, back, 100);
      go(0, back, 50);
      go(0, there, 100);
      CHECK(work < 0);
    }
  }
}

TEST_CASE("a ball that sticks, dragged and rolled round, gives the hand nothing") {
  // 4 mm deep, 0.3 mm aside, 0.03 rad, drag first or roll first. Measured: -0.4 % of the work to and fro.
  for (const bool drag_first : {false, true}) {
    CAPTURE(drag_first);
    auto solver = sticking_ball();
    for (int i = 1; i <= 100; ++i) (void)solver.tick(at(0, 0.1 - 4e-5 * i));
    double aside = 0, angle = 0, work = 0;
    Wrench<double> before = solver.tick(at(0, 0.096)).wrench;
    const auto go = [&](double to_aside, double to_angle) {
      const double from_aside = aside, from_angle = angle;
      for (int i = 1; i <= 50; ++i) {
        const double next = from_aside + i / 50. * (to_aside - from_aside),
                     turned = from_angle + i / 50. * (to_angle - from_angle);
        Pose<double> X = at(next, 0.096);
        X.rotation = Eigen::AngleAxisd(turned, V::UnitZ()).toRotationMatrix();
        const Wrench<double> felt = solver.tick(X).wrench;
        work += 0.5 * ((before.force + felt.force).x() * (next - aside) +
                       (before.torque + felt.torque).z() * (turned - angle));
        before = felt, aside = next, angle = turned;
      }
    };
    for (int round = 0; round < 3; ++round) {
      work = 0;
      if (drag_first)
        go(3e-4, 0), go(3e-4, 0.03), go(0, 0.03), go(0, 0);
      else
        go(0, 0.03), go(3e-4, 0.03), go(3e-4, 0), go(0, 0);
      CHECK(work < 0);
    }
  }
}

TEST_CASE("a flat face that slides over a convex body takes mu N, though it carries the surface along") {
  constexpr double mu = 0.1, deep = 0.003;
  using Elastic = ElasticContact<double, ResponseCompliance>;
  const auto field = std::make_shared<const ResponseField>(ellipsoid_field(0.49, 80));
  const MeshData<double> face = Box<double>({.half = V(0.02, 0.004, 0.02)}).mesh(1500);
  ContactSolver<Ellipsoid<double>, Elastic, CoulombFriction<double>, ContactPoints<256>> solver(
      {.object = Ellipsoid<double>({.axes = V(0.06, 0.04, 0.04)}),
       .tool = ToolPoints<double>(contact_samples(TriangleMesh<double>(face), 0.002), {.contact_area = 1e-4}),
       .force = Elastic({.compliance = ResponseCompliance(field)}),
       .friction = CoulombFriction<double>({.mu_static = mu, .mu_dynamic = mu})});
  const double height = 0.044 - deep;
  for (int i = 0; i <= 100; ++i) (void)solver.tick(at(0, height + deep * (100 - i) / 100), 1e-3);
  V force = V::Zero(), last = force, before = force;
  double swing = 0;  // second difference of the force, over it
  for (int i = 1; i <= 200; ++i) {
    before = last, last = force;
    force = solver.tick(at(0, height, 3e-5 * i), 1e-3).wrench.force;
    if (i > 100) swing = (std::max)(swing, (force - 2 * last + before).norm() / force.norm());
  }
  REQUIRE(solver.contacts()[0].mode == ContactMode::sliding);
  // The cones' slope answers to the loads, which it moves. Measured: 2e-4; 3e-3, every other tick, if ticks'
  // means are averaged that belong to different positions.
  CHECK(swing <= 1e-3);
  // Finite strain's limit is above mu where the face's normal is not m (friction_cones.hpp). Measured: 6 %;
  // with w across m in the gradient of the regular part 50 %.
  CHECK_RELATIVE(-force.z() / force.y(), mu, 0.1);
}

TEST_CASE(
    "the load moves with the body: torque of a ball pushed askew into a flank within 6 % of finite "
    "elements") {
  // Its force on the body, 6 mm deep: (-27.24, -71.79, 0) N, torque about its middle 202.2 N mm (bench/truth/
  // data/contact, ball_flank_skew). Measured: force 1.0 % off, torque 5.1 % more; 2.3 and 9.0 % if the load
  // stays where it was.
  const auto field = std::make_shared<const ResponseField>(ellipsoid_field(0.49, 400));
  using Elastic = ElasticContact<double, ResponseCompliance>;
  ContactSolver<Ellipsoid<double>, Elastic, CoulombFriction<double>, ContactPoints<256>> solver(
      {.object = Ellipsoid<double>({.axes = V(0.06, 0.04, 0.04)}),
       .tool = ToolPoints<double>(
           contact_samples(TriangleMesh<double>(Sphere<double>({.radius = R}).mesh(8000)), 0.0018),
           {.contact_area = 3e-6}),
       .force = Elastic({.compliance = ResponseCompliance(field)}),
       .friction = CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.5})});
  const V start(0.04589, 0.043733, 0), end(0.046494, 0.037763, 0);
  Wrench<double> felt;
  for (int i = 1; i <= 400; ++i) {
    const V x = start + i / 400. * (end - start);
    felt = solver.tick(at(x.x(), x.y())).wrench;
  }
  const V wanted(27.2416, 71.7874, 0);
  CHECK((felt.force - wanted).norm() <= 0.03 * wanted.norm());
  CHECK_RELATIVE(-felt.torque.z(), 0.202193, 0.06);
}
