// SPDX-License-Identifier: MIT
#include <palpate/response/response_contact.hpp>

#include "reference/half_space_truth.hpp"
#include "support/check.hpp"
#include "support/response_meshes.hpp"

#include <array>

namespace {
using namespace palpate;
using V = Vec3<double>;

// What a tick draws beyond small strain at `points` on a block of 60 x 30 x 60 patch radii, in parts of the
// patch's displacement.
class HalfSpace {
 public:
  HalfSpace()
      : field_(block(), [](const V& p) { return p.y() < -29.999; },
               {.E = 1, .nu = 0.49, .mesh = {.vertices = 150}, .threads = 1}) {}

  [[nodiscard]] std::vector<V> beyond_linear(const std::vector<V>& points, const V& d,
                                             double displacement) const {
    const ResponseDisplay display(field_, points);
    std::vector<V> out(points.size(), V::Zero());
    for (const bool second : {true, false}) {
      ResponseTick<1> tick(field_, {.second_order = second});
      const ResponseContact<double> contact{.normal = V::UnitY(), .radius = 1, .displacement = d};
      V force;
      tick.solve(&contact, 1, &force);
      std::vector<double> u(3 * points.size());
      tick.displace(display, u.data(), 3);
      for (std::size_t i = 0; i < points.size(); ++i)
        out[i] += (second ? 1 : -1) / displacement * V(u[3 * i], u[3 * i + 1], u[3 * i + 2]);
    }
    return out;
  }

 private:
  static MeshData<double> block() {
    MeshData<double> mesh = test::box_mesh(V(60, 30, 60), 8);
    for (auto& p : mesh.vertices) p -= V(30, 30, 30);
    return mesh;
  }
  ResponseField field_;
};
const HalfSpace& rubber() {
  static const HalfSpace block;
  return block;
}
}  // namespace

// Bounds: a quarter more than the largest that the fit leaves, 0.016. Terms that do not change with depth
// leave 0.027, askew 0.067.
TEST_CASE("around a disc on a half-space, to 1.2 radii deep: finite elements") {
  std::vector<V> right, left;
  for (const auto& t : test::half_space_truth) {
    right.push_back(V(t.s, 0, 0));
    left.push_back(V(-t.s, 0, 0));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double depth = test::half_space_pressed[k];
    const auto u = rubber().beyond_linear(right, V(0, -depth, 0), depth);
    double error = 0, size = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const auto& exact = test::half_space_truth[i].pressed[k];
      error = (std::max)(error, std::hypot(u[i].x() - exact[0], -u[i].y() - exact[1]));
      size = (std::max)(size, std::hypot(exact[0], exact[1]));
    }
    MESSAGE("pressed ", depth, " radii: largest error ", error, " of the displacement, of ", size);
    CHECK(error < 0.02);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const double depth = test::half_space_askew[k], angle = 35 * std::numbers::pi / 180;
    const V d = depth * V(std::sin(angle), -std::cos(angle), 0);
    const auto r = rubber().beyond_linear(right, d, depth), l = rubber().beyond_linear(left, d, depth);
    double error = 0;
    for (std::size_t i = 0; i < r.size(); ++i)
      error = (std::max)(error, std::abs(0.5 * (r[i].x() + l[i].x()) - test::half_space_truth[i].askew[k]));
    MESSAGE("askew ", depth, " radii: largest error ", error, " of the displacement");
    CHECK(error < 0.02);
  }
}

TEST_CASE("near terms are bounded beyond two radii and where the disc pulls, and go there gradually") {
  const std::vector<V> points{V(1.3, 0, 0), V(0, 0, 2)};
  const auto drawn = [&points](double depth) { return rubber().beyond_linear(points, V(0, -depth, 0), 1); };
  double largest = 0;
  std::vector<V> last = drawn(-3);
  for (int i = -299; i <= 300; ++i) {
    const std::vector<V> u = drawn(0.01 * i);
    for (std::size_t k = 0; k < u.size(); ++k) largest = (std::max)(largest, (u[k] - last[k]).norm());
    last = u;
  }
  // A slope of the drawn field by depth of 1 at most; nothing jumps.
  CHECK(largest < 0.01);
}

TEST_CASE(
    "constants of second order: nu = 1/2 as they are, less of some and more of others down to nu = 0.3") {
  const SecondOrder half = SecondOrder{}.at(0.5), least = SecondOrder{}.at(0.3);
  const auto of = [](const SecondOrder& k) {
    return std::array{k.radial,        k.radial_4.shallow,
                      k.radial_4.deep, k.radial_6.shallow,
                      k.radial_6.deep, k.slide.shallow,
                      k.slide.deep,    k.softening,
                      k.drag,          k.tip,
                      k.sphere_spread, k.sphere_softening,
                      k.normal_4.deep, k.normal_6.deep,
                      k.couple_slid,   k.couple_sunk,
                      k.lever,         k.rotated,
                      k.crossed,       k.ease,
                      k.foreshortened, k.sphere_dipole};
  };
  const auto all = of(SecondOrder{});
  CHECK(of(half) == all);
  // b = 0.4: (2 nu)^3, seven times 1 - 2.5 b, 1 + 1.3 b, 1 - b, 1 + 1.7 b, 1 - 0.4 b; all others stay.
  const std::array factor{0.216, 0., 0., 0., 0., 0., 0., 0., 1.52, 0.6, 1.68, 0.84};
  for (std::size_t i = 0; i < all.size(); ++i) {
    CAPTURE(i);
    const double wanted = (i < factor.size() ? factor[i] : 1) * all[i];
    CHECK(std::abs(of(least)[i] - wanted) <= 1e-15);  // roundings of numbers below 3
  }
  CHECK(of(SecondOrder{}.at(0.1)) == of(least));
  // By how much a surface is drawn in is known of every nu: 3/(4 pi), 0.24/(0.7 pi).
  CHECK(half.sphere_drawn_in == 0);
  CHECK_RELATIVE(least.sphere_drawn_in, 0.24 / (0.7 * std::numbers::pi), test::ulps<double>(8));
  CHECK_RELATIVE(SecondOrder{}.at(0).sphere_drawn_in, 3 / (4 * std::numbers::pi), test::ulps<double>(8));
}
