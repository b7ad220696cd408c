// SPDX-License-Identifier: MIT
#include <palpate/response/response_contact.hpp>
#include <palpate/response/setup/load_positions.hpp>

#include "support/check.hpp"
#include "support/response_meshes.hpp"

#include <map>

namespace {
using namespace palpate;
using V = Vec3<double>;
using detail::LoadPositions;

ElementMesh element_mesh(const MeshData<double>& body, double base, double vertices) {
  std::vector<std::uint8_t> fixed;
  const auto& v = body.vertices;
  for (const auto& t : body.triangles)
    fixed.push_back((std::max)({v[t[0]].y(), v[t[1]].y(), v[t[2]].y()}) < base);
  return make_element_mesh(SmoothSurface(body), fixed, {.vertices = vertices});
}
MeshData<double> cube_mesh() { return test::box_mesh(V(0.1, 0.1, 0.1), 8); }

// Displacement of the free surface by a patch pressed 1 mm at x into the top of a cube of 100 mm, to first
// order, and its force.
struct Cube {
  explicit Cube(double vertices)
      : field(cube_mesh(), [](const V& p) { return p.y() < 1e-6; },
              {.E = 1e5, .nu = 0.49, .mesh = {.vertices = vertices}}),
        display(field, cube_mesh().vertices),
        tick(field, {.second_order = false}) {}
  std::pair<std::vector<double>, double> press(const V& x) {
    const ResponseContact<double> contact{
        .position = x, .normal = V::UnitY(), .radius = 0.008, .displacement = V(0, -0.001, 0)};
    V force = V::Zero();
    tick.solve(&contact, 1, &force);
    std::vector<double> u(3 * display.size());
    tick.displace(display, u.data(), 3);
    return {u, force.norm()};
  }
  ResponseField field;
  ResponseDisplay display;
  ResponseTick<1> tick;
};
}  // namespace

TEST_CASE("load mesh: closed, unfolded; only edges within half their distance to a crease are whole") {
  const ElementMesh solve = element_mesh(cube_mesh(), 1e-6, 150);
  const LoadMesh touch = LoadPositions(solve).load_mesh();
  const auto node = [&](std::uint32_t k) { return touch.nodes()[k]; };
  std::map<std::array<std::uint32_t, 2>, int> sides;
  for (const auto& t : touch.triangles()) {
    CHECK((node(t[1]).source - node(t[0]).source)
              .cross(node(t[2]).source - node(t[0]).source)
              .dot(node(t[0]).normal + node(t[1]).normal + node(t[2]).normal) > 0);
    for (std::size_t c = 0; c < 3; ++c) ++sides[{t[c], t[(c + 1) % 3]}];
  }
  for (const auto& [side, count] : sides) {
    CHECK(count == 1);
    CHECK(sides.contains({side[1], side[0]}));
  }
  int middles = 0;
  for (const LoadNode& k : touch.nodes()) {
    const auto& corner = solve.triangles[k.triangle];
    V x = V::Zero();
    for (std::size_t c = 0; c < 3; ++c) x += double(k.part[Eigen::Index(c)]) * solve.vertices[corner[c]];
    CHECK((x - k.source).norm() < 1e-6 * k.size);  // parts are in float
    middles += k.part.maxCoeff() < 0.99f && !k.crease;
  }
  CHECK(middles > 50);
  int uncut = 0;
  for (const auto& [side, count] : sides) {
    const LoadNode a = node(side[0]), b = node(side[1]);
    if (a.normal.y() < 0.99 || b.normal.y() < 0.99 || a.crease || b.crease)
      continue;  // on the top face, within
    if (a.part.maxCoeff() < 1 || b.part.maxCoeff() < 1) continue;
    const V half = 0.5 * (a.source + b.source);
    CHECK((a.source - b.source).norm() <=
          0.5 * (std::min)({half.x(), 0.1 - half.x(), half.z(), 0.1 - half.z()}));
    ++uncut;
  }
  CHECK(uncut > 0);
}

TEST_CASE("load mesh: where no free crease is, loads are put at the nodes alone") {
  const ElementMesh solve = element_mesh(test::ellipsoid_mesh(V(0.05, 0.04, 0.03), 10), -0.025, 150);
  const LoadMesh touch = LoadPositions(solve).load_mesh();
  for (std::size_t k = 0; k < touch.solved(); ++k)
    CHECK((touch.nodes()[k].crease || touch.nodes()[k].part.maxCoeff() == 1.f));
}

TEST_CASE("gradients along the surface: of a linear function exactly, at every node of a flat face") {
  const ElementMesh solve = element_mesh(cube_mesh(), 1e-6, 150);
  const LoadPositions positions(solve);
  const LoadMesh touch = positions.load_mesh();
  const V slope(1, 2, -3);
  for (std::size_t k = 0; k < positions.solved_or_fixed(); ++k) {
    V gradient = V::Zero();
    for (const auto& w : positions.gradient(k)) gradient += slope.dot(touch.nodes()[w.node].source) * w.g;
    const V along = tangential(slope, touch.nodes()[k].normal);
    CHECK((gradient - along).norm() < 1e-5 * along.norm());  // the fit's least moments are 1e-6 of the others
  }
}

TEST_CASE("sharpened loads: a quadratic's mean over a flat face, by linear interpolation between the nodes") {
  const ElementMesh solve = element_mesh(test::box_mesh(V(0.1, 0.02, 0.1), 8), 1e-6, 400);
  const LoadPositions positions(solve);
  const LoadMesh touch = positions.load_mesh();
  for (const V& by : {V(1, 0, 0), V(0, 0, 1), V(1, 0, 1), V(0.5, 0, -1)}) {
    const auto h = [&by](const V& x) { return by.x() * x.x() * x.x() + by.z() * x.z() * x.z(); };
    double linear = 0, sharpened = 0, right = 0;
    for (const auto& t : touch.triangles()) {
      std::array<V, 3> x;
      double missing = 0;
      bool known = true;
      for (std::size_t c = 0; c < 3; ++c) {
        x[c] = touch.nodes()[t[c]].source;
        if (t[c] >= positions.solved_or_fixed() || positions.sharpening(t[c]).empty()) {
          known = false;
          break;
        }
        for (const auto& [node, weight] : positions.sharpening(t[c]))
          missing += weight * h(touch.nodes()[node].source) / 3;
      }
      if (!known || touch.nodes()[t[0]].normal.y() < 0.99) continue;
      const double area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm(),
                   mean = (h(x[0]) + h(x[1]) + h(x[2])) / 3;
      linear += area * mean;
      sharpened += area * (mean + missing);
      for (std::size_t c = 0; c < 3; ++c) right += area * h(0.5 * (x[c] + x[(c + 1) % 3])) / 3;
    }
    INFO("by ", by.transpose(), ": of linear interpolation's error is left ",
         (sharpened - right) / (linear - right));
    REQUIRE(linear != right);
    CHECK(std::abs(sharpened - right) < 0.05 * std::abs(linear - right));  // 0.02
  }
}

TEST_CASE("next to an edge a contact between two nodes is as right as at one") {
  Cube coarse(120), fine(400);
  double worst = 0, worst_force = 0;
  for (int i = 0; i <= 24; ++i) {
    const V x(0.05 + 0.0005 * i, 0.1,
              0.05 + 0.0015 * i);  // to 14 mm from the edge; edges are up to 30 mm long
    const auto [u, force] = coarse.press(x);
    const auto [v, right] = fine.press(x);
    double error = 0, all = 0;
    for (std::size_t k = 0; k < u.size(); ++k) error += (u[k] - v[k]) * (u[k] - v[k]), all += v[k] * v[k];
    worst = (std::max)(worst, std::sqrt(error / all));
    worst_force = (std::max)(worst_force, std::abs(force / right - 1));
  }
  MESSAGE("120 against 400 vertices: field ", worst, ", force ", worst_force);
  CHECK(worst < 0.08);        // 0.054; with loads at the nodes alone 0.17
  CHECK(worst_force < 0.01);  // 0.005; 0.017
}
