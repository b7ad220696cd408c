// SPDX-License-Identifier: MIT
// expect: HasShare
// expect-gcc: the required expression 'coupling.share\(contacts, result\)' is invalid
// expect-clang: no member named 'share' in 'Deaf'
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/solver/contact_solver.hpp>

/// A coupling that passes nothing on.
struct Deaf {
  static constexpr bool active = true;
  struct Contact {
    palpate::Vec3<double> origin, load, displacement;
    double normal_force;
  };
  struct Result {
    palpate::FixedVector<palpate::Vec3<double>, 4> from_others;
  };
#ifndef PALPATE_MUST_FAIL
  void share(std::span<const Contact>, Result&) const noexcept {}
#endif
};

using Solver = palpate::ContactSolver<palpate::Sphere<double>, palpate::LinearForce<double>,
                                      palpate::Frictionless<double>, palpate::Regions<4>,
                                      palpate::NoDeformation<double>, palpate::AtContact, Deaf>;

int main() { return static_cast<int>(Solver::max_regions) - 4; }
