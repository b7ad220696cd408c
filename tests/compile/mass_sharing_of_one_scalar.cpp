// SPDX-License-Identifier: MIT
// expect: HasWeight
#include <palpate/contact/topology.hpp>

/// Every point weighs the same.
struct Even {
#ifdef PALPATE_MUST_FAIL
  static double weight(double, double) noexcept { return 1; }
  static double norm(double points) noexcept { return 1 / points; }
#else
  template <class S>
  static S weight(S, S) noexcept {
    return S(1);
  }
  template <class S>
  static S norm(S points) noexcept {
    return S(1) / points;
  }
#endif
};

int main() { return static_cast<int>(palpate::SingleRegion<Even>::max_regions) - 1; }
