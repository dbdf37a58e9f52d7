// SPDX-License-Identifier: Apache-2.0
// Vertices of .node, .off, .obj and text .ply files, and what is wrong with them.
#include "tests/unit/io/io_test_support.hpp"

namespace cadt::io::test {
namespace {

struct GoodFile {
  const char* name;
  const char* suffix;
  std::string content;
  Values xy, height;
};

class TextReads : public ::testing::TestWithParam<GoodFile> {};

TEST_P(TextReads, PointsAndHeights) {
  const Folder folder;
  const PointSet points = read_points(folder.file(std::string("p.") + GetParam().suffix, GetParam().content));
  EXPECT_EQ(points.xy, GetParam().xy);
  EXPECT_EQ(points.height, GetParam().height);
}

const std::string ply_start = "ply\nformat ascii 1.0\n";

INSTANTIATE_TEST_SUITE_P(
    Files, TextReads,
    ::testing::Values(
        GoodFile{"node_base_1", "node", "2 2 0 0\n1 5 6\n2 7 8\n", {5, 6, 7, 8}, {}},
        GoodFile{"node_base_0", "node", "# c\n\n2  2  0  0\n0 5 6 # c\n\n1 7 8\n# Generated\n", {5, 6, 7, 8}, {}},
        GoodFile{"node_short_header", "node", "1\n1 5 6\n", {5, 6}, {}},
        GoodFile{"node_marker", "node", "1 2 0 1\n1 5 6 1\n", {5, 6}, {}},
        GoodFile{"node_height", "node", "1 2 1 1\n1 5 6 7 1\n", {5, 6}, {7}},
        GoodFile{"node_two_attributes", "node", "1 2 2 0\n1 5 6 7 8\n", {5, 6}, {}},
        GoodFile{"node_tetgen", "node", "1 3 0 0\n1 5 6 7\n", {5, 6}, {7}},
        GoodFile{"off", "off", "OFF\n2 1 0\n5 6 7\n8 9 10\n3 0 1 0\n", {5, 6, 8, 9}, {7, 10}},
        GoodFile{"off_counts_on_first_line", "off", "OFF 1 0 0\n5 6 7", {5, 6}, {7}},
        GoodFile{"off_without_edges", "off", "OFF\n1 0\n5 6 7\n", {5, 6}, {7}},
        GoodFile{"off_comments", "off", "# c\nOFF # c\n\n# c\n1 0 0 # c\n\n5 6 7 # c\n# c\n", {5, 6}, {7}},
        GoodFile{"coff", "off", "COFF\n1 0 0\n5 6 7 255 0 0 255\n", {5, 6}, {7}},
        GoodFile{"noff", "off", "NOFF\n1 0 0\n5 6 7 0 0 1\n", {5, 6}, {7}},
        GoodFile{"stcnoff", "off", "STCNOFF\n1 0 0\n5 6 7 0 0 1 1 1 1 1 0 0\n", {5, 6}, {7}},
        GoodFile{"off_coloured_faces", "off", "OFF\n1 1 0\n5 6 7\n3 0 0 0 0.1 0.2 0.3\n", {5, 6}, {7}},
        GoodFile{"obj",
                 "obj",
                 "# c\nmtllib a.mtl\no b\nv 5 6 7\nvt 0 0\nvn 0 0 1\nv 8 9 10 1 0 0\nf 1/1/1 2/1/1 1/1/1\n",
                 {5, 6, 8, 9},
                 {7, 10}},
        GoodFile{
            "ply",
            "ply",
            ply_start +
                "comment c\nobj_info i\nelement vertex 2\nproperty float x\nproperty float y\nend_header\n5 6\n7 8\n",
            {5, 6, 7, 8},
            {}},
        GoodFile{"ply_crlf",
                 "ply",
                 "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float "
                 "y\r\nend_header\r\n5 6\r\n",
                 {5, 6},
                 {}},
        GoodFile{"ply_reordered_with_lists",
                 "ply",
                 ply_start + "element vertex 1\nproperty list uchar int a\nproperty double z\nproperty int y\nproperty "
                             "uchar q\nproperty float64 x\nend_header\n2 9 9 7 6 1 5\n",
                 {5, 6},
                 {7}},
        GoodFile{"ply_other_elements_first",
                 "ply",
                 ply_start +
                     "element camera 2\nproperty float q\nelement vertex 1\nproperty float x\nproperty float "
                     "y\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n1\n2\n5 6\n3 0 0 0\n",
                 {5, 6},
                 {}},
        GoodFile{
            "ply_nan_elsewhere",
            "ply",
            ply_start +
                "element vertex 1\nproperty float x\nproperty float y\nproperty float quality\nend_header\n5 6 nan\n",
            {5, 6},
            {}}),
    [](const auto& test) { return std::string(test.param.name); });

struct BadFile {
  const char* name;
  const char* suffix;
  std::string content;
  std::size_t line;
  const char* message;
};

class TextRefuses : public ::testing::TestWithParam<BadFile> {};

TEST_P(TextRefuses, WithLine) {
  const Folder folder;
  expect_read_error(folder.file(std::string("p.") + GetParam().suffix, GetParam().content), GetParam().line,
                    GetParam().message);
}

const std::string ply_xy = ply_start + "element vertex 2\nproperty float x\nproperty float y\nend_header\n";

INSTANTIATE_TEST_SUITE_P(
    Node, TextRefuses,
    ::testing::Values(
        BadFile{"no_points", "node", "0 2 0 0\n", 0, "no points"},
        BadFile{"no_header", "node", "# c\n", 1, "ends where the header"},
        BadFile{"negative_count", "node", "-1 2 0 0\n", 1, "is negative"},
        BadFile{"fractional_count", "node", "1.5 2 0 0\n", 1, "'1.5' is not an integer"},
        BadFile{"hostile_count", "node", "4000000000 2 0 0\n1 0 0\n", 1, "more than the file has room for"},
        BadFile{"count_beyond_64_bits", "node", "99999999999999999999 2 0 0\n1 0 0\n", 1, "not an integer"},
        BadFile{"dimension", "node", "1 4 0 0\n1 0 0\n", 1, "dimension"},
        BadFile{"dimension_1", "node", "1 1 0 0\n1 0 0\n", 1, "2 or 3"},
        BadFile{"header_tail", "node", "1 2 0 0 9\n1 0 0\n", 1, "unexpected '9'"},
        BadFile{"first_index", "node", "1 2 0 0\n2 0 0\n", 2, "first index is 2"},
        BadFile{"index_jumps", "node", "2 2 0 0\n0 0 0\n2 0 0\n", 3, "index is 2 where 1 should be"},
        BadFile{"too_few_points", "node", "2 2 0 0\n0 0 0\n# padding\n", 3, "ends where a point"},
        BadFile{"too_many_points", "node", "1 2 0 0\n0 0 0\n1 1 1\n", 3, "unexpected '1 1 1' after the data"},
        BadFile{"y_missing", "node", "1 2 0 0\n1 0    \n", 2, "the line ends where y"},
        BadFile{"marker_missing", "node", "1 2 0 1\n1 0 0\n", 2,
                "0 attributes and markers after the point, 1 expected"},
        BadFile{"marker_too_many", "node", "1 2 0 0\n1 0 0 5\n", 2,
                "1 attributes and markers after the point, 0 expected"},
        BadFile{"nan", "node", "1 2 0 0\n1 0 nan\n", 2, "y: 'nan' is not a finite number"},
        BadFile{"overflow", "node", "1 2 0 0\n1 1e999 0\n", 2, "x: '1e999' is too large"}),
    [](const auto& test) { return std::string(test.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Off, TextRefuses,
    ::testing::Values(
        BadFile{"keyword", "off", "PLY\n1 0 0\n", 1, "starts with 'OFF'"},
        BadFile{"four_coordinates", "off", "4OFF\n1 0 0\n0 0 0 1\n", 1, "not '4OFF'"},
        BadFile{"binary", "off", "OFF BINARY\n", 1, "'BINARY' is not an integer"},
        BadFile{"no_counts", "off", "OFF\n", 1, "ends where the numbers"},
        BadFile{"hostile_vertices", "off", "OFF\n4000000000 0 0\n0 0 0\n", 2, "more than the file has room for"},
        BadFile{"hostile_faces", "off", "OFF\n1 4000000000 0\n0 0 0\n", 2, "more than the file has room for"},
        BadFile{"vertices_missing", "off", "OFF\n2 0 0\n0 0 0\n# padding\n", 4, "ends where a vertex"},
        BadFile{"faces_missing", "off", "OFF\n1 2 0\n0 0 0\n3 0 0 0\n", 4, "ends where a face"},
        BadFile{"corner_missing", "off", "OFF\n1 1 0\n0 0 0\n3 0 0\n", 4, "the line ends where a corner"},
        BadFile{"hostile_corners", "off", "OFF\n1 1 0\n0 0 0\n4000000000 0 0\n", 4, "room for"},
        BadFile{"z_missing", "off", "OFF\n1 0 0\n0 0   \n", 3, "the line ends where z"},
        BadFile{"infinity", "off", "OFF\n1 0 0\n0 0 inf\n", 3, "z: 'inf' is not a finite number"},
        BadFile{"tail", "off", "OFF\n1 0 0\n0 0 0\n1 1 1\n", 4, "after the data"}),
    [](const auto& test) { return std::string(test.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Obj, TextRefuses,
    ::testing::Values(BadFile{"no_points", "obj", "# c\nf 1 2 3\n", 0, "no points"},
                      BadFile{"z_missing", "obj", "v 1 2 3\nv 1 2\n", 2, "the line ends where z"},
                      BadFile{"word", "obj", "v 1 2 three\n", 1, "z: 'three' is not a decimal number"},
                      BadFile{"nan", "obj", "\nv 1 -nan 3\n", 2, "not a finite number"},
                      BadFile{"junk", "obj", "v 1 2 3\n1 2 3\n", 2, "'1' is not a keyword of OBJ"}),
    [](const auto& test) { return std::string(test.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Ply, TextRefuses,
    ::testing::Values(
        BadFile{"magic", "ply", "plx\n", 1, "starts with 'ply'"},
        BadFile{"header_only", "ply", "ply\nformat ascii 1.0\n", 2, "no 'end_header'"},
        BadFile{"no_format", "ply", "ply\nend_header\n", 2, "no 'format'"},
        BadFile{"version", "ply", "ply\nformat ascii 2.0\n", 2, "version 1.0"},
        BadFile{"format", "ply", "ply\nformat binary 1.0\nend_header\n", 3, "'binary' is not a format"},
        BadFile{"keyword", "ply", "ply\nelements\n", 2, "'elements' is not a keyword"},
        BadFile{"type", "ply", ply_start + "element vertex 1\nproperty real x\n", 4, "'real' is not a type"},
        BadFile{"early_property", "ply", ply_start + "property float x\n", 3, "before the first element"},
        BadFile{"float_length", "ply", ply_start + "element vertex 1\nproperty list float int x\n", 4, "integer type"},
        BadFile{"no_vertex", "ply", ply_start + "end_header\n", 0, "no element 'vertex'"},
        BadFile{"no_y", "ply", ply_start + "element vertex 1\nproperty float x\nend_header\n1\n", 3,
                "no properties x and y"},
        BadFile{"list_x", "ply",
                ply_start + "element vertex 1\nproperty list uchar int x\nproperty float y\nend_header\n1 1 1\n", 3,
                "is a list"},
        BadFile{"no_points", "ply", ply_start + "element vertex 0\nproperty float x\nproperty float y\nend_header\n", 0,
                "no points"},
        BadFile{"negative", "ply", ply_start + "element vertex -2\n", 3, "negative"},
        BadFile{"hostile_count", "ply",
                ply_start + "element vertex 4000000000\nproperty float x\nproperty float y\nend_header\n1 2\n", 3,
                "claims 4000000000 rows"},
        BadFile{"hostile_count_64", "ply",
                ply_start + "element vertex 9223372036854775807\nproperty float x\nproperty float y\nend_header\n1 2\n",
                3, "claims 9223372036854775807 rows"},
        BadFile{
            "hostile_empty_element", "ply",
            ply_start +
                "element nothing 4000000000\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n",
            3, "has no properties"},
        BadFile{"hostile_list", "ply",
                ply_start + "element vertex 1\nproperty float x\nproperty float y\nelement face 1\nproperty list uint "
                            "int vertex_indices\nend_header\n1 2\n4000000000 1 2\n",
                10, "the line ends"},
        BadFile{"truncated", "ply", ply_xy + "1 2222222\n", 7, "ends within element 'vertex'"},
        BadFile{"value_missing", "ply", ply_xy + "1 2\n3\n    ", 8, "the line ends"},
        BadFile{"value_too_many", "ply", ply_xy + "1 2\n3 4 5\n", 8, "unexpected '5'"},
        BadFile{"nan", "ply", ply_xy + "1 2\n3 nan\n", 8, "y of point 1 is not a finite number"},
        BadFile{"overflow", "ply", ply_xy + "1e400 2\n3 4\n", 7, "x of point 0 is not a finite number"},
        BadFile{"tail", "ply", ply_xy + "1 2\n3 4\n5 6\n", 9, "after the data"}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace cadt::io::test
