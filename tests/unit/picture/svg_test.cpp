// SPDX-License-Identifier: Apache-2.0
#include "io/picture/scene.hpp"
#include "tests/unit/picture/meshes.hpp"

#include <cadt/io/picture.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace cadt::io::picture;
using cadt::test::Mesh;

/// The d attribute of the path with this id, empty if there is none.
std::string path(const std::string& svg, const std::string& id) {
  const std::size_t at = svg.find("<path id=\"" + id + "\"");
  if (at == std::string::npos) return {};
  const std::size_t begin = svg.find(" d=\"", at) + 4;
  return svg.substr(begin, svg.find('"', begin) - begin);
}

auto count(const std::string& text, char c) { return std::count(text.begin(), text.end(), c); }

std::vector<double> numbers(std::string text) {
  for (char& c : text) {
    if (c == 'M' || c == 'L' || c == 'z' || c == 'h') c = ' ';
  }
  std::istringstream in(text);
  std::vector<double> out;
  for (double v = 0; in >> v;) out.push_back(v);
  EXPECT_TRUE(in.eof()) << "not a number after " << out.size();
  return out;
}

TEST(Svg, OneSegmentForEachEdgeAndOneCornerForEachHullPoint) {
  const Mesh mesh = cadt::test::lattice(5);
  const std::string svg = svg_text(mesh.scene(), {.width = 500});
  EXPECT_NE(svg.find("viewBox=\"0 0 500 500\""), std::string::npos);
  EXPECT_EQ(count(path(svg, "edges"), 'M'), 4 * 5 * 2 + 4 * 4);
  EXPECT_EQ(count(path(svg, "edges"), 'L'), 4 * 5 * 2 + 4 * 4);
  EXPECT_EQ(count(path(svg, "hull"), 'M') + count(path(svg, "hull"), 'L'), 16);
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
}

TEST(Svg, CoordinatesAreThoseOfThePointsWithYUp) {
  Mesh mesh;
  mesh.xy = {0, 0, 2, 0, 0, 1};
  mesh.triangles = {0, 1, 2};
  mesh.hull = {0, 1, 2};
  const auto hull = numbers(path(svg_text(mesh.scene(), {.width = 1000}), "hull"));
  ASSERT_EQ(hull.size(), 6u);
  EXPECT_DOUBLE_EQ(hull[0], 15);  // margin: 1.5 %
  EXPECT_DOUBLE_EQ(hull[2], 985);
  EXPECT_DOUBLE_EQ(hull[4], 15);
  EXPECT_DOUBLE_EQ(hull[1], 500);  // 970 / 2 + 2 * 15, less the margin
  EXPECT_DOUBLE_EQ(hull[5], 15);
}

TEST(Svg, ExtremeCoordinatesStayInsideTheBox) {
  const double scales[] = {0x1p-1074, 1e-300, 1.0, 1e300};
  for (const double scale : scales) {
    const Mesh mesh = cadt::test::moved(cadt::test::lattice(4), scale, scale == 1.0 ? 1e15 : 0.0);
    const std::string svg = svg_text(mesh.scene(), {.width = 200});
    const auto all = numbers(path(svg, "edges"));
    EXPECT_EQ(all.size(), 4u * 33u);
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    EXPECT_DOUBLE_EQ(*low, 3) << scale;
    EXPECT_DOUBLE_EQ(*high, 197) << scale;
  }
}

TEST(Svg, PointsWithoutTriangles) {
  Mesh mesh;
  mesh.xy = {0, 0, 3, 2, 6, 4, std::numeric_limits<double>::infinity(), 0};
  const std::string svg = svg_text(mesh.scene(), {});
  EXPECT_EQ(count(path(svg, "points"), 'M'), 3);
  EXPECT_EQ(path(svg, "edges"), "");
}

TEST(Svg, GroundHasEachTriangleOnceAndOnlyIfShaded) {
  const Mesh mesh = cadt::test::lattice(6);
  const auto closed = [](const std::string& svg) { return count(svg, 'z'); };
  EXPECT_EQ(closed(svg_text(mesh.scene(), {})) - closed(svg_text(mesh.scene(), {.shade = false})), 50);
}

TEST(Svg, TooManyTrianglesAreRefusedWithAdvice) {
  cadt::io::PointSet points;
  points.xy.resize(2 * (svg_max_faces + 1));
  const std::string name = testing::TempDir() + "cadt_too_many.svg";
  std::remove(name.c_str());
  try {
    cadt::io::write_svg(name, points, cadt::Triangulation());
    FAIL() << "no error";
  } catch (const cadt::io::FileError& e) {
    EXPECT_NE(std::string(e.what()).find(".png"), std::string::npos) << e.what();
    EXPECT_EQ(e.path(), name);
  }
  EXPECT_FALSE(std::ifstream(name).good());
}

TEST(Svg, FileHasTheText) {
  cadt::io::PointSet points;
  points.xy = {0, 0, 1, 1};
  const std::string name = testing::TempDir() + "cadt_points.svg";
  cadt::io::write_svg(name, points, cadt::Triangulation());
  std::stringstream read;
  read << std::ifstream(name).rdbuf();
  EXPECT_EQ(read.str(), svg_text({.xy = points.xy, .height = {}, .triangles = {}, .hull = {}}, {}));
  std::remove(name.c_str());
}

}  // namespace
