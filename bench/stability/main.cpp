// SPDX-License-Identifier: MIT

/// @file Device, hand and solver in closed loop, simulated: a point on a flat object of stiffness K, with
/// friction; without the chain to the motors, with a passivity controller, with a virtual coupling. Rows:
/// what a hand gains, whether it buzzes at rest, and the stiffness felt. Then, for each device, the largest K
/// up to which nothing is gained and nothing buzzes, in a stiff hand and a loose one; and in how many of many
/// plays, also with ticks that are lost or late, the tool goes on vibrating. All of it is simulated time: the
/// same figures in every run. The tables of docs/stability.md are written beside the CSV file (.md).

#include "scenes.hpp"

#include <palpate/device/servo_chain.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/hand_scripts.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace {

using namespace bench;
using test::LoopDevice;
using test::Play;
using test::PlayFigures;
using V = Vec3<double>;

struct NamedDevice {
  const char* name;
  LoopDevice device;
  double nominal;  // stiffest wall by its maker or its users [N/m]
};
// Largest force: CHAI3D, src/devices/CPhantomDevices.cpp. Resolution: data sheets. Nominal stiffness: that of
// OpenHaptics (programmer's guide) for the Touch, CHAI3D's for the others. Mass and friction: assumed, after
// data sheets of which no copy was at hand. Viscous friction: assumed; little is known but that it is small.
constexpr double viscous = 0.005;  // N s/m
const std::array devices{
    NamedDevice{"Touch",
                {.mass = 0.045, .viscous = viscous, .coulomb = 0.26, .resolution = 5.5e-5, .max_force = 3.3},
                500},
    NamedDevice{"Touch X",
                {.mass = 0.045, .viscous = viscous, .coulomb = 0.06, .resolution = 2.3e-5, .max_force = 7.9},
                1000},
    NamedDevice{"Premium 1.5",
                {.mass = 0.075, .viscous = viscous, .coulomb = 0.04, .resolution = 3e-5, .max_force = 8.5},
                800}};

enum class Chain { none, passivity, coupling };
constexpr std::array chains{Chain::none, Chain::passivity, Chain::coupling};
constexpr const char* name_of(Chain chain) {
  return chain == Chain::none ? "none" : chain == Chain::passivity ? "passivity" : "coupling";
}

using Solver = ContactSolver<Box<double>, LinearForce<double>, CoulombFriction<double>>;
using Control = std::function<Wrench<double>(const Pose<double>&, double)>;

const test::PlayGround ground{.at = V(0.02, 0.05, 0.01)};

/// From poses to what is sent. The coupling is as stiff as the device's nominal wall.
Control control(Chain chain, double K, const NamedDevice& of, const LoopDevice& device) {
  const auto solver = std::make_shared<Solver>(
      Solver::Parts{.object = Box<double>({.half = V(0.1, 0.05, 0.1)}),
                    .tool = {},
                    .force = LinearForce<double>({.k = K}),
                    .friction = CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.4})});
  const auto through = [&](auto* chain_type, auto&& params) {
    using Made = std::remove_pointer_t<decltype(chain_type)>;
    typename Made::Params p{};
    p.device = test::model_of(device);
    params(p);
    const auto made = std::make_shared<Made>(*solver, p);
    return Control([solver, made](const Pose<double>& X, double dt) { return made->tick(X, dt).wrench; });
  };
  const auto limit = [&](auto& p) {
    p.limits = {.max_force = device.max_force, .arm_after = 0, .ramp_time = 0, .max_speed = 10};
  };
  using None = ServoChain<Solver, NoVirtualCoupling<double>, NoLimits<double>, NoPassivityControl<double>>;
  using Coupled = ServoChain<Solver, VirtualCoupling<double>, Gate<double>, NoPassivityControl<double>>;
  switch (chain) {
    case Chain::none:
      return through(static_cast<None*>(nullptr), [](auto&) {});
    case Chain::passivity:
      return through(static_cast<ServoChain<Solver>*>(nullptr), limit);
    case Chain::coupling:
      return through(static_cast<Coupled*>(nullptr), [&](auto& p) {
        limit(p);
        p.coupling = {.stiffness = of.nominal,
                      .rotational_stiffness = 1,
                      .contact_stiffness = K,
                      .contact_rotational_stiffness = 1};
      });
  }
  return {};
}

struct Case {
  Play play;
  double K, rate;
  int delay;
  double grip;
  auto operator<=>(const Case&) const = default;
};

constexpr double toss_speed = 0.3;  // m/s

/// `wait`: for so much longer at rest before it is looked at [s].
PlayFigures run(Chain chain, const Case& c, const NamedDevice& of, double wait = 0) {
  LoopDevice device = of.device;
  device.period = 1 / c.rate;
  device.delay = c.delay;
  return test::play(device, {}, {c.play, ground, c.grip, wait}, control(chain, c.K, of, device), toss_speed);
}
double felt(const PlayFigures& f, double K) {
  const double depth = (ground.at - f.position).dot(ground.normal);
  return depth > 0 ? f.sent.force.dot(ground.normal) / (K * depth) : 0;
}
/// Nothing gained beyond what quantised positions hide, and at rest within two encoder steps.
bool is_stable(const PlayFigures& f, const LoopDevice& device) {
  return f.made <= f.quantised && f.amplitude <= 2 * device.resolution;
}

/// The largest stiffness of the grid up to which all plays are stable, and the least that a press there
/// feels.
struct Width {
  double K = 0, felt = 0;
};
constexpr double softest = 50, stiffest = 20000;
Width widest(Chain chain, double rate, int delay, const NamedDevice& of, bool quick) {
  Width width;
  constexpr int steps = 13;  // a factor of 1.59
  for (int i = 0; i <= steps; ++i) {
    const double K = softest * std::pow(stiffest / softest, double(i) / steps);
    double least = 9;
    for (const double grip : {0.5, 0.1})  // 3 N, less than any of the devices gives, and 0.6 N
      for (const Play play : {Play::press, Play::tap, Play::toss}) {
        if (quick && play == Play::tap) continue;
        const PlayFigures f = run(chain, {play, K, rate, delay, grip}, of);
        if (!is_stable(f, of.device)) return width;
        if (play == Play::press) least = (std::min)(least, felt(f, K));
      }
    width = {K, least};
  }
  return width;
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(argc, argv,
                   "table,device,chain,play,K,rate_hz,delay_ticks,grip,made_mJ,quantised_mJ,to_hand_mJ,"
                   "amplitude_steps,felt");
  std::string md = std::string(argv[1]);
  md = md.substr(0, md.rfind('.')) + ".md";
  std::FILE* const table = std::fopen(md.c_str(), "w");
  if (table == nullptr) return std::fprintf(stderr, "cannot write %s\n", md.c_str()), 2;

  // ---- plays, on the Touch X
  const NamedDevice& of = devices[1];
  const std::vector<double> stiffnesses =
      out.quick ? std::vector{500.0, 4000.0} : std::vector{500.0, 1000.0, 2000.0, 4000.0, 10000.0};
  const std::vector<double> rates = out.quick ? std::vector{1000.0} : std::vector{1000.0, 4000.0};
  const std::vector<int> delays = out.quick ? std::vector{1} : std::vector{0, 1, 2};
  const std::vector<double> grips = out.quick ? std::vector{0.3} : std::vector{1.0, 0.3};
  std::map<std::tuple<Case, Chain>, PlayFigures> all;
  for (const Play play : {Play::tap, Play::press, Play::slide, Play::let_go, Play::toss})
    for (const double K : stiffnesses)
      for (const double rate : rates)
        for (const int delay : delays)
          for (const double grip : grips)
            for (const Chain chain : chains) {
              const Case c{play, K, rate, delay, grip};
              const PlayFigures f = run(chain, c, of);
              all[{c, chain}] = f;
              char row[256];
              std::snprintf(row, sizeof row, "play,%s,%s,%s,%g,%g,%d,%g,%.4g,%.4g,%.4g,%.2f,%.3f", of.name,
                            name_of(chain), test::times_of(play).name, K, rate, delay, grip, 1e3 * f.made,
                            1e3 * f.quantised, 1e3 * f.to_hand, f.amplitude / of.device.resolution,
                            play == Play::press ? felt(f, K) : 0.0);
              out.row(row, "deepest_mm", 1e3 * f.deepest);
              if (chain == Chain::passivity) {
                char what[128];
                std::snprintf(what, sizeof what, "%s K %g rate %g delay %d grip %g: given to the hand [mJ]",
                              test::times_of(play).name, K, rate, delay, grip);
                out.require_below(what, 1e3 * f.to_hand, 1e3 * f.quantised);
              }
            }

  std::fprintf(table, "Worst over %zu rates, %zu delays and %zu grips, %s:\n\n", rates.size(), delays.size(),
               grips.size(), of.name);
  std::fprintf(table,
               "| hand | K [N/m] | made in a touch [mJ]: none | passivity | coupling | at rest [steps]: none "
               "| passivity | coupling |\n"
               "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Play play : {Play::tap, Play::press, Play::slide, Play::let_go, Play::toss})
    for (const double K : stiffnesses) {
      std::fprintf(table, "| %s | %g |", test::times_of(play).name, K);
      double made[3]{}, steps[3]{};
      for (const auto& [key, f] : all) {
        const auto& [c, chain] = key;
        if (c.play != play || c.K != K) continue;
        made[int(chain)] = (std::max)(made[int(chain)], 1e3 * f.made);
        steps[int(chain)] = (std::max)(steps[int(chain)], f.amplitude / of.device.resolution);
      }
      for (const double m : made) std::fprintf(table, " %.2g |", m);
      for (const double s : steps) {
        if (test::times_of(play).rest_to > 0)
          std::fprintf(table, s < 10 ? " %.1f |" : " %.0f |", s);
        else
          std::fprintf(table, " |");
      }
      std::fprintf(table, "\n");
    }
  std::fprintf(table,
               "\nStiffness felt in a press over the scene's, least and most over delays and grips, where "
               "nothing buzzes:\n\n"
               "| K [N/m] | rate [Hz] | none | passivity | coupling |\n| --- | --- | --- | --- | --- |\n");
  for (const double K : stiffnesses)
    for (const double rate : rates) {
      std::fprintf(table, "| %g | %g |", K, rate);
      for (const Chain chain : chains) {
        double least = 9, most = 0;
        int buzzing = 0, runs = 0;
        for (const auto& [key, f] : all) {
          const auto& [c, with] = key;
          if (c.play != Play::press || c.K != K || c.rate != rate || with != chain) continue;
          ++runs;
          if (f.amplitude > 2 * of.device.resolution) {
            ++buzzing;
          } else {
            least = (std::min)(least, felt(f, K)), most = (std::max)(most, felt(f, K));
          }
        }
        if (buzzing < runs) std::fprintf(table, " %.2f to %.2f", least, most);
        if (buzzing > 0) std::fprintf(table, "%s%d of %d buzz", buzzing < runs ? ", " : " ", buzzing, runs);
        std::fprintf(table, " |");
      }
      std::fprintf(table, "\n");
    }

  // ---- Z-width
  std::fprintf(table,
               "\nLargest K [N/m] without buzz and gain, and the least that a press feels of it [N/m], delay "
               "of one tick:\n\n"
               "| device | rate [Hz] | none | felt | passivity | felt | coupling | felt |\n"
               "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const NamedDevice& device : devices) {
    if (out.quick && &device != &of) continue;
    for (const double rate : rates) {
      std::fprintf(table, "| %s | %g |", device.name, rate);
      for (const Chain chain : chains) {
        const Width w = widest(chain, rate, 1, device, out.quick);
        char row[128];
        std::snprintf(row, sizeof row, "z_width,%s,%s,,%.0f,%g,1,,,,,,%.3f", device.name, name_of(chain), w.K,
                      rate, w.felt);
        out.row(row, "felt_N_m", w.felt * w.K);
        std::fprintf(table, w.K < stiffest ? " %.0f | %.0f |" : " > %.0f | %.0f |", w.K, w.felt * w.K);
      }
      std::fprintf(table, "\n");
    }
  }

  // ---- who goes on vibrating
  struct Ticks {
    const char* name;
    double rate, jitter, lost;
  };
  const std::vector<Ticks> ticks = out.quick ? std::vector<Ticks>{{"even", 1000, 0, 0}}
                                             : std::vector<Ticks>{{"even", 500, 0, 0},
                                                                  {"even", 1000, 0, 0},
                                                                  {"even", 4000, 0, 0},
                                                                  {"30 % jitter", 1000, 0.3, 0},
                                                                  {"5 % lost", 1000, 0, 0.05}};
  const std::array arms{NamedDevice{"0.3 N s/m and 0.1 N", {.max_force = 8.5}, 0},
                        NamedDevice{"0.04 N alone", {.viscous = 0, .coulomb = 0.04, .max_force = 8.5}, 0},
                        of};
  std::fprintf(
      table,
      "\nRows of stiffness (1,000 to 10,000 N/m) and delay in which a press or a slide ends vibrating, "
      "in grips of 1, 0.3, 0.1:\n\n"
      "| arm | ticks | rate [Hz] | rows | none | passivity | 3 s later | felt, mean |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  struct Setting {
    Chain chain;
    double wait;
  };
  constexpr std::array settings{Setting{Chain::none, 0}, Setting{Chain::passivity, 0},
                                Setting{Chain::passivity, 3}};
  for (const NamedDevice& arm : arms)
    for (const Ticks& t : ticks) {
      int rows = 0, vibrating[settings.size()]{}, presses = 0;
      double sum = 0;
      for (const double K : {1000.0, 2500.0, 4000.0, 5200.0, 10000.0})
        for (const int delay : delays) {
          ++rows;
          for (std::size_t s = 0; s < settings.size(); ++s) {
            const auto [chain, wait] = settings[s];
            int most = 0;
            for (const Play play : {Play::press, Play::slide})
              for (const double grip : {1.0, 0.3, 0.1})
                for (std::uint64_t seed = 1; seed <= (t.jitter + t.lost > 0 ? 3 : 1); ++seed) {
                  NamedDevice device = arm;
                  device.device.jitter = t.jitter, device.device.lost = t.lost, device.device.seed = seed;
                  const PlayFigures f = run(chain, {play, K, t.rate, delay, grip}, device, wait);
                  most = (std::max)(most, f.turns);
                  if (chain == Chain::passivity && wait == 0 && play == Play::press)
                    sum += felt(f, K), ++presses;
                }
            vibrating[s] += most >= test::vibrates_from;
          }
        }
      std::fprintf(table, "| %s | %s | %g | %d | %d | %d | %d | %.2f |\n", arm.name, t.name, t.rate, rows,
                   vibrating[0], vibrating[1], vibrating[2], sum / presses);
      char row[160];
      std::snprintf(row, sizeof row, "vibrates,%s,%s,%s,,%g,,,,,,,%.3f", arm.name, name_of(Chain::passivity),
                    t.name, t.rate, sum / presses);
      out.row(row, "rows", vibrating[1]);
      out.row(row, "rows_later", vibrating[2]);
    }
  std::fclose(table);
  return out.failures > 0;
}
