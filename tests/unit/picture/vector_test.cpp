// SPDX-License-Identifier: Apache-2.0
// SVG and PDF by Cairo.
#include "io/picture/scene.hpp"
#include "tests/unit/picture/meshes.hpp"

#include <cadt/io/picture.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace cadt::io::picture;
using cadt::io::PictureOptions;
using cadt::test::Mesh;

/// A path of the file: its attributes, and the coordinates of its moves and lines.
struct Path {
  std::string attributes;
  std::vector<std::array<double, 2>> at;
  std::size_t moves = 0, closed = 0;
};

std::vector<Path> paths(const std::string& svg) {
  std::vector<Path> result;
  for (std::size_t from = svg.find("<path"); from != std::string::npos; from = svg.find("<path", from + 1)) {
    Path path;
    path.attributes = svg.substr(from, svg.find('>', from) - from);
    const std::size_t begin = path.attributes.find(" d=\"") + 4;
    std::istringstream d(path.attributes.substr(begin, path.attributes.find('"', begin) - begin));
    bool begins = false;
    for (std::string word; d >> word;) {
      if (word == "Z") {
        ++path.closed;
        begins = false;
      }
      if (word != "M" && word != "L") continue;
      path.moves += word == "M";
      path.at.emplace_back();
      d >> path.at.back()[0] >> path.at.back()[1];
      EXPECT_TRUE(d) << path.attributes;
      begins = word == "M";
    }
    if (begins) --path.moves;  // Cairo's, after the last triangle was closed
    result.push_back(path);
  }
  return result;
}

bool has(const Path& path, const std::string& text) { return path.attributes.find(text) != std::string::npos; }
/// Strokes of the edges are see-through.
bool is_edges(const Path& path) { return has(path, "stroke-opacity:0.75"); }

Path edges_of(const std::string& svg) {
  for (const Path& path : paths(svg))
    if (is_edges(path)) return path;
  return {};
}

std::string svg_of(const Mesh& mesh, const PictureOptions& options = {}) { return svg_bytes(mesh.scene(), options); }

TEST(Svg, OneSegmentForEachEdge) {
  const std::string svg = svg_of(cadt::test::lattice(5), {.width = 500});
  EXPECT_NE(svg.find("viewBox=\"0 0 500 500\""), std::string::npos) << svg.substr(0, 400);
  const Path edges = edges_of(svg);
  EXPECT_EQ(edges.moves, 4U * 5 * 2 + 4 * 4) << svg.substr(0, 2000);
  EXPECT_EQ(edges.at.size(), 2 * edges.moves);
}

TEST(Svg, CoordinatesAreThoseOfThePointsWithYUp) {
  Mesh mesh;
  mesh.xy = {0, 0, 2, 0, 0, 1};
  mesh.triangles = {0, 1, 2};
  mesh.hull = {0, 1, 2};
  const Path edges = edges_of(svg_of(mesh, {.width = 1000}));
  ASSERT_EQ(edges.at.size(), 6U);
  for (const auto& [x, y] : std::vector<std::array<double, 2>>{{15, 500}, {985, 500}, {15, 15}}) {  // margin: 1.5 %
    const auto same = [x = x, y = y](const auto& p) {
      return std::fabs(p[0] - x) < 1e-3 && std::fabs(p[1] - y) < 1e-3;
    };
    EXPECT_EQ(std::count_if(edges.at.begin(), edges.at.end(), same), 2) << x << ' ' << y;
  }
}

TEST(Svg, ExtremeCoordinatesStayInsideTheBox) {
  for (const double scale : {0x1p-1074, 1e-300, 1.0, 1e300}) {
    const Mesh mesh = cadt::test::moved(cadt::test::lattice(4), scale, scale == 1.0 ? 1e15 : 0.0);
    const Path edges = edges_of(svg_of(mesh, {.width = 200}));
    ASSERT_EQ(edges.at.size(), 2U * 33) << scale;
    double low = 1e9, high = -1e9;
    for (const auto& p : edges.at) {
      low = std::min({low, p[0], p[1]});
      high = std::max({high, p[0], p[1]});
    }
    EXPECT_NEAR(low, 3, 1e-3) << scale;
    EXPECT_NEAR(high, 197, 1e-3) << scale;
  }
}

TEST(Svg, PointsWithoutTriangles) {
  Mesh mesh;
  mesh.xy = {0, 0, 3, 2, 6, 4, std::numeric_limits<double>::infinity(), 0};
  std::size_t discs = 0;
  for (const Path& path : paths(svg_of(mesh))) discs += path.moves;
  EXPECT_EQ(discs, 3U);
}

TEST(Svg, GroundHasEachTriangleOnceAndOnlyIfShaded) {
  const Mesh mesh = cadt::test::lattice(6);
  const auto triangles = [&](bool shade) {
    std::size_t closed = 0;
    for (const Path& path : paths(svg_of(mesh, {.shade = shade})))
      if (!has(path, "fill:none")) closed += path.closed;
    return closed;
  };
  EXPECT_EQ(triangles(true), 50U);
  EXPECT_EQ(triangles(false), 0U);
}

TEST(Pdf, IsOneAndTheSameInEachRun) {
  const Mesh mesh = cadt::test::lattice(6);
  const std::string pdf = pdf_bytes(mesh.scene(), {.width = 300});
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  EXPECT_NE(pdf.find("%%EOF"), std::string::npos);
  EXPECT_NE(pdf.find("[ 0 0 300 300 ]"), std::string::npos);
  EXPECT_EQ(pdf_bytes(mesh.scene(), {.width = 300}), pdf);
  EXPECT_GT(pdf_bytes(cadt::test::lattice(40).scene(), {.width = 300}).size(), pdf.size() + 1000);
}

TEST(Picture, TooManyTrianglesAreRefusedWithAdvice) {
  cadt::io::PointSet points;
  points.xy.resize(2 * (cadt::io::most_drawn_triangles + 1));
  for (const auto write : {cadt::io::write_svg, cadt::io::write_pdf, cadt::io::write_png}) {
    const std::string name = testing::TempDir() + "cadt_too_many";
    std::remove(name.c_str());
    try {
      write(name, points, cadt::Triangulation(), {});
      FAIL() << "no error";
    } catch (const cadt::io::FileError& e) {
      EXPECT_NE(std::string(e.what()).find("cadt render"), std::string::npos) << e.what();
      EXPECT_EQ(e.path(), name);
    }
    EXPECT_FALSE(std::ifstream(name).good());
  }
}

TEST(Picture, FileHasTheBytes) {
  cadt::io::PointSet points;
  points.xy = {0, 0, 1, 1};
  const Scene scene{.xy = points.xy, .height = {}, .triangles = {}, .hull = {}};
  const std::string name = testing::TempDir() + "cadt_points";
  const auto written = [&](auto write) {
    write(name, points, cadt::Triangulation(), {});
    std::stringstream read;
    read << std::ifstream(name).rdbuf();
    std::remove(name.c_str());
    return read.str();
  };
  EXPECT_EQ(written(cadt::io::write_svg), svg_bytes(scene, {}));
  EXPECT_EQ(written(cadt::io::write_pdf), pdf_bytes(scene, {}));
  EXPECT_EQ(written(cadt::io::write_png), png_bytes(scene, {}));
}

}  // namespace
