// SPDX-License-Identifier: MIT

#include <palpate/device/recorder.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>

using namespace palpate;

namespace {

using V = Vec3<double>;
using Solver = ContactSolver<Ellipsoid<double>, LinearForce<double>, CoulombFriction<double>>;

Solver make(double k = 300) {
  return Solver({.object = Ellipsoid<double>({.axes = {0.06, 0.04, 0.04}}),
                 .tool = {},
                 .force = LinearForce<double>({.k = k}),
                 .friction = CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.3})});
}

/// Into the top, along it, out, and in again; reset in contact in the middle of the second touch.
Recorder play(std::size_t capacity) {
  Solver solver = make();
  ServoChain<Solver> chain(solver, {});
  Recorder recorder(capacity);
  for (std::uint64_t i = 1; i <= 2000; ++i) {
    const double t = 1e-3 * double(i);
    Pose<double> X;
    X.translation = V(0.01 * std::sin(3 * t), 0.041 + 3e-3 * std::cos(2 * 3.1415926 * t), 0);
    const bool anew = i == 1450;
    if (anew) solver.reset();
    const auto out = chain.tick(X, 1e-3);
    const test::HeapCount heap;
    recorder.add(record_of(out, i, 1e-3, anew));
    const auto allocations = heap.allocations();
    REQUIRE(allocations == 0);
  }
  return recorder;
}

std::filesystem::path temporary(const char* name) { return std::filesystem::temp_directory_path() / name; }

}  // namespace

TEST_CASE("recorder: keeps the last ticks in their order") {
  const auto ticks = play(700).ticks();
  REQUIRE(ticks.size() == 700);
  for (std::size_t i = 0; i < ticks.size(); ++i) CHECK(ticks[i].tick == 1301 + i);
  CHECK(play(5000).ticks().size() == 2000);
  CHECK(play(0).ticks().empty());
}

TEST_CASE("recorder: saved, read and played again, all ticks have the same bits") {
  const auto file = temporary("palpate_recorder_test.txt");
  const auto ticks = play(5000).ticks();
  save_ticks(ticks, file.string(), "--scene test");
  const LoadedTicks loaded = load_ticks(file.string());
  CHECK(loaded.note == "--scene test");
  REQUIRE(loaded.ticks.size() == 2000);
  CHECK(loaded.ticks[1449].begins_anew);
  CHECK(same_bits(loaded.ticks[777].tool, ticks[777].tool));
  CHECK(loaded.ticks[777].passivity == ticks[777].passivity);
  Solver solver = make();
  const Replayed again = replay(solver, loaded.ticks);
  CHECK(again.same);
  CHECK(again.ticks == 2000);
  CHECK(again.skipped == 0);
  std::filesystem::remove(file);
}

TEST_CASE("recorder: a record that begins in contact is played from the first tick without it") {
  const auto ticks = play(1500).ticks();  // begins within the first touch
  REQUIRE(has(ticks[0].status, Status::contact));
  Solver solver = make();
  const Replayed again = replay(solver, ticks);
  CHECK(again.same);
  CHECK(again.skipped > 0);
  CHECK(again.ticks + again.skipped == 1500);
}

TEST_CASE("recorder: another scene is found out at the first tick that differs") {
  const auto ticks = play(5000).ticks();
  Solver stiffer = make(300.0000001);
  const Replayed again = replay(stiffer, ticks);
  CHECK_FALSE(again.same);
  std::size_t first = 0;
  while (!has(ticks[first].status, Status::contact)) ++first;
  CHECK(again.recorded.tick == ticks[first].tick);
  CHECK(again.wrench.force.norm() > again.recorded.wrench.force.norm());
  CHECK(again.status == again.recorded.status);
}

TEST_CASE("recorder: numbers that are none are kept bit for bit; files that are none are refused") {
  const auto file = temporary("palpate_recorder_test_bad.txt");
  TickRecord r;
  r.tool.translation.x() = std::numeric_limits<double>::quiet_NaN();
  r.wrench.force.y() = -0.0;
  r.status = Status::invalid_pose;
  save_ticks({&r, 1}, file.string(), "");
  const TickRecord read = load_ticks(file.string()).ticks.at(0);
  CHECK(same_bits(read.tool, r.tool));
  CHECK(std::signbit(read.wrench.force.y()));
  CHECK(read.status == Status::invalid_pose);
  std::ofstream(file) << "palpate ticks 1\n\n2\n1 0 0 0 3f";
  CHECK_THROWS_AS((void)load_ticks(file.string()), SetupError);
  std::ofstream(file) << "something else";
  CHECK_THROWS_AS((void)load_ticks(file.string()), SetupError);
  std::filesystem::remove(file);
  CHECK_THROWS_AS((void)load_ticks(file.string()), SetupError);
  CHECK_THROWS_AS(save_ticks({&r, 1}, (file / "no" / "folder").string(), ""), SetupError);
}
