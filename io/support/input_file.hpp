// SPDX-License-Identifier: Apache-2.0
// A whole file in memory, and the choice of its format.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::io::detail {

/// The content of a file, pipe or ("-") standard input. One read into memory rather than a mapping: a file that another
/// process cuts short must end in an error, not in SIGBUS.
class InputFile {
 public:
  /// Throws FileError when the file cannot be opened or read, or is a directory.
  explicit InputFile(const std::string& path);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }  ///< for messages; "<stdin>" for "-"
  [[nodiscard]] std::string_view bytes() const noexcept { return {data_.get(), size_}; }

 private:
  void read_all(int descriptor);
  void grow(std::size_t capacity);

  std::string name_;
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Lower-case suffix of the file name without the dot; empty if there is none.
[[nodiscard]] std::string suffix_of(const std::string& path);

/// The same file name with another suffix (with its dot), or with one if it has none.
[[nodiscard]] std::string sibling(const std::string& path, const char* suffix);

/// The format asked for, or else that of the suffix. Throws FileError that lists `known` when it is not among them.
[[nodiscard]] std::string choose_format(const std::string& path, const std::string& asked,
                                        const std::vector<std::string>& known);

}  // namespace cadt::io::detail
