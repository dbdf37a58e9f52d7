// SPDX-License-Identifier: Apache-2.0
// What is wrong with a mesh file, and where.
#include "tests/unit/io/io_test_support.hpp"
#include "tests/unit/io/mesh_fixture.hpp"

namespace cadt::io::test {
namespace {

struct BadMesh {
  const char* name;
  const char* suffix;
  std::string content;
  std::size_t line;
  const char* message;
};

class MeshRefuses : public ::testing::TestWithParam<BadMesh> {};

/// All of these index three points.
TEST_P(MeshRefuses, WithLine) {
  const Folder folder;
  expect_mesh_error(folder.file(std::string("m.") + GetParam().suffix, GetParam().content), 3, GetParam().line,
                    GetParam().message);
}

const std::string ply_faces =
    "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

INSTANTIATE_TEST_SUITE_P(
    Text, MeshRefuses,
    ::testing::Values(BadMesh{"empty", "ele", "", 0, "is empty"},
                      BadMesh{"ele_header", "ele", "# c\n", 1, "ends where the header"},
                      BadMesh{"ele_nodes", "ele", "1 6 0\n0 0 1 2 0 1 2\n", 1, "6 nodes"},
                      BadMesh{"ele_hostile", "ele", "4000000000 3 0\n0 0 1 2\n", 1, "more than the file has room for"},
                      BadMesh{"ele_first", "ele", "1 3 0\n5 0 1 2\n", 2, "first number is 5"},
                      BadMesh{"ele_number", "ele", "2 3 0\n0 0 1 2\n2 0 1 2\n", 3, "number is 2 where 1"},
                      BadMesh{"ele_few", "ele", "2 3 0\n0 0 1 2\n# padding\n", 3, "ends where a triangle"},
                      BadMesh{"ele_tail", "ele", "1 3 0\n0 0 1 2\n1 0 1 2\n", 3, "after the data"},
                      BadMesh{"ele_attribute", "ele", "1 3 1\n0 0 1 2\n", 2, "0 attributes, 1 expected"},
                      BadMesh{"ele_short", "ele", "1 3 0\n0 0 1     \n", 2, "the line ends where an index"},
                      BadMesh{"ele_range", "ele", "2 3 0\n0 0 1 2\n1 0 1 4\n", 3,
                              "index 4 is out of range: the 3 points count from 0"},
                      BadMesh{"ele_negative", "ele", "1 3 0\n0 0 1 -1\n", 2, "out of range"},
                      BadMesh{"obj_range", "obj", "v 0 0 0\nf 1 2 4\n", 2,
                              "index 4 is out of range: the 3 points count from 1"},
                      BadMesh{"obj_zero", "obj", "f 0 1 2\n", 1, "'0' is not a corner"},
                      BadMesh{"obj_word", "obj", "f 1 2 x/3\n", 1, "'x/3' is not a corner"},
                      BadMesh{"obj_polygon", "obj", "f 1 2 3 1\n", 1, "4 corners; only triangles"},
                      BadMesh{"obj_edge", "obj", "f 1 2\n", 1, "2 corners; only triangles"},
                      BadMesh{"obj_relative", "obj", "v 0 0 0\nf -1 -2 -3\n", 2, "out of range"},
                      BadMesh{"obj_junk", "obj", "f 1 2 3\n%%\n", 2, "not a keyword"},
                      BadMesh{"off_polygon", "off", "OFF\n0 1 0\n4 0 1 2 0\n", 3, "4 corners; only triangles"},
                      BadMesh{"off_range", "off", "OFF\n0 1 0\n3 0 1 3\n", 3, "index 3 is out of range"},
                      BadMesh{"off_few", "off", "OFF\n0 2 0\n3 0 1 2\n", 3, "ends where a face"},
                      BadMesh{"ply_polygon", "ply", ply_faces + "4 0 1 2 0\n", 6, "4 corners; only triangles"},
                      BadMesh{"ply_range", "ply", ply_faces + "3 0 1 3\n", 6, "index 3 is out of range"},
                      BadMesh{"ply_fraction", "ply", ply_faces + "3 0 1 1.5\n", 6, "not an integer"},
                      BadMesh{"ply_infinite", "ply", ply_faces + "3 0 1 inf\n", 6, "not an integer"},
                      BadMesh{"ply_no_face", "ply", "ply\nformat ascii 1.0\nend_header\n", 0, "no element 'face'"},
                      BadMesh{"ply_no_list", "ply",
                              "ply\nformat ascii 1.0\nelement face 1\nproperty int vertex_indices\nend_header\n1\n", 3,
                              "no list 'vertex_indices'"},
                      BadMesh{"vtu_junk", "vtu", "<VTKFile></VTKFile>", 0, "no raw appended data"},
                      BadMesh{"npz_junk", "npz", "PK nothing", 0, "is not an archive"},
                      BadMesh{"stl", "stl", "solid", 0,
                              "'stl' is not a format that can be used here; known: ele obj off ply vtu npz"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(MeshRefusesNeighbours, OfAnotherMesh) {
  const Folder folder;
  const std::string ele = folder.file("m.ele", "1 3 0\n0 0 1 2\n"), neigh = folder / "m.neigh";
  const auto read = [&] { static_cast<void>(read_mesh(ele, 3)); };
  static_cast<void>(folder.file("m.neigh", "2 3\n0 -1 -1 -1\n1 -1 -1 -1\n"));
  expect_file_error(read, neigh, 1, "has 2 triangles, the .ele file beside it has 1");
  static_cast<void>(folder.file("m.neigh", "1 3\n0 -1 1 -1\n"));
  expect_file_error(read, neigh, 2, "triangle 1 does not exist");
  static_cast<void>(folder.file("m.neigh", "1 3\n0 -1 0 -1\n"));
  EXPECT_EQ(read_mesh(ele, 3).neighbors, (std::vector<std::int32_t>{-1, 0, -1}));
}

/// Every way to cut a binary file short, and every single wrong byte, must end in FileError or in the same triangles or
/// at least in ones that are in range: never in a crash or a huge allocation.
class DamagedMesh : public ::testing::TestWithParam<std::string> {};

TEST_P(DamagedMesh, CutShort) {
  const Folder folder;
  const SquareMesh mesh;
  detail::write_mesh_parts(folder / ("m." + GetParam()), mesh.parts(), {});
  const std::string content = content_of(folder / ("m." + GetParam()));
  // The closing tags of a .vtu file, and padding after the last number of others, carry no data.
  const std::size_t harmless = GetParam() == "vtu" ? std::strlen("\n</AppendedData>\n</VTKFile>\n") : 0;
  for (std::size_t size = 1; size + harmless < content.size(); ++size) {
    const std::string path = folder.file("cut." + GetParam(), content.substr(0, size));
    ASSERT_THROW(static_cast<void>(read_mesh(path, mesh.points())), FileError) << size << " of " << content.size();
  }
}

TEST_P(DamagedMesh, WrongBytes) {
  const Folder folder;
  const SquareMesh mesh;
  detail::write_mesh_parts(folder / ("m." + GetParam()), mesh.parts(), {});
  const std::string content = content_of(folder / ("m." + GetParam()));
  std::size_t refused = 0;
  for (std::size_t at = 0; at < content.size(); ++at) {
    for (const int change : {0x01, 0x80, 0xff}) {
      std::string damaged = content;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      const std::string path = folder.file("bad." + GetParam(), damaged);
      try {
        for (const std::int32_t index : read_mesh(path, mesh.points()).triangles) {
          ASSERT_GE(index, 0);
          ASSERT_LT(index, static_cast<std::int32_t>(mesh.points()));
        }
      } catch (const FileError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, content.size() / 20) << "damage goes unnoticed";
}

INSTANTIATE_TEST_SUITE_P(Binary, DamagedMesh, ::testing::Values("ply", "vtu", "npz"),
                         [](const auto& test) { return test.param; });

TEST(Npz, ChecksumIsChecked) {
  const Folder folder;
  const SquareMesh mesh;
  detail::write_mesh_parts(folder / "m.npz", mesh.parts(), {});
  std::string content = content_of(folder / "m.npz");
  const std::string row = bytes<std::int32_t>(2) + bytes<std::int32_t>(3) + bytes<std::int32_t>(4);
  const std::size_t at = content.find(row);
  ASSERT_NE(at, std::string::npos);
  content[at] = 1;  // still in range
  expect_mesh_error(folder.file("bad.npz", content), mesh.points(), 0, "checksum of 'simplices.npy' is wrong");
}

TEST(BinaryMesh, RangeErrorsNameTheByte) {
  const Folder folder;
  const SquareMesh mesh;
  for (const std::string format : {"ply", "vtu", "npz"}) {
    const std::string path = folder / ("m." + format);
    detail::write_mesh_parts(path, mesh.parts(), {});
    const std::string where = format == "npz" ? "row 0: " : "byte ";
    expect_mesh_error(path, 4, 0, where);
    expect_mesh_error(path, 4, 0, "index 4 is out of range: the 4 points count from 0");
  }
}

}  // namespace
}  // namespace cadt::io::test
