// SPDX-License-Identifier: MIT
#include "standin.hpp"

#include <HDU/hduError.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>

#if defined(__linux__)
#include <pthread.h>
#include <sched.h>
#include <time.h>
#endif

namespace standin {
namespace {

using Vector = std::array<double, 3>;

double norm(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }
Vector scaled(const Vector& v, double factor) { return {v[0] * factor, v[1] * factor, v[2] * factor}; }
bool finite(const Vector& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }
/// v, scaled to the length `limit` where it is longer.
Vector bounded(const Vector& v, double limit) {
  const double length = norm(v);
  return length > limit ? scaled(v, limit / length) : v;
}

struct Operation {
  HDSchedulerHandle handle = 0;
  HDSchedulerCallback callback = nullptr;
  void* data = nullptr;
  HDushort priority = 0;
};

/// What one frame sees.
struct Snapshot {
  Vector position{};  // [mm], quantised
  Vector velocity{};  // [mm/s], smoothed
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
  Vector force{};   // commanded [N]
  Vector torque{};  // commanded [mN m]
  int buttons = 0;
};

constexpr HHD the_device = 0;
constexpr std::size_t max_operations = 32, max_errors = 64;
constexpr HDenum capabilities[] = {
    HD_FORCE_OUTPUT,         HD_MAX_FORCE_CLAMPING,      HD_FORCE_RAMPING,
    HD_SOFTWARE_FORCE_LIMIT, HD_SOFTWARE_VELOCITY_LIMIT, HD_SOFTWARE_FORCE_IMPULSE_LIMIT,
    HD_ONE_FRAME_LIMIT};
constexpr std::size_t capability_count = sizeof capabilities / sizeof capabilities[0];

/// Uniform in [0, 1), by splitmix64. A constant initialises it, unlike the engines of <random>.
struct Uniform {
  std::uint64_t state = 0;
  double operator()() {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
};

/// Everything but the locks and the thread; reset() assigns a fresh one.
struct World {
  Constants constants;
  Script script = nullptr;
  void* user = nullptr;

  // scheduler
  bool real_time = false, running = false, in_round = false;
  std::int64_t period = 1000000, now = 0, last_elapsed = 1000000;  // [ns]
  std::uint64_t ticks = 0;
  std::chrono::steady_clock::time_point tick_start{};
  std::array<Operation, max_operations> operations{};  // by priority, then by age
  std::size_t operation_count = 0;
  HDSchedulerHandle next_handle = 1;

  // errors, newest last; a ring
  std::array<HDErrorInfo, max_errors> errors{};
  std::size_t error_top = 0, error_count = 0;

  // device
  bool open = false, in_frame = false, frame_lost = false, framed_this_tick = false, calibrated = false;
  std::array<bool, capability_count> enabled{false, false, true, true, true, true, true};
  double velocity_limit = constants.velocity_limit, impulse_limit = constants.impulse_limit,
         ramping_rate = constants.ramping_rate;
  Snapshot seen, last_seen;
  HDenum calibration_status = HD_CALIBRATION_OK;

  // arm and hand, SI but for names in mm
  Vector x{}, v{};  // tip [m], [m/s]
  Target target;
  Vector hand{}, hand_before{};              // target [m]
  Vector measured{}, smoothed{};             // [mm], [mm/s]
  Vector pending{}, active{};                // force set in the last frame; force at the motors now [N]
  Vector pending_torque{}, active_torque{};  // [mN m]
  Vector hand_force{}, temperature{};
  double ramp = 0;  // largest force the amplifiers give now [N]
  Vector previous_command{};

  // faults
  int stall = 0, inject_frames = 0, inject_internal = 0;
  HDerror inject_code = HD_SUCCESS, refuse_rate = HD_SUCCESS;
  double jitter = 0;
  Uniform random;
  bool unplugged = false;

  void error(HDerror code, int internal = 0) {
    errors[error_top] = HDErrorInfo{code, internal, open ? the_device : HHD{HD_INVALID_HANDLE}};
    error_top = (error_top + 1) % max_errors;
    error_count = (std::min)(error_count + 1, max_errors);
  }
  bool is_enabled(HDenum cap) const {
    for (std::size_t i = 0; i < capability_count; ++i)
      if (capabilities[i] == cap) return enabled[i];
    return false;
  }
  bool usable(HHD device = the_device) {
    if (open && device == the_device) return true;
    error(HD_BAD_HANDLE);
    return false;
  }
  /// The amplifiers drop out; the ramp starts again.
  void drop(HDerror code) {
    error(code);
    pending = pending_torque = Vector{};
    active = active_torque = Vector{};
    ramp = 0;
  }

  void measure(double elapsed);
  void advance(double elapsed);
  void commit();
  void begin_frame();
};

constinit World world;  // so that another file's static initialiser may script the hand (press.cpp)
std::mutex guard;       // of `world`; not held while callbacks and scripts run
std::condition_variable round_over;  // a tick has ended
thread_local bool in_servo = false;  // this thread runs callbacks

struct Servo {
  std::thread thread;
  ~Servo() {
    {
      const std::lock_guard lock(guard);
      world.running = false;
    }
    if (thread.joinable()) thread.join();
  }
} servo;

void World::measure(double elapsed) {
  const double blend = elapsed > 0 ? 1 - std::exp(-elapsed / constants.velocity_time) : 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double step = constants.resolution;
    const double reading = step > 0 ? std::round(1e3 * x[i] / step) * step : 1e3 * x[i];
    if (elapsed > 0) smoothed[i] += ((reading - measured[i]) / elapsed - smoothed[i]) * blend;
    measured[i] = reading;
  }
}

// m a = F_motor + F_hand - b v - f_c v/|v|, semi-implicit Euler; friction last and never past rest, so that
// the arm can stick.
void World::advance(double elapsed) {
  const int count = (std::clamp)(static_cast<int>(std::ceil(elapsed / 1e-4)), 1, 20000);
  const double h = elapsed / count;
  const Vector hand_velocity =
      scaled({hand[0] - hand_before[0], hand[1] - hand_before[1], hand[2] - hand_before[2]}, 1 / elapsed);
  for (int k = 1; k <= count; ++k) {
    const double part = static_cast<double>(k) / count;
    for (std::size_t i = 0; i < 3; ++i) {
      const double goal = hand_before[i] + part * (hand[i] - hand_before[i]);
      hand_force[i] = target.grip * (constants.hand_stiffness * (goal - x[i]) +
                                     constants.hand_damping * (hand_velocity[i] - v[i]));
      v[i] += h / constants.mass * (active[i] + hand_force[i] - constants.viscous * v[i]);
    }
    const double speed = norm(v), loss = h * constants.coulomb / constants.mass;
    v = speed > loss ? scaled(v, 1 - loss / speed) : Vector{};
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] += h * v[i];
      const double low = 1.5e-3 * constants.workspace[i], high = 1.5e-3 * constants.workspace[i + 3];
      if (x[i] < low || x[i] > high) {
        x[i] = (std::clamp)(x[i], low, high);
        v[i] = 0;
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double load = active[i] / constants.continuous_force;
    temperature[i] += (0.8 * load * load - temperature[i]) * (1 - std::exp(-elapsed / constants.heat_time));
  }
  ramp += ramping_rate * elapsed;
  measure(elapsed);
  active = pending;
  active_torque = pending_torque;
}

void World::begin_frame() {
  frame_lost = false;
  if (inject_frames > 0) {
    --inject_frames;
    error(inject_code, inject_internal);
    frame_lost = inject_code == HD_COMM_ERROR || inject_code == HD_DEVICE_FAULT;
  }
  last_seen = seen;
  if (!frame_lost) {
    seen.position = measured;
    if (!calibrated)
      for (std::size_t i = 0; i < 3; ++i) seen.position[i] += constants.calibration_offset[i];
    seen.velocity = smoothed;
    std::copy(target.rotation, target.rotation + 9, seen.rotation.begin());
    seen.buttons = target.buttons;
  }
  seen.force = seen.torque = Vector{};
}

// From the frame's command to what the amplifiers will give.
void World::commit() {
  Vector force = seen.force, torque = seen.torque;
  const Vector before = previous_command;
  previous_command = finite(force) ? force : Vector{};
  if (frame_lost) force = torque = Vector{};
  if (!finite(force) || !finite(torque)) return drop(HD_FORCE_ERROR);
  if (!is_enabled(HD_FORCE_OUTPUT)) force = torque = Vector{};

  if (is_enabled(HD_SOFTWARE_FORCE_IMPULSE_LIMIT) && running) {
    const double jump = norm({force[0] - before[0], force[1] - before[1], force[2] - before[2]});
    if (jump > impulse_limit * 1e-6 * static_cast<double>(period)) return drop(HD_EXCEEDED_MAX_FORCE_IMPULSE);
  }
  if (!is_enabled(HD_MAX_FORCE_CLAMPING) && is_enabled(HD_SOFTWARE_FORCE_LIMIT) &&
      norm(force) > constants.max_force)
    return drop(HD_EXCEEDED_MAX_FORCE);
  if (is_enabled(HD_SOFTWARE_VELOCITY_LIMIT) && norm(seen.velocity) > velocity_limit)
    return drop(HD_EXCEEDED_MAX_VELOCITY);
  if (*std::max_element(temperature.begin(), temperature.end()) >= 1) return drop(HD_WARM_MOTORS);

  double limit = constants.max_force;
  if (is_enabled(HD_FORCE_RAMPING)) limit = (std::min)(limit, ramp);
  pending = bounded(force, limit);
  pending_torque = constants.output_dof >= 6 ? bounded(torque, constants.max_torque) : Vector{};
}

/// One tick of the scheduler, `elapsed` ns after the last.
void run_tick(std::int64_t elapsed) {
  Script script_function = nullptr;
  void* user = nullptr;
  double t = 0;
  Target target;
  {
    const std::lock_guard lock(guard);
    world.in_round = true;
    ++world.ticks;
    world.now += elapsed;
    world.last_elapsed = elapsed;
    script_function = world.script;
    user = world.user;
    t = 1e-9 * static_cast<double>(world.now);
    target = world.target;
  }
  if (script_function != nullptr) script_function(t, target, user);

  std::array<Operation, max_operations> round;
  std::size_t count = 0;
  {
    const std::lock_guard lock(guard);
    world.target = target;
    world.hand_before = world.hand;
    world.hand = {1e-3 * target.position[0], 1e-3 * target.position[1], 1e-3 * target.position[2]};
    world.advance(1e-9 * static_cast<double>(elapsed));
    world.framed_this_tick = false;
    world.tick_start = std::chrono::steady_clock::now();
    round = world.operations;
    count = world.operation_count;
  }
  const auto find = [](HDSchedulerHandle handle) {
    const auto end = world.operations.begin() + static_cast<std::ptrdiff_t>(world.operation_count);
    return std::find_if(world.operations.begin(), end,
                        [&](const Operation& o) { return o.handle == handle; });
  };
  in_servo = true;
  for (std::size_t i = 0; i < count; ++i) {
    {
      const std::lock_guard lock(guard);  // a callback before this one may have unscheduled it
      if (find(round[i].handle) ==
          world.operations.begin() + static_cast<std::ptrdiff_t>(world.operation_count))
        continue;
    }
    if (round[i].callback(round[i].data) != HD_CALLBACK_DONE) continue;
    const std::lock_guard lock(guard);
    const auto end = world.operations.begin() + static_cast<std::ptrdiff_t>(world.operation_count);
    const auto at = find(round[i].handle);
    if (at != end) {
      std::move(at + 1, end, at);
      --world.operation_count;
    }
  }
  in_servo = false;
  const std::lock_guard lock(guard);
  world.in_round = false;
  round_over.notify_all();
}

/// How long until the next tick [ns], with the faults asked for.
std::int64_t next_wait() {
  const std::lock_guard lock(guard);
  std::int64_t wait = world.period * (1 + world.stall);
  world.stall = 0;
  if (world.jitter > 0) wait += std::llround(1e9 * world.jitter * world.random());
  return wait;
}

void sleep_until(std::chrono::steady_clock::time_point t) {
#if defined(__linux__)
  const std::int64_t ns = std::chrono::duration_cast<std::chrono::nanoseconds>(t.time_since_epoch()).count();
  timespec at{};
  at.tv_sec = static_cast<time_t>(ns / 1000000000);
  at.tv_nsec = static_cast<long>(ns % 1000000000);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {
  }
#else
  std::this_thread::sleep_until(t);
#endif
}

void real_time_loop() {
#if defined(__linux__)
  const sched_param priority{80};  // above everything ordinary; where that is not allowed, as it is
  (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
#endif
  auto last = std::chrono::steady_clock::now(), next = last;
  for (;;) {
    next += std::chrono::nanoseconds(next_wait());
    // Ticks that were missed are lost, as with the device: the loop does not run faster to catch up.
    next = (std::max)(next, std::chrono::steady_clock::now());
    sleep_until(next);
    {
      const std::lock_guard lock(guard);
      if (!world.running) return;
    }
    const auto now = std::chrono::steady_clock::now();
    run_tick((std::max)(std::int64_t{1}, std::int64_t{std::chrono::nanoseconds(now - last).count()}));
    last = now;
  }
}

void stop_scheduler() {
  {
    const std::lock_guard lock(guard);
    world.running = false;
    world.active = world.pending = world.previous_command = Vector{};
    world.active_torque = world.pending_torque = Vector{};
    round_over.notify_all();
  }
  if (servo.thread.joinable()) servo.thread.join();
}

bool is_scheduled(HDSchedulerHandle handle) {  // guard held
  for (std::size_t i = 0; i < world.operation_count; ++i)
    if (world.operations[i].handle == handle) return true;
  return false;
}

/// Schedules; 0 when there is no room. Guard held.
HDSchedulerHandle schedule(HDSchedulerCallback callback, void* data, HDushort priority) {
  if (world.operation_count == max_operations) {
    world.error(HD_SCHEDULER_FULL);
    return 0;
  }
  const auto end = world.operations.begin() + static_cast<std::ptrdiff_t>(world.operation_count);
  const auto at =
      std::find_if(world.operations.begin(), end, [&](const Operation& o) { return o.priority < priority; });
  std::move_backward(at, end, end + 1);
  const HDSchedulerHandle handle = world.next_handle++;
  *at = Operation{handle, callback, data, priority};
  ++world.operation_count;
  return handle;
}

void wait_for(HDSchedulerHandle handle) {
  std::unique_lock lock(guard);
  if (world.real_time) {
    round_over.wait(lock, [&] { return !world.running || !is_scheduled(handle); });
    return;
  }
  while (world.running && is_scheduled(handle)) {
    lock.unlock();
    step();
    lock.lock();
  }
}

// ---- parameters

enum : unsigned { reals = 1, integers = 2, booleans = 4 };
struct Value {
  unsigned types = 0;  // 0: no such parameter
  int count = 0;
  double v[16] = {};
};

Value value(unsigned types, double v) { return Value{types, 1, {v}}; }
Value value(const Vector& v) { return Value{reals, 3, {v[0], v[1], v[2]}}; }
Value transform(const Snapshot& s) {
  Value out{reals, 16, {}};
  for (std::size_t column = 0; column < 3; ++column)
    for (std::size_t row = 0; row < 3; ++row) out.v[4 * column + row] = s.rotation[3 * column + row];
  for (std::size_t i = 0; i < 3; ++i) out.v[12 + i] = s.position[i];
  out.v[15] = 1;
  return out;
}
Value workspace(double factor) {
  Value out{reals, 6, {}};
  for (std::size_t i = 0; i < 6; ++i) out.v[i] = factor * world.constants.workspace[i];
  return out;
}

Value get(HDenum name) {  // guard held
  const Constants& c = world.constants;
  switch (name) {
    case HD_CURRENT_BUTTONS:
      return value(integers, world.seen.buttons);
    case HD_CURRENT_SAFETY_SWITCH:
      return value(booleans, world.target.grip > 0 ? 1 : 0);
    case HD_CURRENT_INKWELL_SWITCH:
      return value(booleans, 1);
    case HD_CURRENT_POSITION:
      return value(world.seen.position);
    case HD_CURRENT_VELOCITY:
      return value(world.seen.velocity);
    case HD_CURRENT_TRANSFORM:
      return transform(world.seen);
    case HD_LAST_POSITION:
      return value(world.last_seen.position);
    case HD_LAST_VELOCITY:
      return value(world.last_seen.velocity);
    case HD_LAST_TRANSFORM:
      return transform(world.last_seen);
    case HD_CURRENT_FORCE:
      return value(world.seen.force);
    case HD_CURRENT_TORQUE:
      return value(world.seen.torque);
    case HD_LAST_FORCE:
      return value(world.last_seen.force);
    case HD_LAST_TORQUE:
      return value(world.last_seen.torque);
    case HD_MAX_WORKSPACE_DIMENSIONS:
      return workspace(1.5);
    case HD_USABLE_WORKSPACE_DIMENSIONS:
      return workspace(1);
    case HD_INPUT_DOF:
      return value(integers, c.input_dof);
    case HD_OUTPUT_DOF:
      return value(integers, c.output_dof);
    case HD_CALIBRATION_STYLE:
      return value(integers, c.calibration_style);
    case HD_UPDATE_RATE:
      return value(integers | reals, std::round(1e9 / static_cast<double>(world.period)));
    case HD_INSTANTANEOUS_UPDATE_RATE:
      return value(integers | reals, std::round(1e9 / static_cast<double>(world.last_elapsed)));
    case HD_NOMINAL_MAX_STIFFNESS:
      return value(reals, c.max_stiffness);
    case HD_NOMINAL_MAX_DAMPING:
      return value(reals, 5e-3);
    case HD_NOMINAL_MAX_FORCE:
      return value(reals, c.max_force);
    case HD_NOMINAL_MAX_CONTINUOUS_FORCE:
      return value(reals, c.continuous_force);
    case HD_MOTOR_TEMPERATURE: {
      Vector shown = world.temperature;
      for (double& t : shown) t = (std::min)(t, 1.0);
      return value(shown);
    }
    case HD_SOFTWARE_VELOCITY_LIMIT:
      return value(reals, world.velocity_limit);
    case HD_SOFTWARE_FORCE_IMPULSE_LIMIT:
      return value(reals, world.impulse_limit);
    case HD_FORCE_RAMPING_RATE:
      return value(reals, world.ramping_rate);
    default:
      return Value{};
  }
}

template <class T>
void get_into(HDenum name, T* out, unsigned type) {
  const std::lock_guard lock(guard);
  if (!world.usable()) return;
  const Value found = get(name);
  if (found.types == 0) return world.error(HD_INVALID_ENUM);
  if ((found.types & type) == 0) return world.error(HD_INVALID_INPUT_TYPE);
  for (int i = 0; i < found.count; ++i) out[i] = static_cast<T>(found.v[i]);
}

template <class T>
void set_from(HDenum name, const T* in) {
  const std::lock_guard lock(guard);
  if (!world.usable()) return;
  const auto limit = [&](double& which) {
    if (!(in[0] >= 0)) return world.error(HD_INVALID_VALUE);
    which = static_cast<double>(in[0]);
  };
  switch (name) {
    case HD_CURRENT_FORCE:
    case HD_CURRENT_TORQUE:
      if (!world.in_frame) return world.error(HD_FRAME_ERROR);
      (name == HD_CURRENT_FORCE ? world.seen.force : world.seen.torque) = {
          static_cast<double>(in[0]), static_cast<double>(in[1]), static_cast<double>(in[2])};
      return;
    case HD_SOFTWARE_VELOCITY_LIMIT:
      return limit(world.velocity_limit);
    case HD_SOFTWARE_FORCE_IMPULSE_LIMIT:
      return limit(world.impulse_limit);
    case HD_FORCE_RAMPING_RATE:
      return limit(world.ramping_rate);
    default:
      return world.error(HD_INVALID_ENUM);
  }
}

void enable(HDenum cap, bool on) {
  const std::lock_guard lock(guard);
  if (!world.usable()) return;
  for (std::size_t i = 0; i < capability_count; ++i)
    if (capabilities[i] == cap) {
      world.enabled[i] = on;
      if (cap == HD_FORCE_OUTPUT && !on) {  // the amplifiers go off at once, whatever the last frame said
        world.pending = world.active = Vector{};
        world.pending_torque = world.active_torque = Vector{};
      }
      return;
    }
  world.error(HD_INVALID_ENUM);
}

}  // namespace

// ---- control

void reset(const Constants& constants) {
  stop_scheduler();
  const std::lock_guard lock(guard);
  world = World{};
  world.constants = constants;
  world.velocity_limit = constants.velocity_limit;
  world.impulse_limit = constants.impulse_limit;
  world.ramping_rate = constants.ramping_rate;
}

void script(Script function, void* user) {
  Target target;
  if (function != nullptr) function(0, target, user);
  const std::lock_guard lock(guard);
  world.script = function;
  world.user = user;
  world.target = target;
  for (std::size_t i = 0; i < 3; ++i)
    world.hand[i] = world.hand_before[i] = world.x[i] = 1e-3 * target.position[i];
  world.v = Vector{};
  world.measure(0);
}

void real_time(bool on) {
  const std::lock_guard lock(guard);
  if (!world.running) world.real_time = on;
}

void step(int ticks) {
  for (int i = 0; i < ticks; ++i) {
    {
      const std::lock_guard lock(guard);
      if (!world.running || world.real_time) return;
    }
    run_tick(next_wait());
  }
}

State state() {
  const std::lock_guard lock(guard);
  State s;
  s.t = 1e-9 * static_cast<double>(world.now);
  s.ticks = world.ticks;
  for (std::size_t i = 0; i < 3; ++i) {
    s.position[i] = 1e3 * world.x[i];
    s.velocity[i] = 1e3 * world.v[i];
    s.force[i] = world.active[i];
    s.torque[i] = world.active_torque[i];
    s.hand_force[i] = world.hand_force[i];
    s.temperature[i] = world.temperature[i];
  }
  s.scheduler_running = world.running;
  s.device_open = world.open;
  return s;
}

void stall(int periods) {
  const std::lock_guard lock(guard);
  world.stall = (std::max)(periods, 0);
}
void jitter(double most, std::uint64_t seed) {
  const std::lock_guard lock(guard);
  world.jitter = most;
  world.random.state = seed;
}
void inject(HDerror code, int internal_code, int frames) {
  const std::lock_guard lock(guard);
  world.inject_code = code;
  world.inject_internal = internal_code;
  world.inject_frames = frames;
}
void refuse_rate(HDerror code) {
  const std::lock_guard lock(guard);
  world.refuse_rate = code;
}
void unplug(bool unplugged) {
  const std::lock_guard lock(guard);
  world.unplugged = unplugged;
}
void calibration(HDenum status) {
  const std::lock_guard lock(guard);
  world.calibration_status = status;
}

Clock::time_point Clock::now() noexcept {
  {
    const std::lock_guard lock(guard);
    if (!world.real_time) return time_point(duration(world.now));
  }
  return time_point(
      std::chrono::duration_cast<duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

}  // namespace standin

// ---- the device interface

using standin::guard;
using standin::world;

extern "C" {

HHD hdInitDevice(HDstring) {
  const std::lock_guard lock(guard);
  if (world.unplugged) {
    world.error(HD_DEVICE_FAULT, -28);
    return HD_INVALID_HANDLE;
  }
  if (world.open) {
    world.error(HD_DEVICE_ALREADY_INITIATED);
    return HD_INVALID_HANDLE;
  }
  world.open = true;
  world.calibrated = false;
  return standin::the_device;
}

void hdDisableDevice(HHD device) {
  const std::lock_guard lock(guard);
  if (!world.usable(device)) return;
  world.open = world.in_frame = false;
  world.enabled = standin::World{}.enabled;
  world.pending = world.active = standin::Vector{};
}

void hdMakeCurrentDevice(HHD device) {
  const std::lock_guard lock(guard);
  world.usable(device);
}
HHD hdGetCurrentDevice() {
  const std::lock_guard lock(guard);
  return world.usable() ? standin::the_device : HHD{HD_INVALID_HANDLE};
}

void hdBeginFrame(HHD device) {
  const std::lock_guard lock(guard);
  if (!world.usable(device)) return;
  const bool second = world.running && world.framed_this_tick && world.is_enabled(HD_ONE_FRAME_LIMIT);
  if (world.in_frame || second) return world.error(HD_ILLEGAL_BEGIN);
  world.in_frame = world.framed_this_tick = true;
  world.begin_frame();
}

void hdEndFrame(HHD device) {
  const std::lock_guard lock(guard);
  if (!world.usable(device)) return;
  if (!world.in_frame) return world.error(HD_ILLEGAL_END);
  world.in_frame = false;
  world.commit();
}

HDErrorInfo hdGetError() {
  const std::lock_guard lock(guard);
  if (world.error_count == 0)
    return HDErrorInfo{HD_SUCCESS, 0, world.open ? standin::the_device : HHD{HD_INVALID_HANDLE}};
  --world.error_count;
  world.error_top = (world.error_top + standin::max_errors - 1) % standin::max_errors;
  return world.errors[world.error_top];
}

HDstring hdGetErrorString(HDerror code) {
  switch (code) {
#define STANDIN_NAME(name) \
  case name:               \
    return #name
    STANDIN_NAME(HD_SUCCESS);
    STANDIN_NAME(HD_INVALID_ENUM);
    STANDIN_NAME(HD_INVALID_VALUE);
    STANDIN_NAME(HD_INVALID_OPERATION);
    STANDIN_NAME(HD_INVALID_INPUT_TYPE);
    STANDIN_NAME(HD_BAD_HANDLE);
    STANDIN_NAME(HD_WARM_MOTORS);
    STANDIN_NAME(HD_EXCEEDED_MAX_FORCE);
    STANDIN_NAME(HD_EXCEEDED_MAX_FORCE_IMPULSE);
    STANDIN_NAME(HD_EXCEEDED_MAX_VELOCITY);
    STANDIN_NAME(HD_FORCE_ERROR);
    STANDIN_NAME(HD_DEVICE_FAULT);
    STANDIN_NAME(HD_DEVICE_ALREADY_INITIATED);
    STANDIN_NAME(HD_COMM_ERROR);
    STANDIN_NAME(HD_COMM_CONFIG_ERROR);
    STANDIN_NAME(HD_TIMER_ERROR);
    STANDIN_NAME(HD_ILLEGAL_BEGIN);
    STANDIN_NAME(HD_ILLEGAL_END);
    STANDIN_NAME(HD_FRAME_ERROR);
    STANDIN_NAME(HD_INVALID_PRIORITY);
    STANDIN_NAME(HD_SCHEDULER_FULL);
#undef STANDIN_NAME
    default:
      return "unknown error";
  }
}

void hdEnable(HDenum cap) { standin::enable(cap, true); }
void hdDisable(HDenum cap) { standin::enable(cap, false); }
HDboolean hdIsEnabled(HDenum cap) {
  const std::lock_guard lock(guard);
  return world.usable() && world.is_enabled(cap) ? HD_TRUE : HD_FALSE;
}

void hdGetBooleanv(HDenum name, HDboolean* out) { standin::get_into(name, out, standin::booleans); }
void hdGetIntegerv(HDenum name, HDint* out) { standin::get_into(name, out, standin::integers); }
void hdGetFloatv(HDenum name, HDfloat* out) { standin::get_into(name, out, standin::reals); }
void hdGetDoublev(HDenum name, HDdouble* out) { standin::get_into(name, out, standin::reals); }
void hdSetFloatv(HDenum name, const HDfloat* in) { standin::set_from(name, in); }
void hdSetDoublev(HDenum name, const HDdouble* in) { standin::set_from(name, in); }

HDstring hdGetString(HDenum name) {
  const std::lock_guard lock(guard);
  if (!world.usable()) return "";
  switch (name) {
    case HD_VERSION:
    case HD_DEVICE_DRIVER_VERSION:
      return "0";
    case HD_DEVICE_MODEL_TYPE:
      return "stand-in device";
    case HD_DEVICE_VENDOR:
      return "palpate";
    case HD_DEVICE_SERIAL_NUMBER:
      return "none";
    default:
      world.error(HD_INVALID_ENUM);
      return "";
  }
}

HDenum hdCheckCalibration() {
  const std::lock_guard lock(guard);
  return world.usable() ? world.calibration_status : HDenum{HD_CALIBRATION_NEEDS_MANUAL_INPUT};
}
void hdUpdateCalibration(HDenum style) {
  const std::lock_guard lock(guard);
  if (!world.usable()) return;
  if (style != static_cast<HDenum>(world.constants.calibration_style)) return world.error(HD_INVALID_VALUE);
  world.calibrated = true;
  world.calibration_status = HD_CALIBRATION_OK;
}

void hdStartScheduler() {
  const std::lock_guard lock(guard);
  if (world.running) return world.error(HD_INVALID_OPERATION);
  world.running = true;
  world.ramp = 0;
  world.previous_command = standin::Vector{};
  if (world.real_time) standin::servo.thread = std::thread(standin::real_time_loop);
}

void hdStopScheduler() {
  if (standin::in_servo) {
    const std::lock_guard lock(guard);
    return world.error(HD_INVALID_OPERATION);  // the thread cannot wait for itself
  }
  standin::stop_scheduler();
}

void hdSetSchedulerRate(HDulong rate) {
  const std::lock_guard lock(guard);
  if (world.refuse_rate != HD_SUCCESS) return world.error(world.refuse_rate);
  for (unsigned n = 1; n <= 80; ++n) {
    const HDulong possible = static_cast<HDulong>(8000.0 / n + 0.5);
    if (possible != rate) continue;
    world.period = std::llround(1e9 / static_cast<double>(rate));
    return;
  }
  world.error(HD_INVALID_VALUE);
}

HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void* data, HDushort priority) {
  const std::lock_guard lock(guard);
  return standin::schedule(callback, data, priority);
}

void hdScheduleSynchronous(HDSchedulerCallback callback, void* data, HDushort priority) {
  HDSchedulerHandle handle = 0;
  {
    const std::lock_guard lock(guard);
    if (world.running && !standin::in_servo) {
      handle = standin::schedule(callback, data, priority);
      if (handle == 0) return;
    }
  }
  if (handle == 0)
    callback(data);
  else
    standin::wait_for(handle);
}

void hdUnschedule(HDSchedulerHandle handle) {
  std::unique_lock lock(guard);
  // The caller may free the callback's data afterwards: let the running tick end.
  if (!standin::in_servo) standin::round_over.wait(lock, [] { return !world.in_round; });
  const auto end = world.operations.begin() + static_cast<std::ptrdiff_t>(world.operation_count);
  const auto at = std::find_if(world.operations.begin(), end,
                               [&](const standin::Operation& o) { return o.handle == handle; });
  if (at == end) return world.error(HD_INVALID_OPERATION);
  std::move(at + 1, end, at);
  --world.operation_count;
}

HDboolean hdWaitForCompletion(HDSchedulerHandle handle, HDWaitCode code) {
  if (code == HD_WAIT_INFINITE) standin::wait_for(handle);
  const std::lock_guard lock(guard);
  return standin::is_scheduled(handle) ? HD_TRUE : HD_FALSE;
}

HDdouble hdGetSchedulerTimeStamp() {
  const std::lock_guard lock(guard);
  if (!world.real_time) return 0;  // simulated time stands still within a tick
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - world.tick_start).count();
}

void hduPrintError(FILE* stream, const HDErrorInfo* error, const char* message) {
  std::fprintf(stream, "%s: %s (0x%04x, internal %d)\n", message, hdGetErrorString(error->errorCode),
               error->errorCode, error->internalErrorCode);
}

HDboolean hduIsForceError(const HDErrorInfo* error) {
  switch (error->errorCode) {
    case HD_WARM_MOTORS:
    case HD_EXCEEDED_MAX_FORCE:
    case HD_EXCEEDED_MAX_VELOCITY:
    case HD_FORCE_ERROR:
      return HD_TRUE;
    default:
      return HD_FALSE;  // the impulse error is not of this class on the real device either
  }
}

HDboolean hduIsSchedulerError(const HDErrorInfo* error) {
  switch (error->errorCode) {
    case HD_COMM_ERROR:
    case HD_COMM_CONFIG_ERROR:
    case HD_TIMER_ERROR:
    case HD_INVALID_PRIORITY:
    case HD_SCHEDULER_FULL:
      return HD_TRUE;
    default:
      return HD_FALSE;
  }
}

}  // extern "C"
