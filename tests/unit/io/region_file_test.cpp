// SPDX-License-Identifier: Apache-2.0
// Triangles in regions, in each format that they are written to.
#include <cadt/io/region_file.hpp>
#include <cadt/io/segments_file.hpp>

#include <array>
#include <regex>
#include <set>

#include "tests/unit/io/io_test_support.hpp"

namespace cadt::io::test {
namespace {

/// A square of two triangles with a diagonal between them, and a point in none.
struct Square {
  std::vector<double> xy{0, 0, 4, 0, 4, 4, 0, 4, 0.1, 9};
  std::vector<double> height{1, 2, 3, 4, 5};
  std::vector<std::int32_t> triangles{0, 1, 2, 0, 2, 3}, region{7, -2};
  std::vector<Segment> segments{{0, 2}, {0, 1}};
  [[nodiscard]] RegionMesh mesh() const {
    RegionMesh mesh;
    mesh.xy = xy;
    mesh.triangles = triangles;
    mesh.region = region;
    mesh.region_name = "label";
    mesh.segments = segments;
    return mesh;
  }
};

TEST(RegionFile, GeoJsonHasAPolygonATriangle) {
  const Folder folder;
  const Square square;
  write_region_mesh(folder / "a.geojson", square.mesh());
  const PolygonsFile file = read_polygons(folder / "a.geojson");
  EXPECT_EQ(file.xy, (Values{0, 0, 4, 0, 4, 4, 0, 0, 4, 4, 0, 4}));
  EXPECT_EQ(file.ring_offsets, (std::vector<std::int64_t>{0, 3, 6}));
  EXPECT_EQ(file.number_of_features, 2U);
  const std::string text = content_of(folder / "a.geojson");
  EXPECT_LT(text.find("\"label\":7"), text.find("\"label\":-2"));
  EXPECT_NE(text.find("\"label\":-2"), std::string::npos);
  EXPECT_NE(text.find("[[[0,0],[4,0],[4,4],[0,0]]]"), std::string::npos) << text;
  EXPECT_EQ(file.crs, "");
  EXPECT_EQ(text.find("crs"), std::string::npos);

  RegionMesh named = square.mesh();
  named.crs = "urn:ogc:def:crs:EPSG::25832 \"quoted\\";
  write_region_mesh(folder / "b.geojson", named);
  EXPECT_EQ(read_polygons(folder / "b.geojson").crs, named.crs);
  EXPECT_EQ(read_segments(folder / "b.geojson").crs, named.crs);

  RegionMesh high = square.mesh();
  high.height = square.height;
  high.region = {};
  write_region_mesh(folder / "b.geojson", high);
  EXPECT_EQ(read_segments(folder / "b.geojson").attributes, (Values{1, 2, 3, 1, 3, 4}));
  EXPECT_EQ(content_of(folder / "b.geojson").find("label"), std::string::npos);
}

TEST(RegionFile, MeshesHaveRegionsOfTriangles) {
  const Folder folder;
  const Square square;
  for (const bool ascii : {false, true}) {
    WriteOptions options;
    options.ascii = ascii;
    write_region_mesh(folder / "a.ply", square.mesh(), options);
    EXPECT_EQ(read_mesh(folder / "a.ply", 5).triangles, square.triangles);
    EXPECT_EQ(read_points(folder / "a.ply").xy, square.xy);
    const std::string text = content_of(folder / "a.ply");
    EXPECT_NE(text.find("property int label\nend_header"), std::string::npos);
    if (ascii) {
      EXPECT_NE(text.find("\n3 0 1 2 7\n3 0 2 3 -2\n"), std::string::npos) << text;
    } else {
      EXPECT_TRUE(text.ends_with(bytes(std::int32_t{3}) + bytes(std::int32_t{-2})));
    }
  }
  write_region_mesh(folder / "a.vtu", square.mesh());
  EXPECT_EQ(read_mesh(folder / "a.vtu", 5).triangles, square.triangles);
  const std::string vtu = content_of(folder / "a.vtu");
  EXPECT_NE(vtu.find("<CellData Scalars=\"label\">\n<DataArray type=\"Int32\" Name=\"label\""), std::string::npos);
  EXPECT_NE(vtu.find(bytes(std::uint64_t{8}) + bytes(std::int32_t{7}) + bytes(std::int32_t{-2}) + "\n</AppendedData>"),
            std::string::npos);
  WriteOptions from_one;
  from_one.base = 1;
  write_region_mesh(folder / "a.ele", square.mesh(), from_one);
  EXPECT_EQ(read_mesh(folder / "a.ele", 5).triangles, square.triangles);
  EXPECT_TRUE(
      std::regex_search(content_of(folder / "a.ele"), std::regex("2  3  1\\s+1 +1 +2 +3 +7\\s+2 +1 +3 +4 +-2\\s")));
  for (const char* format : {"obj", "off", "glb", "node"}) {
    write_region_mesh(folder / (std::string("a.") + format), square.mesh());
    EXPECT_NE(content_of(folder / (std::string("a.") + format)), "");
  }
}

TEST(RegionFile, SegmentsGoToPolyAndEdge) {
  const Folder folder;
  const Square square;
  RegionMesh mesh = square.mesh();
  mesh.height = square.height;
  WriteOptions from_one;
  from_one.base = 1;
  write_region_mesh(folder / "a.poly", mesh, from_one);
  const SegmentsFile graph = read_segments(folder / "a.poly");
  EXPECT_EQ(graph.xy, square.xy);
  EXPECT_EQ(graph.attributes, square.height);
  EXPECT_EQ(graph.segments, square.segments);
  EXPECT_EQ(graph.base, 1);
  write_region_mesh(folder / "a.node", mesh);
  write_region_mesh(folder / "a.edge", mesh);
  EXPECT_EQ(read_segments(folder / "a.edge").segments, square.segments);
}

TEST(RegionFile, PicturesHaveAColourARegionAndThickSegments) {
  const Folder folder;
  const Square square;
  const auto fills = [&](const RegionMesh& mesh) {
    write_region_mesh(folder / "a.svg", mesh);
    const std::string svg = content_of(folder / "a.svg");
    std::set<std::string> found;
    const std::regex fill("fill:(rgb[^;]*);");
    for (auto at = std::sregex_iterator(svg.begin(), svg.end(), fill); at != std::sregex_iterator(); ++at)
      found.insert((*at)[1]);
    return found;
  };
  const auto widest = [&] {
    const std::string svg = content_of(folder / "a.svg");
    double width = 0;
    const std::regex stroke("stroke-width:([0-9.]+);stroke-linecap:round[^>]*d=\"M [0-9. ]*L");
    for (auto at = std::sregex_iterator(svg.begin(), svg.end(), stroke); at != std::sregex_iterator(); ++at)
      width = std::max(width, std::stod((*at)[1]));
    return width;
  };
  RegionMesh mesh = square.mesh();
  const std::size_t two = fills(mesh).size();
  const double thick = widest();
  mesh.segments = {};
  EXPECT_EQ(fills(mesh).size(), two);
  EXPECT_LT(2 * widest(), thick);
  const std::vector<std::int32_t> same{4, 4};
  mesh.region = same;
  const auto one = fills(mesh);
  mesh.region = {};
  EXPECT_EQ(fills(mesh), one) << "a single region looks like none";
  EXPECT_EQ(one.size() + 1, two);
  for (const char* format : {"png", "pdf"}) {
    write_region_mesh(folder / (std::string("a.") + format), square.mesh());
    EXPECT_GT(content_of(folder / (std::string("a.") + format)).size(), 200U);
  }
}

TEST(RegionFile, RefusesWhatDoesNotFit) {
  const Folder folder;
  const Square square;
  const std::string path = folder / "a.geojson";
  const auto expect = [&](const RegionMesh& mesh, const char* message) {
    expect_file_error([&] { write_region_mesh(path, mesh); }, path, 0, message);
  };
  RegionMesh mesh = square.mesh();
  mesh.region = mesh.region.first(1);
  expect(mesh, "differ in number");
  mesh = square.mesh();
  mesh.xy = mesh.xy.first(6);
  expect(mesh, "an index to be written is out of range");
  mesh = square.mesh();
  const std::vector<Segment> wrong{{0, 5}};
  mesh.segments = wrong;
  expect(mesh, "an index to be written is out of range");
  const std::string unknown = folder / "a.stl";
  expect_file_error([&] { write_region_mesh(unknown, square.mesh()); }, unknown, 0, "known: node ele");
  EXPECT_EQ(folder.entries(), 0U);
}

}  // namespace
}  // namespace cadt::io::test
