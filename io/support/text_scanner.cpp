// SPDX-License-Identifier: Apache-2.0
#include "io/support/text_scanner.hpp"

#include <cadt/io/errors.hpp>

#include <fast_float/fast_float.h>
#include <algorithm>
#include <charconv>
#include <cmath>

namespace cadt::io::detail {
namespace {

constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// Strips a leading plus, which neither standard nor fast_float parsing takes.
std::string_view without_plus(std::string_view word) noexcept {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+') word.remove_prefix(1);
  return word;
}

}  // namespace

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  constexpr char hex[] = "0123456789abcdef";
  std::string out = "'";
  for (std::size_t i = 0; i < text.size() && i < longest; ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c >= 0x20 && c != 0x7f) {
      out += text[i];  // bytes from 0x80 on belong to UTF-8
    } else {
      out += {'\\', 'x', hex[c >> 4], hex[c & 15]};
    }
  }
  return out + (text.size() > longest ? "...'" : "'");
}

ParsedNumber parse_number(std::string_view word) noexcept {
  const std::string_view digits = without_plus(word);
  ParsedNumber result;
  const auto [end, code] = fast_float::from_chars(digits.data(), digits.data() + digits.size(), result.value);
  // Depending on its version fast_float reports out-of-range or not; the value is set to infinity or zero either way.
  const bool parsed = code == std::errc() || code == std::errc::result_out_of_range;
  if (!parsed || end != digits.data() + digits.size()) {
    result.problem = NumberProblem::malformed;
  } else if (!std::isfinite(result.value)) {
    const std::size_t first = !digits.empty() && digits[0] == '-' ? 1 : 0;
    const bool spelled_out = first < digits.size() && !is_digit(digits[first]) && digits[first] != '.';
    result.problem = spelled_out ? NumberProblem::not_finite : NumberProblem::overflow;
  }
  return result;
}

std::optional<std::int64_t> parse_integer(std::string_view word) noexcept {
  const std::string_view digits = without_plus(word);
  std::int64_t value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

std::string describe(NumberProblem problem, std::string_view word) {
  switch (problem) {
    case NumberProblem::not_finite:
      return quoted(word) + " is not a finite number";
    case NumberProblem::overflow:
      return quoted(word) + " is too large for a double";
    default:
      return quoted(word) + " is not a decimal number";
  }
}

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

TextScanner::TextScanner(const std::string& name, std::string_view text) : name_(name), text_(text) {
  if (text_.starts_with("\xef\xbb\xbf")) position_ = 3;
  if (text_.starts_with("\xff\xfe") || text_.starts_with("\xfe\xff")) {
    throw FileError(name_, 1, "is UTF-16 text or binary; text must be ASCII or UTF-8");
  }
}

bool TextScanner::next_content_line(char comment) {
  while (next_line()) {
    if (const std::size_t cut = rest_.find(comment); cut != std::string_view::npos) rest_ = rest_.substr(0, cut);
    if (!trimmed(rest_).empty()) return true;
  }
  return false;
}

void TextScanner::need_content_line(const char* what) {
  if (!next_content_line()) fail(std::string("the file ends where ") + what + " should be");
}

std::string_view TextScanner::word() noexcept {
  std::size_t start = 0;
  while (start < rest_.size() && is_blank(rest_[start])) ++start;
  std::size_t end = start;
  while (end < rest_.size() && !is_blank(rest_[end])) ++end;
  const std::string_view result = rest_.substr(start, end - start);
  rest_.remove_prefix(end);
  return result;
}

double TextScanner::number(const char* what) {
  const std::string_view text = word();
  if (text.empty()) fail(std::string("the line ends where ") + what + " should be");
  const ParsedNumber parsed = parse_number(text);
  if (parsed.problem != NumberProblem::none) fail(std::string(what) + ": " + describe(parsed.problem, text));
  return parsed.value;
}

std::int64_t TextScanner::integer(const char* what) {
  const std::string_view text = word();
  if (text.empty()) fail(std::string("the line ends where ") + what + " should be");
  const std::optional<std::int64_t> parsed = parse_integer(text);
  if (!parsed) fail(std::string(what) + ": " + quoted(text) + " is not an integer");
  return *parsed;
}

std::size_t TextScanner::count(const char* what, std::size_t limit) {
  const std::int64_t value = integer(what);
  if (value < 0) fail(std::string(what) + " is negative");
  if (static_cast<std::uint64_t>(value) > limit) {
    fail(std::string(what) + " is " + std::to_string(value) + ", more than the file has room for");
  }
  return static_cast<std::size_t>(value);
}

std::size_t TextScanner::words_left() const noexcept {
  std::size_t words = 0;
  bool inside = false;
  for (const char c : rest_) {
    const bool blank = is_blank(c);
    if (!blank && !inside) ++words;
    inside = !blank;
  }
  return words;
}

bool TextScanner::has_word() const noexcept {
  return std::any_of(rest_.begin(), rest_.end(), [](char c) { return !is_blank(c); });
}

void TextScanner::expect_end_of_line() {
  if (const std::string_view text = word(); !text.empty())
    fail("unexpected " + quoted(text) + " at the end of the line");
}

void TextScanner::expect_end_of_text(char comment) {
  if (next_content_line(comment)) fail("unexpected " + quoted(trimmed(rest_)) + " after the data");
}

void TextScanner::fail(const std::string& message) const {
  throw FileError(name_, number_ == 0 ? 1 : number_, message);
}

void TextScanner::fail_at(std::size_t line, const std::string& message) const { throw FileError(name_, line, message); }

}  // namespace cadt::io::detail
