// SPDX-License-Identifier: MIT
#pragma once

/// @file  What hands do to an object, scripted: for closed loops of device, hand and solver.

#include <support/closed_loop.hpp>

#include <array>
#include <numbers>

namespace palpate::test {

/// Where a hand plays: a point of the surface, the normal there, and a direction along it, all in the
/// device's frame.
struct PlayGround {
  Vec3<double> at = Vec3<double>::Zero(), normal = Vec3<double>::UnitY(), along = Vec3<double>::UnitX();
};

enum class Play {
  tap,     ///< 15 mm in and out of the surface, three times a second
  press,   ///< 20 mm below it, held for 1.5 s, and out
  slide,   ///< 10 mm below it, 10 mm to and fro along it, at rest, and out
  twist,   ///< 10 mm below it, 0.5 rad to and fro about the normal, at rest, and out
  rock,    ///< likewise 0.3 rad about the direction along the surface
  let_go,  ///< 20 mm below it, and let go
  toss,    ///< nobody holds the stylus: it flies at the surface
};
inline constexpr std::array all_plays{Play::tap,  Play::press,  Play::slide, Play::twist,
                                      Play::rock, Play::let_go, Play::toss};

/// Name, seconds, and from when to when it is at rest.
struct PlayTimes {
  const char* name;
  double end, rest_from = 0, rest_to = 0;
};
[[nodiscard]] inline PlayTimes times_of(Play play) {
  switch (play) {
    case Play::tap:
      return {"tap", 2.2};
    case Play::press:
      return {"press", 2.4, 1.5, 2};
    case Play::slide:
      return {"slide", 3.4, 2.7, 3};
    case Play::twist:
      return {"twist", 3.4, 2.7, 3};
    case Play::rock:
      return {"rock", 3.4, 2.7, 3};
    case Play::let_go:
      return {"let go", 2};
    case Play::toss:
      return {"toss", 1};
  }
  return {};
}

/// The hand that plays; its target starts 5 mm above the surface.
struct HandScript {
  Play play;
  PlayGround ground;
  double grip = 1;
  double wait = 0;  ///< at rest for so much longer, before it is looked at [s]

  [[nodiscard]] HandTarget operator()(double t) const {
    constexpr double pi = std::numbers::pi;
    double height = 5e-3, rate = 0;                             // [m], [m/s]
    const auto move = [&](double from, double to, double by) {  // evenly from one time to another
      if (t >= from) height += by * (std::min)(1.0, (t - from) / (to - from));
      if (t >= from && t < to) rate += by / (to - from);
    };
    double swing = 0, swing_rate = 0;  // twice to and fro in 2 s
    const auto to_and_fro = [&](double from) {
      if (t < from || t >= from + 2) return;
      swing = std::sin(2 * pi * (t - from)), swing_rate = 2 * pi * std::cos(2 * pi * (t - from));
    };
    double held = grip;
    switch (play) {
      case Play::tap:
        if (t >= 0.1 && t < 2.1) {
          height -= 10e-3 + 10e-3 * -std::cos(6 * pi * (t - 0.1));
          rate = -10e-3 * 6 * pi * std::sin(6 * pi * (t - 0.1));
        }
        break;
      case Play::press:
        move(0.2, 0.5, -25e-3), move(2 + wait, 2.3 + wait, 25e-3);
        break;
      case Play::let_go:
        move(0.2, 0.5, -25e-3);
        if (t >= 1) held = 0;
        break;
      case Play::toss:
        held = 0;
        break;
      default:
        move(0.1, 0.3, -15e-3), move(3 + wait, 3.2 + wait, 15e-3);
        to_and_fro(0.3);
    }
    HandTarget target{
        .position = ground.at + height * ground.normal, .velocity = rate * ground.normal, .grip = held};
    if (play == Play::slide) {
      target.position += 10e-3 * swing * ground.along;
      target.velocity += 10e-3 * swing_rate * ground.along;
    }
    const Vec3<double> axis = play == Play::twist ? ground.normal : ground.along;
    const double angle = play == Play::twist ? 0.5 : play == Play::rock ? 0.3 : 0;
    target.turn = angle * swing * axis, target.spin = angle * swing_rate * axis;
    return target;
  }
};

/// What came of a play.
struct PlayFigures {
  double made = 0;               ///< ClosedLoop::most_made() [J]
  double to_hand = 0;            ///< over all of it [J]
  double amplitude = 0;          ///< at rest: how far to and fro [m]
  double angular_amplitude = 0;  ///< [rad]
  int turns = 0;                 ///< at rest: ClosedLoop::turns()
  double quantised = 0;          ///< ClosedLoop::most_quantised() [J]
  double deepest = 0;            ///< of the stylus below the surface [m]
  Wrench<double> sent;           ///< mean at rest
  Vec3<double> position;         ///< mean at rest [m]
};

/// From so many turns on at rest a tool vibrates.
inline constexpr int vibrates_from = 4;

/// Plays with a loop of `device` and `hand`. `toss`: speed at which the stylus flies at the surface [m/s].
template <class Control>
[[nodiscard]] PlayFigures play(const LoopDevice& device, const LoopHand& hand, const HandScript& script,
                               Control&& control, double toss = 0) {
  PlayTimes times = times_of(script.play);
  if (times.rest_to > 0)
    times.rest_from += script.wait, times.rest_to += script.wait, times.end += script.wait;
  const PlayGround& ground = script.ground;
  ClosedLoop loop(device, hand, ground.at + 5e-3 * ground.normal,
                  script.play == Play::toss ? Vec3<double>(-toss * ground.normal) : Vec3<double>::Zero());
  PlayFigures f;
  const auto run = [&](double end) {
    while (loop.t < end) {
      loop.tick(script, control);
      f.deepest = (std::max)(f.deepest, (ground.at - loop.x).dot(ground.normal));
    }
  };
  run(times.rest_from);
  if (times.rest_to > 0) {
    loop.begin_window();
    run(times.rest_to);
    f.amplitude = loop.amplitude(), f.angular_amplitude = loop.angular_amplitude();
    f.turns = loop.turns();
    f.sent = loop.mean_wrench(), f.position = loop.mean_position();
  }
  run(times.end);
  f.made = loop.most_made(), f.quantised = loop.most_quantised(), f.to_hand = loop.to_hand;
  return f;
}

}  // namespace palpate::test
