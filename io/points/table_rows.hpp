// SPDX-License-Identifier: Apache-2.0
// Rows and fields of a text table.
#pragma once

#include "io/support/text_scanner.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::io::detail {

/// Splits a table into rows of fields. The separator is recognised from the first row: semicolon, else comma, else tab
/// if there are fields that are no numbers, else runs of blanks. With a separator character, fields may be quoted ("a,
/// ""b""") and a quoted field may span lines. Skipped: blank lines, lines that start with '#', '//' or '>' (segments of
/// GMT), and in tables separated by blanks everything from '#' or '//' on.
class TableRows {
 public:
  TableRows(const std::string& name, std::string_view text);

  /// False at the end of the table.
  bool next();
  [[nodiscard]] const std::vector<std::string_view>& fields() const noexcept { return fields_; }
  /// Line at which the row starts.
  [[nodiscard]] std::size_t line_number() const noexcept { return row_line_; }
  [[nodiscard]] std::size_t bytes_left() const noexcept { return scanner_.bytes_left(); }
  [[nodiscard]] std::size_t bytes_read() const noexcept { return scanner_.position(); }
  [[noreturn]] void fail(const std::string& message) const { scanner_.fail_at(row_line_, message); }

 private:
  static constexpr char blanks = ' ';

  void recognise_separator(std::string_view line);
  [[nodiscard]] static bool is_comment(std::string_view line) noexcept;
  void split_at_blanks(std::string_view line);
  void split_at_separator(std::string_view line);
  void split_quoted();

  TextScanner scanner_;
  char separator_ = 0;             ///< 0: not recognised yet
  bool single_tabs_ = false;       ///< two tabs in a row mean an empty cell, although blanks separate
  bool found_empty_cell_ = false;  ///< by split_at_blanks in its row
  std::vector<std::string_view> fields_;
  std::size_t row_line_ = 0;
};

/// Whether a field of the first row means a number, be it a valid one or not: a row with such a field is no header.
[[nodiscard]] bool looks_numeric(std::string_view field);

}  // namespace cadt::io::detail
