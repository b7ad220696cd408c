// SPDX-License-Identifier: MIT

/// @file How time and memory grow with the object's mesh. The same mesh is what the tool touches (sampled 2
/// mm apart: SampledSurface of a MeshSurface, double; bench/mesh has the mesh itself) and what is drawn
/// (positions and normals, float), so that both grow, and both want the same caches.
///
/// Every tick moves the tool, asks, and writes the whole shape, as one servo thread would:
///
///     detect_us, force_us,   tool to the next position; in turns: penetration() of every tool point (timed
///     exact_us, normals_us   as detection), the whole force tick (timed as force), and that on the exact
///                            ellipsoid, which has no samples; then the shape with normals (timed as normals)
///     shape_us               force tick, then the shape without normals (timed)
///     linear_us              force tick, then the cheapest shape: linear interpolation, on the same mesh
///                            with its vertices in the partition's order (sorted_by_face)
///     copy_us                force tick, then memcpy of as many bytes as the positions have (timed)
///
/// So detection and force find the caches as the shape left them; what exact_us grows by is program and
/// solver, not samples.
///
///     beside_us              the force tick at 10 kHz in a thread of its own, while another draws as fast
///                            as it can (shape with normals, contacts handed over by a TripleBuffer)
///
/// Medians of the thread's processor time, less what reading it costs: a large mesh takes longer than a time
/// slice, and other programs' share would count. memory_MB: heap of mesh surface, shape model and its
/// buffers. hash: of the forces, the positions and the normals.

#include "shape_scene.hpp"

#include <palpate/device/triple_buffer.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>

#include <malloc.h>

#include <atomic>
#include <thread>

namespace {

using namespace bench;

double heap_MB() {
  const auto info = mallinfo2();
  return 1e-6 * static_cast<double>(info.uordblks + info.hblkhd);
}

std::int64_t processor_time() {  // of this thread [ns]
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1000000000 * static_cast<std::int64_t>(t.tv_sec) + t.tv_nsec;
}

struct Median {
  std::vector<std::int64_t> times;
  template <class Work>
  void add(const Work& work) {
    processor_time();  // the clock's own way out of the caches is not the work's: 3 us after a large mesh
    const std::int64_t begin = processor_time();
    work();
    times.push_back(processor_time() - begin);
  }
  /// [us], of all but the first tenth, which warms up.
  double value(std::int64_t clock) {
    const auto from = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 10);
    const auto middle = from + (times.end() - from) / 2;
    std::nth_element(from, middle, times.end());
    return 1e-3 * static_cast<double>((std::max)(*middle - clock, std::int64_t{0}));
  }
};

template <class Object>
Median force_beside_drawing(Touch<Object>& touch, Shape<>& shape, std::span<const Pose<double>> poses) {
  struct Pressed {
    std::array<ContactState<double>, Touch<Object>::max_regions> contact{};
    std::size_t count = 0;
  };
  TripleBuffer<Pressed> hand_over;
  std::atomic<bool> stop{false};
  std::thread drawing([&] {
    while (!stop.load(std::memory_order_relaxed)) {
      if (hand_over.fetch()) shape.write({hand_over.front().contact.data(), hand_over.front().count});
    }
  });
  Median force;
  auto next = Clock::now();
  for (std::size_t k = 0; k < 2000; ++k) {
    wait_until(next += std::chrono::microseconds(100));
    force.add([&] { use(touch.tick(poses[k % poses.size()])); });
    const auto contacts = touch.contacts();
    std::copy(contacts.begin(), contacts.end(), hand_over.back().contact.begin());
    hand_over.back().count = contacts.size();
    hand_over.publish();
  }
  stop = true;
  drawing.join();
  return force;
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(argc, argv,
                   "vertices,triangles,tool_points,detect_us,force_us,shape_us,normals_us,memory_MB,copy_us,"
                   "exact_us,beside_us,linear_us,hash");
  const auto poses = sliding<double>(0.04, 2e-3);
  Median empty;
  for (int k = 0; k < 10000; ++k) empty.add([] {});
  const auto clock = static_cast<std::int64_t>(1e3 * empty.value(0));
  for (const std::size_t wanted : {1000ul, 3000ul, 10000ul, 20000ul, 100000ul, 300000ul, 1000000ul}) {
    const std::size_t ticks = (std::clamp)(10000000 / wanted, std::size_t{150}, std::size_t{2000});
    const double before = heap_MB();
    const MeshData<float> mesh = ellipsoid<float>().mesh(wanted);
    const SampledSurface<MeshSurface<double>> surface(
        MeshSurface<double>(TriangleMesh<double>(ellipsoid<double>().mesh(wanted))), {.spacing = 2e-3});
    Shape<> shape(mesh, true);
    const double memory = heap_MB() - before;
    Shape<> bare(mesh, false);
    Shape<LinearInterpolation<float>> linear(sorted_by_face(mesh, bare.model().field().partition()), false);
    std::vector<float> copy(bare.positions().size());
    for (const int points : {1, 100, 1000}) {
      auto touch = make_touch(surface, points);
      auto exact = make_touch(ellipsoid<double>(), points);
      const auto& body = touch.object();
      Hash hash;
      const auto tick = [&](std::size_t k) {
        hash.add(touch.tick(poses[k % poses.size()]).wrench.force.y());
      };
      Median detect, force, without_samples, normals, positions, plain, copied;
      for (std::size_t k = 0; k < ticks; ++k) {
        const Pose<double>& X = poses[k % poses.size()];
        if (k % 3 == 0) {
          double depth = 0;
          detect.add([&] {
            for (const auto& point : touch.tool().points()) depth += body.penetration(X * point).depth;
          });
          hash.add(depth);
          tick(k);
        } else if (k % 3 == 1) {
          force.add([&] { tick(k); });
        } else {
          without_samples.add([&] { hash.add(exact.tick(X).wrench.force.y()); });
          tick(k);
        }
        normals.add([&] { shape.write(touch.contacts()); });
      }
      for (std::size_t k = 0; k < ticks; ++k) {
        tick(k);
        positions.add([&] { bare.write(touch.contacts()); });
      }
      for (std::size_t k = 0; k < ticks; ++k) {
        tick(k);
        plain.add([&] { linear.write(touch.contacts()); });
      }
      for (std::size_t k = 0; k < ticks; ++k) {
        tick(k);
        copied.add([&] {
          std::memcpy(copy.data(), bare.positions().data(), copy.size() * sizeof(float));
          use(*copy.data());
        });
      }
      hash.add(shape.positions());
      hash.add(shape.normals());
      hash.add(bare.positions());
      hash.add(linear.positions());
      char row[256];
      std::snprintf(row, sizeof row, "%zu,%zu,%d,%.3f,%.3f,%.2f,%.2f,%.2f,%.3f,%.3f,%.3f,%.3f,%016llx",
                    mesh.vertices.size(), mesh.triangles.size(), points, detect.value(clock),
                    force.value(clock), positions.value(clock), normals.value(clock), memory,
                    copied.value(clock), without_samples.value(clock),
                    force_beside_drawing(touch, shape, poses).value(clock), plain.value(clock),
                    static_cast<unsigned long long>(hash.value()));
      double square = 0;
      for (const float x : bare.positions()) square += double(x) * double(x);
      out.row(row, "mean_square_coordinate_m2", square / static_cast<double>(copy.size()));
    }
  }
}
