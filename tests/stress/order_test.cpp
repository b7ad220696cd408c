// SPDX-License-Identifier: MIT

/// @file Neither the order in which a tool's points are given nor the unit of length and force changes what
/// the hand feels: on paths over every surface, with every topology, with friction and without, regions
/// merging and splitting. Shuffled tools give the same bits. In other units, taken back to metre and newton,
///
///     |F' - F| <= 1e-12 max |F|,   |T' - T| <= 1e-12 max |F| 30 mm
///
/// Why 1e-12: a depth d at a distance of 50 d from the origin has 50 roundings of 1e-16, the law's exponent
/// makes three of each, and friction carries them on over some hundred ticks. In units that are powers of
/// 4096, whose square and cube roots are exact, the bits are the same (laws of numbers below 1 aside, whose
/// cube root the C library takes by another way).
///
/// Where there are more regions than the topology has room for (`Status::region_overflow`), states are merged
/// and split in every tick, and that friction makes more of roundings than 1e-12: there only the order is
/// tested.

#include <palpate/palpate.hpp>

#include <doctest/doctest.h>

#include <support/paths.hpp>
#include <support/solvers.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <functional>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

using namespace palpate;
using S = double;
using V = Vec3<S>;

namespace {

constexpr int ticks = 160;

/// Any surface, so that solvers are compiled once for all of them.
class AnyBody {
 public:
  using Scalar = S;
  template <class B>
    requires(!std::same_as<B, AnyBody> && ContactSurface<B>)  // or it would be asked to know of itself
  explicit AnyBody(B body) : body_(std::make_shared<const Of<B>>(std::move(body))) {}

  [[nodiscard]] SurfacePoint<S> closest(const V& x) const noexcept { return body_->closest(x); }
  [[nodiscard]] Penetration<S> penetration(const V& x) const noexcept { return body_->penetration(x); }
  template <std::size_t N>
    requires(N == batch_size || N == 2 * batch_size)
  void penetration(const PointBatch<S, N>& x, PenetrationBatch<S, N>& in) const noexcept {
    body_->penetration(x, in);
  }
  [[nodiscard]] bool separated(const V& c, S r) const noexcept { return body_->separated(c, r); }
  [[nodiscard]] S reach() const noexcept { return body_->reach(); }

 private:
  struct Interface {
    virtual ~Interface() = default;
    virtual SurfacePoint<S> closest(const V& x) const noexcept = 0;
    virtual Penetration<S> penetration(const V& x) const noexcept = 0;
    virtual void penetration(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept = 0;
    virtual void penetration(const PointBatch<S, 2 * batch_size>& x,
                             PenetrationBatch<S, 2 * batch_size>& in) const noexcept = 0;
    virtual bool separated(const V& c, S r) const noexcept = 0;
    virtual S reach() const noexcept = 0;
  };
  template <class B>
  struct Of final : Interface {
    explicit Of(B b) : body(std::move(b)) {}
    SurfacePoint<S> closest(const V& x) const noexcept override { return body.closest(x); }
    Penetration<S> penetration(const V& x) const noexcept override { return body.penetration(x); }
    void penetration(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept override {
      body.penetration(x, in);
    }
    void penetration(const PointBatch<S, 2 * batch_size>& x,
                     PenetrationBatch<S, 2 * batch_size>& in) const noexcept override {
      if constexpr (HasPenetrationBatch<B, 2 * batch_size>) {
        body.penetration(x, in);
      } else {
        for (std::size_t k = 0; k < 2; ++k) {
          PointBatch<S> half;
          PenetrationBatch<S> part;
          for (std::size_t i = 0; i < batch_size; ++i) {
            const std::size_t j = k * batch_size + i;
            half.x[i] = x.x[j], half.y[i] = x.y[j], half.z[i] = x.z[j];
          }
          body.penetration(half, part);
          for (std::size_t i = 0; i < batch_size; ++i) {
            const std::size_t j = k * batch_size + i;
            in.set(j, {part.depth[i], V(part.gradient_x[i], part.gradient_y[i], part.gradient_z[i])});
          }
        }
      }
    }
    bool separated(const V& c, S r) const noexcept override { return body.separated(c, r); }
    S reach() const noexcept override { return body.reach(); }
    B body;
  };
  std::shared_ptr<const Interface> body_;
};
static_assert(ContactSurface<AnyBody>);

/// Points of a tool, in metres.
struct Shape {
  const char* name;
  SurfaceSamples<S> samples;
  S contact_area;
  S distance;  // of regions
};

/// What a length of one metre and a force of one newton are called.
struct Unit {
  S length, force;
};
constexpr Unit metre{1, 1};

SurfaceSamples<S> grid(int n, S spacing, const V& middle) {
  SurfaceSamples<S> s;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      s.points.push_back(middle + V(spacing * (i - 0.5 * (n - 1)), 0, spacing * (j - 0.5 * (n - 1))));
      s.areas.push_back(spacing * spacing);
      s.vector_areas.push_back(V(0, -spacing * spacing, 0));
    }
  }
  return s;
}

SurfaceSamples<S> of_mesh(const MeshData<S>& data) {
  const TriangleMesh<S> mesh(data);
  return {mesh.vertices(), mesh.vertex_areas(), mesh.vertex_vector_areas()};
}

/// A grid of 13 x 13, a ball, a mallet, two pins, a box.
std::vector<Shape> tools() {
  std::vector<Shape> all;
  all.push_back({"grid", grid(13, 1e-3, V::Zero()), 4e-5, 1.2e-3});
  all.push_back({"ball", of_mesh(Sphere<S>({.radius = 4e-3}).mesh(300)), 2e-5, 0.9e-3});
  MeshData<S> mallet = Cylinder<S>({.radius = 6e-3, .half_height = 4e-3}).mesh(500);
  all.push_back({"mallet", of_mesh(mallet), 6e-5, 1.3e-3});
  SurfaceSamples<S> pins = grid(5, 0.5e-3, V(-7e-3, 0, 0));
  const SurfaceSamples<S> other = grid(5, 0.5e-3, V(7e-3, 0, 0));
  pins.points.insert(pins.points.end(), other.points.begin(), other.points.end());
  pins.areas.insert(pins.areas.end(), other.areas.begin(), other.areas.end());
  pins.vector_areas.insert(pins.vector_areas.end(), other.vector_areas.begin(), other.vector_areas.end());
  all.push_back({"pins", pins, 5e-6, 0.8e-3});
  all.push_back({"box", of_mesh(Box<S>({.half = V(5e-3, 3e-3, 5e-3)}).mesh(400)), 8e-5, 1.5e-3});
  return all;
}

ToolPoints<S> tool_of(const Shape& shape, const Unit& unit, std::uint64_t shuffle = 0) {
  std::vector<std::size_t> order(shape.samples.points.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  if (shuffle != 0) {
    std::mt19937_64 random(shuffle);
    std::shuffle(order.begin(), order.end(), random);
  }
  const S l = unit.length;
  SurfaceSamples<S> s;
  for (const std::size_t i : order) {
    s.points.push_back(l * shape.samples.points[i]);
    s.areas.push_back(l * l * shape.samples.areas[i]);
    s.vector_areas.push_back(l * l * shape.samples.vector_areas[i]);
  }
  return ToolPoints<S>(
      s, {.contact_area = l * l * shape.contact_area, .centre_of_mass = V(l * 1e-3, l * 0.03, l * -2e-3)});
}

/// What a tick gives, in metres and newtons.
struct Felt {
  V force, torque;
  Status status;
  std::size_t contacts;
};

template <class Solver>
std::vector<Felt> play(Solver& solver, const std::vector<Pose<S>>& path, const Unit& unit) {
  std::vector<Felt> felt;
  for (Pose<S> X : path) {
    X.translation *= unit.length;
    const auto now = solver.tick(X);
    felt.push_back({now.wrench.force / unit.force, now.wrench.torque / (unit.force * unit.length), now.status,
                    solver.contacts().size()});
  }
  return felt;
}

struct Difference {
  double force = 0;   // largest, over the largest force
  double torque = 0;  // over the largest force times 30 mm
  int others = 0;     // ticks with another status or number of contacts
};

Difference compare(const std::vector<Felt>& a, const std::vector<Felt>& b) {
  Difference d;
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = (std::max)(largest, a[i].force.norm());
    d.force = (std::max)(d.force, (a[i].force - b[i].force).norm());
    d.torque = (std::max)(d.torque, (a[i].torque - b[i].torque).norm());
    d.others += a[i].status != b[i].status || a[i].contacts != b[i].contacts;
  }
  d.force /= largest, d.torque /= 0.03 * largest;
  return d;
}

constexpr std::uint64_t seeds[] = {1, 2};
constexpr Unit powers_of_ten[] = {{1e-3, 1}, {1e3, 1}, {1e-4, 1e3}, {1e6, 1e-6}};
constexpr Unit powers_of_two[] = {{1.0 / 4096, 4096}, {4096, 4096}};

DuffingForce<S> law_in(const Unit& u) {
  return DuffingForce<S>(
      {.c1 = 40 * u.force / u.length, .c3 = 3e8 * u.force / (u.length * u.length * u.length)});
}

template <class Friction>
Friction friction() {
  if constexpr (Friction::active)
    return Friction({.mu_static = 0.5, .mu_dynamic = 0.3});
  else
    return Friction{};
}

template <class Contacts>
Contacts contacts_in(const Unit& u, S distance) {
  if constexpr (ClusteredTopology<Contacts>)
    return {.distance = u.length * distance};
  else
    return {};
}

using Make = std::function<AnyBody(const Unit&)>;

/// A body in all units, and what it is played along.
struct Scene {
  const char* name;
  double tolerance;  // in another unit
  std::vector<Pose<S>> path;
  AnyBody in_metres;
  std::vector<std::pair<Unit, AnyBody>> tens, twos;

  Scene(const char* body, double within, std::vector<Pose<S>> way, const Make& make)
      : name(body), tolerance(within), path(std::move(way)), in_metres(make(metre)) {
    for (const Unit& unit : powers_of_ten) tens.emplace_back(unit, make(unit));
    for (const Unit& unit : powers_of_two) twos.emplace_back(unit, make(unit));
  }
};

void check(const std::vector<Felt>& reference, const std::vector<Felt>& felt, double tolerance) {
  const Difference d = compare(reference, felt);
  CHECK(d.force <= tolerance);
  CHECK(d.torque <= tolerance);
  CHECK(d.others == 0);
}

/// play(body, unit, seed of the shuffle) in all units against the first.
template <class Play>
void check_units(const Scene& scene, const std::vector<Felt>& reference, const Play& play_in) {
  for (const auto& [unit, body] : scene.tens) {
    INFO("lengths times ", unit.length, ", forces times ", unit.force);
    check(reference, play_in(body, unit, 0), scene.tolerance);
  }
  for (const auto& [unit, body] : scene.twos) {
    INFO("lengths times ", unit.length, ", forces times ", unit.force);
    check(reference, play_in(body, unit, 0), 0);
  }
}

/// One topology, all tools. `distance`: of the regions, over the tool's own.
template <class Friction, class Contacts, class Coupling = DefaultCoupling<NoDeformation<S>>>
void check_points(const Scene& scene, const char* topology, S distance = 1) {
  using Solver =
      ContactSolver<AnyBody, DuffingForce<S>, Friction, Contacts, NoDeformation<S>, AtContact, Coupling>;
  for (const Shape& shape : tools()) {
    INFO(scene.name, ", ", shape.name, ", ", topology);
    const auto play_in = [&](const AnyBody& body, const Unit& unit, std::uint64_t shuffle) {
      Solver solver({.object = body,
                     .tool = tool_of(shape, unit, shuffle),
                     .force = law_in(unit),
                     .friction = friction<Friction>(),
                     .contacts = contacts_in<Contacts>(unit, distance * shape.distance)});
      return play(solver, scene.path, unit);
    };
    const std::vector<Felt> reference = play_in(scene.in_metres, metre, 0);
    for (const std::uint64_t seed : seeds) {
      INFO("shuffled, seed ", seed);
      check(reference, play_in(scene.in_metres, metre, seed), 0);
    }
    if (distance == 1) check_units(scene, reference, play_in);
  }
}

template <class Friction>
void check_point(const Scene& scene) {
  using Solver = ContactSolver<AnyBody, DuffingForce<S>, Friction, SinglePoint>;
  INFO(scene.name, ", a tip");
  const auto play_in = [&](const AnyBody& body, const Unit& unit, std::uint64_t) {
    Solver solver({.object = body,
                   .tool = {V::Zero(), V(unit.length * 1e-3, unit.length * 0.03, 0)},
                   .force = law_in(unit),
                   .friction = friction<Friction>()});
    return play(solver, scene.path, unit);
  };
  check_units(scene, play_in(scene.in_metres, metre, 0), play_in);
}

/// Straight down at the top, square to it: where depths and distances are equal in exact arithmetic; then a
/// way over the body.
template <class Body>
std::vector<Pose<S>> path_over(const Body& body, S top, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const test::WanderingPath<Body> way(body, V::Zero(), -2e-3, 5e-3, 0.8, random);
  std::vector<Pose<S>> path;
  for (int i = 0; i < ticks / 4; ++i) {
    Pose<S> X;
    const S t = S(i) / (ticks / 4);
    X.translation = V(0, top + 1e-3 - 3e-3 * std::sin(std::numbers::pi * t), i < ticks / 8 ? 0 : 2e-3 * t);
    path.push_back(X);
  }
  for (int i = 0; i < ticks; ++i) path.push_back(way.at(double(i) / ticks));
  return path;
}

template <class Around>
void check_body(const char* name, const Make& make, const Around& around, S top, std::uint64_t seed,
                double tolerance = 1e-12) {
  using Coulomb = CoulombFriction<S>;
  using None = Frictionless<S>;
  const Scene scene(name, tolerance, path_over(around, top, seed), make);
  check_point<Coulomb>(scene);
  check_points<None, SingleRegion<>>(scene, "one region");
  check_points<Coulomb, SingleRegion<AreaSharing>>(scene, "one region by area");
  check_points<Coulomb, Regions<4>>(scene, "four regions");
  check_points<Coulomb, Regions<4, AreaSharing>, CompliantRegions<>>(scene, "coupled by area");
  check_points<None, Regions<3>, CompliantRegions<>>(scene, "coupled");
  check_points<Coulomb, Regions<4>>(scene, "more regions than there is room for", 0.4);
}

const Ellipsoid<S> egg({.axes = V(0.06, 0.04, 0.05)});
const Box<S> block({.half = V(0.03, 0.025, 0.02)});
const Cylinder<S> can({.radius = 0.03, .half_height = 0.025});
const Superellipsoid<S> brick({.axes = V(0.05, 0.04, 0.03)});

MeshData<S> scaled(MeshData<S> mesh, S length) {
  for (V& v : mesh.vertices) v *= length;
  return mesh;
}

}  // namespace

TEST_CASE("neither order nor unit matters: ellipsoid") {
  check_body(
      "ellipsoid",
      [](const Unit& u) { return AnyBody(Ellipsoid<S>({.axes = u.length * V(0.06, 0.04, 0.05)})); }, egg,
      0.04, 1);
}
TEST_CASE("neither order nor unit matters: box") {
  check_body(
      "box", [](const Unit& u) { return AnyBody(Box<S>({.half = u.length * V(0.03, 0.025, 0.02)})); }, block,
      0.025, 2);
}
TEST_CASE("neither order nor unit matters: cylinder") {
  const auto make = [](const Unit& u) {
    return AnyBody(Cylinder<S>({.radius = 0.03 * u.length, .half_height = 0.025 * u.length}));
  };
  check_body("cylinder", make, can, 0.025, 3);
}
TEST_CASE("neither order nor unit matters: superellipsoid") {
  check_body(
      "superellipsoid",
      [](const Unit& u) { return AnyBody(Superellipsoid<S>({.axes = u.length * V(0.05, 0.04, 0.03)})); },
      brick, 0.04, 4);
}
TEST_CASE("neither order nor unit matters: mesh") {
  const MeshData<S> mesh = block.mesh(600);
  check_body(
      "mesh", [&](const Unit& u) { return AnyBody(MeshSurface<S>(TriangleMesh<S>(scaled(mesh, u.length)))); },
      block, 0.025, 5);
}
TEST_CASE("neither order nor unit matters: samples") {
  const MeshData<S> mesh = egg.mesh(600);
  check_body(
      "samples",
      [&](const Unit& u) {
        return AnyBody(SampledSurface<MeshSurface<S>>(MeshSurface<S>(TriangleMesh<S>(scaled(mesh, u.length))),
                                                      {.spacing = 1.5e-3 * u.length}));
      },
      egg, 0.04, 6, 1e-8);  // a sample is float: one that is rounded the other way is 6e-8 off
}
