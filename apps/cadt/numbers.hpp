// SPDX-License-Identifier: Apache-2.0
// Checks of numbers on the command line. CLI11's own let nan through, take "010" for 8 and "-1" for the largest number.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <limits>

namespace cadt::cli {

/// Decimal digits alone, from `low` to `high`. For transform(), which hands the number on without zeros in front;
/// check() lets CLI11 take it for octal.
[[nodiscard]] CLI::Validator whole_number(std::uint64_t low, std::uint64_t high);

/// For options that take any number that 64 bits hold, such as --seed.
[[nodiscard]] inline CLI::Validator whole_number() {
  return whole_number(0, std::numeric_limits<std::uint64_t>::max());
}

/// A number from `low` to `high`, which nan is not; without `high` any that is finite.
[[nodiscard]] CLI::Validator number_within(double low, double high = std::numeric_limits<double>::max());

}  // namespace cadt::cli
