// SPDX-License-Identifier: MIT

/// @file Where the time of the paper's shape goes at 20,000 vertices, one contact that slides: microseconds
/// per tick of each stage, and its share of the whole.
///
/// skeleton_share, skeleton_release, prepare and weights are called on their own with a tick's input. write
/// is the tick without normals less those four: the field, the vertices' positions and the box around them.
/// normals is the tick with normals less the one without. Medians over the ticks; a stage too short for the
/// clock is repeated.

#include "shape_scene.hpp"

namespace {

using namespace bench;

/// Median time of `work(k)` over the ticks [us], each repeated often enough for the clock.
template <class Work>
double median_us(std::size_t ticks, int repeats, const Work& work) {
  static const std::int64_t clock = clock_cost();
  std::vector<double> times;
  for (std::size_t k = 0; k < ticks; ++k) {
    const auto begin = Clock::now();
    for (int r = 0; r < repeats; ++r) work(k);
    times.push_back(1e-3 * static_cast<double>(nanoseconds(begin, Clock::now()) - clock) / repeats);
  }
  std::nth_element(times.begin(), times.begin() + std::ptrdiff_t(ticks / 2), times.end());
  return times[ticks / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(argc, argv, "stage,time_us,share");
  const std::size_t ticks = 10000;
  const auto mesh = ellipsoid<float>().mesh(20000);
  Shape<> shape(mesh, true), bare(mesh, false);
  const auto& interpolation = bare.model().field().interpolation();
  const auto& partition = interpolation.partition();
  const Beams skeletons = beams();

  // The input of every tick: contacts of a tool that slides over the exact surface.
  const auto poses = sliding<double>(0.04, 2e-3);
  auto touch = make_touch(ellipsoid<double>(), 100);
  std::vector<ContactState<double>> contacts;
  for (std::size_t k = 0; k < 2 * poses.size(); ++k) {
    if (has(touch.tick(poses[k % poses.size()]).status, Status::contact) && k >= poses.size())
      contacts.push_back(touch.contacts().front());
  }
  const auto contact = [&](std::size_t k) -> const ContactState<double>& {
    return contacts[k % contacts.size()];
  };

  Beams::Result loads;
  const auto share = [&](std::size_t k) {
    const ContactState<double>& c = contact(k);
    const SkeletonContact<double> one{c.origin(), -c.force, c.displacement, c.normal_force};
    skeletons.share(std::span(&one, 1), loads);
    use(loads);
  };
  std::vector<Vec3<double>> released(partition.points().size());
  const auto free_ends = [&](std::size_t k) {
    release(skeletons.skeleton(), loads.loads[0], bottom, contact(k).displacement,
            std::span<Vec3<double>>(released));
    use(released.front());
  };
  std::vector<Vec3<float>> corners(released.size());
  PhongInterpolation<float>::Load load;
  const auto prepare = [&](std::size_t k) {
    const ContactState<double>& c = contact(k);
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = released[i].cast<float>();
    interpolation.prepare(
        corners, {c.origin().cast<float>(), c.normal.cast<float>(), c.displacement.cast<float>()}, load);
    use(load);
  };
  const auto weights = [&](std::size_t) {
    for (std::size_t f = 0; f < partition.faces().size(); ++f) {
      const std::size_t count = partition.faces()[f].count;
      detail::with_weights(partition, load.at, f, 0, [count](const auto& of) {
        for (std::size_t i = 0; i < count; i += detail::simd_group<float>::size()) {
          const auto w = of.at(i);
          use(w);
        }
      });
    }
  };
  struct Stage {
    const char* name;
    double time;
  };
  std::vector<Stage> stages{{"skeleton_share", median_us(ticks, 20, share)},
                            {"skeleton_release", median_us(ticks, 20, free_ends)},
                            {"prepare", median_us(ticks, 20, prepare)},
                            {"weights", median_us(ticks, 1, weights)}};
  double before = 0;
  for (const Stage& stage : stages) before += stage.time;
  const double positions = median_us(ticks, 1, [&](std::size_t k) { bare.write(std::span(&contact(k), 1)); });
  const double all = median_us(ticks, 1, [&](std::size_t k) { shape.write(std::span(&contact(k), 1)); });
  stages.push_back({"write", positions - before});
  stages.push_back({"normals", all - positions});
  Hash hash;
  hash.add(shape.positions());
  hash.add(shape.normals());
  for (const Stage& stage : stages) {
    char row[128];
    std::snprintf(row, sizeof row, "%s,%.3f,%.4f", stage.name, stage.time, stage.time / all);
    out.row(row, "tick_us", all);
  }
  std::printf("hash %016llx\n", static_cast<unsigned long long>(hash.value()));
}
