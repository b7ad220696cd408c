// SPDX-License-Identifier: MIT
#pragma once

/// @file  How long a tick can take at most, measured at set-up.

#include <palpate/core/error.hpp>
#include <palpate/core/pose.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>

namespace palpate {

/// The largest work of a tick: every point of the tool inside.
struct LargestWork {
  std::size_t points = 0;  ///< of the tool
  double per_point = 0;    ///< [s], > 0

  /// Of a tick [s].
  [[nodiscard]] double time() const noexcept { return static_cast<double>(points) * per_point; }
  /// How many points a tick of `budget` [s] has time for, at least one: `most` of CoarseTool.
  [[nodiscard]] std::size_t points_within(double budget) const {
    require_positive(budget, "LargestWork", "budget [s] must be > 0");
    const double most = (std::min)(budget / per_point, 1e9);  // more than a tool may have
    return (std::max)(static_cast<std::size_t>(most), std::size_t(1));
  }
};

/// Measures on this machine, now, what a tick costs for each touching point: `solver` at `inside`, a pose at
/// which much of the tool is in the object, as deep as it can get, and at turns about it. Each is timed three
/// times from a state without contact, so that finding the regions counts as well. The least of the three is
/// free of what interrupted it, and the largest over the turns is taken. In use other programs' data take the
/// caches, and a processor runs slower when it is hot: leave a margin of two between this and the servo's
/// period. The shape is not counted: draw() is another thread's.
///
/// Set-up: 27 ticks and a state. Reports a pose at which nothing touches.
template <class Solver>
[[nodiscard]] LargestWork largest_work(const Solver& solver, const Pose<typename Solver::Scalar>& inside,
                                       typename Solver::Scalar dt = typename Solver::Scalar(1e-3)) {
  using S = typename Solver::Scalar;
  using Clock = std::chrono::steady_clock;
  const typename Solver::State fresh = solver.initial_state();
  typename Solver::State state = fresh;
  const Vec3<S> centre = inside * solver.centre_of_mass();
  LargestWork work;
  if constexpr (requires { solver.tool().size(); })
    work.points = solver.tool().size();
  else
    work.points = 1;
  for (int turn = 0; turn < 9; ++turn) {
    Pose<S> X = inside;
    X.rotation = Eigen::AngleAxis<S>(S(0.7) * static_cast<S>(turn), Vec3<S>(1, 2, 2) / S(3)) * X.rotation;
    X.translation = centre - X.rotation * solver.centre_of_mass();
    double least = (std::numeric_limits<double>::max)();
    std::size_t touching = 0;
    for (int again = 0; again < 3; ++again) {
      state = fresh;
      const auto begin = Clock::now();
      (void)solver.evaluate(X, dt, state);
      least = (std::min)(least, std::chrono::duration<double>(Clock::now() - begin).count());
    }
    for (const auto& contact : state.contacts()) touching += contact.points;
    // A clock of coarse steps may see nothing: then a tick took less than one.
    if (touching > 0)
      work.per_point = (std::max)(work.per_point, (std::max)(least, 1e-9) / static_cast<double>(touching));
  }
  if (!(work.per_point > 0)) fail("largest_work", "nothing touches at the pose that was given");
  return work;
}

}  // namespace palpate
