// SPDX-License-Identifier: MIT

/// @file  The whole loop in one thread at the rates of haptic devices: pose from a scripted hand, detection, force,
/// friction, force limit, shape and normals of 20,000 vertices. A tick begins at its own absolute time; one that begins
/// later than the next was due has missed. The thread has no real-time priority: what is held here is held anywhere.

#include "shape_scene.hpp"

namespace {

using namespace bench;

void run(const Output& out, const char* name, bool shaped, bool normals, int points, int rate) {
  Solver solver = make_solver(points);
  Shape shape(shaped ? 20000 : 100, normals);
  const auto poses = sliding<double>(0.04, 2e-3);
  const auto period = std::chrono::nanoseconds(1000000000 / rate);
  const int ticks = rate * (out.quick ? 1 : 10);
  TimeHistogram periods;
  std::uint64_t missed = 0;
  double force = 0;
  const auto start = Clock::now() + std::chrono::milliseconds(1);
  auto due = start, last = start;
  for (int k = 0; k < ticks; ++k) {
    wait_until(due);
    const auto now = Clock::now();
    if (k > 0) periods.add(nanoseconds(last, now));
    last = now;
    while (now >= due + period) {  // as a device that goes on without us
      ++missed;
      due += period;
    }
    due += period;
    const auto result = solver.tick(poses[std::size_t(k) % poses.size()]);
    const double size = result.wrench.force.norm();
    force += size < 3.3 ? size : 3.3;  // what the device would get
    if (shaped) shape.write(solver.contacts());
  }
  const double seconds = 1e-9 * static_cast<double>(nanoseconds(start, last));
  char row[256];
  std::snprintf(row, sizeof row, "%s,%d,%.1f,%.1f,%.1f,%llu", name, rate, (ticks - 1) / seconds, us(periods.quantile(0.99)),
                us(periods.max()), static_cast<unsigned long long>(missed));
  out.row(row, "mean_force_N", force / ticks);
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(argc, argv, "scene,rate_hz_requested,rate_hz_reached,period_p99_us,period_max_us,missed");
  for (const int rate : {1000, 2000, 5000, 10000}) {
    run(out, "force_100_points", false, false, 100, rate);
    run(out, "force_100_points_shape_20000", true, false, 100, rate);
    run(out, "force_100_points_shape_normals_20000", true, true, 100, rate);
  }
}
