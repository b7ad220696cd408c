// SPDX-License-Identifier: MIT

#include "session.hpp"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

namespace touch {

namespace {

void write_csv(const std::string& file, const Device& device) {
  std::ofstream csv(file);
  csv << "t_s,x_m,y_m,z_m,F_x_N,F_y_N,F_z_N,f_x_N,f_y_N,f_z_N,out_x_N,out_y_N,out_z_N,regions,state\n";
  for (std::size_t i = 0; i < device.recorded(); ++i) {
    const auto& r = device.recording()[i];
    const auto put = [&](const V& v) { csv << ',' << v.x() << ',' << v.y() << ',' << v.z(); };
    csv << r.t;
    put(r.pose.translation);
    put(r.result.normal);
    put(r.result.friction);
    put(r.output.force);
    csv << ',' << r.result.regions << ','
        << (r.result.regions == 0 ? "free"
            : r.result.sliding    ? "slip"
                                  : "stick")
        << '\n';
  }
  std::printf("wrote          %s\n", file.c_str());
}

void print_summary(const Device& device) {
  const auto& s = device.statistics();
  double peak = 0;
  std::size_t contact = 0, sliding = 0, gaps = 0, held = 0, softened = 0;
  for (std::size_t i = 0; i < device.recorded(); ++i) {
    const auto& felt = device.recording()[i].result;
    peak = (std::max)(peak, felt.wrench.force.norm());
    contact += felt.regions > 0;
    sliding += felt.sliding;
    held += has(felt.status, palpate::Status::held_back);
    softened += device.recording()[i].passivity < 1;
    gaps += has(device.recording()[i].gate, palpate::GateStatus::gap);
  }
  const auto us = [&](double q) { return 1e-3 * static_cast<double>(s.tick_time.quantile(q)); };
  const double share = contact > 0 ? 100.0 * static_cast<double>(sliding) / static_cast<double>(contact) : 0;
  std::printf("rate reached   %.0f Hz over %.2f s, %llu ticks\n", s.rate(),
              1e-9 * static_cast<double>(s.span), static_cast<unsigned long long>(s.ticks));
  if (s.tick_time.max() == 0)
    std::printf("tick time      none in simulated time: leave out --stepped to measure it\n");
  else
    std::printf(
        "tick time      p50 %.2f us, p99 %.2f us, p99.9 %.2f us, max %.2f us (callback, with the device's "
        "calls)\n",
        us(0.5), us(0.99), us(0.999), 1e-3 * static_cast<double>(s.tick_time.max()));
  std::printf("overruns       %llu\n", static_cast<unsigned long long>(s.overruns));
  if (gaps > 0) {
    std::printf(
        "gaps           %zu: the loop stood still for over %.0f ms and forces were switched off (use "
        "--stepped on a "
        "busy machine)\n",
        gaps, 1e3 * device.gate_params().max_gap);
  }
  std::printf("peak force     %.2f N\n", peak);
  std::printf("in contact     %zu ticks: %.0f %% stick, %.0f %% slip\n", contact, 100 - share, share);
  if (softened > 0) std::printf("softened       %zu ticks, by the passivity controller\n", softened);
  if (held > 0) std::printf("held back      %zu ticks\n", held);
}

}  // namespace

int perform(const Options& options, Feel& feel, const Tool& tool, const Script& script, const V& top,
            const std::string& title, const std::function<void(const Device::Record&)>& update,
            const std::function<void(const Device&)>& finish) {
  Device::Params params;
  params.rate = static_cast<unsigned long>(options.rate);
  params.chain.mapping.offset = top;
  params.chain.mapping.centre_of_mass = tool.centre_of_mass;
  params.chain.stiffness = feel.stiffness_below(top, 0.1, 3);
  params.record = params.history = static_cast<std::size_t>(1.2 * script.seconds * options.rate);

#ifdef PALPATE_STANDIN
  standin::Constants arm;  // the size of a large desktop arm
  arm.max_force = 8.5;
  arm.continuous_force = 1.4;
  for (int i = 0; i < 3; ++i) arm.workspace[i] = -120, arm.workspace[3 + i] = 120;
  arm.output_dof = 6;
  arm.resolution = 0.03;
  params.chain.device = {.mass = arm.mass,
                         .damping = arm.viscous,
                         .friction = arm.coulomb,
                         .resolution = 1e-3 * arm.resolution,
                         .delay = 1};
  standin::reset(arm);
  standin::real_time(!options.stepped);
  struct Hand {
    const Script& script;
    V offset;
  } hand{script, top};
  standin::script(
      [](double t, standin::Target& target, void* user) {
        const Hand& h = *static_cast<Hand*>(user);
        const V x = 1e3 * (h.script.target(t) - h.offset);
        for (int i = 0; i < 3; ++i) target.position[i] = x[i];
        if (!h.script.turn) return;
        const palpate::Mat3<S> turn = h.script.turn(t);
        for (int i = 0; i < 9; ++i) target.rotation[i] = turn(i % 3, i / 3);
      },
      &hand);
#endif

  Device device(feel, params);
  std::printf("%s, tool of %zu points, device \"%s\", %s, %.1f s\n", title.c_str(), feel.tool_points(),
              device.limits().model, options.stepped ? "stepped" : "real time", script.seconds);
  const auto stability = device.stability();
  std::printf(
      "stiffness      %.0f N/m at 3 N; passive for any hand below %.0f, device's own figure %.0f. %s\n",
      stability.stiffness, (std::min)(stability.passive, stability.quantised), stability.nominal,
      stability.advice());
  device.start();
  const bool terminal = is_terminal();
  for (double seconds = 0; seconds < script.seconds && device.running();) {
    if (options.stepped) {
#ifdef PALPATE_STANDIN
      standin::step(static_cast<int>(options.rate / update_rate));
#endif
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(static_cast<int>(1000 / update_rate)));
    }
    if (device.fetch()) {
      const auto& now = device.view();
      seconds = now.t;
      update(now);
      if (terminal) {
        std::printf("\r%5.2f s  F %6.2f N  regions %u  %-5s ", now.t, now.output.force.norm(),
                    now.result.regions,
                    now.result.regions == 0 ? "free"
                    : now.result.sliding    ? "slip"
                                            : "stick");
        std::fflush(stdout);
      }
    }
    palpate::example::DeviceError error;
    while (device.next_error(error))
      std::fprintf(stderr, "\ndevice: %s at %.3f s\n", hdGetErrorString(error.info.errorCode), error.t);
  }
  device.stop();
  if (terminal) std::printf("\n");
  print_summary(device);
  write_csv(options.out + "/forces.csv", device);
  const std::string scene = options.scene.empty() ? "" : "--scene " + options.scene;
  palpate::save_ticks(device.history(), options.out + "/ticks.txt", options.given + scene);
  std::printf("wrote          %s/ticks.txt, which examples/replay plays again\n", options.out.c_str());
  finish(device);
  return 0;
}

}  // namespace touch
