// SPDX-License-Identifier: Apache-2.0
// A file of which parts are read, and tables of numbers in it.
#pragma once

#include "io/support/system_file.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace cadt::io::detail {

/// Open for reading as long as it lives. Functions may be called by several threads at once.
class RandomAccessFile {
 public:
  /// Throws FileError when it is no regular file that can be read.
  explicit RandomAccessFile(const std::string& path);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  /// `size` bytes from byte `at` on. Throws FileError, also if the file has become shorter.
  void read(std::uint64_t at, char* bytes, std::size_t size) const;

 private:
  std::string name_;
  std::uint64_t size_ = 0;
  system_file::Descriptor file_;
};

/// Rows of little-endian floats in a file, one behind the other.
struct NumberRows {
  bool in_rows = false;       ///< false: something else, of which the reader of whole files knows more
  std::size_t item_size = 8;  ///< 4 or 8 bytes
  std::size_t columns = 2;
  std::uint64_t rows = 0, offset = 0;  ///< `offset` of the first, in bytes
};
/// Of a .npy file. Throws FileError for a header that is none.
[[nodiscard]] NumberRows npy_rows(const RandomAccessFile& file);
/// Of a file of bare coordinates of `item_size` bytes.
[[nodiscard]] NumberRows raw_rows(const RandomAccessFile& file, std::size_t item_size);

}  // namespace cadt::io::detail
