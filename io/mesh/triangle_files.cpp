// SPDX-License-Identifier: Apache-2.0
// Triangles and neighbours in the formats of Triangle: .ele .neigh
#include "io/mesh/mesh_parts.hpp"
#include "io/support/number_format.hpp"
#include "io/support/system_file.hpp"
#include "io/support/text_scanner.hpp"

#include <algorithm>
#include <filesystem>

namespace cadt::io::detail {
namespace {

struct EleHeader {
  std::size_t triangles = 0, attributes = 0;
};

/// "0 0 0 0\n" is the shortest line; the last one may lack its end.
constexpr std::size_t shortest_line = 8;

/// Three numbers a row, as they stand in the file.
struct Rows {
  std::vector<std::int64_t> values;
  std::vector<std::size_t> lines;  ///< of each row, for messages
  std::int64_t first_number = 0;   ///< of the first row
};

/// Reads `count` rows "number a b c [attributes]" and the end of the file.
Rows read_rows(TextScanner& scanner, std::size_t count, std::size_t attributes) {
  Rows rows;
  rows.values.reserve(3 * count);
  rows.lines.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    scanner.need_content_line("a triangle");
    const std::int64_t number = scanner.integer("the number of a triangle");
    if (i == 0) {
      if (number != 0 && number != 1) scanner.fail("the first number is " + std::to_string(number) + ", not 0 or 1");
      rows.first_number = number;
    }
    const std::int64_t expected = rows.first_number + static_cast<std::int64_t>(i);
    if (number != expected) {
      scanner.fail("the number is " + std::to_string(number) + " where " + std::to_string(expected) + " should be");
    }
    for (int k = 0; k < 3; ++k) rows.values.push_back(scanner.integer("an index"));
    if (scanner.words_left() != attributes) {
      scanner.fail("the line has " + std::to_string(scanner.words_left()) + " attributes, " +
                   std::to_string(attributes) + " expected");
    }
    rows.lines.push_back(scanner.line_number());
  }
  scanner.expect_end_of_text();
  return rows;
}

EleHeader read_ele_header(TextScanner& scanner) {
  scanner.need_content_line("the header of an .ele file");
  EleHeader header;
  header.triangles = scanner.count("the number of triangles", (scanner.bytes_left() + 1) / shortest_line);
  if (scanner.has_word()) {
    const std::size_t nodes = scanner.count("the number of nodes a triangle", 6);
    if (nodes != 3) scanner.fail("triangles of " + std::to_string(nodes) + " nodes cannot be read, only those of 3");
  }
  if (scanner.has_word()) {
    constexpr std::size_t most_attributes = 1000;
    header.attributes = scanner.count("the number of attributes", most_attributes);
  }
  scanner.expect_end_of_line();
  return header;
}

std::int64_t recognise_base(const Rows& rows, std::size_t points) {
  const auto [least, most] = std::minmax_element(rows.values.begin(), rows.values.end());
  if (rows.values.empty() || *least == 0) return 0;
  if (*most == static_cast<std::int64_t>(points)) return 1;
  // Neither end is used, so the number of the first triangle decides: Triangle numbers triangles from the same base as
  // points.
  return rows.first_number;
}

/// The .neigh file beside the .ele, if there is one.
std::vector<std::int32_t> read_neigh_beside(const std::string& path, std::size_t triangles, std::int64_t base) {
  const std::string name = sibling(path, ".neigh");
  if (path == "-" || !system_file::is_readable(name)) return {};
  const InputFile file(name);
  TextScanner scanner(file.name(), file.bytes());
  scanner.need_content_line("the header of a .neigh file");
  const std::size_t count = scanner.count("the number of triangles", (scanner.bytes_left() + 1) / shortest_line);
  if (count != triangles) {
    scanner.fail("has " + std::to_string(count) + " triangles, the .ele file beside it has " +
                 std::to_string(triangles));
  }
  if (scanner.has_word() && scanner.integer("the number of neighbours") != 3) {
    scanner.fail("a triangle has 3 neighbours");
  }
  scanner.expect_end_of_line();
  const Rows rows = read_rows(scanner, count, 0);
  std::vector<std::int32_t> neighbors;
  neighbors.reserve(rows.values.size());
  for (std::size_t i = 0; i < rows.values.size(); ++i) {
    const std::int64_t value = rows.values[i] == -1 ? -1 : rows.values[i] - base;
    if (value < -1 || value >= static_cast<std::int64_t>(triangles) || (value == -1 && rows.values[i] != -1)) {
      scanner.fail_at(rows.lines[i / 3], "triangle " + std::to_string(rows.values[i]) + " does not exist");
    }
    neighbors.push_back(static_cast<std::int32_t>(value));
  }
  return neighbors;
}

/// Rows "number a b c [attribute]"; -1 stays -1 in either base.
void write_rows(AtomicFile& out, std::span<const std::int32_t> values, int base, bool aligned,
                std::span<const double> attributes = {}) {
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    char* at = put_aligned(out.room(8 * number_room), static_cast<std::int64_t>(i / 3) + base);
    at = put(at, "    ");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t value = values[i + k] < 0 ? values[i + k] : values[i + k] + std::int64_t{base};
      if (k != 0) at = put(at, "  ");
      at = aligned ? put_aligned(at, value) : put(at, value);
    }
    if (!attributes.empty()) at = put(put(at, "    "), attributes[i / 3]);
    *at++ = '\n';
    out.advance(at);
  }
  out.write("# Generated by cadt\n");
}

}  // namespace

void write_ele(AtomicFile& out, std::span<const std::int32_t> triangles, int base, bool attributed,
               std::span<const double> attributes) {
  out.write(std::to_string(triangles.size() / 3) + (attributed ? "  3  1\n" : "  3  0\n"));
  write_rows(out, triangles, base, true, attributes);
}

void write_neigh(AtomicFile& out, std::span<const std::int32_t> neighbors, int base) {
  out.write(std::to_string(neighbors.size() / 3) + "  3\n");
  write_rows(out, neighbors, base, false);
}

MeshFile read_ele(const InputFile& file, const std::string& path, std::size_t points, int base) {
  TextScanner scanner(file.name(), file.bytes());
  const EleHeader header = read_ele_header(scanner);
  const Rows rows = read_rows(scanner, header.triangles, header.attributes);
  const std::int64_t first = base >= 0 ? base : base_beside(path).value_or(recognise_base(rows, points));
  TriangleCollector triangles(points, first);
  triangles.reserve(header.triangles);
  for (std::size_t i = 0; i < rows.values.size(); ++i) {
    if (!triangles.add(rows.values[i])) scanner.fail_at(rows.lines[i / 3], triangles.refusal(rows.values[i]));
  }
  MeshFile mesh;
  mesh.triangles = triangles.take();
  mesh.neighbors = read_neigh_beside(path, header.triangles, first);
  return mesh;
}

}  // namespace cadt::io::detail

namespace cadt::io {

std::optional<int> base_beside(const std::string& path) {
  const std::string node = detail::sibling(path, ".node");
  std::error_code code;
  if (path == "-" || !std::filesystem::is_regular_file(node, code) || !detail::system_file::is_readable(node))
    return std::nullopt;
  const detail::InputFile file(node);
  detail::TextScanner scanner(file.name(), file.bytes());
  scanner.need_content_line("the header of a .node file");
  scanner.need_content_line("a point");
  const std::int64_t base = scanner.integer("the index of a point");
  if (base != 0 && base != 1) scanner.fail("the first index is " + std::to_string(base) + ", not 0 or 1");
  return static_cast<int>(base);
}

}  // namespace cadt::io
