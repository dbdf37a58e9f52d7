// SPDX-License-Identifier: Apache-2.0
// Windows and stars of the star stage, as the host compiles them: each against its definition.
#include "tests/unit/stars/sorted_points.hpp"

namespace {

// As those of one word where there are 16 levels; the key of a cell begins with that of the cell around it, and what
// comes next on the curve is beside it.
TEST(FineKeys, FollowTheCurve) {
  std::mt19937_64 random(7);
  for (const auto& [bits_x, bits_y] :
       {std::pair(16U, 16U), {16U, 12U}, {9U, 14U}, {24U, 24U}, {31U, 31U}, {27U, 20U}}) {
    const cadt_key_grid grid{0, 0, 1, bits_x, bits_y, 0};
    const std::uint32_t levels = cadt_grid_levels(&grid);
    std::map<std::uint64_t, std::pair<std::int64_t, std::int64_t>> cells;
    const std::uint32_t x0 = static_cast<std::uint32_t>(random()) & ((1U << bits_x) - 1) & ~15U,
                        y0 = static_cast<std::uint32_t>(random()) & ((1U << bits_y) - 1) & ~15U;
    for (std::uint32_t k = 0; k < 256; ++k) {
      const std::uint32_t x = x0 + k % 16, y = y0 + k / 16;
      const std::uint64_t key = cadt_fine_key(&grid, x, y, levels);
      ASSERT_LT(key, std::uint64_t{1} << (bits_x + bits_y));
      if (bits_x + bits_y <= 32) {
        ASSERT_EQ(key, cadt_cell_key(&grid, x, y, levels));
      }
      for (std::uint32_t up = 1; up <= levels; ++up)
        ASSERT_EQ(key >> (2 * up), cadt_fine_key(&grid, x >> up, y >> up, levels - up));
      cells[key] = {x, y};
    }
    ASSERT_EQ(cells.size(), 256U);
    for (auto a = cells.begin(), b = std::next(a); b != cells.end(); ++a, ++b) {
      ASSERT_EQ(b->first, a->first + 1);
      ASSERT_EQ(std::abs(a->second.first - b->second.first) + std::abs(a->second.second - b->second.second), 1);
    }
  }
}

TEST(Windows, HaveEveryPointOfTheirSquares) {
  std::size_t all_inside = 0;
  for (const NamedPoints& set : sets()) {
    SCOPED_TRACE(set.name);
    const Sorted s = sorted(set);
    const auto window = std::make_unique<cadt_neighborhood>();
    const cadt_keys keys = s.view();
    std::size_t loaded = 0, owned = 0, inside = 0;
    for (std::size_t t = 0; t + 1 < s.tiles.size(); ++t) {
      const cadt_neighborhood_shape shape =
          cadt_shape_of_neighborhood(&s.grid, s.most, s.points.data(), s.tiles[t], s.tiles[t + 1].begin);
      ASSERT_LE(shape.side * shape.side, static_cast<unsigned>(CADT_NEIGHBORHOOD_CELLS));
      ASSERT_LE(shape.squares * shape.squares, static_cast<unsigned>(CADT_NEIGHBORHOOD_SPANS));
      // by definition: the points whose cells of the grid are within the window
      const double width = shape.side / shape.cells;
      std::set<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < s.size(); ++i) {
        const cadt_point f = cadt_clamp_to_grid(&s.grid, cadt_to_grid(&s.grid, s.points[i]));
        const double x = std::floor(f.x) - shape.origin_x, y = std::floor(f.y) - shape.origin_y;
        if (x >= 0 && x < width && y >= 0 && y < width) expected.insert(i);
      }
      const bool fits = expected.size() <= static_cast<std::size_t>(CADT_NEIGHBORHOOD_POINTS) &&
                        shape.end - shape.begin <= static_cast<std::uint32_t>(CADT_TILE_POINTS);
      // where points from outside may be in the cells at the edge, windows keep off them
      const double square = shape.side / shape.cells / shape.squares;
      const auto off = [&](double from, unsigned bits) {
        return from >= square && from + width <= std::ldexp(1, static_cast<int>(bits)) - square;
      };
      const bool inner = off(shape.origin_x, s.grid.bits_x) && off(shape.origin_y, s.grid.bits_y);
      inside += inner ? 1 : 0;
      ASSERT_EQ(cadt_load_neighborhood(window.get(), &shape, &s.grid, s.points.data(), &keys, s.size(), 1) != 0,
                fits && inner);
      ASSERT_EQ(cadt_load_neighborhood(window.get(), &shape, &s.grid, s.points.data(), &keys, s.size(), 0) != 0, fits);
      if (!fits) continue;
      ++loaded;
      const std::uint32_t total = window->cells[shape.side * shape.side];
      ASSERT_EQ(std::set<std::uint32_t>(window->at, window->at + total), expected);
      ASSERT_EQ(total, expected.size()) << "a point twice";
      ASSERT_EQ(window->rows[shape.tile_side], shape.end - shape.begin);
      owned += window->rows[shape.tile_side];
      for (std::uint32_t cell = 0; cell < shape.side * shape.side; ++cell) {
        for (std::uint32_t place = window->cells[cell]; place < window->cells[cell + 1]; ++place) {
          const cadt_point f = cadt_to_grid(&s.grid, s.points[window->at[place]]);
          ASSERT_EQ(cadt_cell_in_neighborhood(&shape, f), cell);
          const double x = (f.x - shape.origin_x) * shape.cells - 0.5 * shape.side;
          const double y = (f.y - shape.origin_y) * shape.cells - 0.5 * shape.side;
          ASSERT_NEAR(static_cast<double>(window->x[place]), x, 5e-7);
          ASSERT_NEAR(static_cast<double>(window->y[place]), y, 5e-7);
        }
      }
    }
    EXPECT_EQ(loaded == 0, set.name == std::string_view("uniform, coarse")) << "cells of 500 points fill no window";
    EXPECT_LE(owned, s.size());
    all_inside += inside;
  }
  EXPECT_GT(all_inside, 20u);
}

TEST(ProvenStars, AreThoseOfTheMesh) {
  std::map<std::string, double> shares;
  ASSERT_NO_FATAL_FAILURE(check_stars(1, true, shares));
  ASSERT_NO_FATAL_FAILURE(check_stars(1, false, shares));
  for (const char* name : {"uniform", "uniform, fine", "lattice", "lattice, thirds", "two words", "lattice, two words",
                           "clusters, two words"})
    EXPECT_GT(shares[name], 0.85) << name;
  for (const char* name : {"few", "long", "tall", "lattice on the cells' borders", "half empty", "rings"})
    EXPECT_GT(shares[name], 0.2) << name;
  for (const auto& [name, share] : shares) RecordProperty(name, std::to_string(share));
}

}  // namespace
