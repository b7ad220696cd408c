// SPDX-License-Identifier: MIT

// Continuity in time under the tool (V.B): while a contact wanders, grows and sinks, no vertex moves further
// in one tick than a stated factor times the tick's step.

#include "support/check.hpp"

#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/luo_xiao/displacement_field.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace palpate;

namespace {

/// Max change of a vertex per tick over the depth, by the step: how far the contact moves in units of its
/// radius, and its radius, depth and displacement in parts of themselves.
template <class I, class N>
double steepest(const N& neighbourhood) {
  using S = double;
  const Ellipsoid<S> body({.axes = {0.03, 0.02, 0.02}});
  const MeshData<S> mesh = body.mesh(1500);
  DisplacementField<I, N> field(I(make_partition(body, mesh)), neighbourhood, mesh, {.normals = false});
  std::vector<S> now(3 * mesh.vertices.size()), last(now.size());
  const VertexBuffer<S> out{.positions = now.data()};
  field.write_rest(out);
  std::mt19937_64 random(34);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vec3<S>(unit(random), unit(random), unit(random)); };
  double worst = 0;
  for (int path = 0; path < 300; ++path) {
    const Vec3<S> start = body.closest(vector() * 0.1).position, heading = vector().normalized();
    const double step = std::pow(10.0, -3 + 0.8 * unit(random)), radius = 4e-3 + 2e-3 * unit(random),
                 depth = 2e-3 + 1.5e-3 * unit(random), D = depth * (0.7 + 0.3 * unit(random));
    const Vec3<S> skew = 0.3 * vector();
    for (int tick = 0; tick < 5; ++tick) {
      const double grown = 1 + step * tick, a = radius * grown;
      const auto at = body.closest(start + step * radius * tick * heading);
      const std::vector<ContactDisplacement<S>> contact{
          {.position = at.position,
           .normal = at.normal,
           .displacement = D * grown * (tangential<S>(skew, at.normal) - at.normal),
           .area = 3.141592653589793 * a * a,
           .depth = depth * grown}};
      field.write(contact, std::vector<Vec3<S>>(6, Vec3<S>::Zero()), out);
      for (std::size_t i = 0; tick > 0 && i < mesh.vertices.size(); ++i) {
        const Vec3<S> moved(now[3 * i] - last[3 * i], now[3 * i + 1] - last[3 * i + 1],
                            now[3 * i + 2] - last[3 * i + 2]);
        worst = std::max(worst, moved.norm() / (depth * step));
      }
      last = now;
    }
  }
  return worst;
}

}  // namespace

// |b'| a <= 15/8 * 2 a R/(R^2 - a^2) = 2.5 with R = 2 a; the depth's own growth 1, the plane's turn on the
// body's sharpest end (radius 13 mm, a up to 6 mm) 1. The field's part is that of
// interpolation_paths_test.cpp, 40 (linear) and 160 (Phong) times a over the body's half diagonal, at most
// 0.15.
TEST_CASE("a contact that wanders, grows and sinks: no vertex jumps") {
  const AreaNeighbourhood<double> local({.reference_area = 2e-5});
  const double linear = steepest<LinearInterpolation<double>>(local),
               phong = steepest<PhongInterpolation<double>>(local),
               printed = steepest<LinearInterpolation<double>>(
                   Printed<AreaNeighbourhood<double>>({.reference_area = 2e-5}));
  MESSAGE("seed 34, steepest: linear ", linear, ", Phong ", phong, ", printed ", printed);
  CHECK(linear <= 4.5 + 40 * 0.15);
  CHECK(phong <= 4.5 + 160 * 0.15);
  CHECK(printed <= 4.5 + 40 * 0.15);
}
