// SPDX-License-Identifier: Apache-2.0
// Lines, words and numbers of a text file, with errors that name the line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cadt::io::detail {

/// The text in quotes for a message: clipped, with everything unprintable as \xNN.
[[nodiscard]] std::string quoted(std::string_view text);

/// Why a word is no coordinate.
enum class NumberProblem { none, malformed, not_finite, overflow };

struct ParsedNumber {
  double value = 0;
  NumberProblem problem = NumberProblem::none;
};

/// A decimal number that fills `word` exactly: optional sign, digits, point, exponent. Rounded to the nearest double;
/// what is too small becomes zero, what is too large is a problem. Hexadecimal is malformed. Knows no locale.
[[nodiscard]] ParsedNumber parse_number(std::string_view word) noexcept;

/// A decimal integer that fills `word` exactly.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view word) noexcept;

/// Text for the message of a problem; never called with `none`.
[[nodiscard]] std::string describe(NumberProblem problem, std::string_view word);

[[nodiscard]] constexpr bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// Walks over a text line by line, and over the current line word by word. Lines end in LF or CRLF; a UTF-8 byte order
/// mark at the start is skipped.
class TextScanner {
 public:
  /// Throws FileError for UTF-16 text. Both arguments must outlive the scanner.
  TextScanner(const std::string& name, std::string_view text);

  /// Next line as it stands; false at the end of the text.
  bool next_line() {
    if (position_ >= text_.size()) return false;
    const std::size_t end = text_.find('\n', position_);
    const std::size_t stop = end == std::string_view::npos ? text_.size() : end;
    line_ = text_.substr(position_, stop - position_);
    if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    rest_ = line_;
    position_ = stop + 1;
    ++number_;
    return true;
  }

  /// Next line that is not blank once the part from `comment` on is cut off; false at the end of the text.
  bool next_content_line(char comment = '#');

  /// As above, but the end of the text is an error: "the file ends where <what> should be".
  void need_content_line(const char* what);

  /// Next word of the line; empty at its end.
  [[nodiscard]] std::string_view word() noexcept;
  /// Next word as a finite number; a message names `what`.
  [[nodiscard]] double number(const char* what);
  [[nodiscard]] std::int64_t integer(const char* what);
  /// As `integer`, from 0 to `limit`.
  [[nodiscard]] std::size_t count(const char* what, std::size_t limit);
  /// Number of words left on the line: counts them all.
  [[nodiscard]] std::size_t words_left() const noexcept;
  [[nodiscard]] bool has_word() const noexcept;  ///< left on the line

  void expect_end_of_line();
  /// Only blank lines and comments may follow.
  void expect_end_of_text(char comment = '#');

  [[nodiscard]] std::string_view line() const noexcept { return line_; }
  [[nodiscard]] std::size_t line_number() const noexcept { return number_; }
  /// Byte at which the next line starts, and what is left from there.
  [[nodiscard]] std::size_t position() const noexcept { return position_ < text_.size() ? position_ : text_.size(); }
  [[nodiscard]] std::size_t bytes_left() const noexcept { return text_.size() - position(); }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const;

 private:
  const std::string& name_;
  std::string_view text_;
  std::size_t position_ = 0;
  std::string_view line_, rest_;
  std::size_t number_ = 0;
};

}  // namespace cadt::io::detail
