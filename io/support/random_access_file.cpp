// SPDX-License-Identifier: Apache-2.0
#include "io/support/random_access_file.hpp"

#include <cadt/io/errors.hpp>

#include "io/support/npy_format.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace cadt::io::detail {

RandomAccessFile::RandomAccessFile(const std::string& path) : name_(path), file_(system_file::open_to_read(path)) {
  if (!file_.is_open()) throw FileError(name_, 0, "cannot be opened: " + std::generic_category().message(errno));
  const system_file::Kind kind = system_file::kind_of(file_.get());
  if (!kind.regular)
    throw FileError(name_, 0,
                    kind.folder ? "is a directory" : "is no regular file, so that parts of it cannot be read");
  size_ = kind.size;
}

void RandomAccessFile::read(std::uint64_t at, char* bytes, std::size_t size) const {
  while (size != 0) {
    const std::ptrdiff_t got = system_file::read_at(file_.get(), bytes, size, at);
    if (got < 0) throw FileError(name_, 0, "cannot be read: " + std::generic_category().message(errno));
    if (got == 0) throw FileError(name_, 0, "byte " + std::to_string(at) + ": the file has become shorter");
    bytes += got, size -= static_cast<std::size_t>(got), at += static_cast<std::uint64_t>(got);
  }
}

NumberRows npy_rows(const RandomAccessFile& file) {
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), npy_header_bytes)), '\0');
  file.read(0, head.data(), head.size());
  const NpyArray array = parse_npy_header(file.name(), head, static_cast<std::size_t>(file.size()));
  NumberRows rows;
  rows.in_rows = array.kind == 'f' && !array.big_endian && !array.fortran_order && array.shape.size() == 2 &&
                 (array.item_size == sizeof(float) || array.item_size == sizeof(double)) &&
                 (array.shape[1] == 2 || array.shape[1] == 3);
  if (!rows.in_rows) return rows;
  rows.item_size = array.item_size;
  rows.rows = array.shape[0];
  rows.columns = array.shape[1];
  rows.offset = array.data_offset;
  return rows;
}

NumberRows raw_rows(const RandomAccessFile& file, std::size_t item_size) {
  NumberRows rows;
  rows.in_rows = file.size() % (2 * item_size) == 0;
  rows.item_size = item_size;
  rows.rows = file.size() / (2 * item_size);
  return rows;
}

}  // namespace cadt::io::detail
