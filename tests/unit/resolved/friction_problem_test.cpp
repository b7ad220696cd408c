// SPDX-License-Identifier: MIT
// The solve for loads with friction alone, on a few points whose answer is known.
#include <palpate/resolved/detail/friction_problem.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <algorithm>

using namespace palpate;
using detail::VectorList;

namespace {

using V = Vec3<float>;
constexpr int n = 12;
constexpr float mu = 0.3f;
constexpr float tangential = 1.5f;

/// Points that press on a slender part: each with a compliance of its own, 1 along m and 1.5 across it, and
/// all together with C, up to 1,000 times that, along directions of its own.
struct SlenderPart {
  VectorList m;
  Mat3<float> common;

  explicit SlenderPart(const V& compliance) {
    m.resize(n);
    for (int i = 0; i < n; ++i)
      m.set(std::size_t(i), V(0.05f * float(i % 4), 1, 0.04f * float(i / 4)).normalized());
    const Mat3<float> turned = Eigen::AngleAxisf(0.5f, V(1, 2, 3).normalized()).toRotationMatrix();
    common = turned * compliance.asDiagonal() * turned.transpose();
  }
  void operator()(const VectorList& P, VectorList& u) const {
    V sum = V::Zero();
    for (std::size_t i = 0; i < n; ++i) sum += P[i];
    for (std::size_t i = 0; i < n; ++i)
      u.set(i, tangential * P[i] + (1 - tangential) * m[i].dot(P[i]) * m[i] + common * sum);
  }
};

struct Solved {
  detail::Remainder left;
  float off = 0;  // of the loads, largest
};

/// From nothing to loads of which every third sticks, every third slips, and every third touches no more.
/// `lean`: of the cones' axes, over m.
Solved solve(const SlenderPart& part, const Mat3<float>& taken_for, float lean = 0) {
  VectorList wanted, u, axes;
  for (auto* list : {&wanted, &u, &axes}) list->resize(n);
  const auto across = [&](std::size_t i) { return V(part.m[i].cross(V::UnitX()).normalized()); };
  for (std::size_t i = 0; i < n; ++i) {
    const float q = i % 3 == 2 ? 0 : 1 + 0.1f * float(i);
    axes.set(i, part.m[i] + lean * part.m[i].cross(V::UnitZ()));
    wanted.set(i, q * (axes[i] + (i % 3 == 1 ? mu : 0.5f * mu) * across(i)));
  }
  part(wanted, u);
  detail::FrictionLists lists;
  lists.resize(n);
  AlignedList<float> d;
  d.resize(AlignedList<float>::padded(n));
  for (std::size_t i = 0; i < n; ++i) {
    const V normal = part.m[i];
    d[i] = normal.dot(u[i]) - (i % 3 == 2 ? 0.5f : 0.f);  // those apart by 0.5
    lists.anchor.set(i, u[i] - normal.dot(u[i]) * normal + (i % 3 == 1 ? 0.7f : 0.f) * across(i));
    lists.anchored[i] = lists.per_mu[i] = 1;
  }
  Solved out{.left = detail::solve_loads(
                 n, lists, part.m, axes, d.data(), {1, tangential, taken_for}, 1e-3f, 50,
                 [&](const VectorList& P, VectorList& moved) { part(P, moved); }, [](float) { return mu; })};
  for (std::size_t i = 0; i < n; ++i) out.off = (std::max)(out.off, (lists.load[i] - wanted[i]).norm());
  return out;
}

}  // namespace

TEST_CASE("loads with friction: what a slender part does as a whole costs no iterations") {
  for (const V& compliance : {V(1, 1, 1), V(30, 10, 100), V(300, 100, 1000)}) {
    const SlenderPart part(compliance);
    CAPTURE(compliance.z());
    const Solved solved = solve(part, part.common);
    CHECK(solved.left.norm <= solved.left.tolerance);
    CHECK(solved.left.iterations <= 6);                     // measured: 1, 2, 4
    CHECK(solved.off <= solved.left.tolerance);             // over the points' own compliance, 1
    const Solved leaning = solve(part, part.common, 0.2f);  // 2/3 of the cone's slope
    CHECK(leaning.left.norm <= leaning.left.tolerance);
    CHECK(leaning.left.iterations <= 6);  // measured: 3
    CHECK(leaning.off <= leaning.left.tolerance);
    // What it is taken for need not be what it is. Measured: 5, 11, 14 iterations.
    const Solved roughly = solve(part, 0.7f * part.common);
    CHECK(roughly.left.norm <= roughly.left.tolerance);
    CHECK(roughly.left.iterations <= 25);
  }
  // Without: 11 after 50 iterations, of depths of 14,000.
  CHECK(solve(SlenderPart(V(300, 100, 1000)), Mat3<float>::Zero()).left.norm > 1);
}
