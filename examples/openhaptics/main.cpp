// SPDX-License-Identifier: MIT

/// @file The least program for an OpenHaptics device: its servo callback asks a solver for the force.
/// examples/openhaptics.hpp is the whole layer: errors, calibration, torque, statistics, recording.

// [openhaptics]
#include <cstddef>  // NULL, which HD/hd.h uses

#include <HD/hd.h>
#include <palpate/palpate.hpp>

#include <algorithm>
#include <cstdio>
using namespace palpate;

using Touch = ContactSolver<Ellipsoid<double>, LinearForce<double>, CoulombFriction<double>>;
struct Scene {
  Touch touch;
  // No force before the tool is free, at most 3 N, zero when anything is wrong, and never more energy than
  // the hand has put in. The device's origin is 20 mm above the object's top.
  ServoChain<Touch> chain{touch, {.mapping = {.offset = {0, 0.06, 0}}, .stiffness = 300}};
  double peak = 0;  // [N]
};

HDCallbackCode HDCALLBACK servo(void* data) {  // in the device's own thread, 1,000 times a second
  Scene& scene = *static_cast<Scene*>(data);
  HDdouble m[16] = {};
  HDint rate = 0, buttons = 0;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_TRANSFORM, m);  // column by column, mm
  hdGetIntegerv(HD_INSTANTANEOUS_UPDATE_RATE, &rate);
  hdGetIntegerv(HD_CURRENT_BUTTONS, &buttons);
  Pose<double> stylus;  // m
  stylus.rotation << m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10];
  stylus.translation = {1e-3 * m[12], 1e-3 * m[13], 1e-3 * m[14]};
  const Vec3<double> force = scene.chain.tick(stylus, 1.0 / rate).wrench.force;
  hdSetDoublev(HD_CURRENT_FORCE, force.data());  // N
  hdEndFrame(hdGetCurrentDevice());
  scene.peak = (std::max)(scene.peak, force.norm());
  return buttons == 0 ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

int main() {
  Scene scene{Touch({.object = Ellipsoid<double>({.axes = {0.06, 0.04, 0.04}}),  // m; the tool is a point
                     .tool = {},
                     .force = LinearForce<double>({.k = 300}),  // N/m: a small arm can hold that
                     .friction = CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.3})})};
  const HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  if (const HDErrorInfo error = hdGetError(); HD_DEVICE_ERROR(error))
    return std::fprintf(stderr, "%s\n", hdGetErrorString(error.errorCode)), 1;
  hdEnable(HD_FORCE_OUTPUT);
  const auto loop = hdScheduleAsynchronous(servo, &scene, HD_MAX_SCHEDULER_PRIORITY);
  hdStartScheduler();
  std::puts("Touch the ellipsoid; the stylus' button ends the program.");
  hdWaitForCompletion(loop, HD_WAIT_INFINITE);
  hdStopScheduler();
  hdDisableDevice(device);
  std::printf("peak force %.2f N\n", scene.peak);
}
// [openhaptics]
