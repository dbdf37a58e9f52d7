// SPDX-License-Identifier: Apache-2.0
// Files with segments of other projects: the numbers of vertices, segments and holes that were counted apart from cadt.
// They are not part of this repository: CADT_DATA_DIR says where they are.
#include <cadt/io/segments_file.hpp>

#include <algorithm>
#include <cstdlib>
#include <regex>

#include "tests/unit/io/io_test_support.hpp"

namespace cadt::io::test {
namespace {

namespace fs = std::filesystem;

fs::path segments_folder() {
  const char* chosen = std::getenv("CADT_DATA_DIR");
  return fs::path(chosen != nullptr ? chosen : CADT_DEFAULT_DATA_DIR) / "pslg";
}

struct Counted {
  std::string name;  ///< .xz included
  std::size_t vertices, segments, holes;
};

/// The lines "- name | what | 29 vertices, 29 segments, 0 holes ..." of SOURCES.md.
std::vector<Counted> counted_files() {
  std::ifstream in(segments_folder() / "SOURCES.md");
  const std::regex form("- (\\S+) \\|.*\\| (\\d+) vertices, (\\d+) segments(?:, (\\d+) holes)?.*");
  std::vector<Counted> files;
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, form)) continue;
    files.push_back(
        {match[1], std::stoul(match[2]), std::stoul(match[3]), match[4].matched ? std::stoul(match[4]) : 0});
  }
  return files;
}

/// The path of the file, unpacked into the folder if it is packed.
std::string unpacked(const Folder& folder, const std::string& name) {
  const std::string path = (segments_folder() / name).string();
  if (!name.ends_with(".xz")) return path;
  std::string target = folder / name.substr(0, name.size() - 3);
  const std::string command = "xz -dkc '" + path + "' > '" + target + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return target;
}

TEST(FilesOfOthers, HaveWhatWasCounted) {
  if (!fs::exists(segments_folder())) GTEST_SKIP() << "no " << segments_folder();
  const Folder folder;
  std::size_t compared = 0;
  const std::vector<std::string> known = segment_read_formats();
  for (const Counted& file : counted_files()) {
    std::string suffix = fs::path(file.name).extension().string();
    if (suffix == ".xz") suffix = fs::path(file.name).stem().extension().string();
    if (std::find(known.begin(), known.end(), suffix.substr(1)) == known.end()) continue;
    SCOPED_TRACE(file.name);
    const std::string path = unpacked(folder, file.name);
    if (file.name == "issue_bursttriangulator_22.poly") {  // indices out of range, on purpose
      expect_file_error([&] { static_cast<void>(read_segments(path)); }, path, 45, "is out of range: the 20 points");
      continue;
    }
    if (file.name == "cgal_issue_781_very_tiny_edge.txt") continue;  // a format of this file alone
    const SegmentsFile graph = read_segments(path);
    EXPECT_EQ(graph.size(), file.vertices);
    EXPECT_EQ(graph.segments.size(), file.segments);
    if (suffix == ".poly") {
      EXPECT_EQ(graph.holes.size(), file.holes);
    }
    if ((suffix == ".json" || suffix == ".geojson") && file.segments == file.vertices) {
      const PolygonsFile polygons = read_polygons(path);
      EXPECT_EQ(polygons.ring_offsets.size() - polygons.polygon_offsets.size(), file.holes);
    }
    for (const Segment& s : graph.segments) {
      ASSERT_TRUE(s[0] >= 0 && s[1] >= 0 && static_cast<std::size_t>(std::max(s[0], s[1])) < graph.size());
    }
    ++compared;
  }
  EXPECT_GE(compared, 150U);
  RecordProperty("files", static_cast<int>(compared));
}

}  // namespace
}  // namespace cadt::io::test
