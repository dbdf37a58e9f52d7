// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/errors.hpp>

#include <cstddef>
#include <string>
#include <utility>

namespace cadt::io {

/// A file that cannot be read, is malformed, or cannot be written. `what()` is "file:line: what" for text files,
/// "file: byte N: what" for binary ones and "file: what" where no place makes sense.
class FileError : public Error {
 public:
  FileError(std::string path, std::size_t line, const std::string& message)
      : Error(place(path, line).append(": ").append(message)), path_(std::move(path)), line_(line) {}
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// 1-based line of a text file, 0 if unknown.
  [[nodiscard]] std::size_t line() const noexcept { return line_; }

 private:
  static std::string place(const std::string& path, std::size_t line) {
    std::string text = path;
    if (line != 0) text.append(":").append(std::to_string(line));
    return text;
  }

  std::string path_;
  std::size_t line_;
};

}  // namespace cadt::io
