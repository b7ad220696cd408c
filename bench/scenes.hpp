// SPDX-License-Identifier: MIT
#pragma once

/// @file  Scenes and small things that the benchmarks share.

#include <palpate/device/servo_statistics.hpp>
#include <palpate/palpate.hpp>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

namespace bench {

using namespace palpate;

template <Real S>
inline constexpr const char* scalar_name = sizeof(S) == sizeof(float) ? "float" : "double";

template <Real S>
Ellipsoid<S> ellipsoid() {
  return Ellipsoid<S>({.axes = Vec3<S>(S(0.06), S(0.04), S(0.04))});
}
template <Real S>
DuffingForce<S> duffing() {
  return DuffingForce<S>({.c1 = S(40), .c3 = S(3e8)});  // the paper's
}
template <Real S, class Slip = ReturnMapping, class Skew = ByComponents>
PowerLawFriction<S, Slip, Skew> fibre() {
  return PowerLawFriction<S, Slip, Skew>({.K = S(0.562), .beta = S(0.75), .mu_dynamic = S(0.3)});
}

/// Those of a tool's points that are no higher than `highest` [m].
inline SurfaceSamples<double> points_up_to(double highest, const SurfaceSamples<double>& all) {
  SurfaceSamples<double> low;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    if (all.points[i].y() > highest) continue;
    low.points.push_back(all.points[i]);
    low.areas.push_back(all.areas[i]);
    low.vector_areas.push_back(all.vector_areas[i]);
  }
  return low;
}

inline constexpr double spacing = 0.3e-3;  ///< of a tool's points [m]
inline constexpr double joining = 0.5e-3;  ///< threshold r of the regions [m]

/// A flat face of `count` points in `patches` patches, each further from the next than `joining`: so many
/// regions.
template <Real S>
ToolPoints<S> face(int count, int patches) {
  int rows = static_cast<int>(std::sqrt(double(count)));
  while (count % rows != 0 || count / rows < patches) --rows;
  const int columns = count / rows;
  std::vector<Vec3<S>> points;
  for (int i = 0; i < columns; ++i) {
    const double x =
        spacing * (i - 0.5 * (columns - 1)) + 2.2e-3 * (i * patches / columns - 0.5 * (patches - 1));
    for (int j = 0; j < rows; ++j) points.emplace_back(S(x), S(0), S(spacing * (j - 0.5 * (rows - 1))));
  }
  return ToolPoints<S>(points, std::vector<S>(points.size(), S(spacing * spacing)),
                       {.contact_area = S(1e-4)});
}

/// Poses of a tool that slides to and fro, `depth` [m] below the top (0, top, 0) of a body.
template <Real S>
std::vector<Pose<S>> sliding(double top, double depth) {
  std::vector<Pose<S>> poses(256);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double phi = 2 * 3.14159265358979323846 * static_cast<double>(i) / 256;
    poses[i].translation = Vec3<S>(S(1e-3 * std::sin(phi)), S(top - depth), S(0.5e-3 * std::sin(2 * phi)));
  }
  return poses;
}

using Clock = std::chrono::steady_clock;
inline std::int64_t nanoseconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(to - from).count();
}
inline double us(std::uint64_t ns) { return 1e-3 * static_cast<double>(ns); }

/// Processor time of this thread: what others do to the machine counts little.
inline std::int64_t processor_ns() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return std::int64_t(t.tv_sec) * 1000000000 + t.tv_nsec;
}

/// Least time of an empty interval [ns]: what reading the clock adds to every measured one.
inline std::int64_t clock_cost() {
  std::int64_t least = 1000000;
  for (int k = 0; k < 10000; ++k) {
    const auto begin = Clock::now();
    least = (std::min)(least, nanoseconds(begin, Clock::now()));
  }
  return least;
}

/// Returns at `time`, to about 0.1 us: sleeps for most of it, then spins, so that the core does not fall
/// asleep at the wrong moment.
inline void wait_until(Clock::time_point time) {
  const auto left = time - Clock::now();
  if (left > std::chrono::microseconds(200)) {
    const auto nap =
        std::chrono::duration_cast<std::chrono::nanoseconds>(left - std::chrono::microseconds(120));
    timespec t{static_cast<time_t>(nap.count() / 1000000000), static_cast<long>(nap.count() % 1000000000)};
    nanosleep(&t, nullptr);
  }
  while (Clock::now() < time) {
  }
}

/// Keeps a result from being optimised away.
template <class T>
inline void use(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

/// Least time of `repeats` calls of f [ns]: what others do to the machine only ever adds.
template <class F>
double least_ns(int repeats, const F& f) {
  double least = 1e300;
  for (int k = 0; k < repeats; ++k) {
    const auto begin = Clock::now();
    f();
    least = (std::min)(least, static_cast<double>(nanoseconds(begin, Clock::now())));
  }
  return least;
}

/// A CSV file with its header, named by argv[1]; `--quick` after it asks for a short run.
struct Output {
  std::FILE* file;
  bool quick;
  mutable int failures = 0;

  Output(int argc, char** argv, const char* header)
      : file(nullptr), quick(argc > 2 && std::strcmp(argv[2], "--quick") == 0) {
    if (argc < 2 || (file = std::fopen(argv[1], "w")) == nullptr) {
      std::fprintf(stderr, "usage: %s OUTPUT.csv [--quick]\n", argv[0]);
      std::exit(2);
    }
    std::fprintf(file, "%s\n", header);
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  ~Output() { std::fclose(file); }

  /// Writes a row, and prints it together with a figure that shows what was computed.
  void row(const std::string& text, const char* check_name, double check) const {
    std::fprintf(file, "%s\n", text.c_str());
    std::fflush(file);
    std::printf("%s  %s=%.9g\n", text.c_str(), check_name, check);
    std::fflush(stdout);
  }
  /// An error figure that must hold: it does not depend on the machine's speed.
  void require_below(const std::string& what, double error, double bound) const {
    if (error <= bound) return;
    std::fprintf(stderr, "error figure: %s is %.6g, above %.6g\n", what.c_str(), error, bound);
    ++failures;
  }
};

}  // namespace bench
