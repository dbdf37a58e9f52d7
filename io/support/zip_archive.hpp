// SPDX-License-Identifier: Apache-2.0
// Archives of .npz files. Members are written stored, so that readers can map them and writing costs no time; stored
// and deflated ones are read. Sizes of 4 GiB and more use the 64-bit records of the format.
#pragma once

#include "io/support/atomic_file.hpp"
#include "io/support/input_file.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::io::detail {

class ZipWriter {
 public:
  explicit ZipWriter(AtomicFile& out) : out_(out) {}

  /// Adds a member whose content is the parts one after another. They must stay as they are during the call.
  void add(const std::string& name, std::span<const std::string_view> parts);
  /// Writes the directory; nothing may be added afterwards.
  void finish();

 private:
  struct Entry {
    std::string name;
    std::uint32_t crc;
    std::uint64_t size, offset;
  };
  AtomicFile& out_;
  std::vector<Entry> entries_;
  std::uint64_t position_ = 0;
};

class ZipReader {
 public:
  /// Reads the directory. Throws FileError.
  explicit ZipReader(const InputFile& file);

  [[nodiscard]] bool contains(std::string_view name) const;

  struct Member {
    std::string_view content;
    std::size_t offset = 0;            ///< of the content in the file
    std::unique_ptr<char[]> inflated;  ///< holds the content if it was deflated
  };
  /// The content of a member, checked against its checksum. Throws FileError, also when there is none of that name.
  [[nodiscard]] Member read(std::string_view name) const;

 private:
  struct Entry {
    std::string_view name;
    std::uint16_t flags, method;
    std::uint32_t crc;
    std::uint64_t stored_size, size, offset;
  };
  struct Directory {
    std::uint64_t entries, size, offset;
  };
  [[nodiscard]] Directory find_directory() const;
  [[nodiscard]] std::string_view slice(std::uint64_t offset, std::uint64_t size, const char* what) const;
  [[nodiscard]] Entry parse_entry(std::string_view record, std::size_t at) const;

  const std::string& name_;
  std::string_view bytes_;
  std::vector<Entry> entries_;
};

}  // namespace cadt::io::detail
