// SPDX-License-Identifier: MIT
// The servo callback of examples/openhaptics.hpp on the stand-in device, stepped, with a plane spring for a
// solver.
#include <openhaptics.hpp>
#include <standin.hpp>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace {

using palpate::GateStatus;
using palpate::Mat3;
using palpate::Pose;
using palpate::Status;
using palpate::Vec3;
using palpate::Wrench;
using palpate::example::DeviceError;

/// Floor y < 0: F = stiffness times depth, and a torque about z to have one. Misbehaves on demand.
struct PlaneSpring {
  struct Result {
    Wrench<double> wrench;
    Status status = Status::ok;
    double depth = 0;
    palpate::FixedVector<palpate::ContactState<double>, 1> contacts{};
  };
  double stiffness = 300;  // [N/m]
  int axis = 1;            // up
  bool broken = false;
  int resets = 0;

  Result tick(const Pose<double>& pose, double) noexcept {
    Result r;
    if (!palpate::is_usable(pose)) {
      r.status = Status::invalid_pose;
      return r;
    }
    r.depth = -pose.translation[axis];
    if (r.depth > 0) {
      r.status = Status::contact;
      r.wrench.force[axis] = stiffness * r.depth;
      r.wrench.torque.z() = 2 * r.depth;
      const Vec3<double> up = Vec3<double>::Unit(axis);
      r.contacts.push_back({.id = 1,
                            .points = 1,
                            .mode = palpate::ContactMode::frictionless,
                            .centre = pose.translation,
                            .normal = up,
                            .displacement = -r.depth * up,
                            .force = r.wrench.force,
                            .friction = Vec3<double>::Zero(),
                            .normal_force = stiffness * r.depth,
                            .area = 0,
                            .depth = r.depth});
    }
    if (broken) r.wrench.force.x() = std::numeric_limits<double>::quiet_NaN();
    return r;
  }
  void reset() noexcept { ++resets; }
};

using Device = palpate::example::HapticDevice<PlaneSpring, standin::Clock>;

/// 20 mm above the floor for 1.5 s, then down to `depth` mm in 0.5 s, sliding in x, up again at 4 s.
struct Press {
  double depth = 8;  // 1.2 N
  static void script(double t, standin::Target& target, void* self) {
    const double depth = static_cast<Press*>(self)->depth;
    const double down = t < 1.5 ? 0 : t < 2 ? 2 * (t - 1.5) : t < 4 ? 1 : t < 4.5 ? 1 - 2 * (t - 4) : 0;
    target.position[0] = t < 2 ? 0 : 10 * (t - 2);
    target.position[1] = 20 - (20 + depth) * down;
  }
};

struct Fixture {
  PlaneSpring solver;
  Press press;
  std::unique_ptr<Device> device;

  explicit Fixture(const standin::Constants& constants = {}) {
    standin::reset(constants);
    standin::script(&Press::script, &press);
  }
  void start(Device::Params params = {}) {
    if (params.record == 0) params.record = 6000;
    device = std::make_unique<Device>(solver, params);
    device->start();
  }
  std::vector<DeviceError> errors() {
    std::vector<DeviceError> all;
    for (DeviceError e; device->next_error(e);) all.push_back(e);
    return all;
  }
  const Device::Record& step(int ticks) {
    standin::step(ticks);
    (void)device->fetch();
    return device->view();
  }
  GateStatus view_gate() const { return device->view().gate; }
  ~Fixture() {
    device.reset();
    standin::reset();
  }
};

std::string message_of(auto&& build) {
  try {
    build();
  } catch (const palpate::SetupError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE(
    "device, press and slide: armed in the air, force as the spring's, zero after; no errors, no heap") {
  Fixture f;
  f.start();
  CHECK(f.device->limits().max_force == 3.3);
  CHECK(f.device->limits().max_stiffness == 500);
  CHECK(std::string(f.device->limits().model) == "stand-in device");
  CHECK_FALSE(f.device->limits().has_torque);
  CHECK_RELATIVE(f.device->gate_params().max_force, 2.97, 1e-15);
  CHECK(f.device->gate_params().continuous_force == 0.88);
  const palpate::test::HeapCount heap;
  standin::step(5000);
  CHECK(heap.allocations() == 0);
  CHECK(f.device->running());
  f.device->stop();
  CHECK_FALSE(f.device->running());
  CHECK(f.errors().empty());
  CHECK(f.device->dropped_errors() == 0);
  REQUIRE(f.device->recorded() == 5000);

  double peak = 0;
  for (std::size_t i = 0; i < 5000; ++i) {
    const Device::Record& r = f.device->recording()[i];
    REQUIRE(r.tick == i + 1);
    REQUIRE(r.dt == 1e-3);
    const bool armed = has(r.gate, GateStatus::armed);
    // The first tick calibrates, the 500 steps of 1 ms after it arm; their sum may round up to one more.
    if (r.t < 0.4995) REQUIRE_FALSE(armed);
    if (r.t > 0.5015) REQUIRE(armed);
    // What the hold makes is taken off the last of the way out: below a tenth of the deepest 4 mm.
    if (r.result.depth > 4e-4) REQUIRE(r.passivity == 1);
    if (r.gate == GateStatus::armed && r.passivity == 1) REQUIRE(r.output.force == r.result.wrench.force);
    peak = (std::max)(peak, r.output.force.y());
  }
  // Hand 300 N/m at -8 mm against the floor's 300 N/m: 1.2 N, but for friction 0.1 N and the approach's
  // dynamics.
  CHECK_ABSOLUTE(peak, 1.2, 0.25);
  CHECK(f.device->recording()[4999].output.force == Vec3<double>::Zero());
  CHECK(f.device->statistics().ticks == 5000);
  CHECK(f.device->statistics().overruns == 0);
  CHECK(f.device->statistics().jitter.max() == 0);
  CHECK_RELATIVE(f.device->statistics().rate(), 1000, 1e-12);
}

TEST_CASE("device, two runs with jitter: the same bits") {
  std::vector<double> bits[2];
  for (auto& run : bits) {
    Fixture f;
    standin::jitter(3e-4, 99);
    f.start();
    standin::step(4000);
    f.device->stop();
    for (std::size_t i = 0; i < f.device->recorded(); ++i) {
      const Device::Record& r = f.device->recording()[i];
      for (int k = 0; k < 3; ++k) {
        run.push_back(r.pose.translation[k]);
        run.push_back(r.output.force[k]);
        run.push_back(r.output.torque[k]);
      }
      run.push_back(r.dt);
    }
  }
  REQUIRE(bits[0].size() == 40000);
  CHECK(std::memcmp(bits[0].data(), bits[1].data(), bits[0].size() * sizeof(double)) == 0);
}

TEST_CASE(
    "device, pressed far too hard for long: 0.9 of the peak, then the continuous force, motors stay cool") {
  Fixture f;
  f.solver.stiffness = 1500;
  standin::script([](double t, standin::Target& target, void*) {
    target.position[1] = t < 1.5 ? 10 : t < 2 ? 10 - 80 * (t - 1.5) : -30;
  });
  f.start();
  double peak = 0, motor = 0;
  for (int i = 0; i < 60000; ++i) {
    peak = (std::max)(peak, f.step(1).output.force.norm());
    motor = (std::max)(motor, std::fabs(standin::state().force[1]));
  }
  CHECK(peak <= 2.97);
  CHECK(peak > 2.9);
  CHECK(motor <= 2.97);
  CHECK_RELATIVE(standin::state().force[1], 0.88, 1e-2);  // 58 s of 10 s heat time: exp(-5.8)
  CHECK(standin::state().temperature[1] < 1);
  f.device->stop();
  CHECK(f.errors().empty());
}

TEST_CASE("device, 6-DOF: torque goes out in mN m, about the stylus; a 3-DOF device never gets one") {
  for (int dof : {3, 6}) {
    standin::Constants c;
    c.output_dof = dof;
    Fixture f(c);
    Device::Params params;
    params.chain.mapping.centre_of_mass = Vec3<double>(0.02, 0, 0);
    f.start(params);
    CHECK(f.device->limits().has_torque == (dof == 6));
    const Device::Record r = f.step(2500);  // a copy: the torque set in this tick acts after the next
    standin::step(1);
    const standin::State s = standin::state();
    REQUIRE(r.gate == GateStatus::armed);
    REQUIRE(r.result.depth > 0);
    // About the stylus point: 2 depth + lever 0.02 m times F_y.
    CHECK_RELATIVE(r.output.torque.z(), (dof == 6 ? 2 + 0.02 * 300 : 0) * r.result.depth, 1e-14);
    CHECK_RELATIVE(s.torque[2], 1e3 * r.output.torque.z(), 1e-15);
    CHECK(s.force[1] == r.output.force.y());
    f.device->stop();
    CHECK(f.errors().empty());
  }
}

TEST_CASE("device, started inside the object: no force until the hand has come out") {
  Fixture f;
  standin::script([](double t, standin::Target& target, void*) {
    target.position[1] = t < 2 ? -10 : t < 3 ? 10 : -10;
  });
  f.start();
  for (int i = 0; i < 2400; ++i) REQUIRE(f.step(1).output.force == Vec3<double>::Zero());
  CHECK(f.step(1000).output.force.y() > 0.5);
}

TEST_CASE("device, solver gives NaN: zero and disarmed in that tick; force again after free space") {
  Fixture f;
  f.start();
  CHECK(f.step(2500).output.force.y() > 0.9);
  f.solver.broken = true;
  const auto& r = f.step(1);
  CHECK(r.output.force == Vec3<double>::Zero());
  CHECK(has(r.gate, GateStatus::non_finite));
  f.solver.broken = false;
  for (int i = 0; i < 1000; ++i) REQUIRE(f.step(1).output.force == Vec3<double>::Zero());  // still pressed
  CHECK(has(f.view_gate(), GateStatus::in_contact));
  f.step(1500);  // lifted at 4.3 s
  CHECK(has(f.view_gate(), GateStatus::armed));
  CHECK(f.errors().empty());
}

TEST_CASE(
    "device, force errors: to the ring with their time, disarmed, contact state forgotten, loop goes on") {
  for (const HDerror code : std::vector<HDerror>{HD_EXCEEDED_MAX_FORCE_IMPULSE, HD_WARM_MOTORS,
                                                 HD_EXCEEDED_MAX_VELOCITY, HD_FORCE_ERROR}) {
    INFO(std::string(hdGetErrorString(code)));
    Fixture f;
    f.start();
    f.step(2500);
    const int resets = f.solver.resets;
    standin::inject(code);
    f.step(1);
    CHECK(f.solver.resets == resets + 1);
    CHECK(f.step(1).output.force == Vec3<double>::Zero());
    CHECK(has(f.view_gate(), GateStatus::disarmed));
    CHECK(f.device->running());
    const auto all = f.errors();
    REQUIRE(all.size() == 1);
    CHECK(all[0].info.errorCode == code);
    CHECK_ABSOLUTE(all[0].t, 2.5, 1e-9);
    f.step(3000);  // lifted, waited, ramped
    CHECK(f.view_gate() == GateStatus::armed);
  }
}

TEST_CASE("device, a flood of errors: 16 a tick, none lost up to the ring's 64, then counted") {
  Fixture f;
  f.start();
  f.step(10);
  for (int i = 0; i < 40; ++i) hdEnable(0x7777);
  f.step(1);
  CHECK(f.errors().size() == 16);
  f.step(2);
  CHECK(f.errors().size() == 24);
  for (int n = 0; n < 2; ++n) {
    for (int i = 0; i < 48; ++i) hdEnable(0x7777);
    f.step(4);
  }
  CHECK(f.errors().size() == 64);
  CHECK(f.device->dropped_errors() == 32);
  CHECK(f.step(1).output.force == Vec3<double>::Zero());
  CHECK(f.device->running());
}

TEST_CASE("device, fatal errors: the callback ends, force off, main sees it and closes in order") {
  for (const HDerror code : std::vector<HDerror>{HD_COMM_ERROR, HD_DEVICE_FAULT, HD_TIMER_ERROR}) {
    INFO(std::string(hdGetErrorString(code)));
    Fixture f;
    f.start();
    f.step(2500);
    CHECK(standin::state().force[1] > 0.5);
    standin::inject(code, -28);
    const std::uint64_t ticks = f.step(1).tick;
    CHECK_FALSE(f.device->running());
    CHECK(f.step(10).tick == ticks);
    CHECK(standin::state().force[1] == 0);
    f.device->stop();
    f.device->stop();  // again: nothing
    CHECK_FALSE(standin::state().scheduler_running);
    CHECK_FALSE(standin::state().device_open);
    bool seen = false;
    for (const DeviceError& e : f.errors()) {
      seen |= e.info.errorCode == code && e.info.internalErrorCode == -28;
      // The operation had ended by itself; to unschedule it is a complaint, not more.
      CHECK((e.info.errorCode == code || e.info.errorCode == HD_INVALID_OPERATION));
    }
    CHECK(seen);
    CHECK_FALSE(HD_DEVICE_ERROR(hdGetError()));
  }
}

TEST_CASE("device, refused rate: reported, not fatal; the statistics show what the device does") {
  for (bool timer : {false, true}) {
    Fixture f;
    if (timer) standin::refuse_rate(HD_TIMER_ERROR);
    f.start({.rate = 3000});
    f.step(3000);
    CHECK(f.device->running());
    const auto all = f.errors();
    REQUIRE(all.size() == 1);
    CHECK(all[0].info.errorCode == HDerror(timer ? HD_TIMER_ERROR : HD_INVALID_VALUE));
    CHECK(all[0].t < 0);
    f.device->stop();
    CHECK_RELATIVE(f.device->statistics().rate(), 1000, 1e-12);
  }
  Fixture f;
  f.start({.rate = 4000});
  f.step(4000);
  f.device->stop();
  CHECK(f.errors().empty());
  CHECK_RELATIVE(f.device->statistics().rate(), 4000, 1e-12);
}

TEST_CASE(
    "device, stall of the loop: the gap watchdog drops the force before the arm's jump becomes a kick") {
  Fixture f;
  f.start();
  f.step(2500);
  standin::stall(100);
  const auto& r = f.step(1);
  CHECK_ABSOLUTE(r.dt, 0.101, 1e-12);
  CHECK(has(r.gate, GateStatus::gap));
  CHECK(r.output.force == Vec3<double>::Zero());
  f.device->stop();
  CHECK(f.device->statistics().jitter.max() == 100000000);
}

TEST_CASE("device, calibration: no force before it is done; done in the servo loop; manual input waits") {
  standin::Constants c;
  c.calibration_offset[1] = -11;
  Fixture f(c);
  standin::calibration(HD_CALIBRATION_NEEDS_MANUAL_INPUT);
  f.start();
  CHECK_FALSE(f.step(2500).calibrated);
  CHECK(f.view_gate() == GateStatus::disarmed);
  standin::calibration(HD_CALIBRATION_NEEDS_UPDATE);
  CHECK(f.step(1000).calibrated);  // asked once a second
  CHECK(f.solver.resets > 0);
  CHECK_ABSOLUTE(f.device->view().pose.translation.y(), 1e-3 * standin::state().position[1],
                 0.0275e-3 + 1e-12);
  f.step(2000);
  CHECK(f.view_gate() == GateStatus::armed);
  f.device->stop();
  CHECK(f.errors().empty());
}

TEST_CASE("device, workspace: mm to m, axes, offset and scale; the force comes back in device axes") {
  Fixture f;
  f.solver.axis = 2;  // the scene's up is z
  f.solver.stiffness = 100;
  Device::Params params;
  params.chain.mapping.axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  params.chain.mapping.scale = 2;
  f.start(params);
  const auto& r = f.step(2500);
  const standin::State s = standin::state();
  for (int i = 0; i < 3; ++i)  // half an encoder step, scaled
    CHECK_ABSOLUTE(r.pose.translation[(i + 1) % 3], 2e-3 * s.position[i], 2 * 0.0275e-3 + 1e-12);
  CHECK_RELATIVE(r.output.force.y(), 100 * r.result.depth, 1e-14);
  CHECK(r.output.force.x() == 0);
  CHECK(r.output.force.z() == 0);
}

TEST_CASE("device, disarm() from main: at the next tick") {
  Fixture f;
  f.start();
  CHECK(f.step(2500).output.force.y() > 0.9);
  f.device->disarm();
  CHECK(f.step(1).output.force == Vec3<double>::Zero());
  CHECK(f.view_gate() == GateStatus::disarmed);
}

TEST_CASE("device, set-up: what is wrong is named, and nothing stays open") {
  PlaneSpring solver;
  standin::reset();
  const auto build = [&](const Device::Params& p) { return message_of([&] { Device d(solver, p); }); };
  standin::unplug(true);
  CHECK(build({}).find("hdInitDevice: HD_DEVICE_FAULT") != std::string::npos);
  standin::unplug(false);
  CHECK(build({.rate = 0}).find("rate [Hz] must be > 0, got 0") != std::string::npos);
  Device::Params p;
  p.chain.mapping.scale = -1;
  CHECK(build(p).find("mapping.scale must be > 0, got -1") != std::string::npos);
  p = {};
  p.chain.mapping.axes.setZero();
  CHECK(build(p).find("mapping.axes") != std::string::npos);
  p = {};
  p.chain.limits.ramp_time = -2;
  CHECK(build(p).find("ramp_time [s] must be finite and >= 0, got -2") != std::string::npos);
  CHECK_FALSE(standin::state().device_open);
  standin::Constants no_force;
  no_force.max_force = 0;
  standin::reset(no_force);
  CHECK(build({}).find("largest force") != std::string::npos);
  CHECK_FALSE(standin::state().device_open);
  standin::reset();
  {
    Device d(solver, {});
    CHECK(standin::state().device_open);
    CHECK_FALSE(standin::state().scheduler_running);
    d.start();
    CHECK(message_of([&] { d.start(); }).find("start() works once") != std::string::npos);
  }
  CHECK_FALSE(standin::state().device_open);
  CHECK_FALSE(standin::state().scheduler_running);
}

TEST_CASE("device, recording: the first ticks it has room for") {
  Fixture f;
  f.start({.record = 100});
  f.step(250);
  f.device->stop();
  CHECK(f.device->recorded() == 100);
  CHECK(f.device->recording()[99].tick == 100);
  CHECK(f.device->view().tick == 250);
}

// No figure here depends on how fast the machine is.
TEST_CASE("device, real time: main looks on while the servo thread runs; orderly end") {
  Fixture f;
  standin::real_time(true);
  f.start();
  std::uint64_t last = 0;
  bool forward = true;
  while (last < 300) {
    if (!f.device->fetch()) continue;
    forward &= f.device->view().tick > last;
    last = f.device->view().tick;
  }
  CHECK(forward);
  CHECK(f.device->running());
  f.device->stop();
  CHECK(f.device->statistics().ticks >= last);
  CHECK(f.device->statistics().tick_time.count() == f.device->statistics().ticks);
  CHECK(f.errors().empty());
  CHECK_FALSE(standin::state().device_open);
}
