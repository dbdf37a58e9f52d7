// SPDX-License-Identifier: Apache-2.0
#include "text.hpp"

#include "failure.hpp"

#include <fast_float/fast_float.h>  // std::from_chars takes no double in libc++ before version 20
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace cadt::cli {
namespace {

// A finite number at the beginning, and the length of its text.
std::optional<std::pair<double, std::size_t>> number_in_front(std::string_view text) {
  double value = 0;
  const auto [end, code] = fast_float::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || !std::isfinite(value)) return std::nullopt;
  return std::pair(value, static_cast<std::size_t>(end - text.data()));
}

// A number and the word after it; nullopt unless the number is finite and not negative.
std::optional<std::pair<double, std::string>> number_and_unit(std::string_view text) {
  const auto parsed = number_in_front(text);
  if (!parsed || parsed->first < 0) return std::nullopt;
  std::string_view unit = text.substr(parsed->second);
  while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
  return std::pair(parsed->first, lower(unit));
}

// 2^53: doubles beyond would round a count.
std::optional<std::uint64_t> whole(double value) {
  if (value > 9007199254740992.0) return std::nullopt;
  return static_cast<std::uint64_t>(std::llround(value));
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const auto parsed = number_in_front(text);
  if (!parsed || parsed->second != text.size()) return std::nullopt;
  return parsed->first;
}

bool parse_numbers(std::string_view text, std::span<double> numbers) {
  for (double& number : numbers) {
    const bool last = &number == &numbers.back();
    const std::size_t length = last ? text.size() : text.find(',');
    const auto parsed = parse_number(text.substr(0, length));
    if (!parsed || length == text.npos) return false;
    number = *parsed;
    if (!last) text.remove_prefix(length + 1);
  }
  return true;
}

std::uint64_t parse_bytes(std::string_view text) {
  if (const auto parsed = number_and_unit(text)) {
    const std::string& unit = parsed->second;
    static constexpr std::string_view letters = "kmgt";
    double factor = unit.empty() || unit == "b" ? 1 : 0;
    if (!unit.empty() && letters.find(unit[0]) != std::string_view::npos) {
      const std::string rest = unit.substr(1);
      const double power = static_cast<double>(letters.find(unit[0]) + 1);
      if (rest.empty() || rest == "ib" || rest == "i") factor = std::pow(1024.0, power);
      if (rest == "b") factor = std::pow(1000.0, power);
    }
    if (factor > 0) {
      if (const auto bytes = whole(parsed->first * factor); bytes && *bytes > 0) return *bytes;
    }
  }
  throw Failure(exit_usage, fmt::format("'{}' is not an amount of memory; write for example 4G, 512M or 1.5GiB", text));
}

std::size_t parse_count(std::string_view text) {
  if (const auto parsed = number_and_unit(text)) {
    static constexpr std::array<std::pair<std::string_view, double>, 4> units = {
        {{"", 1}, {"k", 1e3}, {"m", 1e6}, {"g", 1e9}}};
    for (const auto& [unit, factor] : units) {
      if (parsed->second != unit) continue;
      const double value = parsed->first * factor;
      if (value != std::floor(value)) break;
      if (const auto count = whole(value)) return static_cast<std::size_t>(*count);
    }
  }
  throw Failure(exit_usage, fmt::format("'{}' is not a number of points; write for example 250000, 2M or 1e6", text));
}

std::string join(const std::vector<std::string>& words, std::string_view separator) {
  return fmt::format("{}", fmt::join(words, separator));
}

std::string key_line(std::string_view key, std::string_view value) { return fmt::format("{:<12}{}\n", key, value); }

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths[i]);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

}  // namespace cadt::cli
