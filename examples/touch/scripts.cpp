// SPDX-License-Identifier: MIT

#include "scripts.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace touch {

using namespace palpate;

namespace {

/// 0 before `begin`, 1 after `end` [s], smooth between.
double smooth_step(double t, double begin, double end) {
  const double s = t <= begin ? 0 : t >= end ? 1 : (t - begin) / (end - begin);
  return s * s * (3 - 2 * s);
}

/// The path, worked out before the servo loop runs: positions every 10 ms, straight lines between. Where it
/// rises or falls faster than a hand, 0.15 m/s, it is lifted before and after, as a hand lifts a tool over a
/// step.
template <class Path>
Script table(double seconds, const Path& path) {
  constexpr double step = 0.01;
  std::vector<V> positions;
  for (int i = 0; i <= static_cast<int>(seconds / step) + 1; ++i) positions.push_back(path(i * step));
  constexpr double climb = 0.15 * step;  // [m]
  for (std::size_t i = 1; i < positions.size(); ++i)
    positions[i].y() = (std::max)(positions[i].y(), positions[i - 1].y() - climb);
  for (std::size_t i = positions.size() - 1; i > 0; --i)
    positions[i - 1].y() = (std::max)(positions[i - 1].y(), positions[i].y() - climb);
  return {seconds,
          [positions = std::move(positions)](double t) -> V {
            const double s = std::clamp(t / step, 0.0, static_cast<double>(positions.size() - 2));
            const auto i = static_cast<std::size_t>(s);
            const double part = (std::min)(s - static_cast<double>(i), 1.0);
            return (1 - part) * positions[i] + part * positions[i + 1];
          },
          {}};
}

/// Down on one point until the hand's spring holds `press` [m], and up again.
Script press_at(const Body& body, double x, double press) {
  constexpr double hover = 4e-3;
  const V position = body.raycast(V(x, 1, 0), -V::UnitY()).position;
  return table(5.4, [=](double t) -> V {
    const double down = smooth_step(t, 1.2, 3.0) - smooth_step(t, 3.4, 5.2);
    return position + V(0, hover - (hover + press) * down, 0);
  });
}

/// The compass comes down tilted, with one pin, then turns about that pin until the other stands as deep.
Script with_both_pins(const Body& heart) {
  Script script = press_at(heart, -compass_width / 2, 6e-3);
  script.seconds = 7.0;
  const auto upright = script.target;
  script.target = [upright](double t) -> V { return upright(t < 3.2 ? t : (std::max)(3.2, t - 1.7)); };
  script.turn = [](double t) -> Mat3<S> {
    const double angle = 0.28 * (1 - smooth_step(t, 3.0, 4.6)), c = std::cos(angle), s = std::sin(angle);
    Mat3<S> turn;
    turn << c, -s, 0, s, c, 0, 0, 0, 1;
    return turn;
  };
  return script;
}

}  // namespace

/// `press` [m] is how far below the surface the hand aims: the hand's spring turns it into a force.
Script make_script(const Options& options, const Body& body, const Tool& tool) {
  if (options.scene == "heart") return with_both_pins(body);
  if (options.scene == "cube-head" || options.scene == "cube-tail") return press_at(body, 0, 6.2e-3);
  constexpr double hover = 6e-3, press = 8e-3, free = 1.2;  // s until the gate has armed and ramped
  const auto below = [&body](double x, double z) { return body.raycast(V(x, 1, z), -V::UnitY()); };
  // Where the tool, standing over (x, z), would be `height` off its first touch, along the surface's normal.
  const auto over = [=, &tool](double x, double z, double height) -> V {
    const RayHit<double> hit = below(x, z);
    double y = hit.hit ? hit.position.y() : -1;
    for (const V& v : tool.mesh.vertices) {
      const RayHit<double> under = below(x + v.x(), z + v.z());
      if (under.hit) y = (std::max)(y, under.position.y() - v.y());
    }
    if (!hit.hit) return V(x, (std::max)(y, 0.0) + height, z);
    return V(x, y, z) + height * body.closest(V(hit.position + 1e-6 * V::UnitY())).normal;
  };
  const double reach = 0.6 * body.upper().x();
  if (options.script == "figure10") {  // down, along +x and slightly +z, up
    return table(6.0, [=](double t) {
      const double down = smooth_step(t, free, free + 0.6) - smooth_step(t, 5.2, 5.8);
      const double along = smooth_step(t, free + 0.6, 5.2);
      return over(reach * (2 * along - 1), 0.1 * reach * along, hover - (hover + press) * down);
    });
  }
  if (options.script == "press") {  // in and out at one point, three times, each deeper
    return table(5.0, [=](double t) {
      const double s = t < free ? 0 : t - free;
      const double wave = 0.5 * (1 - std::cos(6.283185307179586 * s / 1.2));
      return over(options.at_x, options.at_z,
                  hover - (hover + press * (0.4 + 0.2 * std::floor(s / 1.2))) * wave);
    });
  }
  if (options.script == "both") {  // in and out once, tilted so that both pins of the compass touch at once
    if (options.tool != "compass") refuse("--script both needs --tool compass");
    const auto top = [&](double x) { return below(x, options.at_z); };
    double tilt = 0, begin = 0;
    RayHit<double> one;
    for (int i = 0; i < 20; ++i) {  // until the line between the feet lies along the tool
      begin = options.at_x - 0.5 * compass_width * std::cos(tilt);
      one = top(begin);
      const RayHit<double> two = top(begin + compass_width * std::cos(tilt));
      if (!one.hit || !two.hit)
        refuse("--script both: a pin of the compass is beside the object; move it with --at");
      tilt = 0.5 *
             (tilt + std::asin(std::clamp((two.position.y() - one.position.y()) / compass_width, -1.0, 1.0)));
    }
    Script script = table(4.4, [=](double t) -> V {
      const double down = smooth_step(t, free, free + 1.2) - smooth_step(t, 3.0, 4.2);
      return one.position + V(0, hover - (hover + press) * down, 0);
    });
    script.turn = [tilt](double) { return Mat3<double>(Eigen::AngleAxisd(tilt, V::UnitZ())); };
    return script;
  }
  if (options.script == "slide") {  // to and fro across the top
    return table(8.0, [=](double t) {
      const double down = smooth_step(t, free, free + 0.6) - smooth_step(t, 7.2, 7.8);
      const double s = t < free + 0.6 ? 0 : t - free - 0.6;
      return over(options.at_x + 0.5 * reach * std::sin(6.283185307179586 * s / 2.5),
                  options.at_z + 0.2 * reach * std::sin(6.283185307179586 * s / 4.1),
                  hover - (hover + press) * down);
    });
  }
  refuse("unknown script " + options.script);
}

}  // namespace touch
