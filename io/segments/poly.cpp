// SPDX-License-Identifier: Apache-2.0
// The files of Triangle that have segments: .poly .edge
#include "io/points/readers.hpp"
#include "io/segments/readers.hpp"
#include "io/support/number_format.hpp"
#include "io/support/system_file.hpp"

namespace cadt::io {
namespace detail {
namespace {

/// "0 0 0\n"; the last line may lack its end.
constexpr std::size_t shortest_row = 6;

std::size_t count_of(TextScanner& scanner, const char* what) {
  scanner.need_content_line(what);
  return scanner.count(what, (scanner.bytes_left() + 1) / shortest_row);
}

NodeFile nodes_beside(const TextScanner& scanner, const std::string& path) {
  if (path == "-") scanner.fail("the points are in a .node file, and standard input has none beside it");
  const std::string name = sibling(path, ".node");
  if (!system_file::is_readable(name)) {
    scanner.fail("has no points, and there is no file " + name + " that has them");
  }
  return read_node_file(name);
}

SegmentsFile with_nodes(NodeFile nodes) {
  SegmentsFile result;
  result.xy = std::move(nodes.xy);
  result.attributes = std::move(nodes.attributes);
  result.attributes_per_point = nodes.attributes_per_point;
  result.markers = std::move(nodes.markers);
  result.base = nodes.base;
  return result;
}

/// "count [markers]", and rows "number a b [marker]". The numbers of rows say nothing, as in Triangle.
void read_rows(TextScanner& scanner, const char* counted, SegmentsFile& result) {
  const std::size_t count = count_of(scanner, counted);
  const bool marked = scanner.has_word() && scanner.count("the number of markers", 1) == 1;
  scanner.expect_end_of_line();
  result.segments.reserve(count);
  if (marked) result.segment_markers.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    scanner.need_content_line("a segment");
    static_cast<void>(scanner.integer("the number of a segment"));
    const std::int32_t from = read_index(scanner, result.size(), result.base);
    result.segments.push_back({from, read_index(scanner, result.size(), result.base)});
    if (marked) result.segment_markers.push_back(read_marker(scanner));
    scanner.expect_end_of_line();
  }
}

std::array<double, 2> read_place(TextScanner& scanner, const char* numbered) {
  static_cast<void>(scanner.integer(numbered));
  const double x = scanner.number("x");
  return {x, scanner.number("y")};
}

void read_holes(TextScanner& scanner, SegmentsFile& result) {
  const std::size_t count = count_of(scanner, "the number of holes");
  scanner.expect_end_of_line();
  result.holes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    scanner.need_content_line("a hole");
    result.holes.push_back(read_place(scanner, "the number of a hole"));
    scanner.expect_end_of_line();
  }
}

/// May be missing.
void read_regions(TextScanner& scanner, SegmentsFile& result) {
  if (!scanner.next_content_line()) return;
  const std::size_t count = scanner.count("the number of regions", (scanner.bytes_left() + 1) / shortest_row);
  scanner.expect_end_of_line();
  result.regions.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    scanner.need_content_line("a region");
    const auto [x, y] = read_place(scanner, "the number of a region");
    const double attribute = scanner.number("the attribute");
    const double area = scanner.has_word() ? scanner.number("the largest area") : attribute;
    result.regions.push_back({x, y, attribute, area});
    scanner.expect_end_of_line();
  }
}

void write_rows(AtomicFile& out, const SegmentsFile& graph, int base) {
  const bool marked = !graph.segment_markers.empty();
  out.write(std::to_string(graph.segments.size()) + (marked ? "  1\n" : "  0\n"));
  for (std::size_t i = 0; i < graph.segments.size(); ++i) {
    char* at = put_aligned(out.room(6 * number_room), static_cast<std::int64_t>(i) + base);
    for (const std::int32_t v : graph.segments[i]) at = put(put(at, "  "), std::int64_t{v} + base);
    if (marked) at = put(put(at, "  "), std::int64_t{graph.segment_markers[i]});
    *at++ = '\n';
    out.advance(at);
  }
}

void write_place(AtomicFile& out, std::int64_t number, double x, double y) {
  char* at = put_aligned(out.room(6 * number_room), number);
  at = put(put(at, "  "), x);
  out.advance(put(put(at, "  "), y));
}

void write_poly(AtomicFile& out, const SegmentsFile& graph, int base) {
  write_node_section(
      out, {graph.xy, graph.attributes, graph.attributes_per_point, graph.markers, !graph.markers.empty()}, base);
  write_rows(out, graph, base);
  write_places(out, graph.holes, graph.regions, base);
}

}  // namespace

void write_places(AtomicFile& out, std::span<const std::array<double, 2>> holes, std::span<const Region> regions,
                  int base) {
  out.write(std::to_string(holes.size()) + "\n");
  std::int64_t number = base;
  for (const auto& [x, y] : holes) {
    write_place(out, number++, x, y);
    out.write("\n");
  }
  if (!regions.empty()) out.write(std::to_string(regions.size()) + "\n");
  number = base;
  for (const Region& region : regions) {
    write_place(out, number++, region.x, region.y);
    char* at = put(put(out.room(4 * number_room), "  "), region.attribute);
    at = put(put(at, "  "), region.largest_area);
    *at++ = '\n';
    out.advance(at);
  }
}

SegmentsFile read_poly(const InputFile& file, const std::string& path) {
  TextScanner scanner(file.name(), file.bytes());
  NodeFile nodes = read_node_section(scanner);
  const bool beside = nodes.xy.empty();
  SegmentsFile result = with_nodes(beside ? nodes_beside(scanner, path) : std::move(nodes));
  result.nodes_beside = beside;
  read_rows(scanner, "the number of segments", result);
  read_holes(scanner, result);
  read_regions(scanner, result);
  scanner.expect_end_of_text();
  return result;
}

SegmentsFile read_edge(const InputFile& file, const std::string& path) {
  TextScanner scanner(file.name(), file.bytes());
  SegmentsFile result = with_nodes(nodes_beside(scanner, path));
  result.nodes_beside = true;
  read_rows(scanner, "the number of edges", result);
  scanner.expect_end_of_text();
  return result;
}

}  // namespace detail

void write_segments(const std::string& path, const SegmentsFile& graph, const WriteSegmentsOptions& options) {
  const std::string format = detail::choose_format(path == "-" ? "<stdout>" : path, options.format, {"poly", "edge"});
  if (options.base != 0 && options.base != 1) throw FileError(path, 0, "the first index can be 0 or 1");
  if (graph.xy.size() % 2 != 0 || graph.attributes.size() != graph.size() * graph.attributes_per_point ||
      (!graph.markers.empty() && graph.markers.size() != graph.size()) ||
      (!graph.segment_markers.empty() && graph.segment_markers.size() != graph.segments.size())) {
    throw FileError(path, 0, "coordinates, attributes and markers to be written differ in number");
  }
  detail::AtomicFile out(path);
  if (format == "poly") {
    detail::write_poly(out, graph, options.base);
  } else {
    detail::write_rows(out, graph, options.base);
  }
  out.write("# Generated by cadt\n");
  out.commit();
}

}  // namespace cadt::io
