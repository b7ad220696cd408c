// SPDX-License-Identifier: MIT
#pragma once

/// @file  Everything a user can include, for programs of two objects.

#if __has_include(<palpate/palpate.hpp>)
#include <palpate/palpate.hpp>
#endif
#include <all_headers.hpp>  // generated: each header of include/palpate

#include "field.hpp"

/// Functions of the library as one object sees them; one definition in the program means one address.
struct Seen {
  void (*fail)(const char*, const char*);
  bool (*usable)(const palpate::Pose<double>&, double, double);
  bool operator==(const Seen&) const = default;
};
static Seen seen_here() { return {&palpate::fail, &palpate::is_usable<double>}; }
Seen seen_by_second();
