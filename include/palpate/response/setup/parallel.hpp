// SPDX-License-Identifier: MIT
#pragma once

/// @file Loops over several cores at set-up. A host without threads defines PALPATE_NO_THREADS: then <thread>
/// is not included and every loop runs in the calling thread. The results are the same, to the bit.

#include <algorithm>
#include <cstddef>

#ifndef PALPATE_NO_THREADS
#include <thread>
#include <vector>
#endif

namespace palpate::detail {

/// body(i) for i in [0, count), in contiguous chunks on at most `threads` threads, the caller's among them.
template <class Body>
void parallel_for(std::size_t count, [[maybe_unused]] unsigned threads, const Body& body) {
#ifdef PALPATE_NO_THREADS
  for (std::size_t i = 0; i < count; ++i) body(i);
#else
  threads = (std::max)(1u, (std::min)(threads, static_cast<unsigned>((std::max)(count, std::size_t{1}))));
  std::vector<std::thread> pool;
  const auto run = [&](unsigned k) {
    for (std::size_t i = count * k / threads; i < count * (k + 1) / threads; ++i) body(i);
  };
  for (unsigned k = 1; k < threads; ++k) pool.emplace_back(run, k);
  run(0);
  for (auto& t : pool) t.join();
#endif
}

}  // namespace palpate::detail
