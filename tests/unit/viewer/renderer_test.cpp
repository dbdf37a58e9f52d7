// SPDX-License-Identifier: Apache-2.0
// The picture against a reference: triangles that are painted one by one on the host, with many samples a pixel.
#include "viewer/draw/renderer.hpp"

#include <cadt/io/generate.hpp>
#include <cadt/triangulation.hpp>

#include "viewer/draw/palette.hpp"
#include "viewer/gl/context.hpp"
#include "viewer/still/scene_values.hpp"
#include "viewer/still/still.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace {

using namespace cadt;
using namespace cadt::viewer;

struct Scene {
  io::PointSet points;
  Triangulation mesh;
};

Scene scene_of(const std::string& name, std::size_t n) {
  io::GenerateOptions options;
  options.n = n;
  Scene scene{io::generate(name, options), {}};
  scene.mesh = triangulate(scene.points.view());
  return scene;
}

Scene moved(Scene scene, double scale, double x, double y) {
  for (std::size_t i = 0; i < scene.points.xy.size(); i += 2) {
    scene.points.xy[i] = scene.points.xy[i] * scale + x;
    scene.points.xy[i + 1] = scene.points.xy[i + 1] * scale + y;
  }
  return scene;
}

/// A context and a renderer with a mesh in it.
struct Drawing {
  gl::HeadlessContext context;
  Renderer renderer;
  MeshBuffers buffers;
  Camera camera;
  Style style;
  Drawing(const Scene& scene, int width, int height, ColourBy colour)
      : buffers(MeshBuffers::copy(scene.points.xy, scene.mesh.triangles())), camera(buffers.box, width, height) {
    style.colour = colour;
    style.line_width = 0;
    renderer.update(buffers);
    prepare_colour(renderer, buffers, io::picture::scene_of(scene.points, scene.mesh), colour);
  }
  Image draw(std::span<const Stroke> strokes = {}) {
    renderer.draw(buffers, camera, style, strokes);
    EXPECT_EQ(gl::errors_seen(), 0);
    return renderer.read();
  }
};

std::array<int, 3> at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                                   static_cast<std::size_t>(x));
  return {p[0], p[1], p[2]};
}
std::array<int, 3> bytes(std::uint32_t rgb) {
  return {static_cast<int>(rgb >> 16), static_cast<int>(rgb >> 8 & 255), static_cast<int>(rgb & 255)};
}
int difference(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// Share of the pixels that differ by more than `bound` in a channel.
double share_of_different(const Image& a, const Image& b, int bound) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  std::size_t different = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) different += difference(at(a, x, y), at(b, x, y)) > bound;
  return static_cast<double>(different) / (static_cast<double>(a.width) * a.height);
}

/// Which triangle has the place, by orientation in long double; -1: none.
std::ptrdiff_t triangle_of(const Scene& scene, double x, double y) {
  const auto t = scene.mesh.triangles();
  for (std::size_t i = 0; i + 2 < t.size(); i += 3) {
    const auto side = [&](std::size_t k) {
      const auto a = static_cast<std::size_t>(t[i + k]), b = static_cast<std::size_t>(t[i + (k + 1) % 3]);
      const auto& p = scene.points.xy;
      return static_cast<long double>(p[2 * b] - p[2 * a]) * (y - p[2 * a + 1]) -
             static_cast<long double>(p[2 * b + 1] - p[2 * a + 1]) * (x - p[2 * a]);
    };
    if (side(0) >= 0 && side(1) >= 0 && side(2) >= 0) return static_cast<std::ptrdiff_t>(i / 3);
  }
  return -1;
}

TEST(Renderer, EachPixelBelongsToTheTriangleThatHasIt) {
  const Scene scene = scene_of("uniform", 60);
  Drawing drawing(scene, 120, 100, ColourBy::nothing);
  drawing.style.samples = 1;
  (void)drawing.draw();
  int wrong = 0;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 120; ++x) {
      const auto place = drawing.camera.place(x + 0.5, y + 0.5);
      const auto found = drawing.renderer.triangle_at(x, y);
      wrong += triangle_of(scene, place[0], place[1]) != (found ? static_cast<std::ptrdiff_t>(*found) : -1);
    }
  }
  EXPECT_LE(wrong, 2) << "but for places on an edge";
}

TEST(Renderer, EachSampleInTheHullBelongsToOneTriangle) {
  // A lattice whose lines go through the samples: each of them lies on an edge.
  Scene scene;
  for (int i = 0; i <= 32; ++i)
    for (int j = 0; j <= 32; ++j) scene.points.xy.insert(scene.points.xy.end(), {i + 0.5, j + 0.5});
  scene.mesh = triangulate(scene.points.view());
  Drawing drawing(scene, 64, 64, ColourBy::nothing);
  drawing.style.samples = 1;
  drawing.camera = Camera(Extent{{0, 0}, {64, 64}}, 64, 64);
  drawing.camera.zoom(64.0 / 58.0, 32, 32);  // margins of three pixels
  (void)drawing.draw();
  std::vector<int> pixels(scene.mesh.number_of_triangles(), 0);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      if (const auto found = drawing.renderer.triangle_at(x, y)) ++pixels[*found];
    }
  }
  int sum = 0;
  for (const int count : pixels) sum += count;
  EXPECT_EQ(sum, 32 * 32) << "half open: each lattice point belongs to one cell";
}

TEST(Renderer, ColoursAreThoseOfTheRamp) {
  const Scene scene = scene_of("uniform", 40);
  Drawing drawing(scene, 200, 200, ColourBy::order);
  const Image image = drawing.draw();
  const double n = static_cast<double>(scene.mesh.number_of_triangles());
  int seen = 0;
  for (int y = 2; y < 200; y += 3) {
    for (int x = 2; x < 200; x += 3) {
      const auto found = drawing.renderer.triangle_at(x, y);
      if (!found) continue;
      bool inside = true;  // all around, too
      for (const auto& [dx, dy] : std::vector<std::array<int, 2>>{{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {1, 1}, {-1, -1}})
        inside = inside && drawing.renderer.triangle_at(x + dx, y + dy) == found;
      if (!inside) continue;
      ++seen;
      const auto colour = ramp_for(ColourBy::order)(static_cast<float>(static_cast<double>(*found) / n));
      EXPECT_LE(difference(at(image, x, y), bytes(io::picture::to_srgb(colour))), 2) << *found;
    }
  }
  EXPECT_GT(seen, 500);
}

TEST(Renderer, OutsideOfTheHullIsBackground) {
  const Scene scene = scene_of("gaussian", 3000);
  for (const bool dark : {false, true}) {
    Drawing drawing(scene, 100, 100, ColourBy::area);
    drawing.style.dark = dark;
    const Image image = drawing.draw();
    EXPECT_EQ(at(image, 4, 4), bytes(palette(dark).background));
    EXPECT_EQ(at(image, 95, 96), bytes(palette(dark).background));
    EXPECT_GT(difference(at(image, 50, 50), bytes(palette(dark).background)), 5);
  }
}

/// The same picture from four times as many samples along each side, averaged in linear light.
Image reference(const Scene& scene, int width, int height, ColourBy colour) {
  Drawing large(scene, 8 * width, 8 * height, colour);
  large.camera = Camera(large.buffers.box, width, height);
  const Camera small = large.camera;
  large.camera = Camera(large.buffers.box, 8 * width, 8 * height);
  // The margins are not in proportion: the same place in the middle, eight times the scale.
  large.camera.zoom(8 * small.scale() / large.camera.scale(), 4 * width, 4 * height);
  large.style.samples = 2;
  const Image fine = large.draw();
  Image result{width, height,
               std::vector<std::uint8_t>(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      io::picture::Rgb sum;
      for (int j = 0; j < 8; ++j) {
        for (int i = 0; i < 8; ++i) {
          const auto c = at(fine, 8 * x + i, 8 * y + j);
          const auto rgb = io::picture::from_srgb(static_cast<std::uint32_t>(c[0] << 16 | c[1] << 8 | c[2]));
          sum = {sum.r + rgb.r / 64, sum.g + rgb.g / 64, sum.b + rgb.b / 64};
        }
      }
      const std::uint32_t mean = io::picture::to_srgb(sum);
      std::uint8_t* to = result.rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                                   static_cast<std::size_t>(x));
      for (int k = 0; k < 3; ++k) to[k] = static_cast<std::uint8_t>(mean >> (16 - 8 * k));
    }
  }
  return result;
}

TEST(Renderer, FarViewIsTheMeanOfWhatLiesThere) {
  // From triangles of many pixels to hundreds of triangles a pixel; a lattice would show moire.
  struct Case {
    std::string name;
    std::size_t n;
    ColourBy colour;
  };
  for (const auto& [name, n, colour] : std::vector<Case>{{"uniform", 300, ColourBy::angle},
                                                         {"uniform", 20'000, ColourBy::area},
                                                         {"uniform", 200'000, ColourBy::angle},
                                                         {"circles", 50'000, ColourBy::angle},
                                                         {"grid", 90'000, ColourBy::area},
                                                         {"clusters", 100'000, ColourBy::angle}}) {
    const Scene scene = scene_of(name, n);
    const Image expected = reference(scene, 100, 100, colour);
    const Image image = Drawing(scene, 100, 100, colour).draw();
    EXPECT_LT(share_of_different(image, expected, 24), 0.02) << name << ' ' << n << ' ' << to_string(colour);
  }
}

TEST(Renderer, PictureDoesNotDependOnWhereThePointsLie) {
  const Scene scene = scene_of("uniform", 5000);
  Drawing drawing(scene, 200, 200, ColourBy::angle);
  drawing.style.line_width = 1;
  const Image expected = drawing.draw();
  // Metres of UTM, the ends of double, and coordinates whose differences are subnormal.
  for (const auto& [scale, x, y] : std::vector<std::array<double, 3>>{
           {1000, 500'000, 4'100'000}, {0x1p1000, 0, 0}, {0x1p-1000, 0, 0}, {0x1p1022, 0, 0}, {1, 0x1p20, -0x1p20}}) {
    Drawing other(moved(scene, scale, x, y), 200, 200, ColourBy::angle);
    other.style.line_width = 1;
    EXPECT_LT(share_of_different(other.draw(), expected, 16), 0.005) << scale << ' ' << x;
  }
}

TEST(Renderer, UtmCoordinatesDoNotShake) {
  // Zoomed in 10,000 times, half a metre is thousands of pixels: the place under a pixel stays where it is.
  const Scene scene = moved(scene_of("uniform", 20'000), 1000, 500'000, 4'100'000);
  Drawing drawing(scene, 300, 300, ColourBy::order);
  drawing.camera.zoom(10'000, 150, 150);
  drawing.camera.pan(0.25, 0);
  (void)drawing.draw();
  int wrong = 0, seen = 0;
  for (int x = 0; x < 300; x += 7) {
    const auto place = drawing.camera.place(x + 0.5, 150.5);
    const auto found = drawing.renderer.triangle_at(x, 150);
    if (!found) continue;
    ++seen;
    wrong += triangle_of(scene, place[0], place[1]) != static_cast<std::ptrdiff_t>(*found);
  }
  EXPECT_GT(seen, 40);
  EXPECT_EQ(wrong, 0);
}

TEST(Renderer, SlopesFacingTheUpperLeftAreLight) {
  Scene scene = scene_of("uniform", 20'000);
  for (std::size_t i = 0; i < scene.points.xy.size(); i += 2)
    scene.points.height.push_back(-std::fabs(scene.points.xy[i] - 0.5));  // a ridge from top to bottom
  Drawing drawing(scene, 200, 200, ColourBy::height);
  const Image image = drawing.draw();
  const auto light = [&](int x) {
    const auto c = at(image, x, 100);
    return c[0] + c[1] + c[2];
  };
  EXPECT_GT(light(50), light(150) + 60);
}

TEST(Renderer, BaysOfTheOutlineFade) {
  Scene scene;
  for (int i = 0; i < 40; ++i) {  // two blocks with a gap: what lies between was not measured
    for (int j = 0; j < 40; ++j) {
      for (const double x : {0.0, 200.0}) {
        scene.points.xy.insert(scene.points.xy.end(), {x + i, static_cast<double>(j)});
        scene.points.height.push_back(i + j);
      }
    }
  }
  scene.mesh = triangulate(scene.points.view());
  Drawing drawing(scene, 480, 100, ColourBy::height);
  const Image image = drawing.draw();
  const auto paper = bytes(palette(false).background);
  EXPECT_LT(difference(at(image, 240, 50), paper), 60);
  EXPECT_GT(difference(at(image, 40, 50), paper), 60);
}

TEST(Renderer, LinesLieOnTheEdgesAndFadeWithTheTriangles) {
  const Scene scene = scene_of("uniform", 30);
  Drawing drawing(scene, 200, 200, ColourBy::nothing);
  const Image plain = drawing.draw();
  drawing.style.line_width = 2;
  const Image lined = drawing.draw();
  const auto t = scene.mesh.triangles();
  std::size_t shown = 0;
  for (std::size_t i = 0; i < t.size(); i += 3) {
    const auto a = static_cast<std::size_t>(t[i]), b = static_cast<std::size_t>(t[i + 1]);
    const auto& xy = scene.points.xy;
    const auto p = drawing.camera.pixel(0.5 * (xy[2 * a] + xy[2 * b]), 0.5 * (xy[2 * a + 1] + xy[2 * b + 1]));
    const int x = static_cast<int>(p[0]), y = static_cast<int>(p[1]);
    shown += difference(at(lined, x, y), at(plain, x, y)) > 10;
  }
  EXPECT_GT(shown, t.size() / 3 * 9 / 10) << "but for edges of slivers, which fade";
  const double changed = share_of_different(plain, lined, 10);
  EXPECT_GT(changed, 0.02);
  EXPECT_LT(changed, 0.4);
  const Scene dense = scene_of("uniform", 50'000);
  Drawing many(dense, 100, 100, ColourBy::nothing);
  const Image without = many.draw();
  many.style.line_width = 2;
  EXPECT_LT(share_of_different(without, many.draw(), 8), 0.1);
}

TEST(Renderer, StrokesAreDrawnOverTheMesh) {
  const Scene scene = scene_of("uniform", 100);
  Drawing drawing(scene, 100, 100, ColourBy::nothing);
  const Stroke cross{{{0.1, 0.1, 0.9, 0.9}, {0.5, 0.05, 0.5, 0.95}}, 0xff0000, 3};
  const Image image = drawing.draw(std::span<const Stroke>(&cross, 1));
  for (const double s : {0.2, 0.4, 0.5, 0.8}) {
    const auto p = drawing.camera.pixel(s, s), q = drawing.camera.pixel(0.5, s);
    EXPECT_LE(difference(at(image, static_cast<int>(p[0]), static_cast<int>(p[1])), {255, 0, 0}), 40) << s;
    EXPECT_LE(difference(at(image, static_cast<int>(q[0]), static_cast<int>(q[1])), {255, 0, 0}), 40) << s;
  }
  const auto off = drawing.camera.pixel(0.8, 0.2);
  EXPECT_GT(difference(at(image, static_cast<int>(off[0]), static_cast<int>(off[1])), {255, 0, 0}), 100);
}

TEST(Renderer, SetsWithoutTrianglesAreDrawnAsPoints) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{100'000}}) {
    Scene scene;
    for (std::size_t i = 0; i < n; ++i)
      scene.points.xy.insert(scene.points.xy.end(), {3.0 * static_cast<double>(i), 2.0 * static_cast<double>(i)});
    scene.mesh = triangulate(scene.points.view());
    Drawing drawing(scene, 90, 60, ColourBy::area);
    drawing.style.point_radius = 3;
    const Image image = drawing.draw();
    const auto paper = bytes(palette(false).background);
    int inked = 0;
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 90; ++x) inked += difference(at(image, x, y), paper) > 30;
    EXPECT_EQ(inked > 0, n > 0) << n;
    EXPECT_LT(inked, 90 * 60 / 2) << n;
  }
}

TEST(Still, TakesTheViewAndTheSizeItIsTold) {
  const Scene scene = scene_of("terrain", 2000);
  StillOptions options;
  options.width = 300;
  const Image whole = draw_still(scene.points, scene.mesh, options);
  EXPECT_EQ(whole.width, 300);
  EXPECT_NEAR(whole.height, 300, 3);
  options.height = 100;
  options.view = View{scene.points.xy[0], scene.points.xy[1], 30};
  const Image part = draw_still(scene.points, scene.mesh, options);
  EXPECT_EQ(part.height, 100);
  EXPECT_EQ(part.rgba.size(), 4U * 300 * 100);
}

}  // namespace
