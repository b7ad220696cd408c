// SPDX-License-Identifier: MIT
#include <support/no_heap.hpp>

#include <doctest/doctest.h>
#include <Eigen/Core>

#include <cstdlib>
#include <memory>
#include <vector>

using palpate::test::HeapCount;

TEST_CASE("the allocation counter sees nothing where nothing is allocated") {
  const HeapCount heap;
  Eigen::Vector3d v(1, 2, 3);
  v = 2 * v;
  CHECK(heap.allocations() == 0);
}

TEST_CASE("the allocation counter sees new, malloc and Eigen's own allocator") {
  // volatile keeps the compiler from dropping an allocation that is never used
  volatile std::size_t size = 100;
  HeapCount heap;
  const std::vector<double> list(size, 1.0);
  CHECK(heap.allocations() == 1);

  heap = HeapCount();
  struct alignas(64) Wide {
    double x[8];
  };
  Wide* volatile wide = new Wide();
  CHECK(heap.allocations() == 1);
  delete wide;

  heap = HeapCount();
  void* volatile block = std::malloc(size);
  CHECK(heap.allocations() == 1);
  std::free(block);

  heap = HeapCount();
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(size), list[0]);
  CHECK(heap.allocations() == 1);
  CHECK(x.sum() == 100.0);
}
