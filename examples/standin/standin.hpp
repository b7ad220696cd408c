// SPDX-License-Identifier: MIT
#pragma once

/// @file  A haptic device in software, behind the HDAPI calls of include/HD/hd.h: an arm that has mass and
/// friction and is held by a scripted hand, with the habits of the real one that bite. This header is the
/// side that no real device has: constants, script, faults, and time.
///
/// What is imitated
///  - Outputs are zeroed at each begin of a frame; set outside a frame: HD_FRAME_ERROR; second begin in a
///  frame or
///    in a tick: HD_ILLEGAL_BEGIN; unmatched end: HD_ILLEGAL_END; wrong type: HD_INVALID_INPUT_TYPE.
///  - One stack of errors for all threads, newest first; 64 deep, the oldest are lost.
///  - Callbacks run by priority, once per tick, until they return HD_CALLBACK_DONE; at most 32. A synchronous
///  call
///    runs at once when the scheduler is stopped, or when it is made in a callback.
///  - Rates: floor(8000/N + 0.5) Hz, 100 to 8000; others HD_INVALID_VALUE.
///  - Force: off until HD_FORCE_OUTPUT is enabled. Scaled to the maximum with HD_MAX_FORCE_CLAMPING, else
///    HD_EXCEEDED_MAX_FORCE; jump > impulse limit: HD_EXCEEDED_MAX_FORCE_IMPULSE; speed:
///    HD_EXCEEDED_MAX_VELOCITY; motors hot: HD_WARM_MOTORS; not finite: HD_FORCE_ERROR. Each of these drops
///    the output to zero, and with HD_FORCE_RAMPING it comes back at no more than the ramping rate, as it
///    also starts.
///  - A force set in one tick acts from the next, and stays when no frame follows. Positions are in encoder
///  steps; the velocity is smoothed.
///  - The arm moves on while the servo loop sleeps, with the last force held.
///
/// Not imitated: joint space, several devices, gravity, structural resonance, amplifier dynamics.
///
/// Time. Stepped (the default): nothing happens but in `step()`, and simulated time is exact: same script and
/// seeds, same bits. Real time: hdStartScheduler starts a thread that sleeps to absolute times.

#include <HD/hd.h>

#include <chrono>
#include <cstdint>

namespace standin {

/// Device and hand. Defaults resemble a small desktop arm; lengths in mm as in HDAPI, otherwise SI.
struct Constants {
  double mass = 0.06;           ///< of the arm at the tip [kg]
  double viscous = 0.3;         ///< damping of the arm [N s/m]
  double coulomb = 0.1;         ///< friction of the arm [N]
  double hand_stiffness = 300;  ///< grip, tip to the script's target [N/m]
  double hand_damping = 6;      ///< [N s/m]
  double resolution = 0.055;    ///< encoder step at the tip [mm]
  double velocity_time = 5e-3;  ///< smoothing time of the reported velocity [s]
  double workspace[6] = {-80, -60, -35,
                         80,  60,  35};  ///< usable, min xyz and max xyz [mm]; hard stops at 1.5 times
  double max_force = 3.3;                ///< [N]
  double continuous_force = 0.88;        ///< [N]
  double max_stiffness = 0.5;            ///< nominal [N/mm]
  double max_torque = 188;               ///< [mN m], when output_dof is 6: larger is scaled down
  double impulse_limit = 1.5;            ///< [N/ms]
  double velocity_limit = 2000;          ///< [mm/s]
  double ramping_rate = 20;              ///< [N/s]
  double heat_time = 10;  ///< of the motors [s]; continuous_force for ever ends at temperature 0.8
  int input_dof = 6;
  int output_dof = 3;
  int calibration_style = HD_CALIBRATION_AUTO;
  double calibration_offset[3] = {0, 0, 0};  ///< error of reported positions until hdUpdateCalibration [mm]
};

/// Where the hand wants the stylus.
struct Target {
  double position[3] = {0, 0, 0};                    ///< [mm]
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< column-major; followed without lag
  double grip = 1;                                   ///< 0: let go, 1: firm
  int buttons = 0;
};
/// Called once per tick with the time since the scheduler's first start [s]. Real time: in the scheduler's
/// thread.
using Script = void (*)(double t, Target& target, void* user);

/// What an observer beside the device sees.
struct State {
  double t = 0;  ///< [s]
  std::uint64_t ticks = 0;
  double position[3] = {};     ///< true position [mm]
  double velocity[3] = {};     ///< true velocity [mm/s]
  double force[3] = {};        ///< at the motors [N], after clamp and ramp, one tick late
  double torque[3] = {};       ///< at the motors [mN m]
  double hand_force[3] = {};   ///< of the hand on the arm [N]
  double temperature[3] = {};  ///< 0 cold, 1 hot
  bool scheduler_running = false;
  bool device_open = false;
};

/// Back to the state of a fresh process: scheduler stopped, device closed, no errors, no faults, time 0.
void reset(const Constants& constants = {});
/// Null: the hand stays at the origin. Only while the scheduler is stopped.
void script(Script function, void* user = nullptr);
/// Only while the scheduler is stopped. reset() sets stepped.
void real_time(bool on);
/// Stepped mode: runs this many ticks if the scheduler is running.
void step(int ticks = 1);
[[nodiscard]] State state();

/// Faults. All are forgotten by reset().
/// The next tick comes this many periods late.
void stall(int periods);
/// Each period is longer by 0 to `most` [s], uniformly.
void jitter(double most, std::uint64_t seed);
/// `code` is raised at each of the next `frames` begins of a frame. HD_COMM_ERROR, HD_DEVICE_FAULT: position
/// and force do not get through in that frame either.
void inject(HDerror code, int internal_code = 0, int frames = 1);
/// hdSetSchedulerRate fails with this code whatever the rate; HD_SUCCESS: as usual.
void refuse_rate(HDerror code);
/// hdInitDevice fails with HD_DEVICE_FAULT and returns HD_INVALID_HANDLE.
void unplug(bool unplugged);
/// What hdCheckCalibration returns.
void calibration(HDenum status);

/// Clock for std::chrono-like use: simulated time when stepped, the steady clock in real time.
struct Clock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<Clock>;
  static constexpr bool is_steady = true;
  [[nodiscard]] static time_point now() noexcept;
};

}  // namespace standin
