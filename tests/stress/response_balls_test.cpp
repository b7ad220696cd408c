// SPDX-License-Identifier: MIT

// A ball that rolls over bodies that no closed form knows: finite, bounded, without jumps. PALPATE_PATHS:
// paths over each body.

#include <palpate/response/response_contact.hpp>

#include "support/check.hpp"
#include "support/response_bodies.hpp"
#include "support/walker.hpp"

#include <string>

namespace {
using namespace palpate;
using V = Vec3<double>;
using Ball = SphereContact<double>;

Ball middle(const Ball& l, const Ball& r) {
  Ball m = l;
  m.position = 0.5 * (l.position + r.position);
  m.normal = (l.normal + r.normal).normalized();
  m.depth = 0.5 * (l.depth + r.depth);
  return m;
}

void roll_over(const test::ResponseBody& body) {
  const TriangleBvh<double> tree(body.mesh);
  const ResponseField& field = test::body_field(body);
  const ResponseDisplay display(field, field.mesh().vertices);
  ResponseTick<1> tick(field);
  std::vector<double> u(3 * display.size()), before(u), left(u), right(u);
  const auto draw = [&](const Ball& ball, std::vector<double>& out) {
    (void)tick.solve(ball);
    tick.displace(display, out.data(), 3);
  };
  const auto apart = [](const std::vector<double>& l, const std::vector<double>& r) {
    double largest = 0;
    for (std::size_t k = 0; k < l.size(); ++k) largest = (std::max)(largest, std::abs(l[k] - r[k]));
    return largest;
  };
  const double h = field.mesh().length, modulus = 1e5 / (1 - body.nu * body.nu);
  double force_jump = 0, field_jump = 0, most = 0, stiffest = 0;
  const int paths = test::wanted_paths(72, 10000), steps = 40;
  REQUIRE(paths > 0);
  for (int path = 0; path < paths; ++path) {
    const double R = h * std::array{0.3, 1.0, 3.0}[std::size_t(path) % 3],
                 deepest = R * std::array{0.05, 0.2, 0.5}[std::size_t(path / 3) % 3];
    test::Walker walker(tree, body.mesh, 0.3 * h, unsigned(path));
    Ball last;
    V last_force = V::Zero();
    for (int i = 0; i < steps; ++i) {
      walker.step(0.005 * h);
      const Ball ball{.position = walker.position,
                      .normal = walker.normal,
                      .radius = R,
                      .depth = deepest * (1 + i) / steps};
      const double half_space = 4.0 / 3 * modulus * std::sqrt(R) * std::pow(ball.depth, 1.5);
      const auto force = [&](const Ball& at) { return tick.solve(at).on_body(at.normal); };
      const V F = force(ball);
      REQUIRE(is_finite(F));
      stiffest = (std::max)(stiffest, F.norm() / half_space);
      draw(ball, u);
      for (const double x : u) {
        REQUIRE(is_finite(x));
        most = (std::max)(most, std::abs(x) / ball.depth);
      }
      if (i > 0 && (F - last_force).norm() > 0.1 * half_space) {
        force_jump =
            (std::max)(force_jump, test::left_over(last, ball, middle, [&](const Ball& l, const Ball& r) {
                         return (force(l) - force(r)).norm() / half_space;
                       }));
      }
      if (i > 0 && apart(u, before) > 0.1 * ball.depth) {
        field_jump =
            (std::max)(field_jump, test::left_over(last, ball, middle, [&](const Ball& l, const Ball& r) {
                         draw(l, left);
                         draw(r, right);
                         return apart(left, right) / ball.depth;
                       }));
      }
      last = ball;
      last_force = F;
      before = u;
    }
  }
  MESSAGE(std::string(body.name), ": force per half-space's ", stiffest, ", largest jump of force ",
          force_jump, ", of field ", field_jump, ", largest |u| / d ", most);
  // What a body takes from d_H is bounded by half of it, and a tenth of d is gained at most: (2 x 1.1)^1.5 =
  // 3.26; finite strain, at nu = 0.3, and the force across add up to a quarter.
  CHECK(stiffest < 4.1);
  // As for patches (response_bodies_test.cpp).
  CHECK(force_jump < 0.02);
  CHECK(field_jump < 0.02);
  CHECK(most < 5.5);
}
}  // namespace

TEST_CASE("a ball rolls over bodies that are concave, thin, in pieces, with edges: bounded, without jumps") {
  for (const auto& body : test::response_bodies()) roll_over(body);
}
