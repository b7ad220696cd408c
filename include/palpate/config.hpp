// SPDX-License-Identifier: MIT
#pragma once

/// @file Hooks for the host. An engine may put a header named `palpate_config.hpp` on its include path, or
/// define these macros on the command line, to replace the defaults below. The setting must be the same in
/// every translation unit of a program.
///
/// | macro                           | default                       | is called                          |
/// |---------------------------------|-------------------------------|------------------------------------|
/// | PALPATE_ASSERT(condition)       | assert()                      | broken preconditions, debug builds |
/// | PALPATE_ON_SETUP_ERROR(message) | write to stderr, then abort() | without exceptions: bad input      |
/// | PALPATE_COMPILED                | not defined                   | defined: set-up is linked            |
/// | PALPATE_NO_THREADS              | not defined                   | defined: set-up uses no threads    |
///
/// PALPATE_ON_SETUP_ERROR must not return.
///
/// Header-only is the default. Functions that cost much to compile are defined in files of their own, which
/// headers include at their end: what only set-up needs in `setup/*_impl.hpp`, the response field's stages in
/// `response/tick/` (make_stages.hpp). With PALPATE_COMPILED they do not: the files in src/ hold those
/// functions, once, and the program links them; also the tick of one contact and of four (instances.hpp).
/// Meshes and tools are then of float or double. The CMake target palpate::compiled defines the macro and
/// links the library.

#if __has_include(<palpate_config.hpp>)
#include <palpate_config.hpp>
#endif

#ifndef PALPATE_ASSERT
#include <cassert>
#define PALPATE_ASSERT(condition) assert(condition)
#endif

// A function that PALPATE_COMPILED leaves to src/.
#ifdef PALPATE_COMPILED
#define PALPATE_COMPILED_INLINE
#else
#define PALPATE_COMPILED_INLINE inline
#endif

// An empty member costs no byte. MSVC ignores the standard spelling.
#if defined(_MSC_VER)
#define PALPATE_NO_UNIQUE_ADDRESS [[msvc::no_unique_address]]
#else
#define PALPATE_NO_UNIQUE_ADDRESS [[no_unique_address]]
#endif

// A pointer through which alone its data are reached in this scope, so that loops over arrays vectorise.
#define PALPATE_RESTRICT __restrict

// Inlined whatever the optimiser thinks: its arguments are whole registers.
#if defined(_MSC_VER)
#define PALPATE_INLINE __forceinline
#else
#define PALPATE_INLINE inline __attribute__((always_inline))
#endif

// The same of a lambda, after its parameters.
#if defined(_MSC_VER)
#define PALPATE_INLINE_LAMBDA
#else
#define PALPATE_INLINE_LAMBDA __attribute__((always_inline))
#endif

// Everything called in this function becomes part of it at any level of optimisation: for loops over vector
// registers, whose every operation is a function of Eigen's. Not without optimisation or under a sanitizer,
// where it only makes the compilation long.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PALPATE_FLATTEN
#endif
#endif
#if defined(PALPATE_FLATTEN)
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PALPATE_FLATTEN
#elif defined(__GNUC__) && defined(__OPTIMIZE__)
#define PALPATE_FLATTEN [[gnu::flatten]]
#else
#define PALPATE_FLATTEN
#endif

#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
#define PALPATE_HAS_EXCEPTIONS 1
#else
#define PALPATE_HAS_EXCEPTIONS 0
#endif
