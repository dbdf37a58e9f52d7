// SPDX-License-Identifier: Apache-2.0
// The numbers by which pieces of segments claim triangles, and the order in which those that are left are tried.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/constraints/insert/segment_rings.dev.h"
#pragma GCC diagnostic pop

/// Two pieces with one key would both take a triangle for their own.
TEST(PieceOrder, NoTwoPiecesHaveOneKey) {
  for (const std::uint32_t first : {0U, 0x3FF00000U, 0x7FE00000U}) {
    std::vector<std::uint32_t> keys(std::size_t{1} << 21);
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = cadt_key_of_piece(first + static_cast<std::uint32_t>(i));
    std::ranges::sort(keys);
    EXPECT_EQ(std::ranges::adjacent_find(keys), keys.end()) << first;
    EXPECT_LT(keys.back(), 0x80000000U) << first;  // no claim is above all keys
  }
}

TEST(PieceOrder, ShuffledPlacesAreAllPlaces) {
  std::vector<std::uint32_t> counts(300);
  std::iota(counts.begin(), counts.end(), 1U);
  counts.insert(counts.end(), {1023, 1024, 1025, 65535, 65536, 100000});
  for (const std::uint32_t count : counts) {
    const auto bits = static_cast<std::uint32_t>(std::bit_width(count));
    std::vector<int> seen(count);
    for (std::uint32_t i = 0; i < count; ++i) ++seen[cadt_shuffled_place(i, bits, count)];
    EXPECT_EQ(std::ranges::count(seen, 1), static_cast<std::ptrdiff_t>(count)) << count;
  }
}

}  // namespace
