// SPDX-License-Identifier: Apache-2.0
// Vertices in the format of Triangle (and of TetGen, which has three coordinates): .node
#include "io/points/readers.hpp"
#include "io/support/number_format.hpp"
#include "io/support/text_scanner.hpp"

#include <cadt/io/triangle_files.hpp>

namespace cadt::io::detail {
namespace {

struct NodeHeader {
  std::size_t points = 0, dimension = 2, attributes = 0, markers = 0;
};

NodeHeader read_header(TextScanner& scanner) {
  scanner.need_content_line("the header of a .node file");
  // The shortest line of a vertex, "0 0 0\n", has six characters; the last one may lack its end.
  constexpr std::size_t shortest_line = 6, most_attributes = 1000;
  NodeHeader header;
  header.points = scanner.count("the number of points", (scanner.bytes_left() + 1) / shortest_line);
  if (scanner.has_word()) header.dimension = scanner.count("the dimension", 3);
  if (header.dimension < 2) scanner.fail("the dimension must be 2 or 3");
  if (scanner.has_word()) header.attributes = scanner.count("the number of attributes", most_attributes);
  if (scanner.has_word()) header.markers = scanner.count("the number of markers", 1);
  scanner.expect_end_of_line();
  return header;
}

/// Reads the points one after another, each by `read_point` from behind its index. Returns the first index.
template <class ReadPoint>
int read_rows(TextScanner& scanner, std::size_t points, const ReadPoint& read_point) {
  std::int64_t base = 0;
  for (std::size_t i = 0; i < points; ++i) {
    scanner.need_content_line("a point");
    const std::int64_t index = scanner.integer("the index of a point");
    if (i == 0) {
      base = index;
      if (base != 0 && base != 1) scanner.fail("the first index is " + std::to_string(index) + ", not 0 or 1");
    }
    const std::int64_t expected = base + static_cast<std::int64_t>(i);
    if (index != expected) {
      scanner.fail("the index is " + std::to_string(index) + " where " + std::to_string(expected) + " should be");
    }
    read_point();
  }
  return static_cast<int>(base);
}

void expect_columns(const TextScanner& scanner, std::size_t columns) {
  if (scanner.words_left() == columns) return;
  scanner.fail("the line has " + std::to_string(scanner.words_left()) + " attributes and markers after the point, " +
               std::to_string(columns) + " expected");
}

}  // namespace

PointSet read_node(const InputFile& file, const ReadOptions& options) {
  TextScanner scanner(file.name(), file.bytes());
  const NodeHeader header = read_header(scanner);
  // A single attribute of a plane point is taken as its height; of several, none is.
  const bool attribute_is_height = header.dimension == 2 && header.attributes == 1;
  PointCollector points(file.name(), options.projection, header.dimension == 3 || attribute_is_height);
  points.reserve(header.points);
  read_rows(scanner, header.points, [&] {
    const double x = scanner.number("x");
    const double y = scanner.number("y");
    double z = header.dimension == 3 ? scanner.number("z") : 0.0;
    if (attribute_is_height) z = scanner.number("the attribute");
    expect_columns(scanner, (attribute_is_height ? 0 : header.attributes) + header.markers);
    points.add(x, y, z);
  });
  scanner.expect_end_of_text();
  return points.take();
}

NodeFile read_node_section(TextScanner& scanner) {
  const NodeHeader header = read_header(scanner);
  if (header.dimension != 2) scanner.fail("the dimension must be 2, as in Triangle");
  NodeFile nodes;
  nodes.attributes_per_point = header.attributes;
  nodes.xy.reserve(2 * header.points);
  nodes.markers.reserve(header.markers * header.points);
  nodes.base = read_rows(scanner, header.points, [&] {
    for (const char* name : {"x", "y"}) nodes.xy.push_back(scanner.number(name));
    expect_columns(scanner, header.attributes + header.markers);
    for (std::size_t i = 0; i < header.attributes; ++i) nodes.attributes.push_back(scanner.number("an attribute"));
    if (header.markers != 0) nodes.markers.push_back(read_marker(scanner));
  });
  return nodes;
}

std::int32_t read_marker(TextScanner& scanner) {
  const std::int64_t marker = scanner.integer("the marker");
  if (marker != static_cast<std::int32_t>(marker)) scanner.fail("the marker does not fit in 32 bits");
  return static_cast<std::int32_t>(marker);
}

void write_node_section(AtomicFile& out, const NodeColumns& nodes, int base) {
  out.write(std::to_string(nodes.xy.size() / 2) + "  2  " + std::to_string(nodes.attributes_per_point) +
            (nodes.has_markers ? "  1\n" : "  0\n"));
  for (std::size_t i = 0; 2 * i < nodes.xy.size(); ++i) {
    char* at = put_aligned(out.room(4 * number_room), static_cast<std::int64_t>(i) + base);
    at = put(at, "    ");
    at = put(at, nodes.xy[2 * i]);
    at = put(at, "  ");
    at = put(at, nodes.xy[2 * i + 1]);
    for (std::size_t k = 0; k < nodes.attributes_per_point; ++k) {
      out.advance(at);
      at = put(put(out.room(2 * number_room), "  "), nodes.attributes[i * nodes.attributes_per_point + k]);
    }
    out.advance(at);
    at = out.room(2 * number_room);
    if (nodes.has_markers) at = put(put(at, "    "), std::int64_t{nodes.markers[i]});
    *at++ = '\n';
    out.advance(at);
  }
}

void write_node(AtomicFile& out, const NodeColumns& nodes, int base) {
  write_node_section(out, nodes, base);
  out.write("# Generated by cadt\n");
}

}  // namespace cadt::io::detail

namespace cadt::io {

NodeFile read_node_file(const std::string& path) {
  const detail::InputFile file(path);
  detail::TextScanner scanner(file.name(), file.bytes());
  NodeFile nodes = detail::read_node_section(scanner);
  scanner.expect_end_of_text();
  if (nodes.xy.empty()) throw FileError(file.name(), 0, "has no points");
  return nodes;
}

}  // namespace cadt::io
