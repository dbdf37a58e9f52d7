// SPDX-License-Identifier: Apache-2.0
// Segments in each format, and what is wrong with them.
#include <cadt/io/segments_file.hpp>

#include "tests/unit/io/io_test_support.hpp"

#include <chrono>
#include <cmath>

namespace cadt::io::test {
namespace {

using Segments = std::vector<Segment>;
using Places = std::vector<std::array<double, 2>>;

struct GoodGraph {
  const char* name;
  const char* suffix;
  std::string content;
  Values xy;
  Segments segments;
};

class SegmentReads : public ::testing::TestWithParam<GoodGraph> {};

TEST_P(SegmentReads, PointsAndSegments) {
  const Folder folder;
  const SegmentsFile graph = read_segments(folder.file(std::string("g.") + GetParam().suffix, GetParam().content));
  EXPECT_EQ(graph.xy, GetParam().xy);
  EXPECT_EQ(graph.segments, GetParam().segments);
  EXPECT_EQ(graph.format, GetParam().suffix);
}

const std::string feature = R"({"type":"Feature","properties":{"coordinates":[7],"type":"x"},"geometry":)";

INSTANTIATE_TEST_SUITE_P(
    Files, SegmentReads,
    ::testing::Values(
        GoodGraph{"poly_base_1", "poly", "2 2 0 0\n1 5 6\n2 7 8\n1 0\n1 2 1\n0\n", {5, 6, 7, 8}, {{1, 0}}},
        GoodGraph{"poly_base_0_comments",
                  "poly",
                  "# c\n2 2 0 0 # c\n0 5 6\n\n1 7 8\n# c\n1\n77 0 1 # c\n0\n# end\n",
                  {5, 6, 7, 8},
                  {{0, 1}}},
        GoodGraph{"edg", "edg", "2\n1 2 3 4\n5 6 7 8", {1, 2, 3, 4, 5, 6, 7, 8}, {{0, 1}, {2, 3}}},
        GoodGraph{"cin_sites", "cin", "s 1 2 3 4\np 5 6\n", {1, 2, 3, 4, 5, 6}, {{0, 1}}},
        GoodGraph{"cin_point_first", "cin", "p 5 6\ns 1 2 3 4\n", {5, 6, 1, 2, 3, 4}, {{1, 2}}},
        GoodGraph{"obj",
                  "obj",
                  "v 1 2 0\nl 1 3\nv 3 4 0\nv 5 6 0\nl 1/1 2/2 3/3\nl -1 -2\nf 1 2 3\n",
                  {1, 2, 3, 4, 5, 6},
                  {{0, 2}, {0, 1}, {1, 2}, {2, 1}}},
        GoodGraph{"cdt", "txt", "3 2\n0 0\n1 0\n0 1\n0 1\n1 2\n", {0, 0, 1, 0, 0, 1}, {{0, 1}, {1, 2}}},
        GoodGraph{"cdt_base_1", "txt", "3 2\n0 0\n1 0\n0 1\n1 2\n2 3\n", {0, 0, 1, 0, 0, 1}, {{0, 1}, {1, 2}}},
        GoodGraph{"detria",
                  "txt",
                  "4 1 1\n3\n2\n0 0\n1 0\n0 1\n5 5\n2\n1\n0\n0 3\n",
                  {0, 0, 1, 0, 0, 1, 5, 5},
                  {{2, 1}, {1, 0}, {0, 2}, {0, 3}}},
        GoodGraph{"detria_no_polylines", "txt", "2 0 1\n0 0\n1 0\n1 0\n", {0, 0, 1, 0}, {{1, 0}}},
        GoodGraph{"poly2tri",
                  "dat",
                  "0 0\n9 0\n0 9\nHOLE\n1 1\n2 1\n1 2\nSTEINER\n3 3\n4 4\n",
                  {0, 0, 9, 0, 0, 9, 1, 1, 2, 1, 1, 2, 3, 3, 4, 4},
                  {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}}},
        GoodGraph{"geojson_line",
                  "geojson",
                  R"({"type":"LineString","coordinates":[[1,2],[3,4],[1,2]]})",
                  {1, 2, 3, 4, 1, 2},
                  {{0, 1}, {1, 2}}},
        GoodGraph{"geojson_type_last",
                  "json",
                  R"({"coordinates":[[1,2],[3,4]],"type":"LineString"})",
                  {1, 2, 3, 4},
                  {{0, 1}}},
        GoodGraph{"geojson_lines",
                  "geojson",
                  R"({"type":"MultiLineString","coordinates":[[[1,2],[3,4]],[],[[5,6],[7,8]]]})",
                  {1, 2, 3, 4, 5, 6, 7, 8},
                  {{0, 1}, {2, 3}}},
        GoodGraph{"geojson_polygon",
                  "geojson",
                  R"({"type":"Polygon","coordinates":[[[0,0],[9,0],[0,9],[0,0]],[[1,1],[2,1],[1,2]]]})",
                  {0, 0, 9, 0, 0, 9, 1, 1, 2, 1, 1, 2},
                  {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}}},
        GoodGraph{"geojson_collection",
                  "geojson",
                  R"({"type":"FeatureCollection","bbox":[1,2,3],"features":[)" + feature +
                      R"({"type":"Point","coordinates":[1,2]}},)" + feature + R"(null},)" + feature +
                      R"({"type":"GeometryCollection","geometries":[{"type":"MultiPoint","coordinates":[[3,4]]},)"
                      R"({"type":"LineString","coordinates":[[5,6],[7,8]]}]}}]})",
                  {1, 2, 3, 4, 5, 6, 7, 8},
                  {{2, 3}}},
        GoodGraph{"geojson_empty",
                  "geojson",
                  R"({"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[]},)"
                  R"({"type":"MultiPoint","coordinates":[]},{"type":"Polygon","coordinates":[]},)"
                  R"({"type":"MultiLineString","coordinates":[[],[[5,6],[7,8]]]}]})",
                  {5, 6, 7, 8},
                  {{0, 1}}},
        GoodGraph{"rings", "json", "[[[0,0],[9,0],[0,9]],[[1,1]]]", {0, 0, 9, 0, 0, 9, 1, 1}, {{0, 1}, {1, 2}, {2, 0}}},
        GoodGraph{"ring_of_one_place", "json", "[[[3,3],[3,3]]]", {3, 3}, {}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(PolyFile, HasMarkersAttributesHolesAndRegions) {
  const Folder folder;
  const SegmentsFile graph = read_segments(
      folder.file("a.poly",
                  "2 2 2 1\n1 5 6 10 11 3\n2 7 8 12 13 -4\n1 1\n1 1 2 9\n2\n1 0.5 0.25\n2 1 2\n2\n1 3 4 8\n"
                  "2 5 6 7 0.1\n"));
  EXPECT_EQ(graph.attributes, (Values{10, 11, 12, 13}));
  EXPECT_EQ(graph.attributes_per_point, 2U);
  EXPECT_EQ(graph.markers, (std::vector<std::int32_t>{3, -4}));
  EXPECT_EQ(graph.segment_markers, (std::vector<std::int32_t>{9}));
  EXPECT_EQ(graph.holes, (Places{{0.5, 0.25}, {1, 2}}));
  ASSERT_EQ(graph.regions.size(), 2U);
  EXPECT_EQ(graph.regions[0].attribute, 8);
  EXPECT_EQ(graph.regions[1].x, 5);
  EXPECT_EQ(graph.regions[1].y, 6);
  EXPECT_EQ(graph.regions[1].attribute, 7);
  EXPECT_EQ(graph.base, 1);
}

TEST(PolyFile, TakesPointsFromTheNodeFileBesideIt) {
  const Folder folder;
  static_cast<void>(folder.file("a.1.node", "2 2 0 1\n0 5 6 1\n1 7 8 2\n"));
  const SegmentsFile poly = read_segments(folder.file("a.1.poly", "0 2 0 1\n1 0\n1 0 1\n0\n"));
  EXPECT_EQ(poly.xy, (Values{5, 6, 7, 8}));
  EXPECT_EQ(poly.markers, (std::vector<std::int32_t>{1, 2}));
  EXPECT_EQ(poly.segments, (Segments{{0, 1}}));
  const SegmentsFile edge = read_segments(folder.file("a.1.edge", "1 1\n0 1 0 5\n"));
  EXPECT_EQ(edge.xy, poly.xy);
  EXPECT_EQ(edge.segments, (Segments{{1, 0}}));
  EXPECT_EQ(edge.segment_markers, (std::vector<std::int32_t>{5}));
}

TEST(GeoJson, KeepsTheSignOfZero) {
  const Folder folder;
  const SegmentsFile line =
      read_segments(folder.file("a.json", R"({"type":"LineString","coordinates":[[-0,0],[-0.0,-1]]})"));
  EXPECT_TRUE(std::signbit(line.xy[0]) && std::signbit(line.xy[2]));
  EXPECT_FALSE(std::signbit(line.xy[1]));
}

TEST(Obj, LongLinesAreReadInLinearTime) {
  constexpr int n = 300000;
  std::string text, line = "l";
  for (int i = 1; i <= n; ++i) {
    text += "v " + std::to_string(i) + " 0 0\n";
    line += " " + std::to_string(i);
  }
  const Folder folder;
  const std::string file = folder.file("a.obj", text + line + "\n");
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(read_segments(file).segments.size(), std::size_t{n - 1});
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));  // 100 if each vertex counts the rest
}

TEST(ThirdCoordinates, BecomeTheAttribute) {
  const Folder folder;
  EXPECT_EQ(read_segments(folder.file("a.obj", "v 1 2 3\nv 4 5 6\nl 1 2\n")).attributes, (Values{3, 6}));
  EXPECT_EQ(read_segments(folder.file("a.json", R"({"type":"LineString","coordinates":[[1,2,3],[4,5,6]]})")).attributes,
            (Values{3, 6}));
  const SegmentsFile mixed =
      read_segments(folder.file("b.json", R"({"type":"LineString","coordinates":[[1,2,3],[4,5]]})"));
  EXPECT_EQ(mixed.attributes, Values());
  EXPECT_EQ(mixed.attributes_per_point, 0U);
  const SegmentsFile apart = read_segments(
      folder.file("c.json", R"({"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[1,2,3]},)"
                            R"({"type":"Point","coordinates":[4,5]}]})"));
  EXPECT_EQ(apart.attributes, Values());
  EXPECT_EQ(apart.attributes_per_point, 0U);
}

TEST(Polygons, HaveOffsetsAndFeatures) {
  const Folder folder;
  const std::string square = "[[0,0],[4,0],[4,4],[0,4],[0,0]]", hole = "[[1,1],[1,2],[2,2],[1,1]]";
  const PolygonsFile file = read_polygons(
      folder.file("a.geojson", R"({"type":"FeatureCollection","features":[)" + feature +
                                   R"({"type":"Point","coordinates":[1,2]}},)" + feature +
                                   R"({"type":"MultiPolygon","coordinates":[[)" + square + "," + hole + "],[" + hole +
                                   "]]}}," + feature + R"({"type":"Polygon","coordinates":[)" + square + "]}}]}"));
  EXPECT_EQ(file.ring_offsets, (std::vector<std::int64_t>{0, 4, 7, 10, 14}));
  EXPECT_EQ(file.polygon_offsets, (std::vector<std::int64_t>{0, 2, 3, 4}));
  EXPECT_EQ(file.features, (std::vector<std::int32_t>{1, 1, 2}));
  EXPECT_EQ(file.number_of_features, 3U);
  EXPECT_EQ(file.other_geometries, 1U);
  EXPECT_EQ(file.xy.size(), 28U);
  EXPECT_EQ(read_polygons(folder.file("b.json", "[" + square + "," + hole + "]")).polygon_offsets,
            (std::vector<std::int64_t>{0, 2}));
  EXPECT_EQ(file.height, Values());
  EXPECT_EQ(file.crs, "");
  const std::string line = folder.file("c.json", R"({"type":"LineString","coordinates":[[1,2],[3,4]]})");
  expect_file_error([&] { static_cast<void>(read_polygons(line)); }, line, 0, "has no polygons");
}

/// An empty ring is one, and a polygon without rings has one of those, so that none is lost, nor a hole an outline.
TEST(Polygons, KeepRingsWithoutPoints) {
  const Folder folder;
  const std::string square = "[[0,0],[4,0],[4,4],[0,4],[0,0]]";
  struct Case {
    const char* type;
    std::string coordinates;
    std::vector<std::int64_t> rings, polygons;
  };
  for (const Case& one :
       {Case{"Polygon", "[]", {0, 0}, {0, 1}},
        {"Polygon", "[[]]", {0, 0}, {0, 1}},
        {"Polygon", "[" + square + ",[]]", {0, 4, 4}, {0, 2}},
        {"Polygon", "[[]," + square + "]", {0, 0, 4}, {0, 2}},
        {"MultiPolygon", "[[" + square + "],[],[[]," + square + "]]", {0, 4, 4, 4, 8}, {0, 1, 2, 4}}}) {
    SCOPED_TRACE(one.coordinates);
    const PolygonsFile file = read_polygons(
        folder.file("a.json", R"({"type":")" + std::string(one.type) + R"(","coordinates":)" + one.coordinates + "}"));
    EXPECT_EQ(file.ring_offsets, one.rings);
    EXPECT_EQ(file.polygon_offsets, one.polygons);
  }
  const std::string none = folder.file("b.json", R"({"type":"MultiPolygon","coordinates":[]})");
  expect_file_error([&] { static_cast<void>(read_polygons(none)); }, none, 0, "has no polygons");
}

TEST(Polygons, HaveHeightsAndTheReferenceSystem) {
  const Folder folder;
  const std::string ring = R"({"type":"Polygon","coordinates":[[[0,0,5],[4,0,6],[4,4,7],[0,0,5]]]})";
  const std::string flat = R"({"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,0]]]})";
  const std::string crs = R"("crs":{"type":"name","properties":{"name":"EPSG:2056","of":"x"}})";
  const auto read = [&](const std::string& members, const std::string& geometries) {
    return read_polygons(
        folder.file("a.json", R"({"type":"GeometryCollection",)" + members + R"("geometries":[)" + geometries + "]}"));
  };
  EXPECT_EQ(read("", ring).height, (Values{5, 6, 7}));
  EXPECT_EQ(read("", ring + "," + ring).height, (Values{5, 6, 7, 5, 6, 7}));
  EXPECT_EQ(read("", ring + "," + flat).height, Values());
  EXPECT_EQ(read(crs + ",", ring).crs, "EPSG:2056");
  // names of other things, and of a part
  for (const char* other :
       {R"("name":"a",)", R"("crs":null,)", R"("crs":{"name":"a"},)", R"("crs":{"properties":{"href":"a"}},)",
        R"("also":{"properties":{"name":"a"}},)", R"("crs":{"properties":{"a":{"name":"a"}}},)"}) {
    EXPECT_EQ(read(other, ring).crs, "") << other;
  }
  EXPECT_EQ(read("", R"({"type":"Feature",)" + crs + R"(,"geometry":)" + ring + "}").crs, "");
}

struct BadGraph {
  const char* name;
  const char* suffix;
  std::string content;
  std::size_t line;
  const char* message;
};

class SegmentErrors : public ::testing::TestWithParam<BadGraph> {};

TEST_P(SegmentErrors, NameTheLine) {
  const Folder folder;
  const std::string path = folder.file(std::string("g.") + GetParam().suffix, GetParam().content);
  expect_file_error([&] { static_cast<void>(read_segments(path)); }, path, GetParam().line, GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Files, SegmentErrors,
    ::testing::Values(
        BadGraph{"empty", "poly", "", 0, "is empty"}, BadGraph{"format", "svg", "x", 0, "known: poly edge edg"},
        BadGraph{"poly_index", "poly", "2 2 0 0\n1 5 6\n2 7 8\n1 0\n1 0 2\n0\n", 5,
                 "index 0 is out of range: the 2 points count from 1"},
        BadGraph{"poly_index_behind", "poly", "2 2 0 0\n0 5 6\n1 7 8\n1 0\n1 0 2\n0\n", 5,
                 "index 2 is out of range: the 2 points count from 0"},
        BadGraph{"poly_too_many_segments", "poly", "1 2 0 0\n1 5 6\n99 0\n1 1 1\n0\n", 3,
                 "more than the file has room"},
        BadGraph{"poly_marker_missing", "poly", "1 2 0 0\n1 5 6\n1 1\n1 1 1\n0\n", 4, "the marker should be"},
        BadGraph{"poly_marker_extra", "poly", "1 2 0 0\n1 5 6\n1 0\n1 1 1 4\n0\n", 4, "unexpected '4'"},
        BadGraph{"poly_no_holes", "poly", "1 2 0 0\n1 5 6\n1 0\n1 1 1\n", 4, "the number of holes should be"},
        BadGraph{"poly_hole_cut", "poly", "1 2 0 0\n1 5 6\n0 0\n1\n1 5   \n", 5, "y should be"},
        BadGraph{"poly_hole_nan", "poly", "1 2 0 0\n1 5 6\n0 0\n1\n1 5 nan\n", 5, "'nan' is not a finite number"},
        BadGraph{"poly_region_attribute", "poly", "1 2 0 0\n1 5 6\n0 0\n0\n1\n1 5 6\n", 6, "the attribute should be"},
        BadGraph{"poly_region_extra", "poly", "1 2 0 0\n1 5 6\n0 0\n0\n1\n1 5 6 7 8 9\n", 6, "unexpected '9'"},
        BadGraph{"poly_rest", "poly", "1 2 0 0\n1 5 6\n0 0\n0\n0\nmore\n", 6, "unexpected 'more'"},
        BadGraph{"poly_no_node_file", "poly", "0 2 0 0\n1 0\n1 1 2\n0\n", 1, "there is no file"},
        BadGraph{"poly_dimension", "poly", "1 3 0 0\n1 5 6 7\n0 0\n0\n", 1, "the dimension must be 2"},
        BadGraph{"edg_short", "edg", "2\n1 2 3 4\n", 1, "more than the file has room"},
        BadGraph{"edg_word", "edg", "1\n1 2 x 4\n", 2, "x: 'x' is not a decimal number"},
        BadGraph{"edg_rest", "edg", "1\n1 2 3 4\n5 6 7 8\n", 3, "unexpected '5 6 7 8'"},
        BadGraph{"cin_site", "cin", "s 1 2 3 4\nq 1 2\n", 2, "'q' is not a site"},
        BadGraph{"obj_range", "obj", "v 1 2 3\nl 1 2\nv 1 2 3\nl 1 3\n", 4, "vertex 3 is out of range: there are 2"},
        BadGraph{"obj_zero", "obj", "v 1 2 3\nl 0 1\n", 2, "'0' is not the number of a vertex"},
        BadGraph{"obj_negative", "obj", "v 1 2 3\nl -2 1\n", 2, "vertex -2 is before the first"},
        BadGraph{"obj_alone", "obj", "v 1 2 3\nl 1\n", 2, "a line needs two vertices"},
        BadGraph{"obj_keyword", "obj", "v 1 2 3\nx\n", 2, "is not a keyword of OBJ"},
        BadGraph{"txt_header", "txt", "1 2 3 4\n", 1, "CDT's files have two numbers"},
        BadGraph{"cdt_index", "txt", "2 2\n0 0\n1 0\n0 1\n1 2\n", 5,
                 "index 2 is out of range: the 2 points count from 0"},
        BadGraph{"cdt_index_negative", "txt", "2 1\n0 0\n1 0\n-1 1\n", 4, "index -1 is out of range"},
        BadGraph{"cdt_end", "txt", "2 1\n0 0\n1 0\n", 3, "the file ends where an edge should be"},
        BadGraph{"detria_type", "txt", "3 1 0\n3\n3\n0 0\n1 0\n0 1\n0\n1\n2\n", 3, "more than the file has room"},
        BadGraph{"detria_index", "txt", "3 1 0\n3\n2\n0 0\n1 0\n0 1\n0\n1\n3\n", 9, "index 3 is out of range"},
        BadGraph{"dat_word", "dat", "0 0\n1 1\nHOLES\n", 3, "'HOLES' is not a decimal number"},
        BadGraph{"json_syntax", "json", "{\n\"type\": \"Point\",\n]", 3, "is no JSON: "},
        BadGraph{"json_number_only", "json", "\n7", 2, "neither an object nor an array"},
        BadGraph{"json_overflow", "json", "[\n[[1,2],\n[1e999,2]]]", 3, "a number is beyond the largest double"},
        BadGraph{"json_null_feature", "json", "{\"type\": \"FeatureCollection\", \"features\": [null]}", 1,
                 "a feature is null"},
        BadGraph{"json_no_type", "json", "{\"a\": 1}", 1, "an object has no 'type'"},
        BadGraph{"json_other_type", "json", "{\"type\":\n\"Topology\"}", 2, "'Topology' is no type of it"},
        BadGraph{"json_depth", "json", R"({"type":"Polygon","coordinates":[[1,2],[3,4]]})", 1,
                 "are in 2 arrays instead of 3"},
        BadGraph{"json_mixed_depth", "json", "[[[1,2],\n[[3,4]]]]", 2, "positions are in different numbers of arrays"},
        BadGraph{"json_one_number", "json", "[[[1,2],\n[3]]]", 2, "a position needs two numbers"},
        BadGraph{"json_no_number", "json", "[[[1,2],\n[],[3,4]]]", 2, "a position needs two numbers"},
        BadGraph{"json_no_number_first", "json",
                 R"({"type":"LineString","coordinates":[)"
                 "\n[],[1,2]]}",
                 2, "a position needs two numbers"},
        BadGraph{"json_no_number_multipoint", "json", R"({"type":"MultiPoint","coordinates":[[1,2],[]]})", 1,
                 "a position needs two numbers"},
        BadGraph{"json_no_number_at_all", "json", R"({"type":"MultiPolygon","coordinates":[[[[]]]]})", 1,
                 "a position needs two numbers"},
        BadGraph{"json_coordinates_twice", "json",
                 R"({"type":"Point","coordinates":[1,2],)"
                 "\n\"coordinates\":[3,4]}",
                 2, "there are coordinates a second time"},
        BadGraph{"json_array_in_position", "json", "[[[1,\n[2]]]]", 2, "an array is where a number should be"},
        BadGraph{"json_text", "json", "[[[1,\n\"2\"]]]", 2, "text is where numbers should be"},
        BadGraph{"json_null", "json", "[[[1,\nnull]]]", 2, "null is where numbers should be"},
        BadGraph{"json_object", "json", "[[[1,2],\n{}]]", 2, "an object is where numbers should be"},
        BadGraph{"json_features", "json", "{\"type\":\"FeatureCollection\",\n\"features\":7}", 2,
                 "'features' is a number"},
        BadGraph{"json_no_coordinates", "json", R"({"type":"Point"})", 1, "the Point has no coordinates"},
        BadGraph{"json_no_points", "json", R"({"type":"FeatureCollection","features":[]})", 0, "has no points"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(WrittenSegments, ReadBack) {
  const Folder folder;
  const std::string first =
      folder.file("a.poly",
                  "3 2 1 1\n0 0.1 0 10 3\n1 1 0 12 -4\n2 0 1 5 0\n2 1\n0 0 1 9\n1 2 1 0\n1\n0 0.5 0.25\n1\n0 "
                  "0.125 4 8\n");
  const SegmentsFile graph = read_segments(first);
  for (const int base : {0, 1}) {
    WriteSegmentsOptions options;
    options.base = base;
    write_segments(folder / "b.poly", graph, options);
    const SegmentsFile again = read_segments(folder / "b.poly");
    EXPECT_EQ(again.base, base);
    EXPECT_EQ(again.xy, graph.xy);
    EXPECT_EQ(again.attributes, graph.attributes);
    EXPECT_EQ(again.markers, graph.markers);
    EXPECT_EQ(again.segments, graph.segments);
    EXPECT_EQ(again.segment_markers, graph.segment_markers);
    EXPECT_EQ(again.holes, graph.holes);
    ASSERT_EQ(again.regions.size(), 1U);
    EXPECT_EQ(again.regions[0].x, 0.125);
    EXPECT_EQ(again.regions[0].attribute, 8);
    static_cast<void>(folder.file("c.node", base == 0 ? "3 2\n0 0 0\n1 1 0\n2 0 1\n" : "3 2\n1 0 0\n2 1 0\n3 0 1\n"));
    write_segments(folder / "c.edge", graph, options);
    EXPECT_EQ(read_segments(folder / "c.edge").segments, graph.segments);
    EXPECT_EQ(read_segments(folder / "c.edge").segment_markers, graph.segment_markers);
  }
  EXPECT_EQ(folder.entries(), 4U);
}

}  // namespace
}  // namespace cadt::io::test
