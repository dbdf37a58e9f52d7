// SPDX-License-Identifier: Apache-2.0
// The array format of NumPy (.npy, and the members of .npz).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::io::detail {

/// An array whose data have exactly the size that type and shape ask for.
struct NpyArray {
  char kind = 'f';            ///< 'f' float, 'i' signed, 'u' unsigned integer, ...
  std::size_t item_size = 8;  ///< bytes
  bool big_endian = false;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::string_view data;
  std::size_t data_offset = 0;  ///< of `data` in the file

  /// Number of items.
  [[nodiscard]] std::size_t size() const noexcept { return data.size() / item_size; }
  /// Byte of `data` at which item (row, column) of a matrix starts.
  [[nodiscard]] std::size_t item(std::size_t row, std::size_t column) const noexcept {
    return item_size * (fortran_order ? column * shape[0] + row : row * shape[1] + column);
  }
};

/// Parses `bytes`, which start at byte `offset` of the file `name`. Throws FileError.
[[nodiscard]] NpyArray parse_npy(const std::string& name, std::string_view bytes, std::size_t offset);

/// The same from the first bytes of a file of `file_size` bytes: the header, without data. They need not be more than
/// npy_header_bytes.
[[nodiscard]] NpyArray parse_npy_header(const std::string& name, std::string_view bytes, std::size_t file_size);
inline constexpr std::size_t npy_header_bytes = std::size_t{1} << 16;

/// Header for a C-ordered little-endian array, e.g. descr "<f8".
[[nodiscard]] std::string npy_header(std::string_view descr, const std::vector<std::size_t>& shape);

}  // namespace cadt::io::detail
