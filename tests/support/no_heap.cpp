// SPDX-License-Identifier: MIT
#include <support/no_heap.hpp>

#include <cstdlib>
#include <new>

namespace {
thread_local std::size_t count = 0;
}

std::size_t palpate::test::allocations_of_thread() noexcept { return count; }

#if defined(PALPATE_TEST_WRAPS_MALLOC)
// The linker sends calls of malloc() to __wrap_malloc(), and __real_malloc() is malloc(): GNU ld's --wrap.
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t items, std::size_t size);
void* __real_realloc(void* block, std::size_t size);
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
int __real_posix_memalign(void** block, std::size_t alignment, std::size_t size);

void* __wrap_malloc(std::size_t size) { return ++count, __real_malloc(size); }
void* __wrap_calloc(std::size_t items, std::size_t size) { return ++count, __real_calloc(items, size); }
void* __wrap_realloc(void* block, std::size_t size) { return ++count, __real_realloc(block, size); }
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  return ++count, __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  return ++count, __real_posix_memalign(block, alignment, size);
}
}
#define PALPATE_TEST_MALLOC __real_malloc
#define PALPATE_TEST_ALIGNED_ALLOC __real_aligned_alloc
#else
#define PALPATE_TEST_MALLOC std::malloc
#define PALPATE_TEST_ALIGNED_ALLOC std::aligned_alloc
#endif

// The other forms of operator new call one of these two; not so the one without exceptions under a sanitizer.
void* operator new(std::size_t size) {
  ++count;
  if (void* block = PALPATE_TEST_MALLOC(size != 0 ? size : 1)) return block;
  std::abort();  // out of memory in a test
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return operator new(size); }
void* operator new(std::size_t size, std::align_val_t align) {
  ++count;
  const auto alignment = static_cast<std::size_t>(align);
  if (void* block = PALPATE_TEST_ALIGNED_ALLOC(alignment, (size + alignment - 1) / alignment * alignment))
    return block;
  std::abort();
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }
