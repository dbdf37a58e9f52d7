// SPDX-License-Identifier: Apache-2.0
// Tables of numbers: .xy .txt .csv .xyz
#include "io/points/readers.hpp"
#include "io/points/table_columns.hpp"
#include "io/points/table_rows.hpp"
#include "io/support/number_format.hpp"

#include <algorithm>
#include <array>

namespace cadt::io::detail {
namespace {

double field_value(const TableRows& rows, std::size_t column) {
  const std::string_view field = rows.fields()[column];
  const ParsedNumber parsed = parse_number(field);
  if (parsed.problem == NumberProblem::none) return parsed.value;
  const std::string where = "column " + std::to_string(column + 1);
  if (field.empty()) rows.fail(where + " is empty");
  rows.fail(where + ": " + describe(parsed.problem, field));
}

/// A guess from the first rows, bounded by what the file can hold (two characters a number).
std::size_t expected_rows(const TableRows& rows) {
  constexpr std::size_t usual_row = 20, shortest_row = 4;
  const std::size_t by_first = rows.bytes_left() / std::max(rows.bytes_read(), usual_row);
  return std::min(by_first + 1, rows.bytes_left() / shortest_row + 1);
}

}  // namespace

PointSet read_table(const InputFile& file, const ReadOptions& options) {
  TableRows rows(file.name(), file.bytes());
  if (!rows.next()) throw FileError(file.name(), 0, "has no points");
  TableLayout layout = table_layout(rows, options.columns);
  if (layout.has_header && !rows.next()) throw FileError(file.name(), 0, "has no points, only a header line");
  Columns& columns = layout.columns;
  if (layout.third_if_numeric && rows.fields().size() > 2 && looks_numeric(rows.fields()[2])) columns.count = 3;

  // In a table of two columns a third field is a mistake; wider tables may hold anything in the other columns.
  const bool strict = rows.fields().size() == 2;
  const std::size_t needed = columns.last() + 1;
  PointCollector points(file.name(), options.projection, columns.count == 3);
  points.reserve(expected_rows(rows));
  do {
    const std::size_t found = rows.fields().size();
    if (found < needed || (strict && found != 2)) {
      const std::string wanted = strict && needed <= 2 ? "2 are" : "column " + std::to_string(needed) + " is";
      rows.fail("the line has " + std::to_string(found) + (found == 1 ? " field, " : " fields, ") + wanted +
                " expected");
    }
    const double x = field_value(rows, columns.index[0]);
    const double y = field_value(rows, columns.index[1]);
    points.add(x, y, columns.count == 3 ? field_value(rows, columns.index[2]) : 0.0);
  } while (rows.next());
  return points.take();
}

void write_table(AtomicFile& out, std::span<const double> xy, std::span<const double> height,
                 const std::string& format) {
  const bool csv = format == "csv";
  // .xyz requires a third column; the others have it only if there are heights.
  const bool three = !height.empty() || format == "xyz";
  const char separator = csv ? ',' : ' ';
  if (csv) out.write(three ? "x,y,z\n" : "x,y\n");
  for (std::size_t i = 0; 2 * i < xy.size(); ++i) {
    char* at = out.room(4 * number_room);
    at = put(at, xy[2 * i]);
    *at++ = separator;
    at = put(at, xy[2 * i + 1]);
    if (three) {
      *at++ = separator;
      at = put(at, height.empty() ? 0.0 : height[i]);
    }
    *at++ = '\n';
    out.advance(at);
  }
}

}  // namespace cadt::io::detail
