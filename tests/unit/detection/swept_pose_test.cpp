// SPDX-License-Identifier: MIT

#include <palpate/detection/swept_pose.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/sphere.hpp>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <random>
#include <string>

using namespace palpate;

namespace {

template <Real S>
Pose<S> at(S x, S y, S z) {
  Pose<S> X;
  X.translation = Vec3<S>(x, y, z);
  return X;
}

template <Real S>
S deepest(const ToolPoints<S>& tool, const Pose<S>& X, const Box<S>& body) {
  S most = -1;
  for (std::size_t i = 0; i < tool.size(); ++i)
    most = (std::max)(most, -body.closest(X * tool.point(i)).distance);
  return most;
}

}  // namespace

TEST_CASE_TEMPLATE("swept pose: free motion is handed through bit for bit", S, float, double) {
  const Box<S> plate({.half = Vec3<S>(S(0.5), S(0.001), S(0.5))});
  const ToolPoints<S> tool(TriangleMesh<S>(Sphere<S>({.radius = S(0.005)}).mesh(100)),
                           {.contact_area = S(1e-5)});
  SweptPose<S> sweep(S(0.0007));
  const test::HeapCount heap;
  for (int i = 0; i < 200; ++i) {
    const auto X =
        at<S>(S(0.002) * static_cast<S>(i % 7), S(0.006) + S(0.002) * static_cast<S>(i % 13), S(0));
    const auto held = sweep.advance(tool, plate, X);
    CHECK(held.status == Status::ok);
    CHECK(same_bits(held.pose, X));
  }
  CHECK(heap.allocations() == 0);
}

TEST_CASE_TEMPLATE("swept pose: straight at a plate it stops at L, on the side it came from, and comes back",
                   S, float, double) {
  const Box<S> plate({.half = Vec3<S>(S(0.5), S(0.001), S(0.5))});
  const S L = S(0.0007);
  SweptPose<S> sweep(L);
  const PointTool<S> tip{};
  (void)sweep.advance(tip, plate, at<S>(S(0), S(0.1), S(0)));
  auto held = sweep.advance(tip, plate, at<S>(S(0), S(-0.3), S(0)));
  CHECK(has(held.status, Status::held_back));
  // Conservative steps add up to the path to L exactly; rounding is that of coordinates of 0.1 m, once a
  // query.
  CHECK_ABSOLUTE(held.pose.translation.y(), S(0.001) - L, test::ulps<S>(64) * 0.1L);
  held = sweep.advance(tip, plate, at<S>(S(0), S(0.0009), S(0)));
  CHECK(held.status == Status::ok);
  CHECK(held.pose.translation.y() == S(0.0009));
}

TEST_CASE("swept pose: no point gets deeper than 1.25 L on any path") {
  const Box<double> plate({.half = Vec3<double>(0.5, 0.001, 0.5)});
  const ToolPoints<double> tool(
      TriangleMesh<double>(Box<double>({.half = Vec3<double>(0.01, 0.003, 0.002)}).mesh(60)),
      {.contact_area = 1e-5});
  const double L = 0.0007;
  SweptPose<double> sweep(L);
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  (void)sweep.advance(tool, plate, at(0.0, 0.05, 0.0));
  int held = 0;
  for (int i = 0; i < 2000; ++i) {
    auto X = at(0.1 * unit(random), 0.02 * unit(random), 0.1 * unit(random));
    X.rotation =
        Eigen::AngleAxis<double>(3 * unit(random), Vec3<double>(unit(random), unit(random), 2).normalized())
            .toRotationMatrix();
    const auto reached = sweep.advance(tool, plate, X);
    held += has(reached.status, Status::held_back);
    CHECK(deepest(tool, reached.pose, plate) <= 1.001 * L);  // where it stands; 1.25 L is on the way
    CHECK(reached.pose.translation.y() > 0);
    CHECK(is_usable(reached.pose));
  }
  CHECK(held > 500);
}

TEST_CASE("swept pose: poses that are not usable, and a new start") {
  const Box<double> plate({.half = Vec3<double>(0.5, 0.001, 0.5)});
  const PointTool<double> tip{};
  SweptPose<double> sweep(0.0007);
  (void)sweep.advance(tip, plate, at(0.0, 0.1, 0.0));
  const auto bad = at(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  CHECK(same_bits(sweep.advance(tip, plate, bad).pose, bad));
  // Which side it is on is not known any more.
  CHECK(sweep.advance(tip, plate, at(0.0, -0.1, 0.0)).status == Status::ok);
  CHECK(has(sweep.advance(tip, plate, at(0.0, 0.1, 0.0)).status, Status::held_back));
  sweep.reset();
  CHECK(sweep.advance(tip, plate, at(0.0, 0.1, 0.0)).status == Status::ok);
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("swept pose: a depth that is not positive is refused") {
  try {
    const SweptPose<double> sweep(-1);
    FAIL("accepted");
  } catch (const SetupError& error) {
    CHECK(std::string(error.what()) == "SweptPose: depth [m] must be > 0, got -1");
  }
}
#endif
