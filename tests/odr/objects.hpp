// SPDX-License-Identifier: MIT
#pragma once

/// @file The objects of a program that each include the library.

#include <cstddef>
#include <vector>

/// What an object sees of the library, or computes with it, as bytes.
using OfObject = std::vector<std::byte> (*)();

/// Each object adds a function of its own.
inline std::vector<OfObject>& objects() {
  static std::vector<OfObject> all;
  return all;
}
