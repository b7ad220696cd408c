// SPDX-License-Identifier: MIT
#pragma once

/// @file  Names of the slip and skew rules, for the friction laws that carry them. Defined in
/// law/friction/slip.hpp.

namespace palpate {

struct ReturnMapping;
struct LiteralShift;
struct ByComponents;
struct Radial;

}  // namespace palpate
