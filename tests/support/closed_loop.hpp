// SPDX-License-Identifier: MIT
#pragma once

/// @file  A haptic device in a hand, in closed loop with whatever makes its forces, in simulated time: the
/// same numbers in every run.

#include <palpate/core/pose.hpp>
#include <palpate/device/device_model.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace palpate::test {

/// An arm as its tip feels, and its electronics.
struct LoopDevice {
  double mass = 0.06;        ///< apparent, at the tip [kg]
  double viscous = 0.3;      ///< b [N s/m]
  double coulomb = 0.1;      ///< f_c [N], static and sliding
  double resolution = 3e-5;  ///< step of the encoders at the tip [m]; 0: exact

  double inertia = 0;  ///< of stylus and gimbal [kg m^2]; 0: no motors there, and the hand alone turns it
  double angular_viscous = 0;     ///< [N m s/rad]
  double angular_coulomb = 0;     ///< [N m]
  double angular_resolution = 0;  ///< [rad]; 0: exact

  double max_force = std::numeric_limits<double>::infinity();   ///< of the motors [N]
  double max_torque = std::numeric_limits<double>::infinity();  ///< [N m]

  double period = 1e-3;  ///< T [s]
  int delay = 0;         ///< d: a force acts d ticks after the one that computed it, 0 to 3
  double jitter = 0;     ///< a period is T (1 +- jitter), evenly spread
  double lost = 0;       ///< share of the ticks that never come; the force is held
  std::uint64_t seed = 1;
};

/// The device as a chain to the motors has to know it.
[[nodiscard]] inline DeviceModel<double> model_of(const LoopDevice& device) {
  DeviceModel<double> model{.mass = device.mass,
                            .damping = device.viscous,
                            .rotational_damping = device.angular_viscous,
                            .friction = device.coulomb,
                            .resolution = device.resolution,
                            .delay = device.delay};
  if (device.inertia > 0) model.inertia = device.inertia;
  return model;
}

/// Springs and dampers from where the hand wants the stylus to where it is.
struct LoopHand {
  double stiffness = 300, damping = 6;  ///< [N/m], [N s/m]
  double angular_stiffness = 0.3;       ///< [N m/rad]: 300 N/m, 3 cm from the fingers
  double angular_damping = 6e-3;        ///< [N m s/rad]
};

/// Where the hand wants the stylus now, and how fast that moves.
struct HandTarget {
  Vec3<double> position = Vec3<double>::Zero(), velocity = Vec3<double>::Zero();  ///< [m], [m/s]
  Vec3<double> turn = Vec3<double>::Zero(), spin = Vec3<double>::Zero();  ///< turn vector [rad], its rate
  double grip = 1;  ///< factor on all of the hand's springs and dampers; 0: let go
};

/// exp of a turn vector [rad].
[[nodiscard]] inline Mat3<double> turned_by(const Vec3<double>& turn) {
  const double angle = turn.norm();
  if (!(angle > 0)) return Mat3<double>::Identity();
  return Eigen::AngleAxis<double>(angle, turn / angle).toRotationMatrix();
}
/// Its inverse, for turns below pi.
[[nodiscard]] inline Vec3<double> turn_of(const Mat3<double>& R) {
  const Eigen::AngleAxis<double> a(R);
  return a.angle() * a.axis();
}

/// The arm's equations of motion over one tick, with a force that is held, in steps of at most 20 us:
///
///     m v' = F + g (k (x_h - x) + c (v_h - v)) - b v - f_c v/|v|,    or v = 0 if friction can hold it
///
/// and likewise for its turning, whose inertia is the same about all axes. The midpoint rule: what motors and
/// hand put in, less what is lost, is the change of kinetic energy to rounding. Energies are in joules, since
/// the beginning.
class ClosedLoop {
 public:
  using V = Vec3<double>;

  ClosedLoop(const LoopDevice& device, const LoopHand& hand, const V& position, const V& velocity = V::Zero())
      : x(position), v(velocity), device_(device), hand_(hand), random_(device.seed) {
    begin_window();
  }

  V x, v;                                     ///< of the tip [m], [m/s]
  Mat3<double> R = Mat3<double>::Identity();  ///< of the stylus
  V w = V::Zero();                            ///< its spin [rad/s]
  double t = 0;                               ///< [s]
  Wrench<double> acting;                      ///< of the motors, about the tip, in the last tick
  double to_hand = 0, from_motors = 0, lost_to_friction = 0;

  [[nodiscard]] double kinetic() const {
    return device_.mass * v.squaredNorm() / 2 + device_.inertia * w.squaredNorm() / 2;
  }
  /// The most by which the motors, since they last rested, gave more than they had taken and friction lost:
  /// what hand and arm have gained from a touch, at any time in it. Nothing in a passive loop.
  [[nodiscard]] double most_made() const { return most_made_; }
  /// What positions that are read half an encoder step wrong can hide of that from one who counts work by
  /// them: half a step times all changes of the force in a touch, summed over axes; the most of any touch.
  [[nodiscard]] double most_quantised() const { return most_quantised_; }
  [[nodiscard]] const LoopDevice& device() const { return device_; }

  /// What the encoders say.
  [[nodiscard]] Pose<double> reading() const {
    const auto steps = [](const V& a, double step) {
      return step > 0 ? V((a / step).array().round().matrix() * step) : a;
    };
    Pose<double> X{R, steps(x, device_.resolution)};
    if (device_.angular_resolution > 0) X.rotation = turned_by(steps(turn_of(R), device_.angular_resolution));
    return X;
  }

  /// One tick. `control(pose, dt)`: wrench about the tip for the pose that the encoders read; `script(t)`:
  /// the hand's target.
  template <class Script, class Control>
  void tick(const Script& script, Control&& control) {
    if (!(device_.lost > 0) || random() >= device_.lost) {
      commands_[0] = bounded(control(reading(), since_ > 0 ? since_ : device_.period));
      since_ = 0;
    }
    acting = commands_[static_cast<std::size_t>(device_.delay)];
    if (acting.force == V::Zero() && acting.torque == V::Zero()) {
      made_before_ = from_motors - lost_to_friction;
      changes_ = 0;
    } else {
      changes_ += quantised(acting.force - acted_before_.force, acting.torque - acted_before_.torque);
    }
    acted_before_ = acting;
    most_quantised_ = (std::max)(most_quantised_, changes_ + quantised(acting.force, acting.torque));
    for (std::size_t i = commands_.size() - 1; i > 0; --i) commands_[i] = commands_[i - 1];
    const double elapsed = device_.period * (1 + device_.jitter * (2 * random() - 1));
    advance(script, elapsed);
    since_ += elapsed;
    ++window_.ticks;
    window_.low = window_.low.cwiseMin(x), window_.high = window_.high.cwiseMax(x);
    count_turns();
    window_.force += acting.force, window_.torque += acting.torque, window_.position += x;
    if (device_.inertia > 0) {
      const V turn = turn_of(R);
      window_.low_turn = window_.low_turn.cwiseMin(turn),
      window_.high_turn = window_.high_turn.cwiseMax(turn);
    }
  }
  /// Ticks up to the time `end` [s].
  template <class Script, class Control>
  void run(double end, const Script& script, Control&& control) {
    while (t < end) tick(script, control);
  }

  /// What is measured from here on.
  void begin_window() {
    window_ = Window{};
    window_.low = window_.high = window_.farthest = x;
    window_.low_turn = window_.high_turn = turn_of(R);
  }
  /// How far the tip went to and fro since then, along the axis along which it is most [m]; likewise its turn
  /// [rad].
  [[nodiscard]] double amplitude() const { return (window_.high - window_.low).maxCoeff(); }
  [[nodiscard]] double angular_amplitude() const { return (window_.high_turn - window_.low_turn).maxCoeff(); }
  /// How often it turned after more than two encoder steps, along the axis along which it did most: a tool
  /// that vibrates goes on to, one that settles does so a few times.
  [[nodiscard]] int turns() const { return *std::max_element(window_.turns.begin(), window_.turns.end()); }
  /// Means since then.
  [[nodiscard]] Wrench<double> mean_wrench() const {
    return {window_.force / window_.ticks, window_.torque / window_.ticks};
  }
  [[nodiscard]] V mean_position() const { return window_.position / window_.ticks; }

 private:
  struct Window {
    V low = V::Zero(), high = V::Zero(), low_turn = V::Zero(), high_turn = V::Zero();
    V force = V::Zero(), torque = V::Zero(), position = V::Zero();
    double ticks = 0;
    V farthest = V::Zero(), side = V::Ones();  // along each axis: since the last turn, and which way
    std::array<int, 3> turns{};
  };
  void count_turns() {
    for (Eigen::Index k = 0; k < 3; ++k) {
      double &farthest = window_.farthest[k], &side = window_.side[k];
      if (side * (x[k] - farthest) > 0) {
        farthest = x[k];
      } else if (side * (farthest - x[k]) > 2 * device_.resolution) {
        farthest = x[k], side = -side;
        ++window_.turns[static_cast<std::size_t>(k)];
      }
    }
  }

  [[nodiscard]] double quantised(const V& force, const V& torque) const {
    return (device_.resolution * force.lpNorm<1>() + device_.angular_resolution * torque.lpNorm<1>()) / 2;
  }

  /// Uniform in [0, 1), by splitmix64.
  double random() {
    std::uint64_t z = random_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

  [[nodiscard]] Wrench<double> bounded(Wrench<double> c) const {
    const double force = c.force.norm(), torque = c.torque.norm();
    if (force > device_.max_force) c.force *= device_.max_force / force;
    if (torque > device_.max_torque) c.torque *= device_.max_torque / torque;
    return c;
  }

  struct Friction {
    double inertia, viscous, coulomb;
  };
  struct Spring {
    double stiffness, damping;
    V stretch, velocity;  // at the beginning of the step; of the target
  };
  /// Half the sum of the speeds before and after a step of h, which it puts into `speed`; counts energies.
  V step(V& speed, const V& motor, const Spring& hand, const Friction& arm, double h) {
    // With v0, v1 and their mean v: M (v1 - v0) / h = motor + k (stretch - h v / 2) + c (v_h - v) - b v -
    // friction
    const double drag = hand.stiffness * h / 2 + hand.damping + arm.viscous;
    const V pull = hand.stiffness * hand.stretch + hand.damping * hand.velocity;
    const V push = arm.inertia / h * speed + motor + pull - drag / 2 * speed;
    const double size = push.norm();
    const bool slides = size > arm.coulomb;
    V after = V::Zero();
    if (slides) after = push * ((1 - arm.coulomb / size) / (arm.inertia / h + drag / 2));
    const V friction = slides ? V(arm.coulomb / size * push) : push;
    const V mean = (speed + after) / 2, path = h * mean;
    to_hand -= (pull - (hand.stiffness * h / 2 + hand.damping) * mean).dot(path);
    from_motors += motor.dot(path);
    lost_to_friction += (arm.viscous * mean + friction).dot(path);
    speed = after;
    return mean;
  }

  // Within a tick the hand's target moves evenly, and turns are added as vectors.
  template <class Script>
  void advance(const Script& script, double elapsed) {
    const int count = (std::max)(1, static_cast<int>(std::ceil(elapsed / 2e-5 - 1e-9)));
    const double h = elapsed / count;
    const HandTarget target = script(t + elapsed / 2);
    const double g = target.grip;
    const bool turns = device_.inertia > 0;
    V position = target.position - (elapsed - h) / 2 * target.velocity, turned = V::Zero(),
      stretch = V::Zero();
    if (turns && g > 0)
      stretch = turn_of(turned_by(target.turn) * R.transpose()) - (elapsed - h) / 2 * target.spin;
    for (int k = 0; k < count; ++k) {
      x += h * step(v, acting.force,
                    {g * hand_.stiffness, g * hand_.damping, V(position - x), target.velocity},
                    {device_.mass, device_.viscous, device_.coulomb}, h);
      position += h * target.velocity;
      if (turns) {
        turned += h * step(w, acting.torque,
                           {g * hand_.angular_stiffness, g * hand_.angular_damping, V(stretch - turned),
                            target.spin},
                           {device_.inertia, device_.angular_viscous, device_.angular_coulomb}, h);
        stretch += h * target.spin;
      }
      most_made_ = (std::max)(most_made_, from_motors - lost_to_friction - made_before_);
    }
    t += elapsed;
    if (turns)
      R = Eigen::Quaternion<double>(turned_by(turned) * R).normalized().toRotationMatrix();
    else if (g > 0)
      R = turned_by(target.turn);
  }

  LoopDevice device_;
  LoopHand hand_;
  std::array<Wrench<double>, 4> commands_{};  // newest first
  double since_ = 0;                          // the last tick that came [s]
  Wrench<double> acted_before_;
  double most_made_ = 0, made_before_ = 0, most_quantised_ = 0, changes_ = 0;
  Window window_;
  std::uint64_t random_;
};

/// Nobody holds the stylus.
inline constexpr auto nobody = [](double) { return HandTarget{.grip = 0}; };

}  // namespace palpate::test
