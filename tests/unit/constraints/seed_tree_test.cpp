// SPDX-License-Identifier: Apache-2.0
// Which places may lie in a triangle, against a look at all of them.
#include "common/constraints/domains/seed_tree.hpp"
#include "common/verify/host/exact_sign.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace cadt::test {
namespace {

using Place = SeedTree::Place;
using Triangle = SeedTree::Triangle;

int turn(const Place& a, const Place& b, const Place& c) {
  return verifier::orientation({a[0], a[1]}, {b[0], b[1]}, {c[0], c[1]});
}
bool contains(const Triangle& t, const Place& p) {
  return turn(t[0], t[1], p) >= 0 && turn(t[1], t[2], p) >= 0 && turn(t[2], t[0], p) >= 0;
}

std::vector<std::size_t> found_in(const SeedTree& tree, const Triangle& triangle) {
  std::vector<std::size_t> found;
  tree.each_in(triangle, [&](std::size_t i) { found.push_back(i); });
  std::ranges::sort(found);
  return found;
}

TEST(SeedTree, FindsThePlacesInTriangles) {
  std::mt19937_64 random(4);
  const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  std::size_t all = 0;
  for (const std::size_t count : {1U, 2U, 5U, 40U, 300U})
    for (const Place& scale :
         {Place{1, 1}, Place{1e-3, 1e6}, Place{most, most}, Place{least * 8, most}, Place{least * 8, least * 8}}) {
      // Of few different numbers, so that places lie on borders of triangles, of cells, and on one another.
      const auto value = [&](std::size_t k) { return (static_cast<double>(random() % 17) / 8 - 1) * scale[k]; };
      std::vector<Place> places(count);
      for (Place& p : places) p = {value(0), value(1)};
      const SeedTree tree(places);
      for (int round = 0; round < 200; ++round) {
        Triangle triangle = {{{value(0), value(1)}, {value(0), value(1)}, {value(0), value(1)}}};
        if (turn(triangle[0], triangle[1], triangle[2]) == 0) continue;
        if (turn(triangle[0], triangle[1], triangle[2]) < 0) std::swap(triangle[1], triangle[2]);
        const auto found = found_in(tree, triangle);
        ASSERT_TRUE(std::ranges::adjacent_find(found) == found.end());
        for (std::size_t i = 0; i < count; ++i)
          if (contains(triangle, places[i])) {
            ASSERT_TRUE(std::ranges::binary_search(found, i)) << i;
            ++all;
          }
        const auto [left, right] = std::minmax({triangle[0][0], triangle[1][0], triangle[2][0]});
        for (const std::size_t i : found) ASSERT_TRUE(places[i][0] >= left && places[i][0] <= right);
      }
    }
  EXPECT_GT(all, 20000U);
  EXPECT_TRUE(found_in(SeedTree({}), {{{0, 0}, {1, 0}, {0, 1}}}).empty());
}

/// Corners are whole numbers of which only each fourth is a double: what lies in the exact triangle is found with the
/// rounded one.
TEST(SeedTree, FindsThePlacesInTrianglesOfRoundedCorners) {
  using Whole = std::array<std::int64_t, 2>;
  constexpr std::int64_t far = std::int64_t{1} << 54;
  std::mt19937_64 random(6);
  std::size_t all = 0, beside = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto value = [&] { return static_cast<std::int64_t>(random() % 40) * 4; };
    const auto near = [&] { return static_cast<std::int64_t>(random() % 3) - 1; };
    std::vector<Whole> exact(60);
    std::vector<Place> places(exact.size());
    for (std::size_t i = 0; i < exact.size(); ++i)
      for (std::size_t k = 0; k < 2; ++k) {
        exact[i][k] = value();
        places[i][k] = static_cast<double>(far + exact[i][k]);
      }
    std::array<Whole, 3> corners{};
    for (Whole& corner : corners) corner = {value() + near(), value() + near()};
    const auto area = [](const Whole& a, const Whole& b, const Whole& c) {
      return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    };
    if (area(corners[0], corners[1], corners[2]) == 0) continue;
    if (area(corners[0], corners[1], corners[2]) < 0) std::swap(corners[1], corners[2]);
    Triangle rounded{};
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 2; ++k) rounded[c][k] = static_cast<double>(far + corners[c][k]);
    const SeedTree tree(places);
    const auto found = found_in(tree, rounded);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool inside = area(corners[0], corners[1], exact[i]) >= 0 && area(corners[1], corners[2], exact[i]) >= 0 &&
                          area(corners[2], corners[0], exact[i]) >= 0;
      if (!inside) continue;
      ++all;
      if (!contains(rounded, places[i])) ++beside;
      ASSERT_TRUE(std::ranges::binary_search(found, i)) << round;
    }
  }
  EXPECT_GT(all, 10000U);
  EXPECT_GT(beside, 100U);
}

/// Neither a place far from all others nor triangles whose boxes hold most of the places make it look at many.
TEST(SeedTree, LooksAtFewBesideTheTriangle) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Place> places(20000);
  for (Place& p : places) p = {unit(random), unit(random)};
  places[77] = {1e9, 1e9};
  const SeedTree tree(places);
  std::size_t seen = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = unit(random), y = unit(random);
    seen += found_in(tree, {{{x, y}, {x + 0.01, y}, {x, y + 0.01}}}).size();
  }
  EXPECT_LT(seen, 1000U * 20);
  for (int i = 0; i < 100; ++i) {  // along a diagonal
    const double at = unit(random) / 2;
    const auto found = found_in(tree, {{{at, 0}, {at + 0.001, 0}, {at + 0.5, 0.5}}});
    EXPECT_LT(found.size(), 600U);
  }
}

}  // namespace
}  // namespace cadt::test
