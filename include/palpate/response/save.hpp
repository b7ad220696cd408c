// SPDX-License-Identifier: MIT
#pragma once

/// @file A finished response field to a block of bytes and back, so that set-up is paid once. Set-up only; no
/// I/O here: write the bytes wherever you keep them.
///
/// | bytes | content                                                              |
/// |-------|----------------------------------------------------------------------|
/// | 8     | "palpateR"                                                           |
/// | 4     | `saved_field_version`                                                |
/// | 4     | 0x01020304 in the writer's byte order                                |
/// | 8     | number of bytes that follow the checksum                             |
/// | 8     | checksum of those bytes (FNV-1a over 8-byte words, four interleaved) |
/// | ...   | E, nu, length, then each list: its length, its items                 |
///
/// Little and big endian machines do not read each other's files. Bytes that are foreign, of another version,
/// cut short or changed are refused with an error that says which; so are contents that no set-up makes.

#include <palpate/response/response_field.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate {

inline constexpr std::uint32_t saved_field_version = 10;

namespace detail {
/// Not against an adversary: against truncation, transmission and wrong files.
[[nodiscard]] std::uint64_t checksum(std::span<const std::byte> bytes) noexcept;
}  // namespace detail

/// The field as bytes; about ResponseField::memory() of them.
[[nodiscard]] std::vector<std::byte> save_response_field(const ResponseField& field);
/// The field from `save_response_field`'s bytes. Reports what is wrong with them.
[[nodiscard]] ResponseField load_response_field(std::span<const std::byte> bytes);

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/response/setup/save_impl.hpp>
#endif
