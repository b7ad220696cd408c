// SPDX-License-Identifier: MIT

/// @file Energy of detection against a shape that the contact deforms itself, a tick old: a ball on random
/// closed paths over an ellipsoid, from free air to free air, at 1 kHz. Work is taken by the trapezoidal
/// rule, which a conservative force closes to rounding of the path; so what is left over is made by the
/// bulges. Two shapes: half-spaces, and a ring that rises around the contact by `gain` times the depth, far
/// more than an elastic body's. With PassivityController none of it reaches the hand, nor what holding the
/// force from tick to tick makes.

#include <palpate/device/passivity_controller.hpp>
#include <palpate/elasticity/half_space.hpp>
#include <palpate/geometry/deformed_surface.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/geometry/triangle_mesh.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <cstdio>
#include <numbers>
#include <random>

using namespace palpate;

namespace {

using S = double;
using V = Vec3<S>;

constexpr std::uint64_t seed = 20261121;
constexpr int paths = 12;  // of 1 s each
constexpr S radius = 6e-3;
constexpr double pi = std::numbers::pi;

const Ellipsoid<S> body({.axes = V(0.06, 0.04, 0.04)});
const TriangleMesh<S> skin(body.mesh(1500));

/// A hill around each contact, q exp(1 - q) high with q = (r / a)^2, a the contact's radius.
struct Ring {
  S gain;

  Moved<S> write(std::span<const ContactState<S>> contacts, const VertexBuffer<S>& out) const noexcept {
    V* const to = reinterpret_cast<V*>(out.positions);
    for (std::size_t v = 0; v < skin.vertices().size(); ++v) {
      to[v] = skin.vertices()[v];
      for (const ContactState<S>& c : contacts) {
        const S a2 = (std::max)(4e-6, c.area / pi), q = (skin.vertices()[v] - c.origin()).squaredNorm() / a2;
        to[v] += gain * c.displacement.norm() * q * std::exp(1 - q) * skin.vertex_normals()[v];
      }
    }
    return {.vertices = skin.vertices().size()};
  }
};

/// The ball's centre: over a random closed curve on the upper side, down to 1 to 3 mm below the surface and
/// up.
std::vector<V> closed_path(std::mt19937_64& random, int ticks) {
  std::uniform_real_distribution<S> unit(-1, 1);
  std::array<S, 12> a;
  for (S& x : a) x = unit(random);
  const S x0 = 0.4 * unit(random), z0 = 0.3 * unit(random), depth = 2e-3 + 1e-3 * unit(random), clear = 1e-3;
  std::vector<V> path;
  for (int i = 0; i <= ticks; ++i) {
    const S t = S(i) / ticks, down = std::sin(pi * t) * std::sin(pi * t);
    V d(x0, 1, z0);
    for (std::size_t k = 0; k < 3; ++k) {
      const S n = S(k + 1), s = std::sin(2 * pi * n * t), c = std::cos(2 * pi * n * t) - 1;
      d += 0.08 / n * V(a[k] * s + a[k + 3] * c, 0, a[k + 6] * s + a[k + 9] * c);
    }
    const V on = body.raycast(0.2 * d, -d).position;
    path.push_back(on +
                   (radius + clear - (clear + depth) * (std::min)(1.0, 2 * down)) * body.closest(on).normal);
  }
  return path;
}

struct Energy {
  double worst = -1, mean = 0;  // work on the hand per path over the work exchanged, sum of |F . dx|
  double most = 0,
         largest = 0;          // of the held force since the path began, at its most; |F . dx| of a tick [J]
  double jump = 0, force = 0;  // of the force from tick to tick, and the force [N]
  double bulge = 0;            // [m]
};

/// `follow(solver)` after each tick; `limited`: through a controller for a device without losses or delay.
template <class Solver, class Follow>
Energy wander(Solver solver, const Follow& follow, bool limited, int ticks) {
  std::mt19937_64 random(seed);
  Energy e;
  PassivityController<S> limit({.damping = 0, .friction = 0, .resolution = 0, .delay = 0});
  for (int p = 0; p < paths; ++p) {
    const std::vector<V> path = closed_path(random, ticks);
    double gained = 0, exchanged = 0, held = 0;
    V before = V::Zero();
    for (std::size_t i = 0; i < path.size(); ++i) {
      Pose<S> X;
      X.translation = path[i];
      Wrench<S> w = solver.tick(X).wrench;
      if (limited) w = limit.pass(w, X, stored_energy(solver.contacts()), S(1) / ticks);
      follow(solver, e);
      if (i > 0) {
        const double work = 0.5 * (w.force + before).dot(path[i] - path[i - 1]);
        gained += work;
        exchanged += std::abs(work);
        held += before.dot(path[i] - path[i - 1]);
        e.most = (std::max)(e.most, held);
        e.largest = (std::max)(e.largest, std::abs(before.dot(path[i] - path[i - 1])));
      }
      e.jump = (std::max)(e.jump, (w.force - before).norm());
      e.force = (std::max)(e.force, w.force.norm());
      before = w.force;
    }
    CHECK(before == V::Zero());  // the path ends free of contact
    e.worst = (std::max)(e.worst, gained / exchanged);
    e.mean += gained / exchanged / paths;
  }
  return e;
}

struct Figures {
  Energy flat, now, limited;
};

template <class Friction, class Model>
Figures measure(const char* name, const Friction& friction, Model model, int ticks = 1000) {
  const ToolPoints<S> tool(TriangleMesh<S>(Sphere<S>({.radius = radius}).mesh(300)), {.contact_area = 5e-5});
  const LinearForce<S> law({.k = 800});
  using Rest = ContactSolver<Ellipsoid<S>, LinearForce<S>, Friction, SingleRegion<AreaSharing>>;
  using Now =
      ContactSolver<DeformedSurface<Ellipsoid<S>>, LinearForce<S>, Friction, SingleRegion<AreaSharing>>;
  std::vector<V> positions = skin.vertices();
  const auto follow = [&](Now& solver, Energy& e) {
    if (model.write(solver.contacts(), VertexBuffer<S>{.positions = positions.front().data()}).vertices == 0)
      return;
    solver.mutable_object().update(positions);
    e.bulge = (std::max)(e.bulge, solver.object().highest_bulge());
  };
  const auto now = [&](bool limited) {
    return wander(Now({DeformedSurface<Ellipsoid<S>>(body, skin), tool, law, friction, {}, {}}), follow,
                  limited, ticks);
  };
  const Figures f{wander(
                      Rest({body, tool, law, friction, {}, {}}), [](Rest&, Energy&) {}, false, ticks),
                  now(false), now(true)};
  std::printf(
      "%-24s bulge %5.2f mm  gained, mean and worst: undeformed %8.1e %8.1e  deformed %8.1e %8.1e  limited "
      "%8.1e %8.1e; "
      "at most %.1e J, a tick %.1e J; largest force %.2f %.2f %.2f N, its step %.3f %.3f %.3f N\n",
      name, 1e3 * f.now.bulge, f.flat.mean, f.flat.worst, f.now.mean, f.now.worst, f.limited.mean,
      f.limited.worst, f.limited.most, f.limited.largest, f.flat.force, f.now.force, f.limited.force,
      f.flat.jump, f.now.jump, f.limited.jump);
  CHECK(f.limited.most <= 0);
  return f;
}

// A step of the trapezoidal rule is wrong by h^3 F'' / 12: with steps of 1e-4 m over forces that bend within
// 1e-3 m some 1e-3 of a step's work, of either sign in turn.
constexpr double rounding = 1e-4;

}  // namespace

TEST_CASE(
    "stress: bulges of half-spaces do not reach the tool that raises them: no energy from detection on "
    "them") {
  HalfSpaceDeformation<S> model(skin.data(), [](const auto& p) { return p.y() <= -0.032; },
                                {.normals = false});
  const Figures smooth = measure("half-spaces", Frictionless<S>{}, model);
  CHECK(std::abs(smooth.flat.worst) < rounding);
  CHECK(std::abs(smooth.now.worst) < rounding);
  CHECK(smooth.now.bulge > 1e-4);
  const Figures rough =
      measure("half-spaces, friction", CoulombFriction<S>({.mu_static = 0.5, .mu_dynamic = 0.4}), model);
  CHECK(rough.now.worst < 0);
}

TEST_CASE("stress: a ring around the contact makes energy; none of it gets through the controller") {
  for (const double gain : {0.1, 0.2, 0.4, 0.8}) {
    char name[40];
    std::snprintf(name, sizeof name, "ring, gain %.1f", gain);
    const Figures f = measure(name, Frictionless<S>{}, Ring{gain});
    CHECK(f.now.worst > 0.1 * gain);  // so that there is something to hold back
  }
  // Not the delay of a tick alone: such a force has no potential.
  const Figures fast = measure("ring, gain 0.1, 4 kHz", Frictionless<S>{}, Ring{0.1}, 4000);
  CHECK(fast.now.worst > 0.01);
}
