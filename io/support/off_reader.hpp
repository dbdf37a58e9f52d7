// SPDX-License-Identifier: Apache-2.0
// OFF files as text, also those with colours (COFF), normals (NOFF) and texture coordinates (STOFF).
#pragma once

#include "io/support/input_file.hpp"
#include "io/support/text_scanner.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cadt::io::detail {

/// Reads the header on construction; then vertices() times vertex(), faces() times face(), and expect_end().
class OffReader {
 public:
  explicit OffReader(const InputFile& file);

  /// Both are bounded by the size of the file.
  [[nodiscard]] std::size_t vertices() const noexcept { return vertices_; }
  [[nodiscard]] std::size_t faces() const noexcept { return faces_; }

  /// The first three numbers of the next vertex line.
  [[nodiscard]] std::array<double, 3> vertex();
  /// The corners of the next face; colours behind them are skipped.
  void face(std::vector<std::int64_t>& corners);
  void expect_end() { scanner_.expect_end_of_text(); }
  [[noreturn]] void fail(const std::string& message) const { scanner_.fail(message); }

 private:
  TextScanner scanner_;
  std::size_t vertices_ = 0, faces_ = 0;
};

}  // namespace cadt::io::detail
