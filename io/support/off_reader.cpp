// SPDX-License-Identifier: Apache-2.0
#include "io/support/off_reader.hpp"

namespace cadt::io::detail {
namespace {

/// Whether the keyword promises plain vertices of three coordinates first on each line.
bool is_known_keyword(std::string_view word) {
  if (!word.ends_with("OFF")) return false;
  word.remove_suffix(3);
  for (const std::string_view prefix : {"ST", "C", "N"}) {
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  }
  return word.empty();
}

}  // namespace

OffReader::OffReader(const InputFile& file) : scanner_(file.name(), file.bytes()) {
  scanner_.need_content_line("the header of an OFF file");
  if (const std::string_view keyword = scanner_.word(); !is_known_keyword(keyword)) {
    scanner_.fail("an OFF file starts with 'OFF', not " + quoted(keyword) +
                  " (OFF, COFF, NOFF and STOFF as text can be read, with three coordinates)");
  }
  if (!scanner_.has_word()) scanner_.need_content_line("the numbers of vertices and faces");
  // "0 0 0\n" is the shortest vertex, "0\n" the shortest face; the last line may lack its end.
  vertices_ = scanner_.count("the number of vertices", (scanner_.bytes_left() + 1) / 6);
  faces_ = scanner_.count("the number of faces", (scanner_.bytes_left() + 1) / 2);
  if (scanner_.has_word()) {
    static_cast<void>(scanner_.integer("the number of edges"));  // ignored: often wrong
  }
  scanner_.expect_end_of_line();
}

std::array<double, 3> OffReader::vertex() {
  scanner_.need_content_line("a vertex");
  const double x = scanner_.number("x");
  const double y = scanner_.number("y");
  return {x, y, scanner_.number("z")};
}

void OffReader::face(std::vector<std::int64_t>& corners) {
  scanner_.need_content_line("a face");
  corners.clear();
  // A face cannot have more corners than its line has characters: the loop ends at the end of the line.
  const std::size_t count = scanner_.count("the number of corners", scanner_.line().size());
  for (std::size_t k = 0; k < count; ++k) corners.push_back(scanner_.integer("a corner"));
}

}  // namespace cadt::io::detail
