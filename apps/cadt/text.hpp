// SPDX-License-Identifier: Apache-2.0
// Numbers with units, lists, tables.
#pragma once

#include "tiles/machine.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::cli {

using tiles::human_bytes;

/// The whole text as a number that is finite.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
/// As many as `numbers` has, with commas between them. Whether they were there.
[[nodiscard]] bool parse_numbers(std::string_view text, std::span<double> numbers);

/// Inverse, for --max-memory: "4G", "4GiB", "1.5 MB", "1048576". K M G T and KiB ... count 1024, KB ... count 1000, as
/// in the GNU tools. Throws Failure (usage).
[[nodiscard]] std::uint64_t parse_bytes(std::string_view text);

/// A number of points: "250000", "2M", "1e6". K M G count 1000. Throws Failure (usage).
[[nodiscard]] std::size_t parse_count(std::string_view text);

/// "a, b, c".
[[nodiscard]] std::string join(const std::vector<std::string>& words, std::string_view separator = ", ");

/// A line of a summary: the key, and the value in its column.
[[nodiscard]] std::string key_line(std::string_view key, std::string_view value);

/// Rows of equal size as lines with aligned columns; the first row is the header.
[[nodiscard]] std::string table(const std::vector<std::vector<std::string>>& rows);

[[nodiscard]] std::string lower(std::string_view text);

}  // namespace cadt::cli
