// SPDX-License-Identifier: Apache-2.0
// Stars close together in memory, and the order and the early end of their tiles.
#include "tests/unit/stars/sorted_points.hpp"

namespace {

/// Stars close together: of `words` behind those of the tiles.
struct Packed {
  std::vector<std::uint32_t> star_vertices, begins, sizes, found = after_a_sample(0, 1U << 24);
  std::uint32_t overflow, room;

  Packed(const Sorted& s, std::uint32_t words, std::uint32_t lost) {
    const auto n = s.size(), count = static_cast<std::uint32_t>(s.tiles.size() - 1);
    overflow = cadt_pool_of_tile(count, n);
    room = overflow + words - lost;
    star_vertices.assign(std::size_t{overflow} + words, CADT_NONE);
    begins.resize(n);
    sizes.resize(n);
    cadt_prove_stars(0, 1, s.points.data(), s.keys.data(), s.low_keys(), s.low_bits, n, s.grid.half_min_x,
                     s.grid.half_min_y, s.grid.scale, s.grid.bits_x, s.grid.bits_y, s.most.x, s.most.y, 0, nullptr,
                     nullptr, s.tiles.data(), count, 1, 0, count, star_vertices.data(), begins.data(), sizes.data(),
                     overflow, room, found.data());
  }
};

/// Squares with few points among squares with many: in the tiles of the first, vertices at the border have more
/// neighbours than six.
NamedPoints chessboard() {
  std::mt19937_64 random(3);
  const auto unit = [&] { return static_cast<double>(random() >> 12) * 0x1p-52; };
  NamedPoints set{"chessboard", {{0, 0}, {1, 1}}, 8, 8};
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (int i = (x + y) % 2 == 0 ? 330 : 30; i > 0; --i) set.points.push_back({(x + unit()) / 8, (y + unit()) / 8});
  return set;
}

// Where there is room they are those of the mesh, and no two share a word; where there is none they have no proof.
TEST(ProvenStars, CloseTogether) {
  std::size_t without_room = 0, overflowed = 0;
  std::vector<NamedPoints> all = sets();
  all.push_back(chessboard());
  for (const NamedPoints& set : all) {
    SCOPED_TRACE(set.name);
    const Sorted s = sorted(set);
    const Packed packed(s, 4096, 0), tight(s, 4096, 4096);
    const auto star_vertices = links_of(s);
    std::vector<char> taken(packed.star_vertices.size());
    for (std::uint32_t v = 0; v < s.size(); ++v) {
      for (const Packed* p : {&packed, &tight}) {
        if (p->sizes[v] == 0) continue;
        ASSERT_LE(p->begins[v] + p->sizes[v], p->room);
        const auto begin = p->star_vertices.begin() + p->begins[v];
        std::vector<std::uint32_t> star(begin, begin + p->sizes[v]);
        std::ranges::rotate(star, std::ranges::min_element(star));
        auto link = star_vertices[v];
        ASSERT_FALSE(link.empty()) << "vertex " << v << " of the hull has a star";
        std::ranges::rotate(link, std::ranges::min_element(link));
        ASSERT_EQ(star, link) << "vertex " << v;
      }
      for (std::uint32_t k = 0; k < packed.sizes[v]; ++k) ASSERT_EQ(taken[packed.begins[v] + k]++, 0) << "vertex " << v;
      if (packed.sizes[v] != 0 && tight.sizes[v] == 0) ++without_room;
    }
    overflowed += packed.found[CADT_STARS_OVERFLOWED];
    EXPECT_EQ(std::ranges::count(tight.sizes, 0U), tight.found[CADT_STARS_UNPROVEN]);
  }
  EXPECT_GT(overflowed, 6u) << "nothing that the tiles have no room for: a weak test";
  EXPECT_GT(without_room, 0u);
}

// First so many from everywhere, then the others, each once.
TEST(TurnsOfTiles, AreAllOfThem) {
  for (std::uint32_t count = 1; count < 70; ++count) {
    for (std::uint32_t sample = 0; 2 * sample <= count; ++sample) {
      std::vector<std::uint32_t> tiles;
      for (std::uint32_t turn = 0; turn < count; ++turn) tiles.push_back(cadt_tile_of_turn(turn, count, sample));
      for (std::uint32_t turn = 1; turn < sample; ++turn) ASSERT_EQ(tiles[turn] - tiles[turn - 1], count / sample);
      ASSERT_TRUE(std::ranges::is_sorted(tiles.begin() + sample, tiles.end()));
      std::ranges::sort(tiles);
      for (std::uint32_t t = 0; t < count; ++t) ASSERT_EQ(tiles[t], t) << count << " tiles, " << sample << " first";
    }
  }
}

NamedPoints uniform_points(int count) {
  std::mt19937_64 random(5);
  const auto unit = [&] { return static_cast<double>(random() >> 12) * 0x1p-52; };
  NamedPoints set{"uniform", {{0, 0}, {1, 1}}, 8, 8};
  while (static_cast<int>(set.points.size()) < count) set.points.push_back({unit(), unit()});
  return set;
}

// If hardly any point of the sample has a star, a cautious call has those of the sample alone.
TEST(SampleOfTiles, EndsWhatIsInVain) {
  constexpr std::uint32_t most = 1U << 24;
  const NamedPoints set = uniform_points(6000);
  const Sorted s = sorted(set);
  const auto n = s.size(), count = static_cast<std::uint32_t>(s.tiles.size() - 1);
  ASSERT_GT(count, 8U);
  const StarsOf bold(s, after_a_sample(most, 0), false), hopeful(s, after_a_sample(most / 4, 0), true);
  EXPECT_EQ(bold.sizes, hopeful.sizes);
  EXPECT_GT(bold.proven(), n * 3 / 4);
  EXPECT_EQ(bold.found[CADT_STARS_SKIPPED_TILES], 0U);
  EXPECT_EQ(hopeful.found[CADT_STARS_SKIPPED_TILES], 0U);
  const StarsOf cautious(s, after_a_sample(most, 0), true);
  EXPECT_EQ(cautious.found[CADT_STARS_SKIPPED_TILES], count - 1);
  EXPECT_EQ(cautious.found[CADT_STARS_POINTS], n);
  EXPECT_EQ(n - cautious.found[CADT_STARS_UNPROVEN], cautious.proven());
  EXPECT_LE(cautious.proven(), s.tiles[1].begin);
  for (std::uint32_t v = 0; v < s.tiles[1].begin; ++v) ASSERT_EQ(cautious.sizes[v], bold.sizes[v]) << v;
}

// Where none of a tile's first points has a star, a cautious team tries no more of them, and nothing is lost elsewhere.
TEST(CautiousTiles, LeaveWhatMakesNoStars) {
  const NamedPoints set = uniform_points(6000);
  const Sorted s = sorted(set);
  EXPECT_EQ(StarsOf(s, after_a_sample(0, 0), true).sizes, StarsOf(s, after_a_sample(0, 0), false).sizes);

  // A tile with a line of points below, beyond which there is nothing, and others above it.
  NamedPoints shore{"shore", {{0, 0}, {1, 1}}, 8, 8};
  for (int i = 1; i < 300; ++i) shore.points.push_back({i / 300.0, 0});
  for (const cadt_point& p : uniform_points(300).points) shore.points.push_back({p.x, 0.2 + 0.8 * p.y});
  const Sorted one = sorted(shore);
  ASSERT_EQ(one.tiles.size(), 2U);
  EXPECT_GT(StarsOf(one, after_a_sample(0, 0), false).proven(), 50);
  const StarsOf cautious(one, after_a_sample(0, 0), true);
  EXPECT_EQ(cautious.proven(), 0);
  EXPECT_EQ(cautious.found[CADT_STARS_UNPROVEN], one.size());
}

// The points end within the grid: stars know that beyond the last of them there are none.
TEST(ProvenStars, InAPartOfTheGrid) {
  for (const double part : {0.9, 0.63, 0.51}) {
    std::map<std::string, double> shares;
    ASSERT_NO_FATAL_FAILURE(check_stars(part, false, shares));
    EXPECT_GT(shares["uniform"], 0.85) << part;
  }
}

}  // namespace
