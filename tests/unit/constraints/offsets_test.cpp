// SPDX-License-Identifier: Apache-2.0
// Places beyond 2^32 words: arrays are mapped, and only pages that are written take memory.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/sparse.hpp"

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/constraints/domains/domains.dev.h"
#include "common/constraints/polygons/polygons.dev.h"
#pragma GCC diagnostic pop

using cadt::test::Sparse;

constexpr std::size_t wrap = std::size_t{1} << 32;

/// One polygon for a work-item, whose own memory begins 2^32 words behind that of the first one.
TEST(ConstraintOffsets, EachWorkItemHasItsOwnMemory) {
  constexpr std::uint32_t item = 1U << 17, item_words = 1U << 15;
  static_assert(std::size_t{item} * item_words == wrap);
  std::vector<cadt_point> points;
  for (int x = 0; x < 40; ++x) points.push_back({1. * x, 1. * x * x});  // more than a small ring has
  const auto n = static_cast<std::uint32_t>(points.size());
  const std::array<std::uint32_t, 2> ring_begins = {0, n};
  std::vector<std::uint32_t> polygon_rings(item + 2, 0), counts(item + 2), triangles(6 * n);
  polygon_rings.back() = 1;
  std::vector<std::uint32_t> results(std::size_t{CADT_POLYGON_RESULT_WORDS} * (item + 1));
  Sparse<std::uint32_t> memory(wrap + item_words);
  if (!memory) GTEST_SKIP() << "no address space for 16 GB of pages that nobody writes";
  cadt_triangulate_polygons(item, item + 1, points.data(), ring_begins.data(), polygon_rings.data(), item + 1, 1,
                            memory.data(), item_words, 0, triangles.data(), counts.data(), results.data());
  EXPECT_EQ(counts[item], n - 2);
  const auto written = [&](std::size_t from) {
    return std::any_of(&memory[from], &memory[from + 8], [](auto w) { return w != 0; });
  };
  EXPECT_FALSE(written(0));
  EXPECT_TRUE(written(wrap));
}

/// Link 2^32 / 3, which is behind the first 2^32 words.
TEST(ConstraintOffsets, LinksOfLargeDomains) {
  constexpr std::uint32_t place = wrap / 3 + 1;
  Sparse<std::uint32_t> links(std::size_t{CADT_LINK_WORDS} * (place + 3));
  if (!links) GTEST_SKIP() << "no address space for 16 GB of pages that nobody writes";
  // A triangle of region 7 with three constrained edges on the hull; region 9 is outside.
  const std::array<std::uint32_t, 3> vertices = {0, 1, 2}, neighbors = {CADT_NONE, CADT_NONE, CADT_NONE};
  const std::array<std::uint32_t, 1> flags = {7};
  const std::array<std::uint32_t, 2> region = {7, 9};
  std::uint32_t counter = place;
  cadt_domain_links(0, 1, vertices.data(), neighbors.data(), flags.data(), 1, 1, 1, 1, region.data(), nullptr, nullptr,
                    nullptr, nullptr, &counter, links.data(), place + 3);
  EXPECT_EQ(counter, place + 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t at = std::size_t{CADT_LINK_WORDS} * (place + i);
    EXPECT_EQ((std::array{links[at], links[at + 1], links[at + 2]}), (std::array<std::uint32_t, 3>{7, 9, 1}));
  }
}

}  // namespace
