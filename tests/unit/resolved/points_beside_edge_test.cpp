// SPDX-License-Identifier: MIT
// Points under a tool's face beside a sharp edge of the body: which face they press on.
#include <palpate/geometry/box.hpp>
#include <palpate/resolved/detail/points_beside_edge.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <vector>

using namespace palpate;

namespace {

constexpr float deep = 1e-3f, area = 1e-6f;

/// A flat face, 1 mm beneath a block's top: its first point is far from the edges, its second so far inside
/// the side at x = 0. Returns the touching points.
std::vector<detail::TouchingPoint> pressed(float inside, const Vec3<float>& outward) {
  const Box<double> block({.half = {0.02, 0.02, 0.02}, .centre = {-0.02, -0.02, 0}});
  SurfaceSamples<double> samples;
  samples.points = {{-0.01, -deep, 0}, {-inside, -deep, 0}};
  samples.areas = {area, area};
  const ToolPoints<double> tool(samples, {.contact_area = 1e-4});
  detail::PointSystem system(4, 0, false);
  detail::BoundedList<detail::TouchingPoint> touching(4);
  std::vector<detail::PointMemory> memory(2);
  const Vec3<float> down(0, -1, 0), in_by_side(-1, 0, 0), far(-0.01f, -deep, 0);
  system.begin_tick();
  system.touch(deep, deep * area, deep * area * far, deep * area * down);
  touching.push_back({0, deep, far, down, down, 0});
  detail::TouchingLeaf leaf{};
  for (int r = 0; r < 3; ++r) {
    leaf.m[std::size_t(r)][1] = in_by_side[r], leaf.outward[std::size_t(r)][1] = outward[r];
    leaf.x[std::size_t(r)][1] = Vec3<float>(-inside, -deep, 0)[r];
  }
  leaf.aside[1] = inside, leaf.has_aside = true;
  detail::PointsBesideEdge<double> beside(4);
  beside.add(leaf, 0, 0);
  CHECK(beside.press(block, tool, Vec3<double>::Zero(), 7, system, touching, memory));
  CHECK((memory[1].tick == 7) == (touching.size() == 2));
  return {touching.begin(), touching.end()};
}

}  // namespace

TEST_CASE("beside an edge a point under the tool's face presses on the top, at once but steadily") {
  const auto points = pressed(5e-4f, {0, -1, 0});  // half a cell inside: whole
  REQUIRE(points.size() == 2);
  CHECK_RELATIVE(points[1].depth, deep, 1e-5);  // of floats
  CHECK((points[1].m - Vec3<float>(0, -1, 0)).norm() <= 1e-5f);
  const auto coming = pressed(1e-4f, {0, -1, 0});  // a third of 0.3 cells
  REQUIRE(coming.size() == 2);
  CHECK_RELATIVE(coming[1].depth, deep / 3, 1e-4);  // of floats
}

TEST_CASE("beside an edge a wall of the tool presses on no other face") {
  CHECK(pressed(5e-4f, {1, 0, 0}).size() == 1);
}

TEST_CASE("beside an edge a point that has hardly come in has a direction of length 1") {
  for (const float inside : {1e-18f, 1e-22f, 1e-30f}) {  // depths whose squares are no floats
    const auto points = pressed(inside, {0, -1, 0});
    for (const auto& p : points) CHECK_RELATIVE(p.m.norm(), 1, 1e-6);  // of floats
    CHECK(points.size() == (inside > 1e-20f ? 2 : 1));
  }
}
