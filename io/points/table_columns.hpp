// SPDX-License-Identifier: Apache-2.0
// Which columns of a table are the coordinates.
#pragma once

#include "io/points/table_rows.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace cadt::io::detail {

/// 0-based columns of x, y and, if `count` is 3, z.
struct Columns {
  std::array<std::size_t, 3> index{0, 1, 2};
  std::size_t count = 2;
  [[nodiscard]] std::size_t last() const noexcept;
};

struct TableLayout {
  Columns columns;
  bool has_header = false;
  bool third_if_numeric = false;  ///< take the third column as height if the first data row has a number there
};

/// Decides from the first row and the caller's `columns` (see ReadOptions). Throws FileError.
[[nodiscard]] TableLayout table_layout(const TableRows& first_row, const std::string& columns);

}  // namespace cadt::io::detail
