// SPDX-License-Identifier: MIT
// expect: CandidateTree
// expect: tree.touches\(c, r\)
// expect-gcc: is not 'noexcept'
// expect-clang: may throw an exception
#include <palpate/detection/candidates_from.hpp>
#include <palpate/geometry/sphere.hpp>

#ifdef PALPATE_MUST_FAIL
#define MAYBE_NOEXCEPT
#else
#define MAYBE_NOEXCEPT noexcept
#endif

/// A mesh of which nothing is known.
struct Unknown {
  bool touches(const palpate::Vec3<double>&, double) const MAYBE_NOEXCEPT { return true; }
};

int main() {
  const palpate::Sphere<double> ball({.radius = 0.03});
  return palpate::CandidatesFrom<palpate::Sphere<double>, Unknown>(ball, {}).separated(
      palpate::Vec3<double>::Zero(), 1);
}
