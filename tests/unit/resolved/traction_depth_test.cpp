// SPDX-License-Identifier: MIT
// By how much beneath a tool's points tractions act: under a ball, a lying cylinder, contacts far apart.
#include <palpate/resolved/detail/traction_depth.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <cmath>
#include <numbers>

using namespace palpate;
using namespace palpate::test;

namespace {

using V = Vec3<float>;
constexpr double pi = std::numbers::pi, nu = 0.3, a = 1e-3, R = 0.02;
constexpr std::size_t most = 8192;

/// Loads q on a lattice, `cells` along x and z, of a cell's width, that press along -y.
class Pressed {
 public:
  Pressed(int along_x, int along_z, double width, const auto& load_per_area) {
    q_.resize(AlignedList<float>::padded(most));
    system_.begin_tick();
    system_.clear();
    system_.touch(1e-3f, 1e-9f, V::Zero(), -1e-9f * V::UnitY());
    for (int i = 0; i < along_x; ++i)
      for (int k = 0; k < along_z; ++k) {
        const double x = width * (i - 0.5 * (along_x - 1)), z = width * (k - 0.5 * (along_z - 1)),
                     q = load_per_area(x, z) * width * width;
        if (!(q > 0)) continue;
        q_[system_.size()] = float(q);
        system_.add(V(float(x), -1e-3f, float(z)), -V::UnitY(), 1e-3f, float(width * width));
      }
    system_.build();
    depth_.measure(detail::LoadFit(system_, q_.data()));
  }
  [[nodiscard]] const detail::TractionDepth& depth() const { return depth_; }
  /// l along x and z, by the couples of tractions of 1 along these.
  [[nodiscard]] double along_x() const { return depth_.couple(V::UnitX()).z(); }
  [[nodiscard]] double along_z() const { return -depth_.couple(V::UnitZ()).x(); }

 private:
  detail::PointSystem system_{most, float(1 - 2 * nu), true};
  AlignedList<float> q_;
  detail::TractionDepth depth_{nu};
};

/// Hertz's pressure over 4 pi mu: under a ball, and under a lying cylinder, 2 `half` long.
double ball(double x, double z) {
  const double s = 1 - (x * x + z * z) / (a * a);
  return s > 0 ? a / R / (pi * pi * (1 - nu)) * std::sqrt(s) : 0;
}
auto cylinder(double half) {
  return [half](double x, double z) {
    const double s = 1 - x * x / (a * a);
    return s > 0 && std::abs(z) < half ? a / R / (4 * pi * (1 - nu)) * std::sqrt(s) : 0;
  };
}

}  // namespace

TEST_CASE("tractions act beneath a ball's and a cylinder's points by 3/5 of the energy's third degree") {
  // 0.282 is rounded to a thousandth of it. Measured on 60 cells across: 2e-4.
  const Pressed round(60, 60, a / 30, ball);
  CHECK_RELATIVE(round.along_x(), 0.6 * 0.0782 * a * a / R, 1e-3);
  CHECK_RELATIVE(round.along_z(), round.along_x(), 1e-6);  // the same loads, float
  // s is finite: under a cylinder of length L = 60 a, S/s = 0.25 a^2 * 8 pi/A with A = 9/8 load/p = 2.08 a L.
  // Measured on 16 cells across: 0.6 %.
  const Pressed lies(16, 480, a / 8, cylinder(30 * a));
  CHECK_RELATIVE(lies.along_x(), 0.6 / 8 * a * a / R / std::sqrt(1 + 0.25 * 8 * pi / (2.08 * 60)), 0.01);
}

TEST_CASE("contacts far apart have no more than twice what each has") {
  const double apart = 30 * a;
  const Pressed one(12, 12, a / 6, ball),
      two(192, 12, a / 6, [apart](double x, double z) { return ball(std::abs(x) - apart / 2, z); });
  // S = a^2/5 of each, (15 a)^2 along x of both; s = a^2/8 of one and a^2/4 of both.
  // Measured, on twelve cells across that sum up alike in both: 1e-4.
  const double S = 0.2, s = 0.125, each = S / (1 + S / s);
  CHECK_RELATIVE(two.along_x(), one.along_x() * std::sqrt(2 * s / (1 + 2 * s / (15 * 15)) / each), 1e-3);
  CHECK_RELATIVE(two.along_z(), one.along_z() * std::sqrt(S / (1 + S / (2 * s)) / each), 1e-3);
}

TEST_CASE("what tractions are moved by a turn is what their couple does work on") {
  const Pressed lies(16, 160, a / 8, cylinder(10 * a));
  const V t(2, 0.5f, -1), axis = V(0.3f, 0.4f, 1).normalized();
  constexpr float angle = 1e-3f;
  const Mat3<float> turn = Eigen::AngleAxisf(angle, axis).toRotationMatrix();
  // They differ by half the angle; rounding of the turn is 1e-7 of 1 over it. Measured: 1.3e-4.
  CHECK_RELATIVE(t.dot(lies.depth().moved(turn)), angle * axis.dot(lies.depth().couple(t)), 1e-3);
  CHECK(lies.depth().couple(V::UnitY()).norm() <= 1e-6 * lies.along_x());  // float, here and below
  const Mat3<float> twist = Eigen::AngleAxisf(0.3f, V::UnitY()).toRotationMatrix();
  CHECK(lies.depth().moved(twist).norm() <= 1e-6 * lies.along_x());
}

TEST_CASE("without load, and after forget(), tractions act at the points") {
  const Pressed none(2, 2, a, [](double, double) { return 0.; });
  CHECK(none.along_x() == 0);
  detail::TractionDepth depth = Pressed(12, 12, a / 6, ball).depth();
  depth.forget();
  CHECK(depth.couple(V::UnitX()).isZero(0));
  CHECK(depth.moved(Eigen::AngleAxisf(0.3f, V::UnitX()).toRotationMatrix()).isZero(0));
}
