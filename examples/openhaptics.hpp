// SPDX-License-Identifier: MIT
#pragma once

/// @file  A palpate solver behind an OpenHaptics device (HDAPI): life cycle, servo callback, statistics.
/// The same source builds against the vendor's headers and against examples/standin. See docs/device.md.

// The vendor's headers know Linux only by a macro that strict -std=c++20 does not define.
#if defined(__linux__) && !defined(linux)
#define linux 1
#define PALPATE_UNDEF_LINUX
#endif
#include <cstddef>  // NULL

#include <HD/hd.h>
#include <HDU/hduError.h>
#ifdef PALPATE_UNDEF_LINUX
#undef linux
#undef PALPATE_UNDEF_LINUX
#endif

#include <palpate/core/error.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/core/status.hpp>
#include <palpate/device/recorder.hpp>
#include <palpate/device/servo_chain.hpp>
#include <palpate/device/servo_statistics.hpp>
#include <palpate/device/spsc_ring.hpp>
#include <palpate/device/stability_check.hpp>
#include <palpate/device/triple_buffer.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#if defined(__SSE2__) || defined(_M_X64)
#include <xmmintrin.h>
#endif

namespace palpate::example {

/// What the device says of itself.
struct DeviceLimits {
  char model[64] = "";
  double max_force = 0;         ///< [N], motors cool
  double continuous_force = 0;  ///< [N], for ever
  double max_stiffness = 0;     ///< [N/m] of the hand; a stiffer scene will buzz
  double workspace[6] = {};     ///< usable box, min xyz and max xyz [mm]
  bool has_torque = false;
};

/// An error of the device and when it was read. t < 0: at set-up or shutdown.
struct DeviceError {
  double t = -1;  ///< [s] since the first tick
  HDErrorInfo info = {};
};

/// Opens a device and renders `solver` through a ServoChain in the device's own servo thread.
///
/// Solver: as ServoChain has it; an optional `reset()` noexcept forgets contacts after an error. The solver
/// belongs to the servo thread from start() to stop(). Clock: std::chrono-like; tests put a simulated one
/// here. Coupling: NoVirtualCoupling, or VirtualCoupling for scenes that are stiffer than the device.
///
/// Set-up errors throw SetupError. The callback prints nothing, allocates nothing and never waits: errors of
/// the device go to a ring (next_error()), the newest tick to a triple buffer (fetch(), view()), all ticks to
/// a buffer reserved at set-up (recording()). All public functions are for one thread, the one that owns the
/// object.
template <class Solver, class Clock = std::chrono::steady_clock, class Coupling = NoVirtualCoupling<double>>
class HapticDevice {
 public:
  using Chain = ServoChain<Solver, Coupling>;
  using Result = typename Chain::Result;

  struct Params {
    const char* name = HD_DEFAULT_DEVICE;  ///< as configured with the vendor's tool; null: the first device
    unsigned long rate = 1000;             ///< asked for [Hz]; a refusal is reported, not fatal
    /// `limits` are lowered to the device's own; 50 N: larger than any of these.
    typename Chain::Params chain = {.limits = {.max_force = 50}};
    bool reset_encoders =
        false;               ///< devices without a home sensor: true when the arm rests in its neutral pose
    std::size_t record = 0;  ///< ticks to keep for recording()
    std::size_t history = 5000;  ///< ticks to keep for history(), the last ones
  };

  /// One tick.
  struct Record {
    std::uint64_t tick = 0;  ///< 1 in the first
    double t = 0;            ///< [s] since the first tick
    double dt = 0;           ///< [s] since the tick before
    Pose<double> pose;       ///< of the tool in the object's frame
    Vec3<double> velocity =
        Vec3<double>::Zero();  ///< of the hand, device axes, as the device smooths it [m/s]
    Result result{};           ///< the solver's
    Wrench<double> output;     ///< what was sent: device axes, torque about the stylus point
    GateStatus gate = GateStatus::ok;
    double passivity = 1;        ///< scale of the passivity controller
    std::int64_t tick_ns = 0;    ///< work in this tick [ns]
    std::uint64_t overruns = 0;  ///< so far
    bool calibrated = false;
  };

  /// Opens the device, asks its limits, switches forces on (they flow from start() on) and schedules the
  /// callback.
  HapticDevice(Solver& solver, const Params& params)
      : solver_(solver),
        params_(params),
        period_(1000000000 / static_cast<std::int64_t>((std::max)(params.rate, 1ul))),
        chain_(std::in_place, solver, params.chain),
        history_(params.history) {
    if (params.rate < 1) fail("HapticDevice", "rate [Hz] must be > 0", static_cast<double>(params.rate));
    recording_.resize(params.record);

    drain_on_this_thread();  // the stack may hold errors of whatever ran before
    device_ = hdInitDevice(params.name);
    const HDErrorInfo error = hdGetError();
    if (HD_DEVICE_ERROR(error)) fail("HapticDevice: hdInitDevice", hdGetErrorString(error.errorCode));
    if (device_ > 1024)
      fail("HapticDevice: hdInitDevice", "no device, and no error either");  // some versions do that
    open_ = true;
    configure();
  }
  ~HapticDevice() { stop(); }
  HapticDevice(const HapticDevice&) = delete;
  HapticDevice& operator=(const HapticDevice&) = delete;

  /// Sets the rate and starts the scheduler, once. Forces come `limits.arm_after` s after the tool is free of
  /// contact.
  void start() {
    if (!open_ || started_) fail("HapticDevice", "start() works once, and not after stop()");
    hdSetSchedulerRate(static_cast<HDulong>(params_.rate));
    drain_on_this_thread();  // a refused rate: the device keeps its own, and the statistics show which
    hdStartScheduler();
    started_ = true;
    // From here on errors may be the callback's as well. One that was taken from it still disarms.
    const HDErrorInfo error = hdGetError();
    if (!HD_DEVICE_ERROR(error)) return;
    own_errors_.push_back(DeviceError{-1, error});
    disarm_request_.store(true, std::memory_order_relaxed);
    if (!is_fatal(error)) return;
    stop();
    fail("HapticDevice: hdStartScheduler", hdGetErrorString(error.errorCode));
  }

  /// Scheduler, callback, device, in this order; forces are off afterwards. May be called again.
  void stop() noexcept {
    if (!open_) return;
    open_ = false;
    hdStopScheduler();
    hdUnschedule(operation_);  // complains when the callback had ended by itself
    hdDisableDevice(device_);
    drain_on_this_thread();
  }

  /// False after an error that the servo loop cannot survive, and after stop().
  [[nodiscard]] bool running() const noexcept {
    return open_ && started_ && hdWaitForCompletion(operation_, HD_WAIT_CHECK_STATUS) != 0;
  }

  /// The oldest error not yet seen; false when there is none. Print it here, in the main thread.
  bool next_error(DeviceError& error) noexcept {
    if (own_seen_ < own_errors_.size()) {
      error = own_errors_[own_seen_++];
      return true;
    }
    return errors_.pop(error);
  }
  [[nodiscard]] std::uint64_t dropped_errors() const noexcept { return errors_.dropped(); }

  /// True when a tick has ended since the last call; view() is then the newest one.
  bool fetch() noexcept { return out_.fetch(); }
  [[nodiscard]] const Record& view() const noexcept { return out_.front(); }

  /// No force from the next tick until the limits arm again: for a scene that was changed under the tool.
  void disarm() noexcept { disarm_request_.store(true, std::memory_order_relaxed); }

  [[nodiscard]] const DeviceLimits& limits() const noexcept { return limits_; }
  [[nodiscard]] const Gate<double>::Params& gate_params() const noexcept { return chain_->params().limits; }
  /// The scene's stiffness, `chain.stiffness`, beside what the device bears; where torque is sent also
  /// `rotational_stiffness` [N m/rad] about the stylus point.
  [[nodiscard]] StabilityCheck<double> stability(double rotational_stiffness = 0) const noexcept {
    const typename Chain::Params& p = chain_->params();
    return check_stability(p.stiffness, p.mapping.scale, 1e-9 * static_cast<double>(period_), p.device,
                           limits_.max_stiffness, p.has_torque ? rotational_stiffness : 0);
  }
  /// After stop().
  [[nodiscard]] const ServoStatistics& statistics() const noexcept { return statistics_; }
  /// After stop(): the first `record` ticks.
  [[nodiscard]] const Record* recording() const noexcept { return recording_.data(); }
  [[nodiscard]] std::size_t recorded() const noexcept { return recorded_; }
  /// After stop(): the last `history` ticks, for save_ticks() and replay(): what led to a fault.
  [[nodiscard]] std::vector<TickRecord> history() const { return history_.ticks(); }

 private:
  static constexpr int max_drain = 16;  // errors read per tick; the rest waits for the next
  static constexpr std::uint64_t calibration_interval = 1000;  // ticks

  [[nodiscard]] static bool is_fatal(const HDErrorInfo& error) noexcept {
    return hduIsSchedulerError(&error) != 0 || error.errorCode == HD_DEVICE_FAULT;
  }
  [[nodiscard]] static bool is_force_error(const HDErrorInfo& error) noexcept {
    // The library's own class leaves the impulse error out.
    return hduIsForceError(&error) != 0 || error.errorCode == HD_EXCEEDED_MAX_FORCE_IMPULSE;
  }

  /// The device's figure, or 0 where it has none.
  [[nodiscard]] static double ask(HDenum name) noexcept {
    HDdouble value = 0;
    hdGetDoublev(name, &value);
    return is_finite(value) && value > 0 ? value : 0.0;
  }

  /// Closes the device again where something is wrong.
  void configure() {
    hdMakeCurrentDevice(device_);
    const HDstring model = hdGetString(HD_DEVICE_MODEL_TYPE);
    std::snprintf(limits_.model, sizeof limits_.model, "%s", model != nullptr ? model : "");
    limits_.max_force = ask(HD_NOMINAL_MAX_FORCE);
    limits_.continuous_force = ask(HD_NOMINAL_MAX_CONTINUOUS_FORCE);
    limits_.max_stiffness = 1e3 * ask(HD_NOMINAL_MAX_STIFFNESS);
    hdGetDoublev(HD_USABLE_WORKSPACE_DIMENSIONS, limits_.workspace);
    HDint dof = 3, style = 0;
    hdGetIntegerv(HD_OUTPUT_DOF, &dof);
    hdGetIntegerv(HD_CALIBRATION_STYLE, &style);
    limits_.has_torque = dof >= 6;

    typename Chain::Params chain = params_.chain;
    Gate<double>::Params& gate = chain.limits;
    if (limits_.max_force > 0) gate.max_force = (std::min)(gate.max_force, 0.9 * limits_.max_force);
    if (limits_.continuous_force > 0)
      gate.continuous_force = (std::min)(gate.continuous_force, limits_.continuous_force);
    if (const double limit = ask(HD_SOFTWARE_VELOCITY_LIMIT); limit > 0)  // mm/s
      gate.max_speed = (std::min)(gate.max_speed, 0.9e-3 * limit);
    chain.has_torque = limits_.has_torque;
    // A stiff wall, touched fast, is more than the usual impulse limit, and the amplifiers would drop out.
    // The chain looks for jumps itself, and knows how far the tool has moved.
    hdDisable(HD_SOFTWARE_FORCE_IMPULSE_LIMIT);
    drain_on_this_thread();
    if (!(limits_.max_force > 0)) close_and_fail("the device does not tell its largest force");
    chain_.emplace(solver_, chain);  // lower limits than params.chain's, which has been checked
    if ((style & HD_CALIBRATION_AUTO) != 0) calibration_style_ = HD_CALIBRATION_AUTO;
    if ((style & HD_CALIBRATION_INKWELL) != 0) calibration_style_ = HD_CALIBRATION_INKWELL;
    calibrated_ = calibration_style_ == 0;  // otherwise the servo loop sees to it
    if (calibrated_ && params_.reset_encoders) hdUpdateCalibration(HD_CALIBRATION_ENCODER_RESET);
    hdEnable(HD_MAX_FORCE_CLAMPING);
    hdEnable(HD_FORCE_RAMPING);
    hdEnable(HD_FORCE_OUTPUT);
    operation_ = hdScheduleAsynchronous(&HapticDevice::servo, this, HD_MAX_SCHEDULER_PRIORITY);
    const HDErrorInfo error = hdGetError();
    if (HD_DEVICE_ERROR(error)) close_and_fail(hdGetErrorString(error.errorCode));
  }

  [[noreturn]] void close_and_fail(const char* why) {
    hdDisableDevice(device_);
    fail("HapticDevice", why);
  }

  /// Only while the servo thread does not run.
  void drain_on_this_thread() noexcept {
    for (int i = 0; i < max_drain; ++i) {
      const HDErrorInfo error = hdGetError();
      if (!HD_DEVICE_ERROR(error)) return;
      if (!own_errors_.full()) own_errors_.push_back(DeviceError{-1, error});
    }
  }

  static HDCallbackCode HDCALLBACK servo(void* self) noexcept {
    return static_cast<HapticDevice*>(self)->tick();
  }

  HDCallbackCode tick() noexcept {
    const typename Clock::time_point begin = Clock::now();
    if (record_.tick == 0) {
      flush_denormals();  // they cost a hundred cycles each; the setting belongs to the thread
      first_ = begin;
      last_ = begin - std::chrono::nanoseconds(period_);
    }
    record_.dt = 1e-9 * static_cast<double>(nanoseconds(begin - last_));
    record_.t = 1e-9 * static_cast<double>(nanoseconds(begin - first_));
    last_ = begin;
    if (!calibrated_ && record_.tick % calibration_interval == 0) calibrate();

    hdBeginFrame(device_);  // takes the state and makes the device current; outputs are now zero
    // Zeros are no rotation: where a get fails, the solver sees a bad pose.
    HDdouble velocity[3] = {}, transform[16] = {};
    hdGetDoublev(HD_CURRENT_VELOCITY, velocity);
    hdGetDoublev(HD_CURRENT_TRANSFORM, transform);
    record_.velocity = 1e-3 * Vec3<double>(velocity[0], velocity[1], velocity[2]);
    if (!calibrated_ || disarm_request_.exchange(false, std::memory_order_relaxed)) chain_->disarm();
    const auto out = chain_->tick(pose_of(transform), record_.dt, record_.velocity.norm());
    record_.pose = out.tool;
    record_.result = out.result;
    record_.output = out.wrench;
    record_.gate = out.gate;
    record_.passivity = out.passivity;
    history_.add(record_of(out, statistics_.ticks + 1, record_.dt, begins_anew_));
    begins_anew_ = false;

    const Vec3<double>& f = record_.output.force;
    const HDdouble force[3] = {f.x(), f.y(), f.z()};  // N
    hdSetDoublev(HD_CURRENT_FORCE, force);
    if (limits_.has_torque) {
      const Vec3<double> m = 1e3 * record_.output.torque;
      const HDdouble torque[3] = {m.x(), m.y(), m.z()};  // mN m
      hdSetDoublev(HD_CURRENT_TORQUE, torque);
    }
    hdEndFrame(device_);

    const bool alive = drain();
    finish(begin);
    return alive ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
  }

  /// `transform`: column-major, translation in 12..14 [mm].
  [[nodiscard]] static Pose<double> pose_of(const HDdouble (&transform)[16]) noexcept {
    Pose<double> pose;
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row) pose.rotation(row, column) = transform[4 * column + row];
    pose.translation = 1e-3 * Vec3<double>(transform[12], transform[13], transform[14]);
    return pose;
  }

  /// False after an error that ends the loop.
  [[nodiscard]] bool drain() noexcept {
    bool alive = true;
    for (int i = 0; i < max_drain; ++i) {
      const HDErrorInfo error = hdGetError();
      if (!HD_DEVICE_ERROR(error)) break;
      errors_.push(DeviceError{record_.t, error});
      if (is_force_error(error)) forget();
      if (is_fatal(error)) alive = false;
    }
    if (!alive) hdDisable(HD_FORCE_OUTPUT);  // no further frame will replace the last force
    return alive;
  }

  /// After a jump of position or force: no contact state from before may command a force.
  void forget() noexcept {
    chain_->reset();
    begins_anew_ = true;
  }

  void calibrate() noexcept {
    const HDenum status = hdCheckCalibration();
    if (status == HD_CALIBRATION_NEEDS_UPDATE) hdUpdateCalibration(calibration_style_);
    calibrated_ = status == HD_CALIBRATION_OK ||
                  (status == HD_CALIBRATION_NEEDS_UPDATE && hdCheckCalibration() == HD_CALIBRATION_OK);
    forget();
  }

  void finish(typename Clock::time_point begin) noexcept {
    const std::int64_t work = nanoseconds(Clock::now() - begin);
    statistics_.add(period_, std::llround(1e9 * record_.dt), work);
    record_.tick = statistics_.ticks;
    record_.overruns = statistics_.overruns;
    record_.tick_ns = work;
    record_.calibrated = calibrated_;
    if (recorded_ < recording_.size()) recording_[recorded_++] = record_;
    out_.publish(record_);
  }

  template <class Duration>
  [[nodiscard]] static std::int64_t nanoseconds(Duration d) noexcept {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(d).count();
  }
  static void flush_denormals() noexcept {
#if defined(__SSE2__) || defined(_M_X64)
    _mm_setcsr(_mm_getcsr() | 0x8040u);  // flush to zero, denormals are zero
#endif
  }

  Solver& solver_;
  Params params_;
  std::int64_t period_;  // nominal [ns]
  DeviceLimits limits_;
  std::optional<Chain> chain_;  // made again with the device's limits

  HHD device_ = HD_INVALID_HANDLE;
  HDSchedulerHandle operation_ = 0;
  HDenum calibration_style_ = 0;
  bool open_ = false, started_ = false;
  bool calibrated_ = false;  // servo thread's once started

  typename Clock::time_point first_{}, last_{};
  Record record_;
  ServoStatistics statistics_;
  std::vector<Record> recording_;
  std::size_t recorded_ = 0;
  Recorder history_;
  bool begins_anew_ = false;  // the solver was reset since the last tick

  std::atomic<bool> disarm_request_{false};
  SpscRing<DeviceError, 64> errors_;         // from the servo thread
  FixedVector<DeviceError, 64> own_errors_;  // from this one
  std::size_t own_seen_ = 0;
  TripleBuffer<Record> out_;
};

}  // namespace palpate::example
