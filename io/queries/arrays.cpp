// SPDX-License-Identifier: Apache-2.0
// Arrays as tables and as files of NumPy.
#include "io/support/atomic_file.hpp"
#include "io/support/input_file.hpp"
#include "io/support/npy_format.hpp"
#include "io/support/number_format.hpp"
#include "io/support/zip_archive.hpp"

#include <cadt/io/query_files.hpp>

#include <algorithm>
#include <bit>
#include <type_traits>

namespace cadt::io {
namespace detail {
namespace {

std::size_t size_of(const NamedArray& array) {
  return std::visit([](const auto& data) { return data.size(); }, array.data);
}
std::size_t width_of(const NamedArray& array) { return std::max<std::size_t>(array.columns, 1); }

std::string_view bytes_of(const NamedArray& array) {
  return std::visit(
      [](const auto& data) -> std::string_view {
        return {reinterpret_cast<const char*>(data.data()), data.size_bytes()};
      },
      array.data);
}

std::string header_of(const NamedArray& array) {
  static_assert(std::endian::native == std::endian::little, "the binary writers copy numbers as they are in memory");
  static constexpr std::string_view types[] = {"<f8", "<i4", "<u4"};
  std::vector<std::size_t> shape{size_of(array) / width_of(array)};
  if (array.columns != 0) shape.push_back(array.columns);
  return npy_header(types[array.data.index()], shape);
}

char* put_item(char* at, const NamedArray& array, std::size_t i) {
  return std::visit(
      [&](const auto& data) {
        if constexpr (std::is_same_v<std::decay_t<decltype(data[0])>, double>) {
          return put(at, data[i]);
        } else {
          return put(at, static_cast<std::int64_t>(data[i]));
        }
      },
      array.data);
}

void write_names(AtomicFile& out, std::span<const NamedArray> arrays) {
  std::string line;
  for (const NamedArray& array : arrays) {
    for (std::size_t k = 0; k < width_of(array); ++k) {
      if (!line.empty()) line += ',';
      line += array.name;
      if (array.columns > 1) line += std::to_string(k);
    }
  }
  out.write(line + '\n');
}

void write_rows(AtomicFile& out, const std::string& path, std::span<const NamedArray> arrays, char separator) {
  const std::size_t rows = arrays.empty() ? 0 : size_of(arrays[0]) / width_of(arrays[0]);
  for (const NamedArray& array : arrays) {
    if (size_of(array) != rows * width_of(array))
      throw FileError(path, 0, "the columns to be written differ in length");
  }
  for (std::size_t row = 0; row < rows; ++row) {
    bool first = true;
    for (const NamedArray& array : arrays) {
      for (std::size_t k = 0; k < width_of(array); ++k) {
        char* at = out.room(number_room + 1);
        if (!first) *at++ = separator;
        first = false;
        out.advance(put_item(at, array, row * width_of(array) + k));
      }
    }
    out.write("\n");
  }
}

}  // namespace
}  // namespace detail

std::vector<std::string> array_write_formats() { return {"csv", "txt", "npy", "npz"}; }

void write_arrays(const std::string& path, std::span<const NamedArray> arrays, const std::string& asked) {
  using namespace detail;
  const std::string format = choose_format(path == "-" ? "<stdout>" : path, asked, array_write_formats());
  if (format == "npy" && arrays.size() != 1) {
    throw FileError(path, 0, std::to_string(arrays.size()) + " arrays do not fit in an .npy: write an .npz or a .csv");
  }
  AtomicFile out(path);
  if (format == "npy") {
    out.write(header_of(arrays[0]));
    out.write(bytes_of(arrays[0]));
  } else if (format == "npz") {
    ZipWriter zip(out);
    for (const NamedArray& array : arrays) {
      const std::string header = header_of(array);
      const std::string_view parts[] = {header, bytes_of(array)};
      zip.add(array.name + ".npy", parts);
    }
    zip.finish();
  } else {
    if (format == "csv") write_names(out, arrays);
    write_rows(out, path, arrays, format == "csv" ? ',' : ' ');
  }
  out.commit();
}

}  // namespace cadt::io
