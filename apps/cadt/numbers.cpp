// SPDX-License-Identifier: Apache-2.0
#include "numbers.hpp"

#include "text.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <string>
#include <system_error>

namespace cadt::cli {
namespace {

std::string expected(const std::string& what, const std::string& text) {
  return fmt::format("{} is expected, not '{}'", what, text);
}

}  // namespace

CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
  const auto check = [low, high](std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), end, value);
    if (code != std::errc() || stop != end || value < low || value > high)
      return expected(fmt::format("a whole number from {} to {}", low, high), text);
    text = std::to_string(value);  // with zeros in front CLI11 takes it for octal
    return {};
  };
  return {check, "", "whole number"};
}

CLI::Validator number_within(double low, double high) {
  const auto check = [low, high](std::string& text) -> std::string {
    const auto value = parse_number(text);
    if (!value || *value < low || *value > high)
      return expected(high == std::numeric_limits<double>::max() ? fmt::format("a number of at least {}", low)
                                                                 : fmt::format("a number from {} to {}", low, high),
                      text);
    return {};
  };
  return {check, "", "number"};
}

}  // namespace cadt::cli
