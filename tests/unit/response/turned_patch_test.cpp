// SPDX-License-Identifier: MIT

// A patch that the tool turns, across its normal and about it: its torque, where it goes, what it does to
// others.

#include <palpate/elasticity/point_load.hpp>
#include <palpate/response/response_contact.hpp>

#include "reference/rotated_truth.hpp"
#include "support/check.hpp"
#include "support/response_fields.hpp"

namespace {
using namespace palpate;
using V = Vec3<double>;
using Contact = ResponseContact<double>;

const ResponseField& block() {
  static const ResponseField field = test::block_field(V(0.08, 0.05, 0.06), 1e6, 0.49, 240);
  return field;
}
struct Loads {
  V force, torque;
};
Loads solved(const ResponseField& field, const Contact& contact, bool second_order) {
  ResponseTick<1> tick(field, {.second_order = second_order});
  Loads out;
  REQUIRE(tick.solve(&contact, 1, &out.force, &out.torque) == Status::contact);
  return out;
}
Contact on_top(double x, double radius, const V& d, const V& rotation) {
  return {.position = V(x, 0.05, 0),
          .normal = V::UnitY(),
          .radius = radius,
          .displacement = d,
          .rotation = rotation};
}
}  // namespace

TEST_CASE("a small patch: the half-space's moments of tilt and of twist") {
  const double a = 0.001, angle = 0.01;
  for (const double nu : {0.3, 0.5}) {
    const ResponseField field = test::block_field(V(0.08, 0.05, 0.06), 1e6, nu, 150);
    const double unit = field.shear_modulus() * a * a * a * angle;
    const V tilt = solved(field, on_top(0, a, V::Zero(), V(0, 0, angle)), false).torque,
            twist = solved(field, on_top(0, a, V::Zero(), V(0, angle, 0)), false).torque;
    MESSAGE("nu = ", nu, ": tilt ", tilt.z() / unit, ", twist ", twist.y() / unit);
    // Stuck below: by nu, 1 % more than a frictionless disc at 0.3. The body's own part goes with (a /
    // size)^3.
    CHECK(std::abs(tilt.z() / unit - 8 / (3 * (1 - nu))) < 0.012 * 8 / (3 * (1 - nu)));
    CHECK(std::abs(twist.y() / unit - 16. / 3) < 0.005 * 16. / 3);
    // Nothing by symmetry, which 150 vertices have not.
    CHECK(tilt.head<2>().norm() < 1e-3 * tilt.z());
    CHECK(V(twist.x(), 0, twist.z()).norm() < 1e-3 * twist.y());
  }
}

TEST_CASE("five radii from a small patch that tilts freely: the half-space's field of a couple") {
  // Two forces along the normal, half a millimetre apart: to (0.25 / 5)^2. Compressible, for at nu = 1/2 a
  // couple moves nothing along the surface; held in place a patch that tilts pulls sideways, too.
  const double a = 0.001, angle = 0.01, nu = 0.2, apart = 0.00025;
  const ResponseField field = test::block_field(V(0.08, 0.05, 0.06), 1e6, nu, 150);
  const double shift = 1e-6, held = solved(field, on_top(0, a, V::Zero(), V(0, 0, angle)), false).force.x(),
               moved = solved(field, on_top(0, a, V(shift, 0, 0), V::Zero()), false).force.x();
  const Contact contact = on_top(0, a, V(-held / moved * shift, 0, 0), V(0, 0, angle));
  ResponseTick<1> tick(field, {.second_order = false});
  V force, torque;
  tick.solve(&contact, 1, &force, &torque);
  std::vector<V> points;
  for (int i = 0; i < 8; ++i)
    points.push_back(contact.position + 5 * a * V(std::cos(0.7 * i), 0, std::sin(0.7 * i)));
  std::vector<double> u(3 * points.size());
  tick.displace(ResponseDisplay(field, points), u.data(), 3);
  // The side at +x goes up.
  const V up(0, torque.z() / (2 * apart) / (4 * std::numbers::pi * field.shear_modulus()), 0);
  double error = 0, largest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const V r = points[i] - contact.position, side(apart, 0, 0),
            exact = point_load<double>(r - side, -V::UnitY(), up, nu) -
                    point_load<double>(r + side, -V::UnitY(), up, nu);
    error = (std::max)(error, (V(u[3 * i], u[3 * i + 1], u[3 * i + 2]) - exact).norm());
    largest = (std::max)(largest, exact.norm());
  }
  MESSAGE("off by ", error / largest, " of the largest");
  // The patch's width, (1 / 5)^2, and the body's own part, the square of distance over size, (1 / 10)^2.
  CHECK(error < 0.05 * largest);
}

TEST_CASE("the patch goes with the tool: displacement and rotation, exactly") {
  const V turn(0.05, 0.2, -0.1), d(0.0005, -0.002, 0);
  const Contact contact = on_top(0.01, 0.006, d, turn);
  const Mat3<double> R = Eigen::AngleAxis<double>(turn.norm(), turn.normalized()).toRotationMatrix();
  std::vector<V> points;
  for (int i = 0; i < 12; ++i)
    points.push_back(contact.position + 0.0058 * V(std::cos(0.5 * i), 0, std::sin(0.5 * i)) * (i % 3) / 2);
  std::vector<double> u(3 * points.size());
  ResponseTick<1> tick(block());
  V F;
  tick.solve(&contact, 1, &F);
  tick.displace(ResponseDisplay(block(), points), u.data(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const V r = points[i] - contact.position, exact = d + R * r - r;
    CHECK((V(u[3 * i], u[3 * i + 1], u[3 * i + 2]) - exact).norm() < 1e-8);  // floats of millimetres
  }
}

TEST_CASE("pressed and tilted next to an edge: finite elements") {
  const Contact contact = on_top(0.028, 0.006, V(0, -0.004, 0), V(0, 0, -0.16));
  ResponseTick<1> tick(block());
  V F, T;
  tick.solve(&contact, 1, &F, &T);
  std::vector<V> points;
  for (const auto& t : test::truth_rotated) points.push_back(V(t.x[0], t.x[1], t.x[2]));
  std::vector<double> u(3 * points.size());
  tick.displace(ResponseDisplay(block(), points), u.data(), 3);
  double error = 0, norm = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& t = test::truth_rotated[i];
    const V exact(t.u[0], t.u[1], t.u[2]);
    error += (V(u[3 * i], u[3 * i + 1], u[3 * i + 2]) - exact).squaredNorm();
    norm += exact.squaredNorm();
  }
  const V force(test::truth_rotated_force[0], test::truth_rotated_force[1], 0);
  MESSAGE("relative L2 error of the free surface ", std::sqrt(error / norm), ", of the force ",
          (F - force).norm() / force.norm(), ", torque ", T.z(), " of ", test::truth_rotated_torque);
  CHECK(std::sqrt(error / norm) <
        0.06);  // our goal at the deepest; of the free surface alone, on a small mesh
  CHECK((F - force).norm() < 0.03 * force.norm());
  // The goal for forces; 1 % met, where the reference is too stiff by more. The rest vanishes by symmetry,
  // which the mesh has not.
  CHECK(std::abs(T.z() - test::truth_rotated_torque) < 0.03 * std::abs(test::truth_rotated_torque));
  CHECK(T.head<2>().norm() < 0.01 * std::abs(T.z()));
}

TEST_CASE("twisted on a bent surface: finite elements") {
  // Case twist of bench/truth/make_reference.cpp at 0.05 rad: an ellipsoid of 50, 35, 30 mm, 40 degrees of
  // its parameter from the top. A plane has 16 % more.
  const double angle = 40 * std::numbers::pi / 180;
  const V axes(0.05, 0.035, 0.03), position(axes.x() * std::sin(angle), axes.y() * std::cos(angle), 0),
      normal = position.cwiseQuotient(axes.cwiseProduct(axes)).normalized();
  const ResponseField field(test::ellipsoid_mesh(axes, 14), [](const V& p) { return p.y() <= -0.028; },
                            {.E = 1e6, .nu = 0.49, .mesh = {.vertices = 260}, .threads = 1});
  const Contact contact{.position = position, .normal = normal, .radius = 0.006, .rotation = -0.05 * normal};
  const V torque = solved(field, contact, true).torque, truth(-0.00839990622, -0.0143690087, 0);
  MESSAGE("torque ", torque.norm(), " of ", truth.norm());
  CHECK((torque - truth).norm() < 0.03 * truth.norm());  // the goal for forces; 1.2 % met
}

TEST_CASE(
    "the work of rotations' forces on displacements is that of displacements' torques on rotations: "
    "reciprocity") {
  for (const double radius : {0.004, 0.02}) {
    double largest = 0;  // difference of works, over those of the diagonal
    for (int axis = 0; axis < 3; ++axis)
      for (int along = 0; along < 3; ++along) {
        const double d = 1e-4, angle = d / radius;
        const Loads turned = solved(block(), on_top(0.03, radius, V::Zero(), angle * V::Unit(axis)), false),
                    moved = solved(block(), on_top(0.03, radius, d * V::Unit(along), V::Zero()), false);
        const double all = std::sqrt(moved.force.norm() * d * turned.torque.norm() * angle);
        largest = (std::max)(largest, std::abs(turned.force[along] * d - moved.torque[axis] * angle) / all);
      }
    MESSAGE("radius ", radius, ": ", largest);
    // A patch that is wide for its mesh is bonded by five loads, which move it, too, but are left out where w
    // twists it, and which know the bonded flat punch's own loads in the mean only.
    CHECK(largest < (radius < 0.01 ? 0.001 : 0.04));
  }
}

TEST_CASE("two contacts: what turning one does to the other, and moving the other to it, is the same") {
  const V d(0, -0.001, 0);  // both: neither lets the other go
  ResponseTick<2> tick(block(), {.second_order = false});
  const auto answer = [&](const V& rotation, const V& more) {
    const Contact both[2] = {
        on_top(-0.008, 0.005, d, rotation),
        {.position = V(0.008, 0.05, 0.002), .normal = V::UnitY(), .radius = 0.005, .displacement = d + more}};
    V F[2], T[2];
    tick.solve(both, 2, F, T);
    return Loads{F[1], T[0]};
  };
  const double angle = 0.02, shift = 1e-4;
  const Loads rest = answer(V::Zero(), V::Zero());
  Mat3<double> by_turn, by_move;  // works
  for (int i = 0; i < 3; ++i) {
    by_turn.row(i) = shift * (answer(angle * V::Unit(i), V::Zero()).force - rest.force);
    by_move.col(i) = angle * (answer(V::Zero(), shift * V::Unit(i)).torque - rest.torque);
  }
  MESSAGE("largest work ", by_turn.cwiseAbs().maxCoeff(), ", differing by ",
          (by_turn - by_move).cwiseAbs().maxCoeff());
  CHECK((by_turn - by_move).cwiseAbs().maxCoeff() <
        0.002 * by_turn.cwiseAbs().maxCoeff());  // 0.0003 met; as above
}

TEST_CASE("force, torque and field go gradually from no rotation, and from narrow to wide") {
  const std::vector<V> points{V(0.012, 0.05, 0.002), V(0.04, 0.04, 0.01), V(-0.02, 0.05, 0.025)};
  const ResponseDisplay display(block(), points);
  ResponseTick<1> tick(block());
  const auto answer = [&](double turned, double radius) {
    const Contact contact = on_top(0.01, radius, V(0.0003, -0.001, 0), turned * V(0.1, 0.15, -0.2));
    Eigen::Matrix<double, 15, 1> out;
    V F, T;
    tick.solve(&contact, 1, &F, &T);
    std::vector<double> u(9);
    tick.displace(display, u.data(), 3);
    out << F / 10, T / 0.02, Eigen::Map<Eigen::Matrix<double, 9, 1>>(u.data()) / 0.001;
    return out;
  };
  const auto largest_step = [&](int n, auto at) {
    double largest = 0;
    for (int i = 0; i < n; ++i) largest = (std::max)(largest, (at((i + 1.) / n) - at(double(i) / n)).norm());
    return largest;
  };
  const auto turning = [&](double t) { return answer(t, 0.006); };
  const auto widening = [&](double t) { return answer(1, block().mesh().length * (0.8 + 0.8 * t)); };
  // The patch's edge passes the display's vertices within a fiftieth of its radius.
  CHECK(largest_step(1600, turning) < 0.3 * largest_step(400, turning));
  CHECK(largest_step(1600, widening) < 0.5 * largest_step(400, widening));
  CHECK((answer(1e-9, 0.006) - answer(0, 0.006)).norm() < 1e-6);
}

TEST_CASE("a rotation that is not finite, or a half turn: no force, no torque") {
  ResponseTick<1> tick(block());
  for (const double absurd : {std::numeric_limits<double>::quiet_NaN(), 3.2, 1e300}) {
    const Contact contact = on_top(0, 0.005, V(0, -0.001, 0), V(0, absurd, 0));
    V F(1, 1, 1), T(1, 1, 1);
    CHECK(tick.solve(&contact, 1, &F, &T) == Status::invalid_pose);
    CHECK(F.isZero());
    CHECK(T.isZero());
  }
}
