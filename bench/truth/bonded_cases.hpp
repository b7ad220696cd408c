// SPDX-License-Identifier: MIT
#pragma once

/// @file The cases of docs/accuracy.md with bonded patches, and with a frictionless ball.

#include "truth/tetrahedra.hpp"

namespace bench {

struct Case {
  const char* name;
  Body body;
  double E, nu;  // [MPa], -
  std::vector<Patch> patches;
  std::vector<double> depths;  // [mm]
  bool ball = false;           // a frictionless ball of the patch's radius instead
};

// `lean` degrees off the normal, towards `aside`.
inline V leaning(const V& normal, const V& aside, double lean) {
  const double angle = lean * std::acos(-1.0) / 180;
  return -std::cos(angle) * normal + std::sin(angle) * aside;
}
inline Patch on_top(double x, double y, double z, double radius, double lean = 0) {
  return {{x, y, z}, V::UnitY(), leaning(V::UnitY(), V::UnitX(), lean), radius, 1};
}
// Tilted about the axis z by `turn` [rad] with each mm of depth, and pressed by `factor` of it.
inline Patch turned(Patch p, double turn, double factor = 1) {
  p.turn = turn * V::UnitZ();
  p.factor = factor;
  return p;
}
// About its inward normal, not pressed.
inline Patch twisted(Patch p, double turn) {
  p.turn = -turn * p.normal;
  p.factor = 0;
  return p;
}
// On an ellipsoid, `angle` degrees (of its parameter) from the top towards x.
inline Patch on_flank(const V& axes, double angle, double radius, double lean = 0) {
  const double t = angle * std::acos(-1.0) / 180;
  const V position(axes.x() * std::sin(t), axes.y() * std::cos(t), 0);
  const V normal = position.cwiseQuotient(axes.cwiseProduct(axes)).normalized();
  return {position, normal, leaning(normal, V(normal.y(), -normal.x(), 0), lean), radius, 1};
}

inline std::vector<Case> cases() {
  const auto box = [](double x, double y, double z, bool half_x = false, bool half_z = true) {
    return Body{Body::box, {x, y, z}, 0, half_x, half_z};
  };
  const Body ellipsoid{Body::ellipsoid, {60, 40, 40}, -36, true, true},
      a{Body::ellipsoid, {50, 35, 30}, -28, false, true}, A{Body::ellipsoid, {50, 45, 35}, -42, false, true};
  const Body large = box(200, 100, 200, true), block = box(80, 50, 60);
  const V pushed = -V::UnitX();
  return {
      {"half_space",
       box(300, 150, 300, true),
       1,
       0.49,
       {on_top(0, 150, 0, 5)},
       {0.5, 1, 2, 3, 4, 5, 6, 8, 10}},
      {"half_space_askew", box(300, 150, 300), 1, 0.49, {on_top(0, 150, 0, 5, 35)}, {0.5, 1, 2, 3, 4, 5}},
      {"ellipsoid_top", ellipsoid, 1.5, 0.49, {on_top(0, 40, 0, 5)}, {1, 2, 4, 6, 8, 10}},
      {"cube", box(100, 100, 100, true), 1, 0.49, {on_top(0, 100, 0, 10)}, {1, 2, 4, 8, 12}},
      {"ellipsoid_askew", a, 1, 0.49, {on_flank(a.size, 40, 4, 25)}, {1, 2, 4, 6}},
      {"block_head", box(80, 50, 60), 1, 0.49, {on_top(8, 50, 0, 20)}, {1, 2, 4, 7, 10}},
      {"block_edge", box(80, 50, 60), 1, 0.49, {on_top(28, 50, 0, 6)}, {1, 2, 4, 6, 9}},
      {"block_askew", box(80, 50, 60), 1, 0.49, {on_top(0, 50, 0, 6, 30)}, {1, 2, 4, 6}},
      {"slab", box(120, 30, 100, true), 1, 0.49, {on_top(0, 30, 0, 8)}, {1, 2, 4, 6, 9}},
      {"block_askew_nu3", box(80, 50, 60), 1, 0.3, {on_top(0, 50, 0, 6, 30)}, {1, 2, 3}},
      {"cylinder_rim",
       {Body::cylinder, {30, 50, 30}, 0, false, true},
       1,
       0.49,
       {on_top(19, 50, 0, 6)},
       {1, 2, 4, 6, 9}},
      {"cylinder_head",
       {Body::cylinder, {30, 45, 30}, 0, false, true},
       1,
       0.49,
       {on_top(4, 45, 0, 15)},
       {1, 2, 4, 6, 9}},
      {"flat_block_edge", box(100, 40, 80), 1, 0.49, {on_top(40, 40, 0, 5)}, {1, 2, 4, 6}},
      {"wall", box(20, 60, 80), 1, 0.49, {{{10, 40, 0}, V::UnitX(), pushed, 5, 1}}, {1, 2, 4, 6}},
      {"ellipsoid_top_nu3", ellipsoid, 1.5, 0.3, {on_top(0, 40, 0, 5)}, {1, 2, 3, 4}},
      {"block_edge_askew", box(90, 45, 70), 1, 0.49, {on_top(30, 45, 0, 6, 20)}, {1, 2, 4, 7}},
      {"block_near_edge", box(110, 55, 76), 1, 0.49, {on_top(46.5, 55, 0, 4.5)}, {1, 2, 3.5, 5}},
      {"thin_slab", box(90, 28, 100, true), 1, 0.49, {on_top(0, 28, 0, 5)}, {1, 2, 4, 6}},
      {"ellipsoid_held_low", A, 1, 0.49, {on_flank(A.size, 50, 6, 30)}, {1, 2, 4, 6, 9}},
      {"block_two",
       box(100, 60, 80),
       1,
       0.49,
       {on_top(-20, 60, 0, 6), on_top(22, 60, 0, 8)},
       {1, 2, 4, 6, 9}},
      {"tilt", block, 1, 0.49, {turned(on_top(0, 50, 0, 6), 0.1, 0)}, {0.5, 1, 2, 3}},
      {"tilt_nu3", block, 1, 0.3, {turned(on_top(0, 50, 0, 6), 0.1, 0)}, {0.5, 1, 2, 3}},
      {"tilt_edge", block, 1, 0.49, {turned(on_top(28, 50, 0, 6), 0.1, 0)}, {0.5, 1, 2, 3}},
      {"tilt_pressed",
       box(200, 100, 200),
       1,
       0.49,
       {turned(on_top(0, 100, 0, 5), 0.06)},
       {0.5, 1, 2, 3, 4, 5}},
      {"tilt_pressed_nu3",
       box(200, 100, 200),
       1,
       0.3,
       {turned(on_top(0, 100, 0, 5), 0.06)},
       {0.5, 1, 1.5, 2, 2.5, 3}},
      {"tilt_askew",
       box(200, 100, 200),
       1,
       0.49,
       {turned(on_top(0, 100, 0, 5, 35), 0.06)},
       {0.5, 1, 2, 3, 4, 5}},
      {"tilt_pressed_edge", block, 1, 0.49, {turned(on_top(28, 50, 0, 6), -0.04)}, {1, 2, 4, 6}},
      {"tilt_flank", a, 1, 0.49, {turned(on_flank(a.size, 40, 4, 25), 0.06)}, {1, 2, 4}},
      {"twist",
       {Body::ellipsoid, a.size, a.fixed_height},
       1,
       0.49,
       {twisted(on_flank(a.size, 40, 6), 0.1)},
       {0.5, 1, 2, 3}},
      {"ball_ellipsoid", ellipsoid, 1.5, 0.49, {on_top(0, 40, 0, 15)}, {0.5, 1, 2, 4, 8, 12}, true},
      {"ball_half_space", large, 1, 0.49, {on_top(0, 100, 0, 10)}, {0.5, 1, 2, 3, 4, 5}, true},
      {"ball_half_space_nu3", large, 1, 0.3, {on_top(0, 100, 0, 10)}, {0.5, 1, 2, 3, 4, 5}, true},
      {"ball_block", box(80, 50, 60, true), 1, 0.49, {on_top(0, 50, 0, 12)}, {0.5, 1, 2, 4, 8}, true},
      {"ball_edge", box(80, 50, 60), 1, 0.49, {on_top(28, 50, 0, 10)}, {0.5, 1, 2, 4, 6}, true},
      {"ball_slab", box(120, 30, 100, true), 1, 0.49, {on_top(0, 30, 0, 15)}, {0.5, 1, 2, 4, 7}, true},
      {"ball_flank", a, 1, 0.49, {on_flank(a.size, 40, 10)}, {0.5, 1, 2, 4, 7}, true},
  };
}

}  // namespace bench
