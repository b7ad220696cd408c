// SPDX-License-Identifier: MIT

/// @file Run time against error of the force path's parts, beside methods that the library does not ship.
/// Methods that it does ship begin with "palpate". Errors are relative; time_ns is for one evaluation, one
/// tick, or one path, as the setting says. Error figures of the library have bounds, and the program fails
/// above them.

#include "scenes.hpp"
#include "work_precision_force/elastic_contact.hpp"
#include "work_precision_force/methods.hpp"
#include "work_precision_force/table.hpp"

#include <functional>
#include <random>

namespace {

using namespace bench;
using Long = long double;

// ---- the law's inverse
// -----------------------------------------------------------------------------------------------

template <class S>
void inverse(const Table& table) {
  constexpr const char* reference = "Newton's method in long double until it stands still";
  constexpr std::size_t count = 4096;
  constexpr double epsilon = double(std::numeric_limits<S>::epsilon());
  const CubicInverse<Long> exact{40, 3e8L};
  std::vector<S> force(count), depth(count);
  std::vector<Long> truth(count);
  for (std::size_t i = 0; i < count; ++i) {
    force[i] =
        S(std::pow(10.0, -4 + 6 * double(i * 997 % count) / double(count)));  // 0.1 mN to 100 N, out of order
    truth[i] = exact.newton_bound(Long(force[i]), 60);
  }
  const auto measure = [&](const std::string& method, const std::string& setting, const auto& f,
                           double bound = 0) {
    const double ns = least_ns(table.repeats, [&] {
      for (std::size_t i = 0; i < count; ++i) depth[i] = f(force[i]);
      use(depth[0]);
    });
    double error = 0;
    for (std::size_t i = 0; i < count; ++i)
      error = (std::max)(error, std::abs(double((Long(depth[i]) - truth[i]) / truth[i])));
    table.row("inverse of the law", method, scalar_name<S>, setting, ns / double(count), error, reference,
              bound);
  };
  const DuffingForce<S> law = duffing<S>();
  const CubicInverse<S> cubic{40, S(3e8)};
  // 2.5 epsilon is what the law's documentation promises.
  measure(
      "palpate DuffingForce::depth", "3 steps", [&](S F) { return law.depth(F); }, 2.5 * epsilon);
  for (const int n : {1, 2, 4, 8, 16, 32}) {
    const std::string steps = std::to_string(n) + " steps";
    measure("Newton from the linear guess", steps, [&](S F) { return cubic.newton_linear(F, n); });
    measure("Newton from the better bound", steps, [&](S F) { return cubic.newton_bound(F, n); });
  }
  for (const int n : {10, 20, 40, 60})
    measure("bisection", std::to_string(n) + " steps", [&](S F) { return cubic.bisection(F, n); });
  measure("Cardano's formula", "closed", [&](S F) { return cubic.cardano(F); });
  measure("Cardano's formula and a Newton step", "closed",
          [&](S F) { return cubic.newton(F, cubic.cardano(F), 1); });
  measure("asinh form", "closed", [&](S F) { return cubic.hyperbolic(F); });
  for (const std::size_t n : {256u, 4096u, 65536u}) {
    const InverseTable<S> look_up(cubic, S(100), n);
    measure("linear table", std::to_string(n) + " cells", [&](S F) { return look_up(F); });
  }
}

// ---- a region's force under refinement of the tool's points
// ----------------------------------------------------------

constexpr double R = 0.05, tool_radius = 0.015, nominal_area = 1e-4;  // paraboloid y = r^2 / (2 R) [m]

struct Cloud {
  std::vector<Vec3<double>> points;
  std::vector<double> areas;  // projected on the face
  void add(double x, double z, double area) {
    points.emplace_back(x, (x * x + z * z) / (2 * R), z);
    areas.push_back(area);
  }
};
Cloud grid(int n, bool hexagonal) {
  Cloud c;
  const double row_factor = hexagonal ? std::sqrt(3.0) / 2 : 1;
  const double h = tool_radius * std::sqrt(std::numbers::pi / (n * row_factor));
  const int m = static_cast<int>(tool_radius / (h * row_factor)) + 1;
  for (int j = -m; j <= m; ++j)
    for (int i = -m; i <= m; ++i) {
      const double x = h * (i + (hexagonal && j % 2 != 0 ? 0.5 : 0.0)), z = h * row_factor * j;
      if (x * x + z * z <= tool_radius * tool_radius) c.add(x, z, h * h * row_factor);
    }
  return c;
}
Cloud rings(int n) {  // polar midpoint rule with equal areas
  Cloud c;
  const int rings = (std::max)(1, static_cast<int>(std::sqrt(n / 4.0)));
  for (int k = 0; k < rings; ++k) {
    const double inner = tool_radius * k / rings, outer = tool_radius * (k + 1) / rings;
    const int sectors = 4 * (2 * k + 1);
    for (int s = 0; s < sectors; ++s) {
      const double phi = 2 * std::numbers::pi * (s + 0.5) / sectors,
                   r = std::sqrt((inner * inner + outer * outer) / 2);
      c.add(r * std::cos(phi), r * std::sin(phi),
            std::numbers::pi * (outer * outer - inner * inner) / sectors);
    }
  }
  return c;
}
Cloud random_points(int n) {
  Cloud c;
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> side(-tool_radius, tool_radius);
  while (static_cast<int>(c.points.size()) < n) {
    const double x = side(generator), z = side(generator);
    if (x * x + z * z <= tool_radius * tool_radius)
      c.add(x, z, std::numbers::pi * tool_radius * tool_radius / n);
  }
  return c;
}

template <class S>
void region_force(const Table& table, bool quick) {
  constexpr const char* reference = "exact integral 2 pi R U(d) / A0 with U the law's energy";
  using Law = DuffingForce<S>;
  const DuffingForce<double> law = duffing<double>();
  std::vector<Pose<S>> poses(32);
  std::vector<double> exact(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double d = 5e-4 + 1e-3 * double(i) / double(poses.size());
    // Box face at y = 0; sideways moves do not change the answer on a flat face, a turn about y mixes the
    // points' order.
    poses[i].translation = Vec3<S>(S(1e-4 * double(i % 5)), S(-d), S(7e-5 * double(i % 7)));
    exact[i] = 2 * std::numbers::pi * R * law.energy(d) / nominal_area;
  }
  const Box<S> box({.half = Vec3<S>(S(0.5), S(0.5), S(0.5)), .centre = Vec3<S>(S(0), S(-0.5), S(0))});
  const auto measure = [&](const std::string& method, const Cloud& cloud, auto topology, double bound = 0) {
    std::vector<Vec3<S>> points;
    std::vector<S> areas;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      points.push_back(cloud.points[i].cast<S>());
      areas.push_back(S(cloud.areas[i]));
    }
    ContactSolver<Box<S>, Law, Frictionless<S>, decltype(topology)> solver(
        {box, ToolPoints<S>(points, areas, {.contact_area = S(nominal_area)}), duffing<S>(), {}, {}});
    double square = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double F = double(solver.tick(poses[i]).wrench.force.y());
      square += (F / exact[i] - 1) * (F / exact[i] - 1) / double(poses.size());
    }
    const double ns = least_ns(table.repeats, [&] {
      for (const auto& X : poses) use(solver.tick(X));
    });
    table.row("region force", method, scalar_name<S>, std::to_string(points.size()) + " points",
              ns / double(poses.size()), std::sqrt(square), reference, bound);
  };
  for (const int n : {16, 64, 256, 1024, 4096, 16384}) {
    if (quick && n > 5000) continue;
    // A grid's sum of a function that ends with a kink: below 1/n is the second order it must have, 2 the
    // constant.
    measure("palpate by area square grid", grid(n, false), SingleRegion<AreaSharing>{},
            n >= 64 ? 2.0 / std::sqrt(double(n)) : 0);
    measure("palpate by area hexagonal grid", grid(n, true), SingleRegion<AreaSharing>{});
    measure("palpate by area rings", rings(n), SingleRegion<AreaSharing>{});
    measure("palpate equal sharing (the paper's m/n)", grid(n, false), SingleRegion<EqualSharing>{});
    measure("random points by area", random_points(n), SingleRegion<AreaSharing>{});
  }
}

// ---- friction along a path
// -------------------------------------------------------------------------------------------

constexpr int check_points = 32;

/// The tool's tip at the path's parameter s in [0, 1]: to and fro over the top, deeper and shallower.
Vec3<double> path(double s) {
  const double turn = 2 * std::numbers::pi * s;
  return {4e-3 * std::sin(2 * turn), 0.038 + 5e-4 * std::sin(3 * turn), 2e-3 * std::sin(turn)};
}

using Forces = std::array<Vec3<double>, check_points>;

template <class S, class Slip>
Forces follow(int ticks) {
  using Friction = PowerLawFriction<S, Slip>;
  ContactSolver<Ellipsoid<S>, DuffingForce<S>, Friction> solver(
      {ellipsoid<S>(), {}, duffing<S>(), fibre<S, Slip>(), {}});
  Forces forces;
  Pose<S> X;
  for (int k = 1; k <= ticks; ++k) {
    X.translation = path(double(k) / ticks).cast<S>();
    const auto result = solver.tick(X);
    if (k % (ticks / check_points) == 0)
      forces[std::size_t(k / (ticks / check_points) - 1)] = result.wrench.force.template cast<double>();
  }
  return forces;
}

/// A competitor without memory: friction mu F_n tanh(v / v0) against the tip's velocity, from two positions.
template <class S>
Forces follow_regularised(int ticks, double v0) {
  ContactSolver<Ellipsoid<S>, DuffingForce<S>> solver({ellipsoid<S>(), {}, duffing<S>(), {}, {}});
  const PowerLawFriction<S> friction = fibre<S>();
  Forces forces;
  Pose<S> X;
  Vec3<S> before = path(0).cast<S>();
  for (int k = 1; k <= ticks; ++k) {
    X.translation = path(double(k) / ticks).cast<S>();
    Vec3<S> F = solver.tick(X).wrench.force;
    const Vec3<S> n = F.normalized(), move = X.translation - before, along = move - n * n.dot(move);
    const S speed = along.norm() * S(ticks);  // metres per path
    if (speed > S(0)) F -= friction.sliding_limit(F.norm()) * std::tanh(speed / S(v0)) / along.norm() * along;
    before = X.translation;
    if (k % (ticks / check_points) == 0)
      forces[std::size_t(k / (ticks / check_points) - 1)] = F.template cast<double>();
  }
  return forces;
}

double difference(const Forces& a, const Forces& b) {
  double square = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    square += (a[i] - b[i]).squaredNorm();
    norm += b[i].squaredNorm();
  }
  return std::sqrt(square / norm);
}

template <class S>
void friction_path(const Table& table, bool quick) {
  constexpr const char* reference = "return mapping in double with 1048576 ticks";
  static const Forces fine = follow<double, ReturnMapping>(1 << 20);
  for (int ticks = 32; ticks <= (quick ? 4096 : 8192); ticks *= 2) {
    const std::string setting = std::to_string(ticks) + " ticks; time of the path";
    const auto measure = [&](const char* method, const auto& f, double bound = 0) {
      const double error = difference(f(), fine);
      const double ns = least_ns((std::min)(table.repeats, 10), [&] { use(f()); });
      table.row("friction path", method, scalar_name<S>, setting, ns, error, reference, bound);
    };
    // First order in the step: the path of 26 mm in 1,024 ticks is good to a percent, half that in half the
    // step.
    measure(
        "palpate return mapping", [&] { return follow<S, ReturnMapping>(ticks); },
        ticks >= 1024 ? 10.0 / ticks + 1e-4 : 0);
    measure("palpate literal shift (the paper's)", [&] { return follow<S, LiteralShift>(ticks); });
    measure("regularised Coulomb", [&] { return follow_regularised<S>(ticks, 1e-3); });
  }
}

// ---- closest point of an ellipsoid
// ---------------------------------------------------------------------------------

template <class S>
void closest_point(const Table& table, const char* problem, double least, double most) {
  constexpr const char* reference = "bisection in long double";
  constexpr std::size_t count = 2048;
  constexpr double epsilon = double(std::numeric_limits<S>::epsilon());
  const EllipsoidPoint<S> textbook{Vec3<S>(S(0.06), S(0.04), S(0.04))};
  const EllipsoidPoint<Long> exact{textbook.a.template cast<Long>()};
  std::mt19937 generator(2);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> depth(least, most);
  std::vector<Vec3<S>> x(count), p(count);
  std::vector<Vec3<Long>> truth(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3<double> q = Vec3<double>(normal(generator), normal(generator), normal(generator)).normalized();
    const Vec3<double> a(0.06, 0.04, 0.04);
    x[i] = (q.cwiseProduct(a) - depth(generator) * q.cwiseQuotient(a).normalized()).cast<S>();
    truth[i] = exact.bisection(x[i].template cast<Long>(), 120);
  }
  const auto measure = [&](const std::string& method, const std::string& setting, const auto& f,
                           double bound = 0) {
    const double ns = least_ns(table.repeats, [&] {
      for (std::size_t i = 0; i < count; ++i) p[i] = f(x[i]);
      use(p[0]);
    });
    double error = 0;
    for (std::size_t i = 0; i < count; ++i)
      error = (std::max)(error, double((p[i].template cast<Long>() - truth[i]).norm() / exact.a[0]));
    table.row(problem, method, scalar_name<S>, setting, ns / double(count), error, reference, bound);
  };
  const Ellipsoid<S> surface = ellipsoid<S>();
  // A foot near the surface is good to rounding of x, about one epsilon of the largest axis per coordinate.
  measure(
      "palpate closest", "any distance", [&](const Vec3<S>& at) { return surface.closest(at).position; },
      8 * epsilon);
  if (least >= 0) {
    measure(
        "palpate penetration one by one", "inside",
        [&](const Vec3<S>& at) {
          const auto in = surface.penetration(at);
          return Vec3<S>(at + in.depth * in.gradient);
        },
        16 * epsilon);
    const double ns = least_ns(table.repeats, [&] {
      PointBatch<S> at;
      PenetrationBatch<S> in;
      for (std::size_t i = 0; i < count; i += batch_size) {
        for (std::size_t l = 0; l < batch_size; ++l)
          at.x[l] = x[i + l].x(), at.y[l] = x[i + l].y(), at.z[l] = x[i + l].z();
        surface.penetration(at, in);
        for (std::size_t l = 0; l < batch_size; ++l)
          p[i + l] = x[i + l] + in.depth[l] * Vec3<S>(in.gradient_x[l], in.gradient_y[l], in.gradient_z[l]);
      }
      use(p[0]);
    });
    double error = 0;
    for (std::size_t i = 0; i < count; ++i)
      error = (std::max)(error, double((p[i].template cast<Long>() - truth[i]).norm() / exact.a[0]));
    table.row(problem, "palpate penetration sixteen at a time", scalar_name<S>, "inside", ns / double(count),
              error, reference, 16 * epsilon);
  }
  for (const int n : {1, 2, 3, 4, 6, 8, 12})
    measure("Newton from the bound", std::to_string(n) + " steps",
            [&](const Vec3<S>& at) { return textbook.newton(at, n); });
  for (const int n : {10, 20, 30, 50})
    measure("bisection", std::to_string(n) + " steps",
            [&](const Vec3<S>& at) { return textbook.bisection(at, n); });
  for (const int n : {1, 2, 4})
    measure("gradient steps", std::to_string(n) + " steps",
            [&](const Vec3<S>& at) { return textbook.gradient(at, n); });
  measure("along the radius", "closed", [&](const Vec3<S>& at) { return textbook.radial(at); });
}

// ---- float against double: the whole force tick
// ----------------------------------------------------------------------

template <class S>
void whole_tick(const Table& table, double bound) {
  constexpr const char* reference = "sum over the points in long double";
  const auto poses = sliding<S>(0.04, 2e-3);
  const DuffingForce<Long> law = duffing<Long>();
  const EllipsoidPoint<Long> exact{Vec3<Long>(0.06L, 0.04L, 0.04L)};
  for (const int points : {1, 10, 100, 1000}) {
    const ToolPoints<S> tool = face<S>(points, 1);
    ContactSolver<Ellipsoid<S>, DuffingForce<S>, Frictionless<S>, SingleRegion<AreaSharing>> solver(
        {ellipsoid<S>(), tool, duffing<S>(), {}, {}});
    double error = 0;
    for (std::size_t i = 0; i < poses.size(); i += 16) {
      Vec3<Long> sum = Vec3<Long>::Zero();
      for (std::size_t k = 0; k < tool.size(); ++k) {
        const Vec3<Long> at = (tool.point(k) + poses[i].translation).template cast<Long>();
        const Vec3<Long> out = exact.bisection(at, 120) - at;
        sum += Long(tool.area(k)) / Long(tool.contact_area()) * law.force(out.norm()) * out.normalized();
      }
      const Vec3<Long> F = solver.tick(poses[i]).wrench.force.template cast<Long>();
      error = (std::max)(error, double((F - sum).norm() / sum.norm()));
    }
    const double ns = least_ns(table.repeats, [&] {
      for (const auto& X : poses) use(solver.tick(X));
    });
    table.row("force tick", "palpate ContactSolver", scalar_name<S>, std::to_string(points) + " points",
              ns / double(poses.size()), error, reference, bound);
  }
}

// ---- the oscillator (1), undamped and free
// ---------------------------------------------------------------------------

template <class S>
void transient(const Table& table, bool quick) {
  constexpr const char* reference = "Jacobi's cn by the arithmetic-geometric mean";
  const Long a = 0.04L, b = 0.4L, W = std::sqrt(a + b), m = b / (2 * W * W);  // the paper's, amplitude 1
  const Long length = 10;                                                     // about one period, 10.96
  const Long truth = jacobi_cn(W * length, m);
  // The reference against a value with 17 digits from 30-digit arithmetic.
  table.out.require_below("cn", double(std::abs(truth - 0.81483761035484053L)), 1e-16);
  const Oscillator<S> law{S(a), S(b)};
  using State = typename Oscillator<S>::State;
  const auto measure = [&](const char* method, auto step, int n) {
    State end{};
    const double ns = least_ns((std::min)(table.repeats, 20), [&] {
      State s{S(1), S(0)};
      const S h = S(length / n);
      for (int i = 0; i < n; ++i) (law.*step)(s, h);
      end = s;
      use(end);
    });
    table.row("oscillator (1)", method, scalar_name<S>, std::to_string(n) + " steps; time of the path", ns,
              std::abs(double(Long(end.x) - truth)), reference);
  };
  for (int n = 16; n <= (quick ? 4096 : 65536); n *= 4) {
    measure("explicit Euler", &Oscillator<S>::explicit_euler, n);
    measure("symplectic Euler", &Oscillator<S>::symplectic_euler, n);
    measure("velocity Verlet", &Oscillator<S>::verlet, n);
    measure("Newmark average acceleration", &Oscillator<S>::newmark, n);
    measure("Yoshida order 4", &Oscillator<S>::yoshida4, n);
    measure("Runge-Kutta order 4", &Oscillator<S>::runge_kutta4, n);
  }
}

template <class S>
void all(const Table& table, bool quick) {
  inverse<S>(table);
  region_force<S>(table, quick);
  friction_path<S>(table, quick);
  closest_point<S>(table, "closest point within 2 mm of the surface", 0, 2e-3);
  closest_point<S>(table, "closest point up to 20 mm in and out", -0.02, 0.02);
  // D^3 triples the relative error of a depth of 2 mm out of 40 mm: 60 epsilon, and twice that for the sum.
  whole_tick<S>(table, 120 * double(std::numeric_limits<S>::epsilon()));
  transient<S>(table, quick);
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(argc, argv, "case,method,scalar,setting,time_ns,error_rel,reference");
  const Table table{out, out.quick ? 20 : 200};
  all<double>(table, out.quick);
  all<float>(table, out.quick);
  elastic_contact(table, out.quick);
  return out.failures == 0 ? 0 : 1;
}
