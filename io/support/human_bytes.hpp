// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace cadt::io::detail {

/// "4.0 GiB"; below 1024 "512 bytes".
[[nodiscard]] inline std::string human_bytes(std::uint64_t bytes) {
  constexpr std::array units = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  double value = static_cast<double>(bytes);
  std::size_t unit = 0;
  // Beyond 1023.95 "1024.0" would be shown, of which "1.0" of the next unit is the usual form.
  while (value >= (unit == 0 ? 1024 : 1023.95) && unit + 1 < units.size()) value /= 1024, ++unit;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), unit == 0 ? "%.0f %s" : "%.1f %s", value, units[unit]);
  return text.data();
}

}  // namespace cadt::io::detail
