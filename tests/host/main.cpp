// SPDX-License-Identifier: MIT
// An engine as a host: without exceptions, without RTTI, under -ffast-math, with its own hooks.
#include <palpate/core/error.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/law/force/duffing.hpp>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <limits>

static_assert(!PALPATE_HAS_EXCEPTIONS);

namespace {
std::jmp_buf set_up;  // where a handler goes, which must not return
char reported[256];
const char* broken = "";
int failures = 0;

void check(bool holds, const char* what) {
  if (holds) return;
  ++failures;
  std::printf("FAILED: %s\n", what);
}

void check_message(const char* expected) {
  if (std::strcmp(reported, expected) == 0) return;
  ++failures;
  std::printf("FAILED: reported '%s', expected '%s'\n", reported, expected);
}

// Read through volatile: fast-math may assume that a constant it sees is finite.
volatile double not_a_number = std::numeric_limits<double>::quiet_NaN();
volatile double infinite = std::numeric_limits<double>::infinity();
volatile float not_a_number_f = std::numeric_limits<float>::quiet_NaN();

void bad_stiffness() { palpate::require_positive(-3.0, "Spring", "stiffness [N/m] must be > 0"); }
void bad_law() { palpate::DuffingForce<double>({.c1 = 40.0, .c3 = infinite}); }
void bad_vertex() { palpate::fail_at("ToolMesh", "position [m] must be finite", "vertex", 7); }

// A plain function, so that the jump passes no object with a destructor.
void report(void (*bad_set_up)()) {
  reported[0] = '\0';
  if (setjmp(set_up) == 0) bad_set_up();
}
}  // namespace

void host_setup_error(const char* message) noexcept {
  std::snprintf(reported, sizeof reported, "%s", message);
  std::longjmp(set_up, 1);
}

void host_assert(bool holds, const char* condition) noexcept {
  if (!holds) broken = condition;
}

int main() {
  report(&bad_stiffness);
  check_message("Spring: stiffness [N/m] must be > 0, got -3");
  report(&bad_law);
  check_message("DuffingForce: c3 [N/m^3] must be finite, got inf");
  report(&bad_vertex);
  check_message("ToolMesh: position [m] must be finite, at vertex 7");

  palpate::FixedVector<int, 1> list;
  list.push_back(1);
  check(std::strcmp(broken, "") == 0, "a precondition that holds calls nothing");
  PALPATE_ASSERT(!list.full());
  check(std::strcmp(broken, "!list.full()") == 0, "a broken precondition calls the host's assert");

  check(!palpate::is_finite(double(not_a_number)), "NaN is seen under -ffast-math");
  check(!palpate::is_finite(double(infinite)), "infinity is seen under -ffast-math");
  check(!palpate::is_finite(float(not_a_number_f)), "NaN is seen in float under -ffast-math");
  palpate::Pose<double> pose;
  check(palpate::is_usable(pose), "the identity is a usable pose under -ffast-math");
  pose.rotation(1, 2) = not_a_number;
  check(!palpate::is_usable(pose), "a NaN in a pose is seen under -ffast-math");
  return failures;
}
