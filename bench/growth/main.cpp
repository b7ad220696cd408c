// SPDX-License-Identifier: MIT

/// @file  How time and memory grow with the display mesh. Medians; every tick moves the tool, so the whole shape is
/// written. detect_us: which points touch, and how deep; force_us: the whole force tick with it, in a loop of its own as in a servo thread; shape_us: positions;
/// normals_us: positions and normals; copy_us: memcpy of the positions' bytes.

#include "shape_scene.hpp"

#include <malloc.h>

namespace {

using namespace bench;

template <class Work>
double median_us(int ticks, const Work& work) {
  TimeHistogram time;
  for (int k = 0; k < ticks; ++k) {
    const auto begin = Clock::now();
    work(k);
    const auto end = Clock::now();
    if (k >= ticks / 10) time.add(nanoseconds(begin, end));  // the first ones warm up
  }
  return us(time.quantile(0.5));
}

double heap_MB() {
  const auto info = mallinfo2();
  return 1e-6 * static_cast<double>(info.uordblks + info.hblkhd);
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(argc, argv, "vertices,triangles,tool_points,detect_us,force_us,shape_us,normals_us,memory_MB,copy_us");
  const auto poses = sliding<double>(0.04, 2e-3);
  const auto body = ellipsoid<double>();
  for (const std::size_t wanted : {1000ul, 3000ul, 10000ul, 20000ul, 100000ul, 300000ul, 1000000ul}) {
    if (out.quick && wanted > 100000) break;
    const int ticks = static_cast<int>((std::max)(60ul, (std::min)(4000ul, 20000000ul / wanted)));
    const double before = heap_MB();
    Shape shape(wanted, true);
    const double memory = heap_MB() - before;
    Shape bare(wanted, false);
    for (const int points : {1, 100, 1000}) {
      Solver solver = make_solver(points);
      double depth = 0;
      const double detect = median_us(4000, [&](int k) {
        detail::for_each_touching(solver.tool(), poses[std::size_t(k) % 256], body,
                                  [&](std::uint32_t, const Vec3<double>&, const Penetration<double>& in) { depth += in.depth; });
      });
      const double force = median_us(4000, [&](int k) {
        const auto result = solver.tick(poses[std::size_t(k) % 256]);
        depth += 0 * result.wrench.force.x();
      });
      TimeHistogram shape_time;
      for (int k = 0; k < ticks; ++k) {
        const auto unused = solver.tick(poses[std::size_t(k) % 256]);
        depth += 0 * unused.wrench.force.x();
        const auto begin = Clock::now();
        shape.write(solver.contacts());
        if (k >= ticks / 10) shape_time.add(nanoseconds(begin, Clock::now()));
      }
      Solver again = make_solver(points);
      TimeHistogram bare_time;
      for (int k = 0; k < ticks; ++k) {
        const auto unused = again.tick(poses[std::size_t(k) % 256]);
        depth += 0 * unused.wrench.force.x();
        const auto begin = Clock::now();
        bare.write(again.contacts());
        if (k >= ticks / 10) bare_time.add(nanoseconds(begin, Clock::now()));
      }
      std::vector<float> copy(bare.positions().size());
      const double copy_time =
          median_us(ticks, [&](int) {
            std::memcpy(copy.data(), bare.positions().data(), copy.size() * sizeof(float));
            asm volatile("" : : "r"(copy.data()) : "memory");  // keeps the copy
          });
      char row[256];
      std::snprintf(row, sizeof row, "%zu,%zu,%d,%.3f,%.3f,%.2f,%.2f,%.2f,%.3f", shape.vertices(), shape.triangles(), points,
                    detect, force, us(bare_time.quantile(0.5)), us(shape_time.quantile(0.5)), memory,
                    copy_time);
      out.row(row, "mean_square_coordinate_m2", shape.check() + 0 * depth);
    }
  }
}
