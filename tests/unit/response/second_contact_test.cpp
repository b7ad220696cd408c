// SPDX-License-Identifier: MIT
#include <palpate/response/response_contact.hpp>

#include "support/check.hpp"
#include "support/response_meshes.hpp"

namespace {
using namespace palpate;
using V = Vec3<double>;
using Contact = ResponseContact<double>;

// Cube of 60 mm, fixed at its base.
const ResponseField& cube() {
  static const ResponseField field(test::box_mesh(V(0.06, 0.06, 0.06), 8),
                                   [](const V& p) { return p.y() <= 1e-6; },
                                   {.E = 1e5, .nu = 0.45, .mesh = {.vertices = 180}, .threads = 1});
  return field;
}
Contact pressed(double x, double radius, const V& d) {
  return {.position = V(x, 0.06, 0.03), .normal = V::UnitY(), .radius = radius, .displacement = d};
}
// Force on the first contact, and displacements within both patches and elsewhere.
struct Answer {
  V force, second;
  std::vector<double> u;
  [[nodiscard]] double apart(const Answer& other, const V& d) const {
    const double mean = force.norm() / d.norm();
    double largest = (std::max)((force - other.force).norm(), (second - other.second).norm()) / mean;
    for (std::size_t i = 0; i < u.size(); ++i) largest = (std::max)(largest, std::abs(u[i] - other.u[i]));
    return largest / d.norm();
  }
};
Answer answer(const Contact* contacts, std::size_t count) {
  static const ResponseDisplay display(
      cube(), std::vector<V>{V(0.02, 0.06, 0.03), V(0.023, 0.06, 0.031), V(0.04, 0.06, 0.03),
                             V(0.042, 0.06, 0.029), V(0.052, 0.06, 0.03), V(0.054, 0.06, 0.029),
                             V(0.03, 0.06, 0.05), V(0.06, 0.04, 0.03), V(0.03, 0.03, 0)});
  ResponseTick<2> tick(cube());
  V F[2] = {V::Zero(), V::Zero()};
  Answer out;
  tick.solve(contacts, count, F);
  out.force = F[0];
  out.second = F[1];
  out.u.resize(3 * display.size());
  tick.displace(display, out.u.data(), 3);
  return out;
}
}  // namespace

TEST_CASE(
    "a second contact comes in where the first has moved the surface: gradually, whichever way it goes") {
  const V d(0, -2e-3, 4e-4);
  for (const double radius : {0.004, 0.016}) {  // narrow, and wide for its mesh
    const Contact first = pressed(0.02, radius, d);
    const Answer alone = answer(&first, 1);
    for (const V& displacement : {V(0, -1e-3, 0), V(3e-4, -8e-4, 0), V(5e-4, 5e-4, 0)}) {
      const auto with = [&](double part) {
        const Contact both[2] = {first, pressed(0.036 + radius, 0.004, V(part * displacement))};
        return answer(both, 2);
      };
      // Of d, and of the force for it. Sums in float: 4e-7 met. A contact that kept its position at once
      // would be at 0.1.
      CHECK(with(1e-9).apart(alone, d) < 1e-5);
      const auto largest_step = [&](int n) {
        double step = 0;
        Answer before = with(0);
        for (int i = 1; i <= n; ++i) {
          const Answer now = with(double(i) / n);
          step = (std::max)(step, now.apart(before, d));
          before = now;
        }
        return step;
      };
      const double coarse = largest_step(400), fine = largest_step(1600);
      MESSAGE("radius ", radius, ": largest step ", coarse, " of 400, ", fine, " of 1600");
      CHECK(fine < 0.3 * coarse);  // a quarter; a jump would stay
    }
  }
}

TEST_CASE("contacts that are alike hold each other as ever") {
  const V d(0, -1e-3, 0);
  const Contact both[2] = {pressed(0.02, 0.004, d), pressed(0.0201, 0.004, d)};
  const Answer one = answer(both, 1), two = answer(both, 2);
  // At one position they share one contact's force, less the share of the mean over two patches instead of
  // one.
  CHECK((two.force - two.second).norm() < 0.1 * two.force.norm());
  CHECK((two.force + two.second).norm() > 0.9 * one.force.norm());
}

TEST_CASE(
    "what a force does beneath another patch: the same by the patch's loads as by the field, by "
    "reciprocity") {
  detail::ContactSystem<2> system(cube(), {.second_order = false});
  const Contact contacts[2] = {pressed(0.015, 0.003, V(2e-4, -1e-3, 1e-4)),
                               pressed(0.04, 0.003, V(0, -1e-3, 0))};
  for (std::size_t i = 0; i < 2; ++i) {
    system.place(i, {.x = contacts[i].position,
                     .m = -contacts[i].normal,
                     .d = contacts[i].displacement,
                     .rotation = V::Zero(),
                     .a = contacts[i].radius});
  }
  system.solve(1);
  const detail::Indenter& c = system.placed(1).tool;
  const V bent = detail::coupling_of_moments(cube(), system.placed(0), system.placed(1)).transpose() *
                 system.solved(0).P;
  const double step = 0.5 * cube().mesh().length;  // over which the loads' influence functions are slopes
  std::vector<V> points;
  for (const V& t : {c.t1(), c.t2()})
    for (const double side : {-step, step}) points.push_back(c.x + side * t);
  ResponseTick<1> tick(cube(), {.second_order = false});
  V F;
  tick.solve(contacts, 1, &F);
  std::vector<double> u(12);
  tick.displace(ResponseDisplay(cube(), points), u.data(), 3);
  const auto slope = [&](std::size_t t) {
    const double* low = &u[6 * t];
    return V((V(low[3], low[4], low[5]) - V(low[0], low[1], low[2])) / (2 * step));
  };
  const V seen(0.5 * (slope(0).dot(c.t1()) + slope(1).dot(c.t2())), slope(0).dot(c.m), slope(1).dot(c.m));
  MESSAGE("spread and slopes: by the loads ", bent.transpose(), ", seen ", seen.transpose());
  // The influence functions' slopes are fitted to neighbours an edge away, the field's taken over one: 8 %
  // apart on this mesh of 180.
  CHECK((bent - seen).norm() < 0.15 * seen.norm());
}
