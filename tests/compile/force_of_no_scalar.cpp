// SPDX-License-Identifier: MIT
// expect: HasScalar
// expect: Scalar
#include <palpate/law/force/concept.hpp>

#ifdef PALPATE_MUST_FAIL
using Number = int;  // a scalar is a floating point type
#else
using Number = double;
#endif

struct Spring {
  using Scalar = Number;
  Number force(Number depth) const noexcept { return depth > 0 ? depth : 0; }
  Number stiffness(Number depth) const noexcept { return depth > 0 ? 1 : 0; }
  Number energy(Number depth) const noexcept { return depth > 0 ? depth * depth / 2 : 0; }
  Number depth(Number force) const noexcept { return force; }
  Number max_depth() const noexcept { return 1000; }
};

template <palpate::ForceLaw Law>
struct Solver {
  Law law;
};

int main() { return Solver<Spring>{}.law.force(0) > 0; }
