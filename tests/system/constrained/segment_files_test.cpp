// SPDX-License-Identifier: Apache-2.0
// Points and segments from elsewhere: test data of other projects, inputs that made them crash or loop, maps. They are
// not part of this repository (CADT_DATA_DIR). Those without crossings have CGAL's triangles; those with crossings are
// refused with all pairs, and triangulated with Crossing::exact; all within a second.
#include <cadt/io/segments_file.hpp>

#include "tests/support/data_files.hpp"
#include "tests/support/oracle_constrained.hpp"
#include "tests/system/constrained/constrained_check.hpp"
#include "tests/system/constrained/legal_segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

namespace cadt::test {
namespace {

namespace fs = std::filesystem;
using Pairs = std::vector<std::array<std::int32_t, 2>>;

std::vector<fs::path> segment_files() {
  std::vector<fs::path> files;
  const std::vector<std::string> formats = io::segment_read_formats();
  for (const fs::directory_entry& entry : fs::directory_iterator(*data_folder() / "pslg")) {
    fs::path name = entry.path().filename();
    if (name.extension() == ".xz") name = name.stem();
    std::string suffix = name.extension().string();
    if (!suffix.empty()) suffix.erase(0, 1);
    if (std::ranges::find(formats, suffix) != formats.end()) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// By boxes, in the order of their left sides, then exactly.
Pairs crossings_of_all_pairs(const Points& xy, const std::vector<Segment>& segments) {
  struct Box {
    std::array<double, 2> low, high;
    std::int32_t segment;
  };
  std::vector<Box> boxes;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    Box box{};
    box.segment = static_cast<std::int32_t>(s);
    for (std::size_t k = 0; k < 2; ++k)
      std::tie(box.low[k], box.high[k]) = std::minmax(xy[2 * static_cast<std::size_t>(segments[s][0]) + k],
                                                      xy[2 * static_cast<std::size_t>(segments[s][1]) + k]);
    boxes.push_back(box);
  }
  std::ranges::sort(boxes, {}, [](const Box& box) { return box.low[0]; });
  Pairs pairs;
  for (auto i = boxes.begin(); i != boxes.end(); ++i)
    for (auto j = i + 1; j != boxes.end() && j->low[0] <= i->high[0]; ++j)
      if (i->low[1] <= j->high[1] && j->low[1] <= i->high[1] &&
          crosses(xy, segments[static_cast<std::size_t>(i->segment)], segments[static_cast<std::size_t>(j->segment)]))
        pairs.push_back({std::min(i->segment, j->segment), std::max(i->segment, j->segment)});
  std::ranges::sort(pairs);
  return pairs;
}

class Files : public ConstrainedTest {
 protected:
  /// Refused with all pairs, and with exact crossings CGAL's over an exact kernel.
  void check_crossed(const Points& xy, const std::vector<Segment>& segments, const Pairs& pairs) const {
    try {
      static_cast<void>(triangulated(xy, segments));
      ADD_FAILURE() << "no error";
    } catch (const CrossingError& error) {
      EXPECT_EQ(error.pairs(), pairs);
    }
    ConstraintOptions constraints;
    constraints.crossing = Crossing::exact;
    const ConstrainedTriangulation mesh = triangulated(xy, segments, constraints);
#if CADT_TEST_CGAL
    if (segments.size() > 10000) return;
    const CrossedOracleMesh expected = cgal_constrained_plus(xy, segments, mesh.added_parents());
    EXPECT_EQ(expected.unknown, 0U);
    EXPECT_TRUE(std::ranges::equal(mesh.added_points(), expected.added_xy));
    std::vector<Triangle> triangles;
    for (std::size_t t = 0; t < mesh.mesh().number_of_triangles(); ++t) triangles.push_back(mesh.mesh().triangle(t));
    make_canonical(triangles);
    EXPECT_TRUE(triangles == expected.triangles);
    EXPECT_TRUE(std::ranges::equal(mesh.constrained_edges(), expected.constrained));
#endif
  }
};

TEST_P(Files, WithoutCrossingsAsCgalElseRefusedAndExact) {
  if (!data_folder() || !fs::is_directory(*data_folder() / "pslg")) GTEST_SKIP() << "no data: set CADT_DATA_DIR";
  std::size_t plain = 0, crossed = 0;
  const std::size_t most = GetParam().backend == Backend::opencl ? 20000 : 500000;
  for (const fs::path& path : segment_files()) {
    SCOPED_TRACE(path.filename().string());
    if (path.filename() == "earcut_expected.json") continue;  // what earcut makes of the others
    io::SegmentsFile file;
    try {
      file = io::read_segments(unpacked(path, "pslg").string());
    } catch (const io::FileError& error) {  // an index that is out of range, on purpose, and a format of its own
      EXPECT_TRUE(path.filename() == "issue_bursttriangulator_22.poly" ||
                  path.filename() == "cgal_issue_781_very_tiny_edge.txt")
          << error.what();
      continue;
    }
    if (file.size() > most) continue;
    const Pairs pairs = crossings_of_all_pairs(file.xy, file.segments);
    double seconds = CADT_MOST_SECONDS;
    for (int tries = 0; tries < 5 && seconds >= CADT_MOST_SECONDS; ++tries) {  // other tests run beside it
      const auto begin = std::chrono::steady_clock::now();
      try {
        static_cast<void>(triangulated(file.xy, file.segments));
      } catch (const CrossingError&) {  // looked at below
      }
      seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (GetParam().backend == Backend::opencl) break;  // where kernels are compiled
      EXPECT_TRUE(tries < 4 || seconds < CADT_MOST_SECONDS) << seconds << " s";
    }
    if (pairs.empty()) {
      check(file.xy, file.segments);
      ++plain;
    } else {
      check_crossed(file.xy, file.segments, pairs);
      ++crossed;
    }
  }
  EXPECT_GE(plain, 100U);
  EXPECT_GE(crossed, 20U);
}

CADT_ON_MAIN_BACKENDS(Files);

}  // namespace
}  // namespace cadt::test
