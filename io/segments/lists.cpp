// SPDX-License-Identifier: Apache-2.0
// Plain lists of segments and polylines: .edg and .cin of CGAL, .dat of poly2tri, lines of Wavefront .obj
#include "io/segments/readers.hpp"
#include "io/support/obj_statements.hpp"

namespace cadt::io::detail {
namespace {

std::int32_t read_point(TextScanner& scanner, SegmentCollector& graph) {
  const double x = scanner.number("x");
  return graph.add_point(x, scanner.number("y"));
}

void read_segment(TextScanner& scanner, SegmentCollector& graph) {
  const std::int32_t from = read_point(scanner, graph);
  graph.add_segment(from, read_point(scanner, graph));
  scanner.expect_end_of_line();
}

/// Lines "p x y" and "s x1 y1 x2 y2"; the scanner is behind the first word of the first one.
void read_sites(TextScanner& scanner, std::string_view kind, SegmentCollector& graph) {
  for (;;) {
    if (kind == "s") {
      read_segment(scanner, graph);
    } else if (kind == "p") {
      static_cast<void>(read_point(scanner, graph));
      scanner.expect_end_of_line();
    } else {
      scanner.fail(quoted(kind) + " is not a site: p or s");
    }
    if (!scanner.next_content_line()) return;
    kind = scanner.word();
  }
}

/// The vertex that a word "7", "-1" or "7/2" of an OBJ file names, from 0. `vertices` is their number so far.
std::int64_t obj_vertex(TextScanner& scanner, std::size_t vertices) {
  std::string_view text = scanner.word();
  text = text.substr(0, text.find('/'));
  const auto index = parse_integer(text);
  if (!index || *index == 0) scanner.fail(quoted(text) + " is not the number of a vertex");
  if (*index > 0) return *index - 1;
  const std::int64_t from_end = static_cast<std::int64_t>(vertices) + *index;
  if (from_end < 0) scanner.fail("vertex " + std::string(text) + " is before the first one");
  return from_end;
}

}  // namespace

SegmentsFile read_segment_list(const InputFile& file) {
  TextScanner scanner(file.name(), file.bytes());
  SegmentCollector graph(file.name());
  scanner.need_content_line("the number of segments");
  const bool counted = scanner.words_left() == 1;
  if (!counted) {
    read_sites(scanner, scanner.word(), graph);
    return graph.take();
  }
  constexpr std::size_t shortest_line = 8;  // "0 0 0 0\n"
  const std::size_t count = scanner.count("the number of segments", (scanner.bytes_left() + 1) / shortest_line);
  for (std::size_t i = 0; i < count; ++i) {
    scanner.need_content_line("a segment");
    read_segment(scanner, graph);
  }
  scanner.expect_end_of_text();
  return graph.take();
}

SegmentsFile read_poly2tri(const InputFile& file) {
  TextScanner scanner(file.name(), file.bytes());
  SegmentCollector graph(file.name());
  std::size_t first = 0;
  bool ring = true;
  const auto end_ring = [&] {
    if (ring) graph.close_ring(first);
    first = graph.points();
  };
  while (scanner.next_content_line()) {
    const std::string_view line = trimmed(scanner.line());
    if (line == "HOLE" || line == "STEINER") {
      end_ring();
      ring = line == "HOLE";
      continue;
    }
    static_cast<void>(read_point(scanner, graph));
    scanner.expect_end_of_line();
  }
  end_ring();
  return graph.take();
}

SegmentsFile read_obj_lines(const InputFile& file) {
  TextScanner scanner(file.name(), file.bytes());
  SegmentCollector graph(file.name());
  struct Line {
    std::int64_t from, to;
    std::size_t number;  // in the file
  };
  std::vector<Line> lines;  // vertices may follow those who name them
  std::vector<double>& heights = graph.file().attributes;
  while (scanner.next_content_line()) {
    const std::string_view keyword = scanner.word();
    if (keyword == "v") {
      static_cast<void>(read_point(scanner, graph));
      heights.push_back(scanner.number("z"));  // a weight or a colour may follow
    } else if (keyword == "l") {
      if (scanner.words_left() < 2) scanner.fail("a line needs two vertices");
      std::int64_t from = obj_vertex(scanner, graph.points());
      while (scanner.has_word()) {
        const std::int64_t to = obj_vertex(scanner, graph.points());
        lines.push_back({from, to, scanner.line_number()});
        from = to;
      }
    } else if (!is_obj_keyword(keyword)) {
      scanner.fail(quoted(keyword) + " is not a keyword of OBJ");
    }
  }
  const auto points = static_cast<std::int64_t>(graph.points());
  for (const auto& [from, to, number] : lines) {
    if (from >= points || to >= points) {
      scanner.fail_at(number, "vertex " + std::to_string(std::max(from, to) + 1) + " is out of range: there are " +
                                  std::to_string(points));
    }
    graph.add_segment(static_cast<std::int32_t>(from), static_cast<std::int32_t>(to));
  }
  graph.file().attributes_per_point = 1;
  graph.file().base = 1;
  return graph.take();
}

}  // namespace cadt::io::detail
