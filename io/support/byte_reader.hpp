// SPDX-License-Identifier: Apache-2.0
// Numbers of either byte order out of a block of bytes, with errors that name the byte.
#pragma once

#include <cadt/io/errors.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace cadt::io::detail {

/// A number at `bytes`, which must hold sizeof(T) of them.
template <class T>
[[nodiscard]] T load(const char* bytes, bool big_endian) noexcept {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

[[noreturn]] inline void fail_at_byte(const std::string& name, std::size_t byte, const std::string& message) {
  throw FileError(name, 0, "byte " + std::to_string(byte) + ": " + message);
}

/// Reads forward through bytes that lie `offset` bytes into their file.
class ByteReader {
 public:
  ByteReader(const std::string& name, std::string_view bytes, std::size_t offset, bool big_endian)
      : name_(name), bytes_(bytes), offset_(offset), big_endian_(big_endian) {}

  [[nodiscard]] std::size_t left() const noexcept { return bytes_.size() - position_; }
  /// Position in the file.
  [[nodiscard]] std::size_t position() const noexcept { return offset_ + position_; }

  /// The next `size` bytes; the end of the file before that is an error: "the file ends within <what>".
  const char* take(std::size_t size, const char* what) {
    if (size > left()) fail_at_byte(name_, offset_ + bytes_.size(), std::string("the file ends within ") + what);
    const char* at = bytes_.data() + position_;
    position_ += size;
    return at;
  }
  template <class T>
  [[nodiscard]] T read(const char* what) {
    return load<T>(take(sizeof(T), what), big_endian_);
  }
  void expect_end() const {
    if (left() != 0) fail(std::to_string(left()) + " bytes after the data");
  }
  [[noreturn]] void fail(const std::string& message) const { fail_at_byte(name_, position(), message); }

 private:
  const std::string& name_;
  std::string_view bytes_;
  std::size_t offset_;
  std::size_t position_ = 0;
  bool big_endian_;
};

/// The value if it is finite, else an error at `byte`.
inline double finite_or_fail(double value, const std::string& name, std::size_t byte) {
  if (!std::isfinite(value))
    fail_at_byte(name, byte, std::isnan(value) ? "a coordinate is NaN" : "a coordinate is infinite");
  return value;
}

}  // namespace cadt::io::detail
