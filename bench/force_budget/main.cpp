// SPDX-License-Identifier: MIT

/// @file Does every force tick keep its budget? One row for each composition, number of points and of
/// regions: back to back, and paced at 1 kHz, where a dozen scenes take turns and each finds the caches used
/// by the others. Compiled once for each SCALAR.
///
/// After every tick an empty tick runs: arithmetic without memory that takes as long as the median tick. Both
/// are exposed to the machine for the same time, so it holds up as many ticks of the library as empty ones:
/// an offender has more ticks over the budget than that. OUTPUT_machine.csv has the empty tick's distribution
/// row by row.
///
/// The tool goes round the same path of 256 poses again and again, and a solver does the same work in the
/// same position each time. The least time of a position over all rounds is the solver's own, without the
/// machine: OUTPUT_machine.csv has the median position and the slowest one (own_p50_us, own_max_us; empty for
/// fewer than 8 rounds). bench/force_budget/check fails on a slowest one over 30 us.
///
/// Budgets: 30 us for 99.9 % of all ticks up to 1,000 points and 8 regions; median 0.1 us for one point and 1
/// us for 100 points on an exact surface. Times are less what reading the clock takes.

#include "scenes.hpp"
#include "support/no_heap.hpp"

#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/luo_xiao/beam/region_skeletons.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>

namespace {

using namespace bench;

constexpr std::int64_t budget = 30000;   // [ns]
constexpr std::size_t positions = 256;   // of the tool's path
constexpr std::size_t least_rounds = 8;  // of the path, for a least time of a position

struct Empty {
  long turns = 1;
  volatile double sink = 0;

  void tick() {
    double x = 0.5;  // not the fixed point, which a compiler would see
    for (long i = 0; i < turns; ++i) x = x * 0.999 + 1e-3;
    sink = x;
  }
  void calibrate(std::int64_t ns) {
    turns = 10000;
    const double least = least_ns(20, [&] { tick(); });
    turns = (std::max)(1L, static_cast<long>(10000 * static_cast<double>(ns) / least));
  }
};

struct Scene {
  std::string composition;
  const char* scalar;
  int points;
  double median_budget;                     // [us]
  std::function<double(std::size_t)> tick;  // k-th tick; returns a force to check
  std::function<std::size_t()> regions;

  std::size_t most_regions = 0, ticks = 0, allocations = 0, over = 0, empty_over = 0, over_beside_held_up = 0;
  std::int64_t median = 0;  // of the warm-up [ns]
  double force = 0;
  Empty empty = {};
  TimeHistogram time = {}, empty_time = {};
  std::array<std::int64_t, positions> least = {};  // time at each position of the path [ns]

  // Median and largest of the least times [us]; 0 where each position was met too few times.
  [[nodiscard]] std::array<double, 2> own() const {
    if (ticks < least_rounds * positions) return {};
    auto sorted = least;
    std::sort(sorted.begin(), sorted.end());
    return {1e-3 * static_cast<double>(sorted[positions / 2]), 1e-3 * static_cast<double>(sorted.back())};
  }
};

struct Bench {
  const Output& out;
  std::FILE* machine;
  std::int64_t clock = clock_cost();
  std::vector<Scene> scenes = {};
  int rows = 0, offenders = 0, held_up = 0;
  double slowest = 0;  // own time of any row [us]
  std::string slowest_row = {};

  template <class Solver>
  void add(std::string name, int points, double top, typename Solver::Parts parts, double depth = 2e-3) {
    using S = typename Solver::Scalar;
    const auto solver = std::make_shared<Solver>(std::move(parts));
    const auto poses = std::make_shared<std::vector<Pose<S>>>(sliding<S>(top, depth));
    scenes.push_back({std::move(name), scalar_name<S>, points,
                      points == 1     ? 0.1
                      : points == 100 ? 1.0
                                      : 30.0,
                      [solver, poses](std::size_t k) {
                        const Pose<S>& X = (*poses)[k % positions];
                        if constexpr (Solver::is_rate_dependent) {
                          return static_cast<double>(solver->tick(X, S(1e-3)).wrench.force.y());
                        } else {
                          return static_cast<double>(solver->tick(X).wrench.force.y());
                        }
                      },
                      [solver] { return solver->contacts().size(); }});
  }

  template <class S, class Law, class Friction>
  void point(const char* name, const Law& law, const Friction& friction) {
    add<ContactSolver<Ellipsoid<S>, Law, Friction>>(name, 1, 0.04, {ellipsoid<S>(), {}, law, friction, {}});
  }
  template <class S, class Body>
  void body(const char* name, const Body& surface, double top) {
    const std::string of(name);
    add<ContactSolver<Body, DuffingForce<S>, PowerLawFriction<S>>>(
        of + " duffing fibre point", 1, top, {surface, {}, duffing<S>(), fibre<S>(), {}});
    for (const int points : {100, 1000}) {
      add<ContactSolver<Body, DuffingForce<S>, PowerLawFriction<S>, Regions<8, AreaSharing>>>(
          of + " duffing fibre regions<8>", points, top,
          {surface, face<S>(points, 1), duffing<S>(), fibre<S>(), {joining}});
    }
  }
  template <class S, std::size_t N, class Acting = AtContact>
  void regions(const char* suffix, int points) {
    add<ContactSolver<Ellipsoid<S>, DuffingForce<S>, PowerLawFriction<S>, Regions<N, AreaSharing>,
                      NoDeformation<S>, Acting>>(
        "ellipsoid duffing fibre regions<" + std::to_string(N) + ">" + suffix, points, 0.04,
        {ellipsoid<S>(), face<S>(points, int(N)), duffing<S>(), fibre<S>(), {joining}});
  }
  template <class S, class Rule>
  void coupled(const char* name, int points) {
    using Coupling = RegionSkeletons<Skeleton<S>, Rule>;
    std::vector<Vec3<S>> ends;
    for (const auto& end : extremal_points(ellipsoid<S>())) ends.push_back(end.position);
    add<ContactSolver<Ellipsoid<S>, DuffingForce<S>, PowerLawFriction<S>, Regions<4, AreaSharing>,
                      NoDeformation<S>, AtContact, Coupling>>(
        name, points, 0.04,
        {ellipsoid<S>(),
         face<S>(points, 4),
         duffing<S>(),
         fibre<S>(),
         {joining},
         {},
         Coupling(Skeleton<S>(ends,
                              EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e5, .nu = 0.5})),
                              VolumePreserving<double>({.volume = ellipsoid<double>().volume()})))});
  }

  template <class S>
  void all() {
    using Coulomb = CoulombFriction<S>;
    const Coulomb coulomb({.mu_static = S(0.5), .mu_dynamic = S(0.3)});
    const DuffingForce<S> law = duffing<S>();
    std::vector<typename TabulatedForce<S, 32>::Sample> samples;
    for (int i = 0; i < 32; ++i) samples.push_back({S(2e-4) * S(i), law.force(S(2e-4) * S(i))});
    const TabulatedForce<S, 32> table(samples);
    const SaturatedForce<DuffingForce<S>> saturated(law, {.limit = S(2)});

    // laws and decorators
    point<S>("ellipsoid duffing point", law, Frictionless<S>{});
    point<S>("ellipsoid linear fibre point", LinearForce<S>({.k = S(300)}), fibre<S>());
    point<S>("ellipsoid power fibre point", PowerLawForce<S>({.k = S(1e4), .p = S(1.5)}), fibre<S>());
    point<S>("ellipsoid tabulated fibre point", table, fibre<S>());
    point<S>("ellipsoid saturated duffing fibre point", saturated, fibre<S>());
    point<S>("ellipsoid damped duffing fibre point", DampedForce<DuffingForce<S>>(law, {.damping = S(0.5)}),
             fibre<S>());
    point<S>("ellipsoid damped viscous saturated duffing fibre point",
             DampedForce<SaturatedForce<DuffingForce<S>>, Viscous>(saturated, {.damping = S(0.5)}),
             fibre<S>());
    // friction laws, slip and skew rules
    point<S>("ellipsoid duffing coulomb point", law, coulomb);
    point<S>("ellipsoid duffing fibre point", law, fibre<S>());
    point<S>("ellipsoid duffing fibre literal-shift point", law, fibre<S, LiteralShift>());
    point<S>("ellipsoid duffing fibre radial point", law, fibre<S, ReturnMapping, Radial>());
    // where the force acts
    add<ContactSolver<Ellipsoid<S>, DuffingForce<S>, PowerLawFriction<S>, SinglePoint, NoDeformation<S>,
                      AtMassCentre>>("ellipsoid duffing fibre point at-mass-centre", 1, 0.04,
                                     {ellipsoid<S>(), {}, law, fibre<S>(), {}});
    // topologies and sharing
    for (const int points : {1, 10, 100, 1000}) {
      add<ContactSolver<Ellipsoid<S>, DuffingForce<S>, Frictionless<S>, SingleRegion<AreaSharing>>>(
          "ellipsoid duffing region", points, 0.04, {ellipsoid<S>(), face<S>(points, 1), law, {}, {}});
      add<ContactSolver<Ellipsoid<S>, DuffingForce<S>, PowerLawFriction<S>, SingleRegion<AreaSharing>>>(
          "ellipsoid duffing fibre region", points, 0.04,
          {ellipsoid<S>(), face<S>(points, 1), law, fibre<S>(), {}});
      regions<S, 1>("", points);
      if (points < 10) continue;
      regions<S, 2>("", points);
      regions<S, 4>("", points);
      regions<S, 8>("", points);
    }
    add<ContactSolver<Ellipsoid<S>, DuffingForce<S>, PowerLawFriction<S>, SingleRegion<EqualSharing>>>(
        "ellipsoid duffing fibre region equal-sharing", 100, 0.04,
        {ellipsoid<S>(), face<S>(100, 1), law, fibre<S>(), {}});
    regions<S, 8, AtMassCentre>(" at-mass-centre", 100);
    add<ContactSolver<Ellipsoid<S>, TabulatedForce<S, 32>, Coulomb, Regions<8, AreaSharing>>>(
        "ellipsoid tabulated coulomb regions<8>", 100, 0.04,
        {ellipsoid<S>(), face<S>(100, 8), table, coulomb, {joining}});
    // coupling of regions (section VI)
    for (const int points : {100, 1000}) {
      coupled<S, CoupledRegions>("ellipsoid duffing fibre regions<4> coupled", points);
      coupled<S, SuperposedRegions>("ellipsoid duffing fibre regions<4> superposed", points);
    }
    // surfaces
    body<S>("sphere", Sphere<S>({.radius = S(0.05)}), 0.05);
    body<S>("box", Box<S>({.half = Vec3<S>(S(0.06), S(0.04), S(0.04))}), 0.04);
    body<S>("cylinder", Cylinder<S>({.radius = S(0.05), .half_height = S(0.04)}), 0.04);
    const Superellipsoid<S> pill({.axes = Vec3<S>(S(0.06), S(0.04), S(0.04)), .e1 = S(0.5), .e2 = S(0.5)});
    body<S>("superellipsoid", pill, 0.04);
    body<S>("superellipsoid e1 0.3 e2 0.7",  // powers that are no whole numbers
            Superellipsoid<S>({.axes = Vec3<S>(S(0.06), S(0.04), S(0.04)), .e1 = S(0.3), .e2 = S(0.7)}),
            0.04);
    body<S>("superellipsoid sampled", SampledSurface<Superellipsoid<S>>(pill, {.spacing = S(2e-3)}), 0.04);
    const MeshSurface<S> mesh(TriangleMesh<S>(ellipsoid<S>().mesh(2000)));
    add<ContactSolver<MeshSurface<S>, DuffingForce<S>, PowerLawFriction<S>, Regions<8, AreaSharing>>>(
        "mesh duffing fibre regions<8>", 100, 0.04, {mesh, face<S>(100, 1), law, fibre<S>(), {joining}});
  }

  /// Warms up with one turn of the scene, which is also the check of what is computed.
  void warm_up(Scene& s) const {
    TimeHistogram time;
    s.force = 0;
    for (std::size_t k = 0; k < positions; ++k) {
      const auto begin = Clock::now();
      s.force += s.tick(k) / positions;
      time.add(nanoseconds(begin, Clock::now()) - clock);
      s.most_regions = (std::max)(s.most_regions, s.regions());
    }
    s.median = (std::max<std::int64_t>)(1, static_cast<std::int64_t>(time.quantile(0.5)));
    s.empty.calibrate(s.median);
    s.time = s.empty_time = {};
    s.least.fill(std::numeric_limits<std::int64_t>::max());
    s.ticks = s.allocations = s.over = s.empty_over = s.over_beside_held_up = 0;
  }

  void tick(Scene& s, std::size_t k) const {
    const palpate::test::HeapCount heap;
    const auto begin = Clock::now();
    const double force = s.tick(k);
    const auto between = Clock::now();
    s.empty.tick();
    const auto end = Clock::now();
    use(force);
    s.allocations += heap.allocations();
    ++s.ticks;
    const std::int64_t ours = nanoseconds(begin, between) - clock, theirs = nanoseconds(between, end) - clock;
    s.time.add(ours);
    s.empty_time.add(theirs);
    s.least[k % positions] = (std::min)(s.least[k % positions], ours);
    if (theirs > budget) ++s.empty_over;
    if (ours > budget) {
      ++s.over;
      if (theirs > 2 * s.median + 2000) ++s.over_beside_held_up;
    }
  }

  /// Ticks of a row: as many as asked for, in at most two seconds (quick: 0.1), but at least `least`.
  [[nodiscard]] std::size_t count(const Scene& s, std::size_t least, std::size_t most) const {
    const auto fit =
        static_cast<std::size_t>((out.quick ? 1e8 : 2e9) / (2 * static_cast<double>(s.median) + 100));
    return std::clamp(fit, least, most);
  }

  void back_to_back() {
    for (Scene& s : scenes) {
      warm_up(s);
      const std::size_t ticks = count(s, least_rounds * positions, out.quick ? 5000 : 100000);
      for (std::size_t k = 0; k < ticks; ++k) tick(s, k);
      report("back_to_back", s);
    }
  }

  void paced() {
    constexpr std::size_t most = 12;  // scenes in turn within each millisecond
    std::vector<Scene*> turn;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      warm_up(scenes[i]);
      turn.push_back(&scenes[i]);
      if (turn.size() < most && i + 1 < scenes.size()) continue;
      std::size_t ticks = out.quick ? 150 : 5000;
      auto next = Clock::now();
      for (std::size_t k = 0; k < ticks; ++k) {
        wait_until(next += std::chrono::milliseconds(1));
        for (Scene* s : turn) {
          if (s->ticks < count(*s, (std::min)(ticks, std::size_t(200)), ticks)) tick(*s, k);
        }
        next = (std::max)(next,
                          Clock::now() - std::chrono::milliseconds(1));  // a slow scene is not caught up with
      }
      for (Scene* s : turn) report("paced_1kHz", *s);
      turn.clear();
    }
  }

  void report(const char* pace, const Scene& s) {
    const double p50 = us(s.time.quantile(0.5)), p999 = us(s.time.quantile(0.999));
    char key[160], text[320];
    std::snprintf(key, sizeof key, "%s,%s,%s,%d,%zu", pace, s.composition.c_str(), s.scalar, s.points,
                  s.most_regions);
    std::snprintf(text, sizeof text, "%s,%.3f,%.3f,%.3f,%.3f,%zu,%zu,%zu", key, p50,
                  us(s.time.quantile(0.99)), p999, us(s.time.max()), s.over, s.ticks, s.allocations);
    out.row(text, "mean_force_N", s.force);
    const auto [own_p50, own_max] = s.own();
    char own[64] = ",";
    if (own_max > 0) std::snprintf(own, sizeof own, "%.3f,%.3f", own_p50, own_max);
    if (own_max > slowest) slowest = own_max, slowest_row = key;
    std::fprintf(machine, "%s,%.3f,%.3f,%.3f,%.3f,%zu,%zu,%s,%.9g\n", key, us(s.empty_time.quantile(0.5)),
                 us(s.empty_time.quantile(0.99)), us(s.empty_time.quantile(0.999)), us(s.empty_time.max()),
                 s.empty_over, s.over_beside_held_up, own, s.force);
    ++rows;
    // Ticks over the budget beyond those that the empty tick shows, less three standard deviations of that
    // difference.
    const double ours = double(s.over), theirs = double(s.empty_over);
    const bool slow = ours - theirs - 3 * std::sqrt(ours + theirs) > 1e-3 * double(s.ticks);
    const bool slow_median = p50 > s.median_budget;
    if (slow_median) std::printf("  OFFENDER: median %.3f us, budget %g us\n", p50, s.median_budget);
    if (slow || p999 > us(budget)) {
      std::printf("  %s: 99.9 %% %.1f us, budget %g us; over it are %zu of %zu ticks, and %zu empty ones\n",
                  slow ? "OFFENDER" : "machine held up", p999, us(budget), s.over, s.ticks, s.empty_over);
      if (!slow) ++held_up;
    }
    if (slow_median || slow) ++offenders;
    if (s.allocations > 0) std::printf("  ALLOCATES\n");
  }
};

}  // namespace

int main(int argc, char** argv) {
  const Output out(
      argc, argv,
      "scene,composition,scalar,points,regions,p50_us,p99_us,p999_us,max_us,over_budget_count,ticks,"
      "heap_allocations");
  std::string name(argv[1]);
  name.insert(name.find_last_of('.'), "_machine");
  std::FILE* const machine = std::fopen(name.c_str(), "w");
  if (machine == nullptr) return 2;
  std::fprintf(machine,
               "scene,composition,scalar,points,regions,empty_p50_us,empty_p99_us,empty_p999_us,empty_max_us,"
               "empty_over_budget,"
               "over_budget_beside_held_up_empty,own_p50_us,own_max_us,mean_force_N\n");
  Bench bench{.out = out, .machine = machine};
  std::printf("reading the clock takes %lld ns, taken off all times\n", static_cast<long long>(bench.clock));
  bench.all<SCALAR>();
  bench.back_to_back();
  bench.paced();
  std::fclose(machine);
  std::printf(
      "force budget, %s: %s, %d of %d rows over it (median or 99.9 %%); in %d more the machine was held up\n",
      scalar_name<SCALAR>, bench.offenders == 0 ? "PASS" : "OFFENDERS", bench.offenders, bench.rows,
      bench.held_up);
  std::printf("slowest position of all paths, %s, least of its rounds: %.3f us (budget %g): %s\n",
              scalar_name<SCALAR>, bench.slowest, us(budget), bench.slowest_row.c_str());
  return 0;
}
