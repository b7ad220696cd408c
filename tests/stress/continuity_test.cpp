// SPDX-License-Identifier: MIT

/// @file Force is continuous along any continuous tool path: on random smooth paths over every surface, in
/// which points join and leave and the contact sticks, slides and sticks again,
///
///     |dF| <= C K |dx|
///
/// with |dx| the largest displacement of any tool point in the tick and K the largest tangent stiffness: of
/// the touching points, sum of share times F'(depth), plus the tangential spring's F'(|D_t|). C is stated per
/// surface below, from: 2 for the normal force (the law's stiffness and, at half the reach, as much again
/// from the turning normal; 6 over a blended edge), times 1 + mu for friction's share, plus 1 for the
/// tangential spring itself. What the literal policies do is printed beside it.

#include <palpate/palpate.hpp>

#include <doctest/doctest.h>

#include <support/paths.hpp>
#include <support/solvers.hpp>

#include <cstdio>
#include <random>

using namespace palpate;
using S = double;
using V = Vec3<S>;

namespace {

constexpr int paths_per_surface = 10000;
constexpr int region_paths = 500;
constexpr int ticks_per_path = 500;

struct Worst {
  double ratio = 0;       // |dF| / (K |dx|)
  double in_contact = 0;  // share of ticks in contact
  double sliding = 0;     // share of those that slide
  double changes = 0;     // ticks in which the number of touching points changed
};

/// The points of a tool and the share of the force law that each carries.
struct Outline {
  std::vector<V> points;
  std::vector<S> shares;
};

/// Sum over the touching points of share times F'(depth) [N/m].
template <class Body, class Force>
S stiffness(const Outline& tool, const Pose<S>& X, const Body& body, const Force& force) {
  S K = 0;
  for (std::size_t i = 0; i < tool.points.size(); ++i) {
    const S depth = body.penetration(X * tool.points[i]).depth;
    if (depth > 0) K += tool.shares[i] * force.stiffness(depth);
  }
  return K;
}

template <class Solver, class Body>
Worst wander(typename Solver::Parts parts, const Body& body, const Outline& tool, S radius, S deepest,
             int paths, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Solver solver(std::move(parts));
  Worst worst;
  double ticks = 0, touching = 0, sliding = 0;
  for (int p = 0; p < paths; ++p) {
    const test::WanderingPath<Body> path(body, V::Zero(), radius - deepest, radius + deepest, 0.4, random);
    solver.reset();
    Pose<S> last = path.at(0);
    V force = solver.tick(last).wrench.force;
    std::uint32_t points_before = 0;
    S K_before = stiffness(tool, last, body, solver.force_law());
    for (int i = 1; i <= ticks_per_path; ++i) {
      const Pose<S> X = path.at(double(i) / ticks_per_path);
      const TickResult<S> now = solver.tick(X);
      S step = 0;
      for (const V& x : tool.points) step = (std::max)(step, (X * x - last * x).norm());
      S K = stiffness(tool, X, body, solver.force_law());
      std::uint32_t points = 0;
      for (const ContactState<S>& c : solver.contacts()) {
        points += c.points;
        K += solver.force_law().stiffness(tangential<S>(c.displacement, c.normal).norm());
        sliding += c.mode == ContactMode::sliding;
      }
      const S bound = (std::max)(K, K_before) * step;
      if (bound > 0) worst.ratio = (std::max)(worst.ratio, (now.wrench.force - force).norm() / bound);
      ++ticks;
      touching += has(now.status, Status::contact);
      worst.changes += points != points_before;
      points_before = points;
      K_before = K;
      force = now.wrench.force;
      last = X;
    }
  }
  worst.in_contact = touching / ticks;
  worst.sliding = touching > 0 ? sliding / touching : 0;
  return worst;
}

const DuffingForce<S> law({.c1 = 40, .c3 = 3e8});
using Default = PowerLawFriction<S>;
using Literal = PowerLawFriction<S, LiteralShift>;

template <class F>
F fibre() {  // the paper's K = 10 and beta = 3/4 read in dyn, and a dry sliding coefficient
  return F({.K = 0.562, .beta = 0.75, .mu_dynamic = 0.3});
}

template <class Body>
void check_surface(const char* name, const Body& body, S deepest, S normal_factor, std::uint64_t seed) {
  constexpr S radius = 3e-3;
  const Sphere<S> ball({.radius = radius});
  const MeshData<S> mesh = ball.mesh(200);
  const ToolPoints<S> tool(TriangleMesh<S>(ball.mesh(200)), {.contact_area = 2e-5});
  Outline outline{{tool.points().begin(), tool.points().end()}, {}};
  for (const S area : tool.areas()) outline.shares.push_back(area / tool.contact_area());
  const Outline tip{{V::Zero()}, {1}};
  const S C = normal_factor * (1 + fibre<Default>().max_coefficient()) + 1;
  INFO("surface ", name, ", seed ", seed, ", C ", C);

  const Worst point = wander<ContactSolver<Body, DuffingForce<S>, Default, SinglePoint>>(
      {body, {}, law, fibre<Default>(), {}}, body, tip, 0, deepest, paths_per_surface, seed);
  const Worst region = wander<ContactSolver<Body, DuffingForce<S>, Default, SingleRegion<AreaSharing>>>(
      {body, tool, law, fibre<Default>(), {}}, body, outline, radius, deepest, region_paths, seed);
  const Worst regions = wander<ContactSolver<Body, DuffingForce<S>, Default, Regions<4, AreaSharing>>>(
      {body, tool, law, fibre<Default>(), {6e-4}}, body, outline, radius, deepest, region_paths, seed);
  const Worst literal = wander<ContactSolver<Body, DuffingForce<S>, Literal, Regions<4, EqualSharing>>>(
      {body, tool, law, fibre<Literal>(), {6e-4}}, body, outline, radius, deepest, region_paths / 5, seed);
  std::printf(
      "%-15s C %5.2f  largest |dF|/(K|dx|): point %6.3f  region %6.3f  regions %6.3f  literal %8.1f   "
      "contact %2.0f %%, sliding %2.0f %%, %g changes of the touching set\n",
      name, C, point.ratio, region.ratio, regions.ratio, literal.ratio, 100 * region.in_contact,
      100 * region.sliding, regions.changes);
  CHECK(point.ratio <= C);
  CHECK(region.ratio <= C);
  CHECK(regions.ratio <= C);
  // The paths must be ones on which something happens.
  CHECK(region.in_contact > 0.3);
  CHECK(region.sliding > 0.05);
  CHECK(regions.changes > 1000);
}

}  // namespace

TEST_CASE("force is continuous on random smooth paths: sphere") {
  check_surface("sphere", Sphere<S>({.radius = 0.04}), 2e-3, 2, 101);
}
TEST_CASE("force is continuous on random smooth paths: ellipsoid") {
  check_surface("ellipsoid", Ellipsoid<S>({.axes = V(0.06, 0.04, 0.05)}), 2e-3, 2, 102);
}
TEST_CASE("force is continuous on random smooth paths: box, over edges and corners") {
  check_surface("box", Box<S>({.half = V(0.03, 0.025, 0.02)}), 2e-3, 6, 103);
}
TEST_CASE("force is continuous on random smooth paths: cylinder, over its rims") {
  check_surface("cylinder", Cylinder<S>({.radius = 0.03, .half_height = 0.025}), 2e-3, 6, 104);
}
TEST_CASE("force is continuous on random smooth paths: superellipsoid") {
  check_surface("superellipsoid", Superellipsoid<S>({.axes = V(0.05, 0.04, 0.03)}), 1e-3, 2, 105);
}
