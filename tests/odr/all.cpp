// SPDX-License-Identifier: MIT
// Everything a user can include, as an engine would (tests/build.cmake).
#if __has_include(<palpate/palpate.hpp>)
#include <palpate/palpate.hpp>
#endif
#include <all_headers.hpp>  // generated: each header of include/palpate

#include "field.hpp"
#include "objects.hpp"

static_assert(!PALPATE_HAS_EXCEPTIONS);

/// Functions of the library: one definition in the program means one address.
struct Seen {
  void (*fail)(const char*, const char*) = &palpate::fail;
  bool (*usable)(const palpate::Pose<double>&, double, double) = &palpate::is_usable<double>;
};

static std::vector<std::byte> seen_here() {
  std::vector<std::byte> bytes = field_here();
  const Seen seen;
  const auto* const at = reinterpret_cast<const std::byte*>(&seen);
  bytes.insert(bytes.end(), at, at + sizeof(seen));
  return bytes;
}
[[maybe_unused]] static const bool added = (objects().push_back(&seen_here), true);
