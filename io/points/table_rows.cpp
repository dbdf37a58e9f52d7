// SPDX-License-Identifier: Apache-2.0
#include "io/points/table_rows.hpp"

#include <algorithm>

namespace cadt::io::detail {
namespace {

/// Position of the first `wanted` outside double quotes.
std::size_t find_unquoted(std::string_view line, char wanted) {
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') inside = !inside;
    if (line[i] == wanted && !inside) return i;
  }
  return std::string_view::npos;
}

bool equals_ignoring_case(std::string_view a, std::string_view lower) {
  return a.size() == lower.size() && std::equal(a.begin(), a.end(), lower.begin(), [](char x, char y) {
           return (x >= 'A' && x <= 'Z' ? static_cast<char>(x - 'A' + 'a') : x) == y;
         });
}

}  // namespace

bool looks_numeric(std::string_view field) {
  if (!field.empty() && (field[0] == '+' || field[0] == '-')) field.remove_prefix(1);
  if (!field.empty() && field[0] == '.') field.remove_prefix(1);
  if (field.empty()) return false;
  if (field[0] >= '0' && field[0] <= '9') return true;
  return equals_ignoring_case(field, "nan") || equals_ignoring_case(field, "inf") ||
         equals_ignoring_case(field, "infinity") || equals_ignoring_case(field.substr(0, 4), "nan(");
}

TableRows::TableRows(const std::string& name, std::string_view text) : scanner_(name, text) {}

bool TableRows::is_comment(std::string_view line) noexcept {
  const std::string_view start = line.substr(std::min(line.find_first_not_of(" \t\v\f"), line.size()));
  return start.empty() || start[0] == '#' || start[0] == '>' || start.starts_with("//");
}

void TableRows::recognise_separator(std::string_view line) {
  for (const char separator : {';', ','}) {
    if (find_unquoted(line, separator) != std::string_view::npos) {
      separator_ = separator;
      return;
    }
  }
  separator_ = blanks;
  if (find_unquoted(line, '\t') == std::string_view::npos) return;
  // Between words tabs separate fields that may hold spaces. Between numbers they are blanks like others, but two in a
  // row mean an empty cell, unless the first row has them as well: then they align the columns.
  split_at_blanks(line);
  const bool numbers = std::all_of(fields_.begin(), fields_.end(), [](std::string_view field) {
    return parse_number(field).problem != NumberProblem::malformed;
  });
  if (!numbers) separator_ = '\t';
  single_tabs_ = numbers && !found_empty_cell_;
  fields_.clear();
}

void TableRows::split_at_blanks(std::string_view line) {
  const char* at = line.data();
  const char* const end = at + line.size();
  found_empty_cell_ = false;
  for (;;) {
    int tabs = fields_.empty() ? 1 : 0;
    while (at != end && is_blank(*at)) tabs += *at++ == '\t' ? 1 : 0;
    if (at == end) return;
    found_empty_cell_ = found_empty_cell_ || tabs > 1;
    const char* const start = at;
    while (at != end && !is_blank(*at)) ++at;
    fields_.emplace_back(start, static_cast<std::size_t>(at - start));
  }
}

void TableRows::split_at_separator(std::string_view line) {
  for (;;) {
    const std::size_t end = line.find(separator_);
    if (end == std::string_view::npos) break;
    fields_.push_back(trimmed(line.substr(0, end)));
    line.remove_prefix(end + 1);
  }
  // A separator at the end of the line adds no field: some writers put it there.
  if (const std::string_view last = trimmed(line); !last.empty()) fields_.push_back(last);
}

void TableRows::split_quoted() {
  std::string_view line = scanner_.line();
  std::size_t start = 0, at = 0;
  bool inside = false;
  const char* const base = line.data();
  const auto add = [&](std::size_t from, std::size_t to) {
    std::string_view field = trimmed({base + from, to - from});
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
    fields_.push_back(trimmed(field));
  };
  for (;;) {
    for (; at < line.size(); ++at) {
      if (base[at] == '"') {
        inside = !inside;
      } else if (base[at] == separator_ && !inside) {
        add(start, at);
        start = at + 1;
      }
    }
    if (!inside) break;
    // The lines of a text are adjacent in memory, so a field that goes on in the next line is still one view.
    if (!scanner_.next_line()) scanner_.fail_at(row_line_, "a quoted field is not closed");
    line = {base, static_cast<std::size_t>(scanner_.line().data() - base) + scanner_.line().size()};
  }
  if (!trimmed({base + start, line.size() - start}).empty()) add(start, line.size());
}

bool TableRows::next() {
  fields_.clear();
  while (fields_.empty()) {
    do {
      if (!scanner_.next_line()) return false;
    } while (is_comment(scanner_.line()));
    row_line_ = scanner_.line_number();
    std::string_view line = scanner_.line();
    if (separator_ == 0) {
      if (line.find('\0') != std::string_view::npos) fail("is not text");
      recognise_separator(line);
    }
    if (separator_ == blanks) {
      if (const std::size_t cut = line.find('#'); cut != std::string_view::npos) line = line.substr(0, cut);
      if (const std::size_t cut = line.find("//"); cut != std::string_view::npos) line = line.substr(0, cut);
      split_at_blanks(line);
      if (single_tabs_ && found_empty_cell_) fail("there is an empty cell between tabs");
    } else if (line.find('"') != std::string_view::npos) {
      split_quoted();
    } else {
      split_at_separator(line);
    }
  }
  return true;
}

}  // namespace cadt::io::detail
