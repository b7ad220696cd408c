// SPDX-License-Identifier: MIT

/// @file What a response field costs, in the tick and at set-up: docs/accuracy.md, chapter Cost.
///
/// The ellipsoid of half axes 60, 40, 40 mm, fixed where y <= -36 mm, E = 1.5 MPa, nu = 0.49, the default
/// number of boundary element vertices; contacts move along path.hpp's path, so that no tick has those of the
/// one before. Steps take turns, so that all see the same machine; a turn is six times along the path, so
/// that a step finds the caches as it left them.
///
///     force                solve(), which also finds the position; "after a field": a field drawn just
///                          before used the caches
///     field                displace() into packed floats, after a solve() that is not timed
///     deformation model    ResponseFieldDeformation::write(): force, field, positions, normals if asked for
///     memcpy               of as many bytes as the positions have
///     set-up, bind         of the field, by two threads; of the mesh that is drawn
///     save, load           to bytes and back
///     fresh memory         what the system takes for as many bytes, written once
///
/// time_us: lower quartile, as what others do to the machine only adds; p99_us has them in it. Both less what
/// reading the clock takes. The last five steps are done five times, each in memory that the system has just
/// given, as in a program that starts; their p99_us is the longest. heap_allocations: in all ticks of the
/// step; empty where allocating is the work. hash: of the figures beside the row, and of what the step wrote
/// last; a loaded field has that of the one set up.

#include "response/path.hpp"
#include "shape_scene.hpp"
#include "support/no_heap.hpp"

#include <palpate/response/deformation.hpp>
#include <palpate/response/save.hpp>

#include <malloc.h>

#include <functional>
#include <memory>
#include <optional>

namespace {

using namespace bench;
using Floats = std::span<const float>;
constexpr std::size_t positions = 300, laps = 6, rounds = 5;

struct Step {
  const char* name;
  std::size_t contacts, vertices;
  const char* scalar;
  double goal;         // [us]; 0: none
  const char* figure;  // what `work` returns
  std::function<double(std::size_t)> work;
  std::function<void(std::size_t)> before = {};  // not timed
  std::function<Floats()> written = {};
  bool is_tick = true;

  std::vector<double> times = {};  // [us]
  std::size_t allocations = 0;
  double sum = 0;  // of the figures
  Hash hash = {};

  void run(std::size_t count) {
    static const std::int64_t clock = clock_cost();
    for (std::size_t k = 0; k < count; ++k) {
      const palpate::test::HeapCount heap;
      if (before) before(k % positions);
      const auto begin = Clock::now();
      const double value = work(k % positions);
      const std::int64_t ns = nanoseconds(begin, Clock::now()) - clock;
      allocations += heap.allocations();
      times.push_back(1e-3 * double(ns));
      sum += value;
      hash.add(value);
    }
    if (written) hash.add(written());
  }
  [[nodiscard]] double quantile(double q) const {
    std::vector<double> sorted = times;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(q * double(sorted.size()))];
  }
  [[nodiscard]] double time() const { return quantile(0.25); }
};

void judge(double time, double goal) {
  if (goal > 0 && time <= goal) std::printf("  goal %.10g us: met\n", goal);
  if (goal > 0 && time > goal)
    std::printf("  goal %.10g us: missed by %.0f %%\n", goal, 100 * (time / goal - 1));
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(
      argc, argv,
      "step,contacts,display_vertices,solve_vertices,scalar,time_us,p99_us,goal_us,heap_allocations,hash");
  const auto body = ellipsoid<double>().mesh(2000);
  const auto shown = ellipsoid<float>().mesh(20000);
  const std::size_t size = shown.vertices.size();
  const auto highest = std::ranges::max_element(shown.vertices, {}, [](const auto& p) { return p.y(); });
  // The highest vertex in packed positions.
  const auto top_y = 3 * static_cast<std::size_t>(highest - shown.vertices.begin()) + 1;
  std::vector<PathContact> path;
  for (std::size_t k = 0; k < positions; ++k) path.push_back(contact_on_path(k, positions));

  std::shared_ptr<const ResponseField> field;
  std::optional<ResponseField> loaded;
  std::optional<ResponseDisplay> display;
  std::vector<std::byte> bytes, memory;
  const auto columns = [](const ResponseField& f) {
    return Floats(f.influence(0, 0), f.loads * 3 * f.stride() * f.load_mesh().solved());
  };
  const auto set_up = [&](std::size_t) {
    field = std::make_shared<const ResponseField>(
        body, [](const auto& p) { return p.y() <= -0.036; }, ResponseField::Params{.E = 1.5e6, .nu = 0.49});
    return 1e-6 * double(field->memory());
  };
  const auto bind = [&](std::size_t) { return double(display.emplace(*field, shown.vertices).slots()); };
  const auto save = [&](std::size_t) {
    bytes = save_response_field(*field);
    return 1e-6 * double(bytes.size());
  };
  const auto touch = [&](std::size_t) {
    memory.resize(bytes.size());
    return 1e-6 * double(memory.size());
  };
  const auto load = [&](std::size_t) {
    return 1e-6 * double(loaded.emplace(load_response_field(bytes)).memory());
  };
  // Gives back to the system what a step made before.
  const auto released = []<class T>(T& made) {
    return [&made](std::size_t) {
      made = T();
      malloc_trim(0);
    };
  };
  std::vector<Step> once{
      {"set-up", 0, 0, "double", 10e6, "memory_MB", set_up, released(field), [&] { return columns(*field); }},
      {"bind", 0, size, "float", 0, "slots", bind, released(display)},
      {"save", 0, 0, "float", 0, "saved_MB", save, released(bytes)},
      {"fresh memory", 0, 0, "float", 0, "MB", touch, released(memory)},
      {"load", 0, 0, "float", 0.1e6, "memory_MB", load, released(loaded), [&] { return columns(*loaded); }}};
  for (Step& step : once) {
    step.is_tick = false;
    step.run(5);
  }

  ResponseTick<> tick(*field);
  ResponseFieldDeformation<double> bare(field, shown, {.normals = false}), model(field, shown);
  std::vector<float> moved(3 * size), copy(3 * size), shape(6 * size);
  std::array<Vec3<double>, 2> force, torque;
  std::array<ResponseContact<double>, 2> made;
  const auto solve = [&](std::size_t contacts) {
    return [&, contacts](std::size_t k) {
      (void)tick.solve(path[k].patches.data(), contacts, force.data());
      return force[0].norm();
    };
  };
  const auto solve_turned = [&](std::size_t k) {
    (void)tick.solve(&path[k].turned, 1, force.data(), torque.data());
    return force[0].norm();
  };
  const auto solve_ball = [&](std::size_t k) { return tick.solve(path[k].ball).force; };
  const auto displace = [&](std::size_t) {
    tick.displace(*display, moved.data(), 3);
    return 1e3 * double(moved[top_y]);
  };
  const auto draw = [&](std::size_t k) {
    displace(k);
    use(made = path[k].patches);  // the caller has just made the contact
  };
  const auto write = [&](auto& to) {
    return [&](std::size_t k) {
      (void)to.write(std::span(&path[k].state, 1),
                     VertexBuffer<float>{.positions = shape.data(), .normals = &shape[3 * size]});
      return 1e3 * double(shape[top_y]);
    };
  };
  const auto copied = [&](std::size_t) {
    std::memcpy(copy.data(), moved.data(), moved.size() * sizeof(float));
    use(*copy.data());
    return 1e3 * double(copy[top_y]);
  };
  const auto u = [&] { return Floats(moved); };
  const auto x = [&] { return Floats(shape); };
  std::vector<Step> ticks{
      {"force", 1, 0, "double", 0.5, "mean_N", solve(1)},
      {"force after a field", 1, size, "double", 0.5, "mean_N", solve(1), draw},
      {"force of a turned patch", 1, 0, "double", 0, "mean_N", solve_turned},
      {"force of a ball", 1, 0, "double", 0, "mean_N", solve_ball},
      {"force", 2, 0, "double", 0, "mean_N", solve(2)},
      {"memcpy", 0, size, "float", 0, "mean_at_top_mm", copied},
      {"deformation model", 1, size, "float", 0, "mean_top_mm", write(bare), {}, x},
      {"deformation model with normals", 1, size, "float", 120, "mean_top_mm", write(model), {}, x},
      {"field of a turned patch", 1, size, "float", 0, "mean_at_top_mm", displace, solve_turned, u},
      {"field", 1, size, "float", 60, "mean_at_top_mm", displace, solve(1), u},
      {"field", 2, size, "float", 100, "mean_at_top_mm", displace, solve(2), u}};
  for (Step& step : ticks) step.times.reserve(positions * laps * rounds);
  for (std::size_t r = 0; r < rounds; ++r)
    for (Step& step : ticks) step.run(positions * laps);

  char text[256];
  const auto report = [&](const Step& s) {
    char goal[32] = "", allocations[32] = "";
    if (s.goal > 0) std::snprintf(goal, sizeof goal, "%.10g", s.goal);
    if (s.is_tick) std::snprintf(allocations, sizeof allocations, "%zu", s.allocations);
    std::snprintf(text, sizeof text, "%s,%zu,%zu,%zu,%s,%.3f,%.3f,%s,%s,%016llx", s.name, s.contacts,
                  s.vertices, field->mesh().vertices.size(), s.scalar, s.time(), s.quantile(0.99), goal,
                  allocations, static_cast<unsigned long long>(s.hash.value()));
    out.row(text, s.figure, s.sum / double(s.times.size()));
    judge(s.time(), s.goal);
  };
  for (const Step& step : ticks) report(step);
  const double two = ticks.back().time(), one = ticks.rbegin()[1].time(), goal = 40;
  std::snprintf(text, sizeof text, "field of each further contact,1,%zu,%zu,float,%.3f,,%g,,", size,
                field->mesh().vertices.size(), two - one, goal);
  out.row(text, "of_the_first", (two - one) / one);
  judge(two - one, goal);
  for (const Step& step : once) report(step);
}
