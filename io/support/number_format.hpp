// SPDX-License-Identifier: Apache-2.0
// Numbers as text, without a locale.
#pragma once

#include <fmt/compile.h>
#include <charconv>
#include <cstddef>
#include <cstdint>

namespace cadt::io::detail {

/// Room that any single number of this header takes.
inline constexpr std::size_t number_room = 32;

/// The shortest decimal that reads back to the same double. Returns the end of the text.
inline char* put(char* at, double value) { return fmt::format_to(at, FMT_COMPILE("{}"), value); }

inline char* put(char* at, std::int64_t value) { return std::to_chars(at, at + number_room, value).ptr; }

/// Right-aligned in at least four columns, as Triangle sets its indices.
inline char* put_aligned(char* at, std::int64_t value) {
  for (std::int64_t limit = 1000; limit > 1 && value >= 0 && value < limit; limit /= 10) *at++ = ' ';
  if (value < 0 && value > -10) *at++ = ' ', *at++ = ' ';
  return put(at, value);
}

/// Copies a literal without its terminating zero.
template <std::size_t n>
char* put(char* at, const char (&text)[n]) {
  for (std::size_t i = 0; i + 1 < n; ++i) *at++ = text[i];
  return at;
}

}  // namespace cadt::io::detail
