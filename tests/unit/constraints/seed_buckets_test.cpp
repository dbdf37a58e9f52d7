// SPDX-License-Identifier: Apache-2.0
// Which places lie in a box, against a look at all of them.
#include "common/constraints/domains/seed_buckets.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace cadt::test {
namespace {

using Place = SeedBuckets::Place;

std::vector<std::size_t> in_box(const std::vector<Place>& places, Place low, Place high) {
  std::vector<std::size_t> found;
  SeedBuckets(places).each_in(low, high, [&](std::size_t i) { found.push_back(i); });
  std::ranges::sort(found);
  return found;
}

std::vector<std::size_t> by_brute_force(const std::vector<Place>& places, Place low, Place high) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i][0] >= low[0] && places[i][0] <= high[0] && places[i][1] >= low[1] && places[i][1] <= high[1])
      found.push_back(i);
  return found;
}

TEST(SeedBuckets, FindThePlacesInBoxes) {
  std::mt19937_64 random(4);
  const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  std::size_t all = 0;
  for (const std::size_t count : {1U, 2U, 5U, 40U, 300U})
    for (const Place& scale : {Place{1, 1}, Place{0, 1}, Place{1e-3, 1e6}, Place{most, most}, Place{least, most}}) {
      // Of few different numbers, so that places lie on borders of boxes, of cells, and on one another.
      const auto value = [&](std::size_t k) { return (static_cast<double>(random() % 17) / 8 - 1) * scale[k]; };
      std::vector<Place> places(count);
      for (Place& p : places) p = {value(0), value(1)};
      for (int box = 0; box < 200; ++box) {
        const double a = value(0), b = value(0), c = value(1), d = value(1);
        const Place low = {std::min(a, b), std::min(c, d)}, high = {std::max(a, b), std::max(c, d)};
        const auto expected = by_brute_force(places, low, high);
        ASSERT_EQ(in_box(places, low, high), expected);
        all += expected.size();
      }
    }
  EXPECT_GT(all, 50000U);
  EXPECT_TRUE(in_box({}, {0, 0}, {1, 1}).empty());
}

}  // namespace
}  // namespace cadt::test
