// SPDX-License-Identifier: Apache-2.0
// Tiles, as the host compiles their kernels, against the definition of the quadtree's leaves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#define CADT_WIDE 0
namespace {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/stars/tiles.dev.h"
#pragma GCC diagnostic pop

using Keys = std::vector<std::uint32_t>;

/// Whether so many of the points in a square lie in a part of it.
bool is_crowded(const Keys& keys, std::uint32_t begin, std::uint32_t end, unsigned level, unsigned levels) {
  const unsigned part = level + CADT_OVERFULL_LEVELS;
  for (std::uint32_t i = begin; part <= levels && i + CADT_TILE_OVERFULL <= end; ++i) {
    const std::uint64_t first = keys[i], last = keys[i + CADT_TILE_OVERFULL - 1];
    if (first >> (2 * (levels - part)) == last >> (2 * (levels - part))) return true;
  }
  return false;
}

/// The leaves of the quadtree by its definition: begin and level of each. `again`: crowded ones are divided.
std::map<std::uint32_t, int> tiles_by_definition(const Keys& keys, unsigned levels, bool again = false) {
  std::map<std::uint32_t, int> tiles;
  const auto n = static_cast<std::uint32_t>(keys.size());
  const std::function<void(std::uint32_t, std::uint32_t, unsigned, std::uint32_t)> divide =
      [&](std::uint32_t begin, std::uint32_t end, unsigned level, std::uint32_t most) {
        if (end - begin <= most || level == levels) {
          if (again && most == CADT_TILE_POINTS && is_crowded(keys, begin, end, level, levels))
            divide(begin, end, level, CADT_TILE_FEW);
          else
            tiles[begin] = static_cast<int>(level);
          return;
        }
        const unsigned shift = 2 * (levels - level - 1);
        for (std::uint32_t from = begin, to = begin; from < end; from = to) {
          while (to < end && keys[to] >> shift == keys[from] >> shift) ++to;
          divide(from, to, level + 1, most);
        }
      };
  for (std::uint32_t from = 0, to = 0; from < n; from = to) {
    const auto top = [&](std::uint32_t i) { return std::uint64_t{keys[i]} >> (2 * levels); };
    while (to < n && top(to) == top(from)) ++to;
    divide(from, to, 0, CADT_TILE_POINTS);
  }
  return tiles;
}

std::map<std::uint32_t, int> tiles_found(const Keys& keys, unsigned levels) {
  std::map<std::uint32_t, int> tiles;
  const cadt_keys view = cadt_keys_of(keys.data(), nullptr, 0);
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    const cadt_i32 level = cadt_tile_level(&view, static_cast<std::uint32_t>(keys.size()), i, levels, CADT_TILE_POINTS);
    if (level >= 0) tiles[i] = level;
  }
  return tiles;
}

/// Of every CADT_TILE_OVERFULL-th point on: so many in a small part of their tile.
std::uint32_t crowded_samples(const Keys& keys, unsigned levels, const std::map<std::uint32_t, int>& tiles) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < keys.size(); i += CADT_TILE_OVERFULL) {
    const auto next = tiles.upper_bound(i);
    const auto end = next == tiles.end() ? static_cast<std::uint32_t>(keys.size()) : next->first;
    const std::uint32_t last = std::min<std::uint32_t>(i + CADT_TILE_OVERFULL, end);
    count += is_crowded(keys, i, last, static_cast<unsigned>(std::prev(next)->second), levels) ? 1 : 0;
  }
  return count;
}

/// The same tiles by the kernels, as the driver runs them.
std::map<std::uint32_t, int> tiles_divided_again(const Keys& keys, unsigned levels) {
  const auto n = static_cast<std::uint32_t>(keys.size());
  Keys before, crowded, ranks(n + 1);
  std::vector<cadt_tile> tiles;
  const auto make = [&] {
    const std::uint32_t* const old = before.empty() ? nullptr : before.data();
    const std::uint32_t* const marks = before.empty() ? nullptr : crowded.data();
    std::array<std::uint32_t, 2> found{};
    cadt_tile_flags(0, 1, keys.data(), nullptr, 0, old, marks, ranks.data(), n, levels, n, found.data());
    if (!old) {
      EXPECT_EQ(found[1], crowded_samples(keys, levels, tiles_found(keys, levels)));
    }
    std::exclusive_scan(ranks.begin(), ranks.end(), ranks.begin(), 0u);
    tiles.assign(ranks[n] + 1, {});
    cadt_tile_pack(0, 1, keys.data(), nullptr, 0, old, marks, ranks.data(), tiles.data(), n, levels, n);
  };
  make();
  crowded.assign(tiles.size() - 1, 0);
  cadt_tile_overfull(0, 1, keys.data(), nullptr, 0, ranks.data(), tiles.data(), n, levels, n, crowded.data());
  before = ranks;
  make();
  EXPECT_EQ(tiles.back().begin, n);
  std::map<std::uint32_t, int> made;
  for (std::size_t t = 0; t + 1 < tiles.size(); ++t) made[tiles[t].begin] = tiles[t].level;
  return made;
}

TEST(Tiles, AreTheLargestSquaresWithFewPoints) {
  std::mt19937_64 random(1);
  const auto below = [&](std::uint64_t n) { return random() % n; };
  std::set<int> levels_seen;
  int more = 0;
  for (int run = 0; run < 400; ++run) {
    const unsigned bits = 1 + static_cast<unsigned>(below(32));
    const unsigned levels = static_cast<unsigned>(below(bits / 2 + 1));
    const std::uint64_t all = std::uint64_t{1} << bits;
    Keys keys;
    // clumps of many sizes: equal keys, keys in a small square, and keys anywhere
    for (std::uint64_t clump = 0, clumps = 1 + below(12); clump < clumps; ++clump) {
      const std::uint64_t span = std::uint64_t{1} << below(bits + 1), start = below(all);
      const std::uint64_t sizes[] = {1, 5, 600, 639, 640, 641, 1280, 2000};
      for (std::uint64_t k = 0, size = sizes[below(8)]; k < size; ++k)
        keys.push_back(static_cast<std::uint32_t>(std::min(all - 1, start / span * span + below(span))));
    }
    std::ranges::sort(keys);
    const auto expected = tiles_by_definition(keys, levels), divided = tiles_by_definition(keys, levels, true);
    ASSERT_EQ(tiles_found(keys, levels), expected) << "run " << run << ", " << bits << " bits, " << levels << " levels";
    ASSERT_EQ(tiles_divided_again(keys, levels), divided) << "run " << run << ", " << bits << " bits, " << levels;
    more += divided.size() > expected.size() ? 1 : 0;
    for (const auto& [begin, level] : expected) levels_seen.insert(level);
  }
  EXPECT_GT(levels_seen.size(), 12u);
  EXPECT_GT(more, 100);
}

TEST(Tiles, ExactlyAsManyAsFit) {
  constexpr std::uint32_t most = CADT_TILE_POINTS;
  for (const std::uint32_t extra : {0u, 1u}) {
    // the square 1 of level 1 with `most` + extra points in its two first quarters
    Keys keys(3, 0u);
    keys.insert(keys.end(), most / 2, 0x40u);
    keys.insert(keys.end(), most / 2 + extra, 0x50u);
    keys.insert(keys.end(), 5000, 0x80u);
    EXPECT_EQ(tiles_found(keys, 4), tiles_by_definition(keys, 4));
    EXPECT_EQ(tiles_found(keys, 4).contains(3 + most / 2), extra == 1);
  }
}

TEST(Tiles, CountsKeysOutOfOrder) {
  Keys keys;
  keys.reserve(2 * CADT_TILE_POINTS);  // or the compiler warns of places that are not read
  keys = {0, 0, 5, 3, 3, 9, 8, 7};
  std::vector<std::uint32_t> flags(keys.size() + 1);
  const auto n = static_cast<std::uint32_t>(keys.size());
  for (const std::uint32_t expected : {3u, 0u}) {
    std::array<std::uint32_t, 2> found{};
    cadt_tile_flags(0, 1, keys.data(), nullptr, 0, nullptr, nullptr, flags.data(), n, 2, n, found.data());
    EXPECT_EQ(found[0], expected);
    std::ranges::sort(keys);
  }
}

}  // namespace
