// SPDX-License-Identifier: Apache-2.0
// write_mesh with a triangulation of the library, in every format.
#include "tests/unit/io/io_test_support.hpp"

#include <algorithm>

namespace cadt::io::test {
namespace {

Triangulation on_host(const PointSet& points) {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  return triangulate(points.view(), options);
}

class WriteMesh : public ::testing::TestWithParam<std::string> {};

TEST_P(WriteMesh, WritesWhatTheLibraryComputed) {
  const Folder folder;
  const PointSet points{{0, 0, 3, 0, 3, 2, 0, 2, 1, 1, 1, 1}, {}, {}};
  const Triangulation mesh = on_host(points);
  ASSERT_EQ(mesh.number_of_triangles(), 4U);
  const std::string path = folder / ("m." + GetParam());
  write_mesh(path, points, mesh);
  EXPECT_EQ(folder.entries(), 1U);
  EXPECT_GT(std::filesystem::file_size(path), 50U);
  const auto readable = mesh_read_formats();
  if (std::find(readable.begin(), readable.end(), GetParam()) == readable.end()) return;
  const MeshFile back = read_mesh(path, points.size());
  EXPECT_EQ(back.triangles, std::vector<std::int32_t>(mesh.triangles().begin(), mesh.triangles().end()));
  if (GetParam() == "npz") {
    EXPECT_EQ(back.neighbors, std::vector<std::int32_t>(mesh.neighbors().begin(), mesh.neighbors().end()));
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, WriteMesh, ::testing::ValuesIn(mesh_write_formats()),
                         [](const auto& test) { return test.param; });

TEST(WriteMeshErrors, PointsOfAnotherMesh) {
  const Folder folder;
  const PointSet points{{0, 0, 3, 0, 3, 2}, {}, {}}, others{{0, 0, 1, 1}, {}, {}};
  const std::string path = folder / "m.obj";
  expect_file_error([&] { write_mesh(path, others, on_host(points)); }, path, 0, "it has 3 points, not 2");
  EXPECT_EQ(folder.entries(), 0U);
}

}  // namespace
}  // namespace cadt::io::test
