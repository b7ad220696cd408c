// SPDX-License-Identifier: MIT

/// @file Contact resolved at the tool's points on random smooth closed paths that begin and end in the air:
/// the tool is pressed, rolled, tilted, twisted, slid and lifted; one tool has two contacts that merge and
/// part. Bodies: half-spaces behind a box's faces, a sphere, an ellipsoid and a cylinder; response fields of
/// an ellipsoid and of a bent one, concave above like an organ, as a mesh; and float; and points of two
/// spacings.
///
/// *Continuity.* In a tick force and torque change by at most
///
///     |dF| <= K |dx|,   |dtau| <= K |dx| L,   K = 1.32 2 E' sqrt(A/pi)
///
/// with |dx| the largest displacement of any tool point and what two ticks' tolerance leaves of displacements
/// (2e-4 of the depths' norm), A the area of the loaded cells, K the stiffness of a flat rectangle 10:1 of
/// that area (1.32 of a disc's; no rigid tool with so much in contact is stiffer but a more slender one, a
/// sideways push is softer, and whole cells are more than the contact; with points of two spacings that of a
/// rectangle 20:1, 1.55, for the fine ones resolve an edge half as wide), L the farthest point from the centre
/// of mass. With friction 1 + mu times that, for its limit follows the pressure. It is checked at three step
/// lengths: where the step is halved the bound is, and a jump would stay.
///
/// *Energy.* Without friction a closed path of 1,000 ticks and more gives no work: less than 0.5 % of what
/// goes to and fro on a half-space (points come in up to eight ticks late: with 500 ticks 1 %). On a body
/// with a response field the regular part's gradients are in force and torque, by regression over the
/// contact: -0.8 to 0.9 % on an ellipsoid; -4 to 2 % on a bent one, by its tip, which is no wider than the
/// tools, -2 to 1 % for the ball. With friction the hand gains nothing.
///
/// PALPATE_STRESS in the environment (tests/run --stress): 10,000 paths and more.

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/adaptive_contact_points.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/bowl.hpp>
#include <support/joined.hpp>
#include <support/no_heap.hpp>
#include <support/paths.hpp>
#include <support/response_fields.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace palpate;
using namespace palpate::test;

namespace {

using V = Vec3<double>;
constexpr double E = 1e6, nu = 0.49, E_plane = E / (1 - nu * nu), pi = std::numbers::pi;
constexpr double mu = 0.4;

/// How far a path goes along the surface [rad, seen from the body's middle], tilts and twists [rad].
struct Reach {
  double sweep, tilt, twist;
};

/// A position on a body's surface and its outward normal.
struct Place {
  V x, normal;
};
/// Of a body, seen from its middle.
template <class Body>
auto seen_on(const Body& body) {
  return [&body](const V& look) {
    const V x = body.raycast(V::Zero(), look).position;
    return Place{x, body.closest(x).normal};
  };
}

/// `Surface`: from a unit direction to the Place there.
template <class Surface>
class ClosedPath {
 public:
  /// `allowed(x)`: may the tool's lowest point be there?
  template <class Allowed>
  ClosedPath(const Surface& surface, const Reach& reach, const Allowed& allowed, std::mt19937_64& random)
      : surface_(surface), reach_(reach) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto everywhere = [&] {
      for (int i = 0; i < 50; ++i)
        if (!allowed(at(i / 50.).translation)) return false;
      return true;
    };
    do {
      do {
        towards_ = V(unit(random), unit(random), unit(random));
      } while (towards_.norm() < 0.1 || towards_.norm() > 1);
      towards_.normalize();
      side_ = perpendicular<double>(towards_);
      for (double& p : phase_) p = pi * unit(random);
      phase_[5] = pi / 2;  // begins at its highest
      dips_ = 1 + static_cast<int>(3 * std::abs(unit(random)));
    } while (!everywhere());
  }
  /// At t in [0, 1], down to 0.8 mm. The tool's lowest point is its origin, and its y axis points away from
  /// the body.
  [[nodiscard]] Pose<double> at(double t) const {
    const auto wave = [&](std::size_t k, int n) { return std::sin(2 * pi * n * t + phase_[k]); };
    const V look = (towards_ + reach_.sweep * (wave(0, 1) * side_ + wave(1, 2) * towards_.cross(side_)));
    const auto [x, out] = surface_(look.normalized());
    Pose<double> X;
    X.rotation = Eigen::Quaternion<double>::FromTwoVectors(V::UnitY(), out).toRotationMatrix() *
                 rotation_about<double>(V::UnitX(), reach_.tilt * wave(2, 1)) *
                 rotation_about<double>(V::UnitZ(), reach_.tilt * wave(3, 1)) *
                 rotation_about<double>(V::UnitY(), reach_.twist * wave(4, 1));
    X.translation = x + (1e-3 * wave(5, dips_) + 0.2e-3) * out;
    return X;
  }

 private:
  const Surface& surface_;
  Reach reach_;
  V towards_, side_;
  int dips_;
  std::array<double, 6> phase_;
};

struct Tool {
  const char* name;
  SurfaceSamples<double> samples, fine;
  double tilt;

  template <Topology Contacts, Real S>
  [[nodiscard]] auto points() const {
    if constexpr (AdaptiveTopology<Contacts>)
      return AdaptiveTool<S>(points<S>(samples), points<S>(fine));
    else
      return points<S>(samples);
  }
  template <Real S>
  [[nodiscard]] static ToolPoints<S> points(const SurfaceSamples<double>& samples) {
    SurfaceSamples<S> out;
    for (const V& x : samples.points) out.points.push_back(x.cast<S>());
    for (const double area : samples.areas) out.areas.push_back(static_cast<S>(area));
    for (const V& area : samples.vector_areas) out.vector_areas.push_back(area.cast<S>());
    return ToolPoints<S>(out, {.contact_area = S(1e-4), .centre_of_mass = Vec3<S>(0, S(0.02), 0)});
  }
};
const std::vector<Tool>& tools() {
  static const std::vector<Tool> all = [] {
    const auto made = [](const char* name, const MeshData<double>& mesh, double spacing, double tilt) {
      const TriangleMesh<double> shape(mesh);
      return Tool{name, contact_samples(shape, spacing), contact_samples(shape, spacing / 2), tilt};
    };
    MeshData<double> ball, block;
    append(ball, Sphere<double>({.radius = 6e-3}).mesh(1000), V(0, 6e-3, 0));
    append(block, Box<double>({.half = V(3e-3, 2e-3, 2e-3)}).mesh(24), V(0, 2e-3, 0));
    // Hills 6 mm apart; the saddle between them is 0.25 mm higher.
    const auto hills = bowl(5.5e-3, 3e-3, [](double x, double z) {
      const double s = x * x / 9e-6 - 1;
      return 0.25e-3 * s * s + z * z / 9e-3;
    });
    return std::vector<Tool>{made("ball", ball, 1e-3, 0.3), made("two hills", hills, 0.9e-3, 0.1),
                             made("block", block, 1e-3, 0.1)};
  }();
  return all;
}

/// The most of each over some paths.
struct Worst {
  double force = 0, torque = 0;          // |dF| / (K |dx|), |dtau| / (K |dx| L)
  double gained = -1, lost = -1;         // by the hand on a closed path, over all work to and fro
  double touching = 0, sliding = 0;      // ticks
  std::size_t apart = 0, joined = 0;     // ticks: both ends of the tool press and its middle does not; does
  std::size_t allocations = 0, bad = 0;  // bad: not finite, or not converged
};

template <Real S>
[[nodiscard]] Pose<S> pose_in(const Pose<double>& X) {
  return {X.rotation.template cast<S>(), X.translation.template cast<S>()};
}
template <Real S>
[[nodiscard]] Wrench<double> in_double(const Wrench<S>& w) {
  return {w.force.template cast<double>(), w.torque.template cast<double>()};
}

/// Of one spacing, all over the tool, and how many others it has.
template <Real S>
[[nodiscard]] std::pair<const ToolPoints<S>&, std::size_t> even(const ToolPoints<S>& tool) {
  return {tool, 0};
}
template <Real S>
[[nodiscard]] std::pair<const ToolPoints<S>&, std::size_t> even(const AdaptiveTool<S>& tool) {
  return {tool.fine(), tool.coarse().size()};
}

/// One round of `ticks` ticks.
template <class Solver, class Path>
void go_round(Solver& solver, const Path& path, int ticks, Worst& worst) {
  using S = typename Solver::Scalar;
  const auto& tool = solver.tool();
  const auto& [points, others] = even(tool);
  const double slender = others > 0 ? 1.55 : 1.32;
  const V centre = tool.centre_of_mass().template cast<double>();
  double arm = 0;
  for (const Vec3<S>& x : points.points()) arm = (std::max)(arm, (x.template cast<double>() - centre).norm());
  solver.reset();
  Pose<double> before = path.at(0);
  const HeapCount heap;
  Wrench<double> last = in_double(solver.tick(pose_in<S>(before)).wrench);
  double area_before = 0, work = 0, spent = 0;
  for (int i = 1; i <= ticks; ++i) {
    const Pose<double> X = path.at(static_cast<double>(i) / ticks);
    const auto felt = solver.tick(pose_in<S>(X));
    const Wrench<double> now = in_double(felt.wrench);
    const Status status = felt.status;
    worst.bad += !is_finite(now.force) || !is_finite(now.torque) || has(status, Status::unconverged);
    double step = 0, areas[2] = {};  // of points of either spacing
    for (const Vec3<S>& point : points.points()) {
      const V x = point.template cast<double>();
      step = (std::max)(step, (X * x - before * x).norm());
    }
    for (const ContactState<S>& c : solver.contacts()) {
      ++worst.touching;
      worst.sliding += c.mode == ContactMode::sliding;
    }
    bool left = false, right = false, middle = false;
    double depth2 = 0;
    for (const auto& p : solver.state().points()) {
      depth2 += double(p.depth) * double(p.depth);
      areas[p.point < others] += double(tool.area(p.point));
      const double x = double(tool.point(p.point).x());
      left |= x<-2e-3, right |= x> 2e-3, middle |= std::abs(x) < 1e-3;
    }
    const double area = (std::max)(areas[0], areas[1]);
    const double K = slender * 2 * E_plane * std::sqrt((std::max)(area, area_before) / pi);
    step +=
        2 * double(solver.force_law().params().tolerance) * std::sqrt(depth2);  // of this tick and the last
    if (K > 0) {
      worst.force = (std::max)(worst.force, (now.force - last.force).norm() / (K * step));
      worst.torque = (std::max)(worst.torque, (now.torque - last.torque).norm() / (K * step * arm));
    }
    worst.apart += left && right && !middle, worst.joined += left && right && middle;
    const Eigen::AngleAxis<double> spin(Mat3<double>(X.rotation * before.rotation.transpose()));
    const V path_of_centre = X * centre - before * centre;
    const double w = (now.force + last.force).dot(path_of_centre) / 2 +
                     (now.torque + last.torque).dot(spin.angle() * spin.axis()) / 2;
    work += w, spent += std::abs(w);
    before = X, last = now, area_before = area;
  }
  worst.allocations += heap.allocations();
  worst.bad += last.force != V::Zero();  // it ends in the air
  if (spent > 0) {
    worst.gained = (std::max)(worst.gained, work / spent);
    worst.lost = (std::max)(worst.lost, -work / spent);
  }
}

/// From the middle of a round on a copy of the state gives the same bits.
template <class Solver, class Path>
bool copies_agree(Solver& solver, const Path& path, int ticks) {
  solver.reset();
  int i = 0;
  using S = typename Solver::Scalar;
  for (; i < ticks / 3; ++i) (void)solver.tick(pose_in<S>(path.at(static_cast<double>(i) / ticks)), S(1e-3));
  auto copy = solver.state();
  bool same = true;
  for (; i <= ticks; ++i) {
    const Pose<S> X = pose_in<S>(path.at(static_cast<double>(i) / ticks));
    const auto a = solver.tick(X, S(1e-3)), b = solver.evaluate(X, S(1e-3), copy);
    same &= std::memcmp(&a.wrench, &b.wrench, sizeof a.wrench) == 0 && a.status == b.status;
  }
  return same;
}

/// 6 usual ones of each tool in each of eight scenes.
int paths(int usual) { return std::getenv("PALPATE_STRESS") != nullptr ? 80 * usual : usual; }

/// `Contacts`: of one spacing, or of two. `most_work`: by which a round without friction may miss, of all work
/// to and fro.
template <Topology Contacts = ContactPoints<128>, class Body, class Compliance, class Surface, class Allowed>
void check(const char* name, const Body& body, const Compliance& compliance, const Surface& surface,
           const Allowed& allowed, double most_work, std::uint64_t seed) {
  using S = typename Body::Scalar;
  using Elastic = ElasticContact<S, Compliance>;
  using Smooth = ContactSolver<Body, Elastic, Frictionless<S>, Contacts>;
  using Rough = ContactSolver<Body, Elastic, CoulombFriction<S>, Contacts>;
  const Elastic elastic({.compliance = compliance});
  for (const Tool& tool : tools()) {
    INFO(std::string(name), ", ", std::string(tool.name), ", seed ", seed);
    std::mt19937_64 random(seed);
    const Reach far{0.3, tool.tilt, 0.5}, near{2e-3, 2e-3, 5e-3};
    Worst smooth, coarse, rough, small;
    bool same = true;

    Smooth slick({.object = body, .tool = tool.points<Contacts, S>(), .force = elastic});
    for (int p = 0; p < paths(3); ++p) {
      const ClosedPath path(surface, far, allowed, random);
      go_round(slick, path, 500, coarse);
      for (const int ticks : {1000, 2000}) go_round(slick, path, ticks, smooth);
      same &= copies_agree(slick, path, 300);
    }
    Rough dry({.object = body,
               .tool = tool.points<Contacts, S>(),
               .force = elastic,
               .friction = CoulombFriction<S>({.mu_static = S(mu), .mu_dynamic = S(0.75 * mu)})});
    for (int p = 0; p < paths(1); ++p) {
      const ClosedPath path(surface, far, allowed, random);
      for (const int ticks : {500, 1000, 2000}) go_round(dry, path, ticks, rough);
      same &= copies_agree(dry, path, 300);
    }
    // Strokes of 0.1 mm: it sticks and slips in part, and little of the work is lost.
    for (int p = 0; p < paths(2); ++p) {
      const ClosedPath path(surface, near, allowed, random);
      go_round(dry, path, 500, small);
      same &= copies_agree(dry, path, 300);
    }
    std::printf(
        "%-15s %-9s |dF|/(K|dx|) %.2f, |dtau|/(K|dx|L) %.2f, work %.2g to %.2g (500 ticks: %.2g to %.2g); "
        "friction: %.2f, %.2f, work at most %.2g; 0.1 mm: work %.2g to %.2g, sliding %2.0f %%\n",
        name, tool.name, smooth.force, smooth.torque, -smooth.lost, smooth.gained, -coarse.lost,
        coarse.gained, rough.force, rough.torque, rough.gained, -small.lost, small.gained,
        100 * small.sliding / small.touching);
    CHECK(smooth.bad + coarse.bad + rough.bad + small.bad == 0);
    CHECK(smooth.allocations + coarse.allocations + rough.allocations + small.allocations == 0);
    CHECK(same);
    for (const Worst& w : {smooth, coarse}) {
      CHECK(w.force <= 1);
      CHECK(w.torque <= 1);
    }
    CHECK(rough.force <= 1 + mu);
    CHECK(rough.torque <= 1 + mu);
    CHECK(smooth.gained <= most_work);
    CHECK(smooth.lost <= most_work);
    CHECK(rough.gained <= 0);
    CHECK(small.gained <= 0);
    // The paths must be ones on which something happens.
    CHECK(smooth.touching > 0.3 * 3000 * paths(3));
    CHECK(rough.sliding > 0.5 * rough.touching);
    CHECK(small.sliding < 0.9 * small.touching);
    if (std::strcmp(tool.name, "two hills") == 0) {
      CHECK(smooth.apart > 50);
      CHECK(smooth.joined > 50);
    }
  }
}

constexpr auto anywhere = [](const V&) { return true; };

}  // namespace

TEST_CASE("resolved contact on random closed paths: half-space, a box's faces") {
  const V half(0.06, 0.05, 0.04);
  // 11 mm from the edges, more than the tools' size.
  const auto within = [&](const V& x) {
    int beside = 0;
    for (int k = 0; k < 3; ++k) beside += std::abs(x[k]) < half[k] - 0.011;
    return beside == 2;
  };
  const Box<double> box({.half = half});
  check("box", box, HalfSpace({.E = E, .nu = nu}), seen_on(box), within, 0.005, 1);
}
TEST_CASE("resolved contact on random closed paths: half-space, a sphere") {
  const Sphere<double> sphere({.radius = 0.04});
  check("sphere", sphere, HalfSpace({.E = E, .nu = nu}), seen_on(sphere), anywhere, 0.005, 2);
}
TEST_CASE("resolved contact on random closed paths: half-space, an ellipsoid") {
  const Ellipsoid<double> ellipsoid({.axes = V(0.06, 0.04, 0.05)});
  check("ellipsoid", ellipsoid, HalfSpace({.E = E, .nu = nu}), seen_on(ellipsoid), anywhere, 0.005, 3);
}
TEST_CASE("resolved contact on random closed paths: half-space, an ellipsoid, float") {
  const Ellipsoid<double> ellipsoid({.axes = V(0.06, 0.04, 0.05)});
  check("in float", Ellipsoid<float>({.axes = {0.06f, 0.04f, 0.05f}}), HalfSpace({.E = E, .nu = nu}),
        seen_on(ellipsoid), anywhere, 0.005, 6);
}
TEST_CASE("resolved contact on random closed paths: half-space, a cylinder's side") {
  const Cylinder<double> cylinder({.radius = 0.04, .half_height = 0.06});
  check(
      "cylinder", cylinder, HalfSpace({.E = E, .nu = nu}), seen_on(cylinder),
      [](const V& x) { return std::abs(x.y()) < 0.049; }, 0.005, 7);
}
TEST_CASE("resolved contact on random closed paths: a response field") {
  const Ellipsoid<double> ellipsoid({.axes = V(0.06, 0.04, 0.04)});
  check(
      "response field", ellipsoid,
      ResponseCompliance(std::make_shared<const ResponseField>(ellipsoid_field(nu, 300))), seen_on(ellipsoid),
      [](const V& x) { return x.y() > 0; }, 0.01, 4);
}
TEST_CASE("resolved contact on random closed paths: a response field, points of two spacings") {
  const Ellipsoid<double> ellipsoid({.axes = V(0.06, 0.04, 0.04)});
  check<AdaptiveContactPoints<128>>(
      "two spacings", ellipsoid,
      ResponseCompliance(std::make_shared<const ResponseField>(ellipsoid_field(nu, 300))), seen_on(ellipsoid),
      [](const V& x) { return x.y() > 0; }, 0.01, 4);
}
TEST_CASE("resolved contact on random closed paths: a response field, concave above") {
  // An ellipsoid bent upwards: its mesh is what a user has, its equation the path's.
  const V axes(0.06, 0.025, 0.04);
  constexpr double bend = 10;  // [1/m]
  MeshData<double> mesh = ellipsoid_mesh(axes, 16);
  for (V& p : mesh.vertices) p.y() += bend * p.x() * p.x();
  const auto bent = [&](const V& look) {
    const V x = look / look.cwiseQuotient(axes).norm(), n = x.cwiseQuotient(axes.cwiseAbs2());
    return Place{x + V(0, bend * x.x() * x.x(), 0),
                 V(n.x() - 2 * bend * x.x() * n.y(), n.y(), n.z()).normalized()};
  };
  const ResponseCompliance field(std::make_shared<const ResponseField>(
      mesh, [](const V& p) { return p.y() < -0.015; },
      ResponseField::Params{.E = E, .nu = nu, .mesh = {.vertices = 300}, .threads = 1}));
  const SampledSurface<MeshSurface<double>> surface(MeshSurface<double>(TriangleMesh<double>(mesh)),
                                                    {.spacing = 1e-3});
  check(
      "bent, as a mesh", surface, field, bent, [](const V& x) { return x.y() > 0.01; }, 0.06, 8);
}

TEST_CASE("resolved contact, poses that jump: finite, no heap, the same bits") {
  using Elastic = ElasticContact<double, HalfSpace>;
  using Solver = ContactSolver<Sphere<double>, Elastic, CoulombFriction<double>, ContactPoints<64>>;
  for (const Tool& tool : tools()) {
    Solver first({.object = Sphere<double>({.radius = 0.01}),
                  .tool = Tool::points<double>(tool.samples),
                  .force = Elastic({.compliance = HalfSpace({.E = E, .nu = nu})}),
                  .friction = CoulombFriction<double>({.mu_static = 0.4, .mu_dynamic = 0.3})});
    Solver second = first;
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    const HeapCount heap;
    bool finite = true, same = true;
    int touching = 0, full = 0, free = 0;
    for (int i = 0; i < paths(2000); ++i) {
      Pose<double> X;
      X.rotation =
          rotation_about<double>(V(unit(random), unit(random), unit(random)).normalized(), 3 * unit(random));
      X.translation = 0.015 * V(unit(random), unit(random), unit(random));
      const auto a = first.tick(X), b = second.tick(X);
      finite &= is_finite(a.wrench.force) && is_finite(a.wrench.torque);
      same &= std::memcmp(&a.wrench, &b.wrench, sizeof a.wrench) == 0;
      touching += has(a.status, Status::contact), full += has(a.status, Status::point_overflow);
      free += a.wrench.force == V::Zero() && !has(a.status, Status::contact);
    }
    const std::size_t allocations = heap.allocations();
    CHECK(allocations == 0);
    CHECK(finite);
    CHECK(same);
    CHECK(touching > paths(2000) / 4);
    CHECK(full > 0);
    CHECK(touching + free == paths(2000));
  }
}
