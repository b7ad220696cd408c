// SPDX-License-Identifier: MIT
// A law that computes in double inside a float scene would convert silently on every tick.
// expect: HasForce
// expect: law.force\(depth\)
// expect: same_as
#include <palpate/law/force/concept.hpp>

#ifdef PALPATE_MUST_FAIL
using Result = double;
#else
using Result = float;
#endif

struct Spring {
  using Scalar = float;
  Result force(float depth) const noexcept { return depth > 0 ? depth : 0; }
  float stiffness(float depth) const noexcept { return depth > 0 ? 1.0f : 0.0f; }
  float energy(float depth) const noexcept { return depth > 0 ? depth * depth / 2 : 0; }
  float depth(float force) const noexcept { return force; }
  float max_depth() const noexcept { return 1e30f; }
};

template <palpate::ForceLaw Law>
struct Solver {
  Law law;
};

int main() { return Solver<Spring>{}.law.force(0) > 0; }
