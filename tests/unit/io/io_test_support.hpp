// SPDX-License-Identifier: Apache-2.0
// Files and expectations that the tests of the formats share.
#pragma once

#include <cadt/io/mesh_file.hpp>
#include <cadt/io/points_file.hpp>

#include <gtest/gtest.h>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "tests/support/portable.hpp"

namespace cadt::io::test {

/// A folder that exists as long as the test.
class Folder {
 public:
  Folder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("cadt-io-") + std::to_string(cadt::test::process_number()) + "-" +
                       info->test_suite_name() + "-" + info->name();
    for (char& c : name) {
      if (c == '/') c = '_';
    }
    path_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file and returns its path.
  [[nodiscard]] std::string file(const std::string& name, const std::string& content) const {
    std::filesystem::remove(path_ / name);  // rewriting a file in place makes some file systems sync it
    std::ofstream(path_ / name, std::ios::binary) << content;
    return *this / name;
  }
  /// Number of entries, hidden ones as well.
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The bytes of a number, little-endian or reversed.
template <class T>
std::string bytes(T value, bool big_endian = false) {
  std::string text(sizeof(T), '\0');
  std::memcpy(text.data(), &value, sizeof(T));
  return big_endian ? std::string(text.rbegin(), text.rend()) : text;
}

/// How the message about a place in a binary file starts.
inline std::string at_byte(std::size_t byte, const std::string& message) {
  return std::string("byte ").append(std::to_string(byte)).append(": ").append(message);
}

/// Runs `call`, which must throw FileError with this line and a message that holds `part` after the path.
template <class Call>
void expect_file_error(Call&& call, const std::string& path, std::size_t line, const std::string& part) {
  try {
    std::forward<Call>(call)();
  } catch (const FileError& error) {
    const std::string what = error.what();
    EXPECT_EQ(error.line(), line) << what;
    EXPECT_EQ(error.path(), path);
    EXPECT_EQ(what.rfind(path + (line != 0 ? ":" + std::to_string(line) : std::string()) + ": ", 0), 0U) << what;
    EXPECT_NE(what.find(part), std::string::npos) << what << "\n  lacks: " << part;
    return;
  }
  ADD_FAILURE() << "no FileError for " << path << ", expected: " << part;
}

inline void expect_read_error(const std::string& path, std::size_t line, const std::string& part,
                              const ReadOptions& options = {}) {
  expect_file_error([&] { static_cast<void>(read_points(path, options)); }, path, line, part);
}

inline void expect_mesh_error(const std::string& path, std::size_t points, std::size_t line, const std::string& part) {
  expect_file_error([&] { static_cast<void>(read_mesh(path, points)); }, path, line, part);
}

using Values = std::vector<double>;

}  // namespace cadt::io::test
