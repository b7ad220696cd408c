// SPDX-License-Identifier: MIT
// expect: HasStiffness
// expect: law.stiffness\(depth\)
// expect-gcc: the required expression 'law.stiffness\(depth\)' is invalid
// expect-clang: no member named 'stiffness' in 'Spring'
#include <palpate/law/force/concept.hpp>

struct Spring {
  using Scalar = double;
  double force(double depth) const noexcept { return depth > 0 ? depth : 0; }
#ifndef PALPATE_MUST_FAIL
  double stiffness(double depth) const noexcept { return depth > 0 ? 1 : 0; }
#endif
  double energy(double depth) const noexcept { return depth > 0 ? depth * depth / 2 : 0; }
  double depth(double force) const noexcept { return force; }
  double max_depth() const noexcept { return 1e300; }
};

template <palpate::ForceLaw Law>
struct Solver {
  Law law;
};

int main() { return Solver<Spring>{}.law.force(0) > 0; }
