// SPDX-License-Identifier: MIT
// Torque against twist of a region that sticks.
#include <palpate/geometry/box.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/check.hpp>

#include <numbers>
#include <random>
#include <string>

using namespace palpate;
using V = Vec3<double>;

namespace {

const Box<double> block({.half = V(0.05, 0.02, 0.05)});
using Spring = LinearForce<double>;
const Spring spring({.k = 1000});
using Bonded = BondedDisc<double>;
template <class Skew>
using Rough = CoulombFriction<double, ReturnMapping, Skew>;
constexpr double mu = 0.5;
const Rough<ByComponents> rough({.mu_static = mu, .mu_dynamic = mu});

/// A square face of 10 mm, n x n points.
ToolPoints<double> face(int n) {
  std::vector<V> points;
  const double spacing = 0.01 / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      points.emplace_back(spacing * (i - 0.5 * (n - 1)), 0, spacing * (j - 0.5 * (n - 1)));
  return ToolPoints<double>(points, std::vector<double>(points.size(), spacing * spacing),
                            {.contact_area = 1e-4});
}
const double a = std::sqrt(1e-4 / std::numbers::pi);  // radius of the face's area

Pose<double> at(double x, double depth, double twist, double tilt = 0) {
  Pose<double> X;
  X.rotation =
      (Eigen::AngleAxisd(tilt, V::UnitX()) * Eigen::AngleAxisd(twist, V::UnitY())).toRotationMatrix();
  X.translation = V(x, 0.02 - depth, 0);
  return X;
}

template <class Skew>
using Solver = ContactSolver<Box<double>, Spring, Rough<Skew>, SingleRegion<AreaSharing>>;

Solver<ByComponents> solver_of(int n = 7) {
  return Solver<ByComponents>({.object = block, .tool = face(n), .force = spring, .friction = rough});
}

struct Work {
  double net = 0, gross = 0;  // [J]
};
/// Of the wrench along path(t), t from 0 to 2 pi in 4,000 steps, by the trapezoidal rule.
template <class S, class Path>
Work work_along(S& solver, const Path& path) {
  constexpr int steps = 4000;
  Work work;
  Wrench<double> last{};
  Pose<double> before;
  for (int i = 0; i <= steps; ++i) {
    const Pose<double> X = path(2 * std::numbers::pi * i / steps);
    const Wrench<double> now = solver.tick(X).wrench;
    if (i > 0) {
      const Eigen::AngleAxisd turn(Mat3<double>(X.rotation * before.rotation.transpose()));
      const double done = 0.5 * (now.force + last.force).dot(X.translation - before.translation) +
                          0.5 * (now.torque + last.torque).dot(turn.angle() * turn.axis());
      work.net += done;
      work.gross += std::abs(done);
    }
    last = now;
    before = X;
  }
  return work;
}

}  // namespace

TEST_CASE("a face that sticks resists twist as a bonded disc, 16/3 G a^3, and gives way across as nu says") {
  for (const double nu : {0.0, 0.3, 0.5}) {
    Solver<Bonded> solver(
        {.object = block,
         .tool = face(7),
         .force = spring,
         .friction = Rough<Bonded>({.mu_static = mu, .mu_dynamic = mu, .skew = Bonded({.nu = nu})})});
    (void)solver.tick(at(0, 2e-3, 0));
    const Wrench<double> felt = solver.tick(at(1e-4, 2e-3, 0.02)).wrench;
    const double G = 1000 * (1 - nu) / (4 * a);  // of the half-space whose disc has this stiffness along
    CHECK_RELATIVE(felt.torque.y(), -16.0 / 3 * G * a * a * a * 0.02, 1e-9);  // a difference of rotations
    CHECK_RELATIVE(felt.force.x(), -8 * G * a / (2 - nu) * 1e-4, 1e-9);
  }
  auto literal = solver_of();  // as stiff across as along: nu = 0
  (void)literal.tick(at(0, 2e-3, 0));
  CHECK_RELATIVE(literal.tick(at(0, 2e-3, 0.02)).wrench.torque.y(), -4.0 / 3 * a * a * 1000 * 0.02, 1e-9);
}

TEST_CASE("twisted on, the region slips at 2/3 a mu F, whatever its mesh; sliding on takes the torque away") {
  for (const int n : {3, 7, 20}) {
    auto solver = solver_of(n);
    Wrench<double> felt{};
    for (int i = 0; i <= 1000; ++i) felt = solver.tick(at(0, 2e-3, 1e-3 * i)).wrench;
    CHECK_RELATIVE(felt.torque.y(), -2.0 / 3 * a * mu * 2, 1e-9);
    CHECK(solver.contacts()[0].mode == ContactMode::sliding);
    for (int i = 1; i <= 500; ++i) felt = solver.tick(at(1e-5 * i, 2e-3, 1)).wrench;
    CHECK_RELATIVE(felt.force.x(), -mu * 2, 1e-3);  // 5 mm, ten stretches: the rest is below exp(-7)
    CHECK(std::abs(felt.torque.y()) < 1e-2 * 2.0 / 3 * a * mu * 2);
  }
}

TEST_CASE("sliding and turning at once: on the limit surface, in the direction of its normal") {
  // The surface's normal: velocity v and rate w with f ~ v, tau/lever ~ lever w; here w lever = v: 45
  // degrees.
  auto solver = solver_of();
  const double lever = 2.0 / 3 * a;
  Wrench<double> felt{};
  for (int i = 0; i <= 4000; ++i) felt = solver.tick(at(5e-6 * i, 2e-3, 5e-6 * i / lever)).wrench;
  const double f = -felt.force.x(), t = -felt.torque.y() / lever;
  CHECK_RELATIVE(std::hypot(f, t), mu * 2, 1e-6);
  CHECK_RELATIVE(
      t / f, 1.0,
      0.02);  // a tick's rotation is 0.1 % of the stretch; friction acts where the tool's point was
}

TEST_CASE("stuck, 10,000 small turns leave no torque and no drift; a closed path in 6 degrees does no work") {
  auto solver = solver_of();
  (void)solver.tick(at(0, 2e-3, 0));
  for (int i = 0; i < 10000; ++i) {
    (void)solver.tick(at(0, 2e-3, 0.01 * std::sin(0.37 * i)));
  }
  CHECK(std::abs(solver.tick(at(0, 2e-3, 0)).wrench.torque.y()) <= 1e-15);

  const Work work = work_along(solver, [](double t) {
    return at(1e-4 * (std::cos(t) - 1), 2e-3, 0.05 * std::sin(t), 0.02 * (std::cos(2 * t) - 1));
  });
  CHECK(std::abs(work.net) <=
        1e-5 * work.gross);  // the trapezoid's square of the step, (2 pi/4000)^2, and what tilting adds
}

TEST_CASE("over random closed paths, sliding, twisting and pressed more and less, friction gives no energy") {
  std::mt19937_64 random(20050617);  // fixed seed
  std::uniform_real_distribution<double> part(-1, 1), phase(0, 6.28);
  double most = -1;
  for (int path = 0; path < 60; ++path) {
    auto solver = solver_of(5);
    double c[6], p[6];
    for (int k = 0; k < 6; ++k) c[k] = part(random), p[k] = phase(random);
    const auto position = [&](double t) {
      return at(1e-3 * (c[0] * std::sin(t + p[0]) + c[1] * std::sin(2 * t + p[1])),
                2e-3 + 1e-3 * c[2] * std::sin(2 * t + p[2]),
                0.4 * (c[3] * std::sin(t + p[3]) + c[4] * std::sin(3 * t + p[4])));
    };
    const Work work = work_along(solver, position);
    most = (std::max)(most, work.net / work.gross);
  }
  CHECK(most <= 1e-4);  // the trapezoid errs by the square of the step; with a margin of 10
}

TEST_CASE("pressed deeper while twisted, the torque stays and the spring stores no more") {
  auto solver = solver_of();
  (void)solver.tick(at(0, 1e-3, 0));
  const double before = solver.tick(at(0, 1e-3, 0.02)).wrench.torque.y();
  double worst = 0;
  const DuffingForce<double> stiffening({.c1 = 500, .c3 = 1e8});
  ContactSolver<Box<double>, DuffingForce<double>, Rough<ByComponents>, SingleRegion<AreaSharing>> deeper(
      {.object = block, .tool = face(7), .force = stiffening, .friction = rough});
  (void)deeper.tick(at(0, 1e-3, 0));
  const double torque = deeper.tick(at(0, 1e-3, 0.02)).wrench.torque.y();
  for (int i = 1; i <= 100; ++i)
    worst = (std::max)(worst, std::abs(deeper.tick(at(0, 1e-3 + 2e-5 * i, 0.02)).wrench.torque.y() - torque));
  CHECK(worst <= 1e-12);
  CHECK(before < 0);
  // Turned back by less than it was turned: the stiffer spring is empty before.
  CHECK(deeper.tick(at(0, 3e-3, 0.01)).wrench.torque.y() > 0);
}

TEST_CASE(
    "two feet that are twisted and merge keep their torque; split again, and round and round, none is made") {
  std::vector<V> points;
  for (int i = -10; i <= 10; ++i) points.emplace_back(5e-4 * i, std::abs(i) > 4 ? 0 : 2e-4, 0);
  const ToolPoints<double> feet(points, std::vector<double>(points.size(), 2.5e-7), {.contact_area = 2e-6});
  ContactSolver<Box<double>, Spring, Rough<ByComponents>, Regions<4, AreaSharing>> solver(
      {.object = block, .tool = feet, .force = spring, .friction = rough, .contacts = {.distance = 6e-4}});
  double twist = 0, depth = 1.6e-4, torque = 0, work = 0, most = 0, jump = 0;
  std::size_t regions = 0, changes = 0;
  const auto go = [&](double to_twist, double to_depth) {
    const double from = twist, from_depth = depth;
    for (int i = 1; i <= 400; ++i) {
      const double next = from + (to_twist - from) * i / 400;
      depth = from_depth + (to_depth - from_depth) * i / 400;
      const double now = solver.tick(at(0, depth, next)).wrench.torque.y();
      work += 0.5 * (torque + now) * (next - twist);
      most = (std::max)(most, work);
      if (solver.contacts().size() != regions && regions > 0) {
        ++changes;
        jump = (std::max)(jump, std::abs(now - torque));
      }
      regions = solver.contacts().size();
      torque = now;
      twist = next;
    }
  };
  go(0, 1.6e-4);
  go(2e-3, 1.6e-4);
  CHECK(torque < -1e-8);  // two feet of 0.25 N/mm at 3.75 mm
  const double two = torque;
  go(2e-3, 2.6e-4);
  CHECK_RELATIVE(torque, two, 1e-6);
  for (int turn = 0; turn < 6; ++turn) {
    const double start = twist;
    go(start, 1.6e-4);
    go(start + 1e-3, 1.6e-4);
    go(start + 1e-3, 2.6e-4);
    go(start, 2.6e-4);
  }
  CHECK(changes > 10);
  CHECK(jump <= 1e-3 * std::abs(two));
  CHECK(most <= 1e-4 * std::abs(two) * 1e-3);
}

TEST_CASE("no torque where there is none: a point, no friction, at the mass centre, as printed") {
  using Body = Box<double>;
  static_assert(!ContactSolver<Body, Spring, Rough<ByComponents>>::resists_twist);
  static_assert(!ContactSolver<Body, Spring, Frictionless<double>, SingleRegion<AreaSharing>>::resists_twist);
  static_assert(!ContactSolver<Body, Spring, Rough<ByComponents>, SingleRegion<AreaSharing>,
                               NoDeformation<double>, AtMassCentre>::resists_twist);
  static_assert(!ContactSolver<Body, Spring, CoulombFriction<double, LiteralShift>,
                               SingleRegion<AreaSharing>>::resists_twist);
  static_assert(Solver<ByComponents>::resists_twist && Solver<Radial>::resists_twist);
  // A region of one point without area to speak of, 0.6 pm in radius: a torque of no more than that lever.
  ContactSolver<Body, Spring, Rough<ByComponents>, SingleRegion<AreaSharing>> needle(
      {.object = block,
       .tool = ToolPoints<double>({V::Zero()}, {1e-24}, {.contact_area = 1e-24}),
       .force = spring,
       .friction = rough});
  (void)needle.tick(at(0, 1e-3, 0));
  const auto turned = needle.tick(at(0, 1e-3, 0.3)).wrench;
  CHECK(turned.torque.norm() <= 0.6e-12 * turned.force.norm());
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("bonded disc: a bad nu is refused by name and value") {
  for (const double nu : {-0.1, 0.6, std::numeric_limits<double>::quiet_NaN()}) {
    std::string said;
    try {
      Bonded({.nu = nu});
    } catch (const SetupError& error) {
      said = error.what();
    }
    CHECK(said.rfind("BondedDisc: nu [-] must be in [0, 1/2], got", 0) == 0);
  }
}
#endif
