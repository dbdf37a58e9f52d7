// SPDX-License-Identifier: Apache-2.0
// Polygons in one call: equal, polygon by polygon, to the constrained triangulation of each, and of exact area.
#include <gtest/gtest.h>

#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/data_files.hpp"
#include "tests/unit/constraints/polygons_test.hpp"

namespace cadt::test {
namespace {

TEST_P(Polygons, SquareWithHole) {
  PolygonSet set;
  set.add({{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}}, {{1, 1}, {3, 1}, {3, 3}, {1, 3}}});
  const PolygonsResult result = triangulate(set);
  EXPECT_EQ(result.triangles(0).size(), 24U);
  EXPECT_EQ(twice_area(set, result.triangles(0)), 24);
  EXPECT_TRUE(result.problems().empty());
  EXPECT_EQ(std::ranges::count(result.triangles(), 4), 0);  // the point that closes the ring is the first one
  EXPECT_THROW((void)result.triangles(1), InputError);
}

/// Stars with stars as holes, in either direction, closed or not: the area is exact.
TEST_P(Polygons, AreasAreExact) {
  std::mt19937_64 random(1);
  PolygonSet set;
  std::vector<double> areas;
  for (std::size_t i = 0; i < 4000; ++i) {
    const double x = static_cast<double>(random() % 2000000), y = static_cast<double>(random() % 2000000);
    std::vector<Ring> polygon = {star(random, 3 + random() % (i % 100 == 0 ? 300 : 30), x, y, 5e5, 1e6)};
    areas.push_back(std::abs(twice_area(polygon[0])));
    for (std::size_t hole = polygon[0].size() < 12 ? 0 : random() % 4; hole > 0; --hole) {
      polygon.push_back(
          star(random, 3 + random() % 9, x + (hole == 1 ? 8e4 : 0), y + (hole == 2 ? 8e4 : -8e4), 1e4, 4e4));
      areas.back() -= std::abs(twice_area(polygon.back()));
    }
    for (Ring& ring : polygon) {
      if (random() % 2 != 0) std::ranges::reverse(ring);
      if (random() % 2 != 0) ring.push_back(ring.front());
    }
    std::ranges::rotate(polygon, polygon.begin() + static_cast<std::ptrdiff_t>(random() % polygon.size()));
    set.add(polygon);
  }
  const PolygonsResult result = triangulate(set);
  EXPECT_TRUE(result.problems().empty());
  for (std::size_t p = 0; p < set.size(); ++p) ASSERT_EQ(twice_area(set, result.triangles(p)), areas[p]) << p;
  expect_equal(set);
}

/// Rings between few places: they touch, cover one another, go back, cross.
TEST_P(Polygons, RandomRingsOnSmallLattices) {
  std::mt19937_64 random(2);
  std::map<PolygonStatus, std::size_t> all;
  for (const std::uint64_t size : {3U, 4U, 5U, 7U}) {
    PolygonSet set;
    for (std::size_t i = 0; i < 2500; ++i) {
      std::vector<Ring> polygon(1 + random() % 3);
      for (Ring& ring : polygon)
        for (std::uint64_t n = 1 + random() % 7; n > 0; --n)
          ring.push_back({static_cast<double>(random() % size), static_cast<double>(random() % size)});
      set.add(polygon);
    }
    for (const auto& [status, count] : expect_equal(set)) all[status] += count;
    if (HasFailure()) return;
  }
  for (const PolygonStatus status : {PolygonStatus::ok, PolygonStatus::too_few_points, PolygonStatus::self_crossing,
                                     PolygonStatus::ring_crossing, PolygonStatus::zero_area})
    EXPECT_GE(all[status], 20U) << to_string(status);
}

/// Boxes of a lattice, whose corners are cocircular and on one another's sides.
TEST_P(Polygons, RectilinearRings) {
  std::mt19937_64 random(3);
  PolygonSet set;
  for (std::size_t i = 0; i < 2000; ++i) {
    std::vector<Ring> polygon;
    for (std::uint64_t r = 1 + random() % 5; r > 0; --r) {
      const auto x = static_cast<double>(random() % 8), y = static_cast<double>(random() % 8),
                 w = static_cast<double>(1 + random() % 8), h = static_cast<double>(1 + random() % 8);
      polygon.push_back({{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}});
    }
    set.add(polygon);
  }
  const auto counts = expect_equal(set);
  EXPECT_GE(counts.at(PolygonStatus::ok), 500U);
}

/// A comb and a spiral of right angles; with more points than one work-item takes as well.
TEST_P(Polygons, CombsAndSpirals) {
  PolygonSet set;
  for (const std::size_t teeth : {2U, 10U, 100U, 300U}) {
    Ring comb;
    for (std::size_t i = 0; i < teeth; ++i) {
      const auto x = static_cast<double>(i);
      comb.insert(comb.end(), {{4 * x, 0}, {4 * x + 1, 100}});
    }
    comb.push_back({4 * static_cast<double>(teeth), -1});
    comb.push_back({0, -1});
    set.add({comb});
    Ring out, back;
    for (std::size_t i = 0; i < teeth; ++i) {
      const auto r = static_cast<double>(2 * i + 2);
      const std::array<double, 2> turn[] = {{r, -r}, {r, r}, {-r, r}, {-r, -r - 2}};
      out.push_back(turn[i % 4]);
      back.push_back({turn[i % 4][0] * 0.99, turn[i % 4][1] * 0.99});
    }
    out.insert(out.end(), back.rbegin(), back.rend());
    set.add({out});
  }
  expect_equal(set);
}

TEST_P(Polygons, LargePolygonsAmongSmallOnes) {
  std::mt19937_64 random(4);
  PolygonSet set;
  for (const std::size_t n : {5U, 511U, 7U, 512U, 513U, 3U, 3000U, 4U}) {
    std::vector<Ring> polygon = {star(random, n, 0, 0, 5e8, 1e9)};
    polygon.push_back(star(random, 3 + n / 100, 0, 0, 1e7, 2e7));
    set.add(polygon);
    std::swap(polygon[0], polygon[1]);
    if (n > 500) polygon[1][100] = polygon[1][0];  // its sides cross
    if (n > 500) std::swap(polygon[1][200], polygon[1][240]);
    set.add(polygon);
    if (n == 513) set.add({Ring(600, {1, 1})});
    if (n == 513) set.add({{}, Ring(600, {1, 1})});
    if (n == 513) polygon[1][300][0] = std::numeric_limits<double>::infinity();
    set.add(polygon);
    set.add({star(random, n, 0, 0, 5e8, 1e9), star(random, 3 + n / 100, 7e8, 0, 1e8, 5e8)});
  }
  const auto counts = expect_equal(set);
  EXPECT_GE(counts.at(PolygonStatus::ring_crossing), 4U);
  EXPECT_GE(counts.at(PolygonStatus::self_crossing), 4U);
  EXPECT_EQ(counts.at(PolygonStatus::not_finite), 1U);
  EXPECT_EQ(counts.at(PolygonStatus::too_few_points), 2U);
}

/// Coordinates of any size; those too far apart for the narrow arithmetic are done by the wide one.
TEST_P(Polygons, AnyDoubles) {
  std::mt19937_64 random(5);
  PolygonSet set;
  for (const int exponent : {-1050, -1000, -500, -150, -130, -60, 20, 40, 60, 300, 990}) {
    std::vector<Ring> polygon = {star(random, 20, 0, 0, 5e8, 1e9), star(random, 5, 0, 0, 1e7, 2e7)};
    for (Ring& ring : polygon)
      for (auto& [x, y] : ring) x = std::ldexp(x, exponent), y = std::ldexp(y, exponent);
    set.add(polygon);
    polygon[1][0][0] = std::ldexp(1.0, -1060);
    set.add(polygon);
    set.add(
        {{{0, 0}, {std::ldexp(1.0, exponent), 0}, {std::ldexp(1.0, exponent), std::ldexp(1.0, -exponent / 2 - 3)}}});
  }
  const double largest = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  set.add({{{-largest, -largest}, {largest, -largest}, {largest, largest}, {-largest, largest}}});
  set.add({{{-least, -least}, {least, -least}, {least, least}, {-least, least}}});
  set.add({{{-largest, 0}, {largest, -least}, {largest, least}}});
  for (const double tiny : {least, std::ldexp(1.0, -200)})  // moves a corner of a square off the circle of the others
    for (const double moved : {tiny, -tiny})
      for (const auto& [corner, axis] : {std::pair{0, 0}, {0, 1}, {1, 1}, {3, 0}}) {
        Ring ring = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        ring[static_cast<std::size_t>(corner)][static_cast<std::size_t>(axis)] = moved;
        set.add({ring});
      }
  expect_equal(set);
}

/// A large polygon is a call of its own: what that counts is told, too.
TEST_P(Polygons, CountersOfLargeOnes) {
  Ring ring;  // teeth so slanted that their sides are no Delaunay edges
  for (int i = 0; i < 300; ++i) {
    ring.push_back({2.0 * i, 0});
    ring.push_back({2.0 * i + 51, 100});
  }
  ring.push_back({900, -50});
  ring.push_back({-50, -50});
  PolygonSet set;
  set.add({ring});
  const Statistics found = triangulate(set).statistics();
  std::vector<Segment> segments;
  const auto corners = static_cast<std::int32_t>(ring.size());
  for (std::int32_t i = 0; i < corners; ++i) segments.push_back({i, (i + 1) % corners});
  const Statistics alone =
      triangulate_constrained(set.points, segments, {.domain = Domain::even_odd}, GetParam().options()).statistics();
  EXPECT_GT(alone.certified_edges, 0U);
  EXPECT_GT(alone.inserted_segments, 0U);
  EXPECT_EQ(found.certified_edges, alone.certified_edges);
  EXPECT_EQ(found.inserted_segments, alone.inserted_segments);
  for (const auto counter : {&Statistics::launches, &Statistics::incircle_tests, &Statistics::orientation_tests,
                             &Statistics::bytes_device_peak})
    EXPECT_GT(found.*counter, 0U);
}

TEST_P(Polygons, NothingToDo) {
  PolygonSet set;
  EXPECT_EQ(triangulate(set).size(), 0U);
  set.add({});
  set.add({{}, {}});
  const PolygonsResult result = triangulate(set);
  EXPECT_EQ(result.problems().size(), 2U);
  EXPECT_EQ(result.problems()[1].first, -1);
  EXPECT_TRUE(result.triangles().empty());
  Options watched = GetParam().options();
  watched.tuning.watch = [](const Snapshot&) {};
  EXPECT_THROW((void)set.triangulate(watched), OptionError);
}

/// A slice of larger arrays: the offsets neither begin with 0 nor end with the number of points.
TEST_P(Polygons, SliceOfArrays) {
  PolygonSet set;
  for (int i = 0; i < 5; ++i) set.add({{{0, 0}, {1, 0}, {0, 1.0 + i}}});
  const std::vector<std::int64_t> polygons = {1, 2, 3};
  const PolygonsResult result = triangulate_polygons(set.points, set.rings, polygons, GetParam().options());
  EXPECT_EQ(std::vector(result.triangles().begin(), result.triangles().end()),
            (std::vector<std::int32_t>{3, 4, 5, 6, 7, 8}));
  const std::vector<std::int64_t> rings = {3, 6, 9};
  EXPECT_EQ(triangulate_polygons(set.points, rings, std::vector<std::int64_t>{0, 2}, GetParam().options()).size(), 1U);
}

TEST_P(Polygons, WrongOffsets) {
  const Ring points(6);
  std::string text;
  const auto index = [&](const std::vector<std::int64_t>& rings, const std::vector<std::int64_t>& polygons) {
    try {
      (void)triangulate_polygons(points, rings, polygons, GetParam().options());
    } catch (const InputError& error) {
      text = error.what();
      return static_cast<int>(error.index());
    }
    return -1;
  };
  EXPECT_EQ(index({0, 3, 6}, {0, 1, 2}), -1);
  EXPECT_EQ(index({}, {0}), 0);
  EXPECT_EQ(index({0, 3, 6}, {}), 0);
  EXPECT_EQ(index({-1, 3, 6}, {0, 2}), 0);
  EXPECT_EQ(index({0, 4, 3}, {0, 2}), 2);
  EXPECT_EQ(index({0, 3, 7}, {0, 2}), 2);
  EXPECT_EQ(index({0, 3, 6}, {0, 2, 1}), 2);
  EXPECT_EQ(index({0, 3, 6}, {0, 3}), 1);
  EXPECT_EQ(text, "the offsets of polygons end with 3: let them end with at most 2, the number of rings");
}

TEST_P(Polygons, FloatsAndSeparateArrays) {
  const std::vector<float> xy = {0, 0, 3, 0, 3, 3, 0, 3};
  const std::vector<double> x = {0, 3, 3, 0}, y = {0, 0, 3, 3};
  const std::vector<std::int64_t> rings = {0, 4}, polygons = {0, 1};
  const Options options = GetParam().options();
  const PolygonsResult floats = triangulate_polygons(xy, rings, polygons, options),
                       arrays = triangulate_polygons(PointsView(x, y), rings, polygons, options);
  EXPECT_EQ(floats.triangles().size(), 6U);
  EXPECT_TRUE(std::ranges::equal(floats.triangles(), arrays.triangles()));
}

std::string text_of(const std::filesystem::path& file) {
  std::stringstream text;
#if defined(__unix__)
  if (file.extension() == ".xz") {
    FILE* pipe = popen(("xz -dkc '" + file.string() + "'").c_str(), "r");
    for (int c = 0; pipe != nullptr && (c = fgetc(pipe)) != EOF;) text << static_cast<char>(c);
    if (pipe == nullptr || pclose(pipe) != 0) ADD_FAILURE() << "xz cannot read " << file;
    return text.str();
  }
#endif
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A list of rings of pairs of numbers.
std::vector<Ring> polygon_of(const std::string& json) {
  std::vector<Ring> polygon;
  std::vector<double> numbers;
  int depth = 0;
  for (const char* c = json.c_str(); *c != '\0';) {
    if (std::isdigit(static_cast<unsigned char>(*c)) != 0 || *c == '-') {
      char* end = nullptr;
      numbers.push_back(std::strtod(c, &end));
      c = end;
      continue;
    }
    if (*c == '[' && ++depth == 2) polygon.emplace_back();
    if (*c == ']' && depth-- == 3) polygon.back().push_back({numbers.at(numbers.size() - 2), numbers.back()});
    ++c;
  }
  return polygon;
}

/// Polygons of the tests of mapbox/earcut, of which some have holes of one point, and some cross themselves. The area
/// of all others is that of their rings.
TEST_P(Polygons, FixturesOfEarcut) {
  const auto folder = data_folder();
  if (!folder || !std::filesystem::exists(*folder / "pslg")) GTEST_SKIP() << "no CADT_DATA_DIR/pslg";
  const std::map<std::string, PolygonStatus> defects = {{"bad-hole", PolygonStatus::ring_crossing},
                                                        {"empty-square", PolygonStatus::zero_area},
                                                        {"issue107", PolygonStatus::too_few_points},
                                                        {"issue83", PolygonStatus::zero_area},
                                                        {"water-huge", PolygonStatus::self_crossing},
                                                        {"water-huge2", PolygonStatus::self_crossing},
                                                        {"simplified-us-border", PolygonStatus::self_crossing},
                                                        {"water", PolygonStatus::self_crossing}};
  PolygonSet set;
  std::vector<std::string> names;
  std::vector<double> areas;
  for (const auto& entry : std::filesystem::directory_iterator(*folder / "pslg")) {
    std::string name = entry.path().filename().string();
    if (!name.starts_with("earcut_") || name == "earcut_expected.json") continue;
    names.push_back(name.substr(7, name.find('.') - 7));
    const std::vector<Ring> polygon = polygon_of(text_of(entry.path()));
    areas.push_back(0);
    for (const Ring& ring : polygon) areas.back() += (&ring == polygon.data() ? 1 : -1) * std::abs(twice_area(ring));
    set.add(polygon);
  }
  ASSERT_GE(names.size(), 34U);
  expect_equal(set);
  const PolygonsResult result = triangulate(set);
  for (std::size_t p = 0; p < set.size(); ++p) {
    SCOPED_TRACE(names[p]);
    const auto defect = defects.find(names[p]);
    EXPECT_EQ(to_string(result.status()[p]), to_string(defect == defects.end() ? PolygonStatus::ok : defect->second));
    if (defect != defects.end()) continue;
    EXPECT_NEAR(twice_area(set, result.triangles(p)), areas[p], 1e-13 * areas[p] + 1e-20);
  }
}
CADT_ON_MAIN_BACKENDS(Polygons);

}  // namespace
}  // namespace cadt::test
