// SPDX-License-Identifier: MIT
// expect: HasForce
// expect: law.force\(depth\)
// expect-gcc: is not 'noexcept'
// expect-clang: may throw an exception
#include <palpate/law/force/concept.hpp>

#ifdef PALPATE_MUST_FAIL
#define MAYBE_NOEXCEPT
#else
#define MAYBE_NOEXCEPT noexcept
#endif

struct Spring {
  using Scalar = double;
  double force(double depth) const MAYBE_NOEXCEPT { return depth > 0 ? depth : 0; }
  double stiffness(double depth) const noexcept { return depth > 0 ? 1 : 0; }
  double energy(double depth) const noexcept { return depth > 0 ? depth * depth / 2 : 0; }
  double depth(double force) const noexcept { return force; }
  double max_depth() const noexcept { return 1e300; }
};

template <palpate::ForceLaw Law>
struct Solver {
  Law law;
};

int main() { return Solver<Spring>{}.law.force(0) > 0; }
