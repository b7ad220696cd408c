// SPDX-License-Identifier: MIT
#pragma once

/// @file The table of run time against error.

#include "scenes.hpp"

#include <cstdio>
#include <string>

namespace bench {

struct Table {
  const Output& out;
  int repeats;

  /// bound: what the library's own error must stay below; 0: not the library's, or nothing is promised.
  void row(const char* problem, const std::string& method, const char* scalar, const std::string& setting,
           double ns, double error, const char* reference, double bound = 0) const {
    char text[320];
    std::snprintf(text, sizeof text, "%s,%s,%s,%s,%.4g,%.4g,%s", problem, method.c_str(), scalar,
                  setting.c_str(), ns, error, reference);
    out.row(text, "error", error);
    if (bound > 0)
      out.require_below(std::string(problem) + " " + method + " " + scalar + " " + setting, error, bound);
  }
};

}  // namespace bench
