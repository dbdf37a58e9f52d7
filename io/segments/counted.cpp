// SPDX-License-Identifier: Apache-2.0
// The .txt files of CDT (artem-ogre/CDT) and of detria: counts, points, polylines, edges.
#include "io/segments/readers.hpp"

#include <algorithm>

namespace cadt::io::detail {
namespace {

/// "0 0\n"; the last line may lack its end.
constexpr std::size_t shortest_pair = 4;

std::size_t read_count(TextScanner& scanner, const char* what) {
  return scanner.count(what, (scanner.bytes_left() + 1) / shortest_pair);
}

void read_points(TextScanner& scanner, std::size_t count, SegmentCollector& graph) {
  graph.file().xy.reserve(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    scanner.need_content_line("a point");
    const double x = scanner.number("x");
    static_cast<void>(graph.add_point(x, scanner.number("y")));
    scanner.expect_end_of_line();
  }
}

struct Edges {
  std::vector<std::array<std::int64_t, 2>> ends;  ///< as they are in the file
  std::vector<std::size_t> lines;
};

Edges read_edges(TextScanner& scanner, std::size_t count) {
  Edges edges;
  edges.ends.reserve(count);
  edges.lines.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    scanner.need_content_line("an edge");
    const std::int64_t from = scanner.integer("the index of a point");
    edges.ends.push_back({from, scanner.integer("the index of a point")});
    edges.lines.push_back(scanner.line_number());
    scanner.expect_end_of_line();
  }
  return edges;
}

void add_edges(const TextScanner& scanner, const Edges& edges, std::int64_t base, SegmentCollector& graph) {
  const auto points = static_cast<std::int64_t>(graph.points());
  for (std::size_t i = 0; i < edges.ends.size(); ++i) {
    for (const std::int64_t v : edges.ends[i]) {
      if (v >= base && v - base < points) continue;
      scanner.fail_at(edges.lines[i], "index " + std::to_string(v) + " is out of range: the " + std::to_string(points) +
                                          " points count from " + std::to_string(base));
    }
    graph.add_segment(static_cast<std::int32_t>(edges.ends[i][0] - base),
                      static_cast<std::int32_t>(edges.ends[i][1] - base));
  }
}

/// The number of points is an index of edges that count from 1 alone.
std::int64_t base_of(const Edges& edges, std::size_t points) {
  const auto uses = [&](std::int64_t index) {
    return std::any_of(edges.ends.begin(), edges.ends.end(),
                       [index](const auto& ends) { return ends[0] == index || ends[1] == index; });
  };
  return uses(static_cast<std::int64_t>(points)) && !uses(0) ? 1 : 0;
}

void read_cdt(TextScanner& scanner, SegmentCollector& graph) {
  const std::size_t points = read_count(scanner, "the number of points");
  const std::size_t count = read_count(scanner, "the number of edges");
  read_points(scanner, points, graph);
  const Edges edges = read_edges(scanner, count);
  const std::int64_t base = base_of(edges, points);
  add_edges(scanner, edges, base, graph);
  graph.file().base = static_cast<int>(base);
}

/// A line of `count` numbers, each at most `limit`.
std::vector<std::size_t> read_line(TextScanner& scanner, std::size_t count, const char* what, std::size_t limit) {
  std::vector<std::size_t> numbers;
  numbers.reserve(count);
  scanner.need_content_line(what);
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(scanner.count(what, limit));
  scanner.expect_end_of_line();
  return numbers;
}

void read_detria(TextScanner& scanner, SegmentCollector& graph) {
  const std::size_t points = read_count(scanner, "the number of points");
  const std::size_t polylines = scanner.count("the number of polylines", scanner.bytes_left());
  const std::size_t count = read_count(scanner, "the number of edges");
  scanner.expect_end_of_line();
  std::vector<std::size_t> lengths;
  if (polylines != 0) {
    lengths = read_line(scanner, polylines, "the length of a polyline", scanner.bytes_left());
    constexpr std::size_t last_type = 2;  // outline, hole, or by nesting: the domain says what is inside
    static_cast<void>(read_line(scanner, polylines, "the type of a polyline", last_type));
  }
  read_points(scanner, points, graph);
  for (const std::size_t length : lengths) {
    std::int32_t first = 0, before = 0;
    for (std::size_t i = 0; i < length; ++i) {
      scanner.need_content_line("the index of a point");
      const std::int32_t index = read_index(scanner, points, 0);
      scanner.expect_end_of_line();
      if (i == 0) first = index;
      if (i != 0) graph.add_segment(before, index);
      before = index;
    }
    if (length > 1) graph.add_segment(before, first);
  }
  add_edges(scanner, read_edges(scanner, count), 0, graph);
}

}  // namespace

SegmentsFile read_counted(const InputFile& file) {
  TextScanner scanner(file.name(), file.bytes());
  SegmentCollector graph(file.name());
  scanner.need_content_line("the numbers of points and edges");
  const std::size_t numbers = scanner.words_left();
  if (numbers == 2) {
    read_cdt(scanner, graph);
  } else if (numbers == 3) {
    read_detria(scanner, graph);
  } else {
    scanner.fail("the first line has " + std::to_string(numbers) +
                 " words: CDT's files have two numbers there, of points and edges, detria's three, of points, "
                 "polylines and edges");
  }
  scanner.expect_end_of_text();
  return graph.take();
}

}  // namespace cadt::io::detail
