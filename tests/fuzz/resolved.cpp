// SPDX-License-Identifier: MIT

/// @file Ticks of tools whose contact is resolved at their points: half-space and response field, with and
/// without friction, beside other tools, with points of one spacing and of two.

#include "ticks.hpp"

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/response_compliance.hpp>

#include <support/on_block.hpp>

#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace {
using namespace palpate;
using fuzz::Bytes;
using fuzz::require;

constexpr double E = 1e5, nu = 0.45, E_plane = E / (1 - nu * nu);
const Vec3<double> axes(0.03, 0.02, 0.01), block(0.04, 0.03, 0.03);
/// Half of a tool's diagonal, and the deepest that a point gets in a body [m].
const double reach = Vec3<double>(6e-3, 4e-3, 4e-3).norm(), deepest = 0.02;
/// Of a flat punch as wide as the tool, pressed by as much; half as much again for friction (mu <= 0.5), for
/// loads that turn with the surface, and for what fewer points leave [N].
const double most = 1.5 * 2 * E_plane * reach * deepest;
constexpr double near_base = 15;  // a field's stiffness over the half-space's, at most: above its fixed face

constexpr double spacing = 2.5e-3;
template <Real S>
SurfaceSamples<S> samples(const MeshData<double>& mesh, double apart) {
  return contact_samples(TriangleMesh<S>(mesh_cast<S>(mesh)), S(apart));
}
template <Real S>
SurfaceSamples<S> brick(double apart = spacing) {
  return samples<S>(Box<double>({.half = {6e-3, 4e-3, 4e-3}}).mesh(26), apart);
}
template <Real S>
SurfaceSamples<S> egg() {
  return samples<S>(Ellipsoid<double>({.axes = {6e-3, 4e-3, 4e-3}}).mesh(300), spacing);
}
template <Real S>
ToolPoints<S> tool(const SurfaceSamples<S>& samples) {
  return ToolPoints<S>(samples, {.contact_area = S(1e-4), .centre_of_mass = {S(0), S(0.05), S(0)}});
}
template <Real S>
CoulombFriction<S> coulomb() {
  return CoulombFriction<S>({.mu_static = S(0.5), .mu_dynamic = S(0.3)});
}
ResponseCompliance rubber() { return test::block_compliance(block, 40); }

/// `limit`: no force is larger [N]; infinity where others push with whatever they like.
template <class Solver>
void require_sound(const Solver& solver, const typename Solver::State& state,
                   const Pose<typename Solver::Scalar>& X, const TickResult<typename Solver::Scalar>& result,
                   double limit) {
  using S = typename Solver::Scalar;
  const auto& [force, torque] = result.wrench;
  const Status status = result.status;
  require(is_finite(force) && is_finite(torque), "a wrench is finite");
  require(has(status, Status::invalid_pose) == !is_usable(X), "invalid_pose for poses that are none");
  require(!has(status, Status::non_finite_result), "no contact gives what is not finite");
  require(has(status, Status::contact) == !state.contacts().empty(), "contact is said");
  require(state.points().empty() == state.contacts().empty(), "a contact has points");
  if (!has(status, Status::contact)) {
    require(force.isZero(S(0)) && torque.isZero(S(0)), "no contact, no force");
    return;
  }
  require(is_finite(state.residual().relative), "a residual is finite");
  require(force.norm() <= S(limit), "no force is more than a punch's");
  S pressed = S(0);
  for (const auto& p : state.points()) {
    require(is_finite(p.position) && is_finite(p.normal) && is_finite(p.force) && is_finite(p.pressure) &&
                is_finite(p.depth),
            "a point's contact is finite");
    require(p.pressure >= S(0), "no point pulls");
    require(std::abs(p.normal.norm() - S(1)) < S(1e-3), "a point's normal is a unit vector");
    require(p.point < solver.tool().size(), "a point is the tool's");
    pressed += p.force.norm();
  }
  for (const auto& c : state.contacts()) {
    require(is_finite(c.centre) && is_finite(c.displacement) && is_finite(c.force) && is_finite(c.friction) &&
                is_finite(c.normal_force) && is_finite(c.depth),
            "a contact is finite");
    require(c.area >= S(0) && is_finite(c.area), "an area is a number >= 0");
    require((c.force - force).norm() <= S(1e-5) * pressed, "the contact's force is the wrench's");
  }
}
template <class Solver, class Before>
void walk(Solver& solver, double limit, Bytes& in, const Before& before) {
  fuzz::walk(solver, 0.03, in, before,
             [limit](const auto& s, const auto& state, const auto& X, bool, const auto& felt) {
               require_sound(s, state, X, felt, limit);
             });
}
const auto nothing = [](const auto&, const Bytes&) {};

template <Real S, class Compliance, class Object, class Friction>
using Solver = ContactSolver<Object, ElasticContact<S, Compliance>, Friction, ContactPoints<64>>;

void slick(Bytes& in) {
  static Solver<float, HalfSpace, Ellipsoid<float>, Frictionless<float>> solver(
      {.object = Ellipsoid<float>({.axes = axes.cast<float>()}),
       .tool = tool(brick<float>()),
       .force = ElasticContact<float, HalfSpace>({.compliance = HalfSpace({.E = E, .nu = nu})})});
  walk(solver, most, in, nothing);
}
void rough(Bytes& in) {
  static Solver<double, HalfSpace, Box<double>, CoulombFriction<double>> solver(
      {.object = Box<double>({.half = axes}),
       .tool = tool(brick<double>()),
       .force = ElasticContact<double, HalfSpace>({.compliance = HalfSpace({.E = E, .nu = nu})}),
       .friction = coulomb<double>()});
  walk(solver, most, in, nothing);
}
void bends(Bytes& in) {
  static auto solver = test::on_block(block, rubber(), Frictionless<double>{}, egg<double>());
  walk(solver, near_base * most, in, nothing);
}
void drags(Bytes& in) {
  using Fibre = PowerLawFriction<float>;
  static Solver<float, ResponseCompliance, Box<float>, Fibre> solver(
      {.object = Box<float>({.half = (block / 2).cast<float>(), .centre = {0, float(block.y() / 2), 0}}),
       .tool = tool(egg<float>()),
       .force = ElasticContact<float, ResponseCompliance>({.compliance = rubber()}),
       .friction = Fibre({.K = 0.3f, .beta = 0.75f, .mu_dynamic = 0.3f, .linear_below = 0.2f})});
  walk(solver, near_base * most, in, nothing);
}
constexpr double cell = 6e-6, largest = 1e4 * E * cell;  // [m^2], [N]: of a load that is taken
/// Points of two spacings, beside loads that come and go, of a tool that presses, pulls or is out of its mind:
/// any number of newtons.
void pair(Bytes& in) {
  using Elastic = ElasticContact<double, ResponseCompliance>;
  static ContactSolver<Box<double>, Elastic, CoulombFriction<double>, AdaptiveContactPoints<256, 256>> solver(
      {.object = test::standing_block(block),
       .tool = {tool(brick<double>()), tool(brick<double>(spacing / 2))},
       .force = Elastic({.compliance = rubber()}),
       .friction = coulomb<double>()});
  std::vector<SurfaceLoad<double>> loads;
  walk(solver, std::numeric_limits<double>::infinity(), in, [&loads](auto& state, Bytes& bytes) {
    const std::uint8_t op = bytes.byte();
    if (op % 8 == 0) loads.clear();
    if (op % 8 == 1 && loads.size() < 300) {
      const Vec3<double> n = bytes.units<double>();
      loads.push_back(
          {.position = bytes.units<double>() * 0.03,
           .direction = n.norm() > 0.01 ? n.normalized() : Vec3<double>::UnitY(),
           .force = op & 128 ? bytes.numbers<double>() : bytes.units<double>() * (op & 64 ? largest : 1),
           .area = cell,
           .shift = op & 32 ? bytes.numbers<double>() : Vec3<double>::Zero()});
    }
    state.set_beside(std::span<const SurfaceLoad<double>>(loads));
  });
}
}  // namespace

/// The field's set-up is no input's time.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  (void)rubber();
  return 0;
}
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return palpate::fuzz::play({slick, rough, bends, drags, pair}, data, size);
}
