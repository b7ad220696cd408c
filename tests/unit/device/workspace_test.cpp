// SPDX-License-Identifier: MIT
#include <palpate/device/workspace.hpp>

#include <support/check.hpp>

#include <cmath>
#include <random>

namespace {

using palpate::Mat3;
using palpate::Pose;
using palpate::Vec3;
using palpate::WorkspaceMapping;
using palpate::Wrench;

template <class S>
struct Draw {
  std::mt19937_64 random{21};
  S number() { return std::uniform_real_distribution<S>(S(-1), S(1))(random); }
  Vec3<S> vector() { return Vec3<S>(number(), number(), number()); }
  Mat3<S> rotation() {  // of a random unit quaternion
    S q[4], norm = 0;
    for (S& c : q) {
      c = number();
      norm += c * c;
    }
    for (S& c : q) c /= std::sqrt(norm);
    const S w = q[0], x = q[1], y = q[2], z = q[3];
    Mat3<S> R;
    R << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
    return R;
  }
};

}  // namespace

TEST_CASE_TEMPLATE("workspace, millimetre to metre example: scaled, turned, shifted", S, float, double) {
  WorkspaceMapping<S> m;
  m.axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // (x, y, z) to (z, x, y): x toward the user, z up
  m.scale = S(2);
  m.offset = Vec3<S>(S(0), S(0), S(0.5));
  Pose<S> device;
  device.translation = Vec3<S>(S(0.25), S(0.5), S(0.125));
  const Pose<S> tool = m.to_scene(device);
  CHECK(tool.translation == Vec3<S>(S(0.25), S(0.5), S(1.5)));
  CHECK(tool.rotation == Mat3<S>::Identity());
  // Up in the scene is up for the hand.
  CHECK(m.to_device({Vec3<S>(0, 0, 3), Vec3<S>::Zero()}, tool).force == Vec3<S>(0, 3, 0));
}

// The hand moves the stylus by velocity v and angular velocity w. Power of the wrench at the stylus point
// must be the solver's power at the centre of mass; with scale s the scene moves s v.
TEST_CASE_TEMPLATE("workspace, wrench: its power on the stylus is the solver's power on the tool", S, float,
                   double) {
  Draw<S> draw;
  INFO("seed 21");
  for (int i = 0; i < 1000; ++i) {
    WorkspaceMapping<S> m;
    m.axes = draw.rotation();
    m.offset = draw.vector();
    m.centre_of_mass = draw.vector();
    const Pose<S> device{draw.rotation(), draw.vector()};
    const Pose<S> tool = m.to_scene(device);
    const Wrench<S> wrench{draw.vector(), draw.vector()};
    const Vec3<S> v = draw.vector(), w = draw.vector();  // device axes
    const Vec3<S> v_scene = m.axes * v, w_scene = m.axes * w;
    const Vec3<S> v_centre = v_scene + w_scene.cross(Vec3<S>(tool.rotation * m.centre_of_mass));
    const Wrench<S> out = m.to_device(wrench, tool);
    // Sums of products of numbers up to 1: tens of roundings.
    CHECK_ABSOLUTE(out.force.dot(v) + out.torque.dot(w),
                   wrench.force.dot(v_centre) + wrench.torque.dot(w_scene), palpate::test::ulps<S>(64));
    CHECK(palpate::is_usable(tool));
  }
}

TEST_CASE("workspace, felt stiffness: scale times the object's") {
  WorkspaceMapping<double> m;
  m.scale = 4;
  const double stiffness = 100, dx = 1e-3;
  const auto force_at = [&](double x) {
    const Pose<double> tool = m.to_scene({Mat3<double>::Identity(), Vec3<double>(x, 0, 0)});
    return m.to_device({-stiffness * tool.translation, Vec3<double>::Zero()}, tool).force.x();
  };
  CHECK_RELATIVE(-(force_at(dx) - force_at(0)) / dx, 400, 1e-14);
}

TEST_CASE("workspace, validity") {
  CHECK(WorkspaceMapping<float>{}.is_usable());
  CHECK_FALSE(WorkspaceMapping<double>{.scale = 0}.is_usable());
  CHECK_FALSE(WorkspaceMapping<double>{.scale = std::nan("")}.is_usable());
  CHECK_FALSE(WorkspaceMapping<double>{.axes = -Mat3<double>::Identity()}.is_usable());
  CHECK_FALSE(WorkspaceMapping<double>{.offset = Vec3<double>(0, HUGE_VAL, 0)}.is_usable());
  CHECK_FALSE(WorkspaceMapping<double>{.centre_of_mass = Vec3<double>(0, std::nan(""), 0)}.is_usable());
}
