// SPDX-License-Identifier: Apache-2.0
// Files as other programs wrote them. They are not part of this repository: CADT_DATA_DIR says where they are.
#include "tests/unit/io/io_test_support.hpp"

#include <cstdlib>
#include <optional>

namespace cadt::io::test {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
  const char* chosen = std::getenv("CADT_DATA_DIR");
  return fs::path(chosen != nullptr ? chosen : CADT_DEFAULT_DATA_DIR) / "real";
}

/// The file, unpacked into the folder if it is there as .xz only.
std::optional<std::string> provide(const Folder& folder, const fs::path& wanted) {
  if (fs::exists(wanted)) return wanted.string();
  const fs::path packed = wanted.string() + ".xz";
  if (!fs::exists(packed)) return std::nullopt;
  const std::string target = folder / wanted.filename().string();
  if (std::system(("xz -dkc '" + packed.string() + "' > '" + target + "'").c_str()) != 0) return std::nullopt;
  return target;
}

struct RealFile {
  const char* original;  ///< as its program wrote it
  const char* expected;  ///< its coordinates as plain text
};

class RealFiles : public ::testing::TestWithParam<RealFile> {};

TEST_P(RealFiles, GiveTheExpectedCoordinates) {
  const Folder folder;
  const auto original = provide(folder, data_folder() / "orig" / GetParam().original);
  const auto expected = provide(folder, data_folder() / GetParam().expected);
  if (!original || !expected) GTEST_SKIP() << GetParam().original << " is not in " << data_folder();
  const PointSet points = read_points(*original);
  const PointSet reference = read_points(*expected);
  ASSERT_EQ(points.size(), reference.size());
  for (std::size_t i = 0; i < points.xy.size(); ++i) ASSERT_EQ(points.xy[i], reference.xy[i]) << "value " << i;
}

INSTANTIATE_TEST_SUITE_P(
    Originals, RealFiles,
    ::testing::Values(RealFile{"bunny.ply", "bunny.xy"}, RealFile{"bunny_res4.ply", "bunny_res4.xy"},
                      RealFile{"featuretype_cad.ply", "featuretype_cad.xy"},
                      RealFile{"pdal_ply_simple_binary.ply", "pdal_ply_simple_binary.xy"},
                      RealFile{"ply_fixed_top.ply", "ply_fixed_top.xy"},
                      RealFile{"ply_octagonal_pocket.ply", "ply_octagonal_pocket.xy"},
                      RealFile{"ply_points_ascii_with_lists.ply", "ply_points_ascii_with_lists.xy"},
                      RealFile{"ply_points_emptyface.ply", "ply_points_emptyface.xy"},
                      RealFile{"ply_sphere.ply", "ply_sphere.xy"}, RealFile{"fandisk.obj", "fandisk.xy"},
                      RealFile{"spot.obj", "spot.xy"}, RealFile{"triangle_dots.node", "triangle_dots.xy"},
                      RealFile{"triangle_ell.node", "triangle_ell.xy"},
                      RealFile{"triangle_spiral.node", "triangle_spiral.xy"},
                      RealFile{"triangle_double_hex_2.node", "triangle_double_hex_2.xy"},
                      RealFile{"triangle_la_1.node", "triangle_la_1.xy"},
                      RealFile{"cells_osmfish_cortex.txt", "cells_osmfish_cortex.xy"},
                      RealFile{"central_park_squirrels.csv", "central_park_squirrels.xy"},
                      RealFile{"gshhs_australia.txt", "gshhs_australia.xy"}, RealFile{"ocean_r.xyz", "ocean_r.xy"},
                      RealFile{"oz_quakes.txt", "oz_quakes.xy"}, RealFile{"walmart_stores.csv", "walmart_stores.xy"}),
    [](const auto& test) {
      std::string name = test.param.original;
      for (char& c : name) c = c == '.' ? '_' : c;
      return name;
    });

TEST(RealFilesOfOtherFormats, NameTheKnownOnes) {
  if (!fs::exists(data_folder() / "orig")) GTEST_SKIP() << "no " << data_folder();
  std::size_t tried = 0;
  for (const auto& entry : fs::directory_iterator(data_folder() / "orig")) {
    const std::string path = entry.path().string(), suffix = entry.path().extension().string();
    if (suffix != ".laz" && suffix != ".json" && suffix != ".poly" && suffix != ".msh") continue;
    expect_read_error(path, 0, "known: xy txt csv");
    ++tried;
  }
  EXPECT_GT(tried, 0U);
}

}  // namespace
}  // namespace cadt::io::test
