// SPDX-License-Identifier: Apache-2.0
// Choice of the reader and writer of segments.
#include "io/segments/readers.hpp"

#include <filesystem>
#include <numeric>
#include <system_error>

namespace cadt::io {
namespace detail {

void SegmentCollector::join_from(std::size_t first) {
  for (std::size_t i = first; i + 1 < points(); ++i) {
    add_segment(static_cast<std::int32_t>(i), static_cast<std::int32_t>(i + 1));
  }
}

void SegmentCollector::close_ring(std::size_t first) {
  join_from(first);
  if (first + 1 < points()) add_segment(static_cast<std::int32_t>(points() - 1), static_cast<std::int32_t>(first));
}

std::int32_t read_index(TextScanner& scanner, std::size_t points, std::int64_t base) {
  const std::int64_t given = scanner.integer("the index of a point");
  const std::int64_t index = given - base;
  if (index < 0 || static_cast<std::uint64_t>(index) >= points ||
      static_cast<std::uint64_t>(index) >= most_indexed_points) {
    scanner.fail("index " + std::to_string(given) + " is out of range: the " + std::to_string(points) +
                 " points count from " + std::to_string(base));
  }
  return static_cast<std::int32_t>(index);
}

namespace {

SegmentsFile read_as(const std::string& format, const InputFile& file, const std::string& path) {
  if (format == "poly") return read_poly(file, path);
  if (format == "edge") return read_edge(file, path);
  if (format == "edg" || format == "cin") return read_segment_list(file);
  if (format == "obj") return read_obj_lines(file);
  if (format == "geojson" || format == "json") return read_geojson(file);
  if (format == "txt") return read_counted(file);
  return read_poly2tri(file);
}

}  // namespace
}  // namespace detail

std::vector<std::string> segment_read_formats() {
  return {"poly", "edge", "edg", "cin", "obj", "geojson", "json", "txt", "dat"};
}

std::string node_file_of(const std::string& path, const std::string& asked) {
  try {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) return {};  // a pipe can be read once
    const std::string format = asked.empty() ? detail::suffix_of(path) : asked;
    if (format == "edge") return detail::sibling(path, ".node");
    if (format != "poly") return {};
    const detail::InputFile file(path);
    detail::TextScanner scanner(file.name(), file.bytes());
    const bool has_points = scanner.next_content_line() && scanner.integer("the number of points") != 0;
    return has_points ? std::string() : detail::sibling(path, ".node");
  } catch (const FileError&) {  // which reading it will explain
    return {};
  }
}

SegmentsFile read_segments(const std::string& path, const std::string& asked) {
  const std::string format = detail::choose_format(path == "-" ? "<stdin>" : path, asked, segment_read_formats());
  const detail::InputFile file(path);
  if (file.bytes().empty()) throw FileError(file.name(), 0, "is empty");
  SegmentsFile result = detail::read_as(format, file, path);
  if (result.size() == 0) throw FileError(file.name(), 0, "has no points");
  result.format = format;
  return result;
}

}  // namespace cadt::io
