// SPDX-License-Identifier: Apache-2.0
// Values at points: tables and arrays of NumPy.
#include "io/points/table_rows.hpp"
#include "io/support/byte_reader.hpp"
#include "io/support/input_file.hpp"
#include "io/support/npy_format.hpp"

#include <cadt/io/query_files.hpp>

#include <algorithm>
#include <cstdint>

namespace cadt::io {
namespace detail {
namespace {

Values read_value_table(const InputFile& file) {
  TableRows rows(file.name(), file.bytes());
  if (!rows.next()) throw FileError(file.name(), 0, "has no values");
  const bool header = std::none_of(rows.fields().begin(), rows.fields().end(), looks_numeric);
  if (header && !rows.next()) throw FileError(file.name(), 0, "has no values, only a header line");
  Values result;
  result.per_row = rows.fields().size();
  do {
    if (rows.fields().size() != result.per_row) {
      rows.fail("the line has " + std::to_string(rows.fields().size()) + " fields, the lines before it have " +
                std::to_string(result.per_row));
    }
    for (std::size_t k = 0; k < result.per_row; ++k) {
      const ParsedNumber parsed = parse_number(rows.fields()[k]);
      if (parsed.problem != NumberProblem::none) {
        const std::string where = "column " + std::to_string(k + 1);
        rows.fail(rows.fields()[k].empty() ? where + " is empty"
                                           : where + ": " + describe(parsed.problem, rows.fields()[k]));
      }
      result.values.push_back(parsed.value);
    }
  } while (rows.next());
  return result;
}

template <class T>
double load_as_double(const char* bytes, bool big_endian) {
  return static_cast<double>(load<T>(bytes, big_endian));
}

using Loader = double (*)(const char*, bool);
Loader loader_of(const InputFile& file, const NpyArray& array) {
  const bool integer = array.kind == 'i' || array.kind == 'u';
  const bool with_sign = array.kind == 'i';
  switch (array.item_size) {
    case 1:
      if (integer) return with_sign ? load_as_double<std::int8_t> : load_as_double<std::uint8_t>;
      break;
    case 2:
      if (integer) return with_sign ? load_as_double<std::int16_t> : load_as_double<std::uint16_t>;
      break;
    case 4:
      if (integer) return with_sign ? load_as_double<std::int32_t> : load_as_double<std::uint32_t>;
      if (array.kind == 'f') return load_as_double<float>;
      break;
    case 8:
      if (integer) return with_sign ? load_as_double<std::int64_t> : load_as_double<std::uint64_t>;
      if (array.kind == 'f') return load_as_double<double>;
      break;
    default:
      break;
  }
  fail_at_byte(file.name(), 0, "the array must hold float32, float64 or integers");
}

Values read_value_array(const InputFile& file) {
  const NpyArray array = parse_npy(file.name(), file.bytes(), 0);
  if (array.shape.empty() || array.shape.size() > 2) {
    fail_at_byte(file.name(), 0, "the array must have the shape (n,) or (n, m)");
  }
  const Loader value = loader_of(file, array);
  if (array.data.empty()) throw FileError(file.name(), 0, "has no values");
  Values result;
  result.per_row = array.shape.size() == 2 ? array.shape[1] : 1;
  result.values.reserve(array.size());
  for (std::size_t row = 0; row < array.shape[0]; ++row) {
    for (std::size_t k = 0; k < result.per_row; ++k) {
      const std::size_t at = array.shape.size() == 2 ? array.item(row, k) : row * array.item_size;
      const double number = value(array.data.data() + at, array.big_endian);
      if (!std::isfinite(number)) {
        fail_at_byte(file.name(), array.data_offset + at, "a value is NaN or infinite: leave its point out");
      }
      result.values.push_back(number);
    }
  }
  return result;
}

}  // namespace
}  // namespace detail

std::vector<std::string> value_read_formats() { return {"txt", "csv", "npy"}; }

Values read_values(const std::string& path, const std::string& asked) {
  const std::string format = detail::choose_format(path == "-" ? "<stdin>" : path, asked, value_read_formats());
  const detail::InputFile file(path);
  if (file.bytes().empty()) throw FileError(file.name(), 0, "is empty");
  return format == "npy" ? detail::read_value_array(file) : detail::read_value_table(file);
}

}  // namespace cadt::io
