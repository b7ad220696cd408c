// SPDX-License-Identifier: MIT

/// @file The whole loop in one thread at the rates of haptic devices: pose of a scripted hand, detection,
/// force, friction, force limit, shape and normals of 20,000 vertices. A tick begins at its own absolute
/// time; one that begins after the next was due has missed. Ordinary scheduling, no privileges: no real-time
/// priority, no locked memory, no core of its own; so the longest period is the machine's as much as the
/// library's.
///
/// The tool touches the exact ellipsoid, or (mesh_...) the mesh that is drawn.

#include "shape_scene.hpp"

namespace {

using namespace bench;

enum class Draw { nothing, positions, normals };

template <class Object>
void run(const Output& out, const char* name, const Object& object, const MeshData<float>& mesh, Draw draw,
         int rate) {
  auto touch = make_touch(object, 100);
  Shape<> shape(mesh, draw == Draw::normals);
  const auto poses = sliding<double>(0.04, 2e-3);
  const auto period = std::chrono::nanoseconds(1000000000 / rate);
  const auto duration = std::chrono::milliseconds(5000);
  TimeHistogram periods;
  std::uint64_t missed = 0, ticks = 0;
  double force = 0;
  const auto start = Clock::now() + std::chrono::milliseconds(1);
  auto due = start, last = start;
  for (; due < start + duration; ++ticks) {
    wait_until(due);
    const auto now = Clock::now();
    if (ticks > 0) periods.add(nanoseconds(last, now));
    last = now;
    while (now >= due + period) {  // as a device that goes on without us
      ++missed;
      due += period;
    }
    due += period;
    const auto result = touch.tick(poses[ticks % poses.size()]);
    const double size = result.wrench.force.norm();
    force += size < 3.3 ? size : 3.3;  // what the device would get
    if (draw != Draw::nothing) shape.write(touch.contacts());
  }
  const double seconds = 1e-9 * static_cast<double>(nanoseconds(start, last));
  char row[256];
  std::snprintf(row, sizeof row, "%s,%d,%.1f,%.1f,%.1f,%llu", name, rate,
                static_cast<double>(ticks - 1) / seconds, us(periods.quantile(0.99)), us(periods.max()),
                static_cast<unsigned long long>(missed));
  out.row(row, "mean_force_N", force / static_cast<double>(ticks));
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(argc, argv, "scene,rate_hz_requested,rate_hz_reached,period_p99_us,period_max_us,missed");
  const auto mesh = ellipsoid<float>().mesh(20000);
  const SampledSurface<MeshSurface<double>> surface(
      MeshSurface<double>(TriangleMesh<double>(ellipsoid<double>().mesh(20000))), {.spacing = 2e-3});
  const auto exact = ellipsoid<double>();
  for (const int rate : {1000, 2000, 5000, 10000}) {
    run(out, "force", exact, mesh, Draw::nothing, rate);
    run(out, "force_shape_20000", exact, mesh, Draw::positions, rate);
    run(out, "force_shape_normals_20000", exact, mesh, Draw::normals, rate);
    run(out, "mesh_force_shape_normals_20000", surface, mesh, Draw::normals, rate);
  }
}
