// SPDX-License-Identifier: Apache-2.0
// Windows and stars of the star stage, as the host compiles them: each against its definition.
#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#define CADT_WIDE 0
namespace {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/stars/tile_stars.dev.h"
#pragma GCC diagnostic pop

using Keys = std::vector<std::uint32_t>;

/// Sorted points with what the kernels need of them.
struct Sorted {
  std::vector<cadt_point> points;
  Keys keys, low;  ///< the low words, if there are two
  std::uint32_t low_bits = 0;
  cadt_key_grid grid{};
  cadt_point most{};             ///< largest coordinates, in units of the grid
  std::vector<cadt_tile> tiles;  ///< one more at the end
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(points.size()); }
  [[nodiscard]] const std::uint32_t* low_keys() const { return low_bits != 0 ? low.data() : nullptr; }
  [[nodiscard]] cadt_keys view() const { return cadt_keys_of(keys.data(), low_keys(), low_bits); }
};

struct NamedPoints {
  const char* name;
  std::vector<cadt_point> points;
  unsigned bits_x, bits_y, fine = 0;  ///< of the bits, those in the low word of a key of two
};

/// \pre distinct points, in [0, 1). `part` of the grid along each axis is used.
Sorted sorted(const NamedPoints& set, double part = 1) {
  const auto& [name, points, bits_x, bits_y, fine] = set;
  Sorted s;
  s.low_bits = 2 * fine;
  double low_x = 1, low_y = 1, high_x = 0, high_y = 0;
  for (const cadt_point& p : points) {
    low_x = std::min(low_x, p.x);
    low_y = std::min(low_y, p.y);
    high_x = std::max(high_x, p.x);
    high_y = std::max(high_y, p.y);
  }
  s.grid = {0.5 * low_x,
            0.5 * low_y,
            part * std::min(std::ldexp(2, static_cast<int>(bits_x)) / (high_x - low_x),
                            std::ldexp(2, static_cast<int>(bits_y)) / (high_y - low_y)),
            bits_x,
            bits_y,
            0};
  s.most = cadt_to_grid(&s.grid, {high_x, high_y});
  const auto n = static_cast<std::uint32_t>(points.size());
  Keys keys(n), low(n);
  if (fine != 0)
    cadt_fine_hilbert_keys(0, 1, points.data(), keys.data(), low.data(), s.low_bits, n, n, s.grid.half_min_x,
                           s.grid.half_min_y, s.grid.scale, bits_x, bits_y);
  else
    cadt_hilbert_keys(0, 1, points.data(), keys.data(), n, n, s.grid.half_min_x, s.grid.half_min_y, s.grid.scale,
                      bits_x, bits_y);
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return std::pair(keys[i], low[i]); });
  for (const std::uint32_t i : order) {
    s.points.push_back(points[i]);
    s.keys.push_back(keys[i]);
    s.low.push_back(low[i]);
  }
  const cadt_u32 levels = cadt_grid_levels(&s.grid);
  std::vector<std::uint32_t> flags(n + 1), ranks(n + 1);
  std::uint32_t descents = 0;
  cadt_tile_flags(0, 1, s.keys.data(), s.low_keys(), s.low_bits, nullptr, nullptr, flags.data(), n, levels, n,
                  &descents);
  EXPECT_EQ(descents, 0u);
  std::exclusive_scan(flags.begin(), flags.end(), ranks.begin(), 0u);
  s.tiles.resize(ranks[n] + 1);
  cadt_tile_pack(0, 1, s.keys.data(), s.low_keys(), s.low_bits, nullptr, nullptr, ranks.data(), s.tiles.data(), n,
                 levels, n);
  return s;
}

std::vector<NamedPoints> sets() {
  std::mt19937_64 random(2);
  const auto unit = [&] { return static_cast<double>(random() >> 12) * 0x1p-52; };
  const auto scattered = [&](std::size_t n, double x, double y, double width, double height) {
    std::vector<cadt_point> points;
    for (std::size_t i = 0; i < n; ++i) points.push_back({x + width * unit(), y + height * unit()});
    return points;
  };
  const auto lattice = [](int columns, int rows, double step) {
    std::vector<cadt_point> points;
    for (int i = 0; i < columns; ++i)
      for (int j = 0; j < rows; ++j) points.push_back({i * step, j * step});
    return points;
  };
  const auto together = [](std::vector<cadt_point> a, const std::vector<cadt_point>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  return {
      {"uniform", scattered(8000, 0, 0, 1, 1), 9, 9},
      {"uniform, fine", scattered(8000, 0, 0, 1, 1), 16, 16},
      {"uniform, coarse", scattered(8000, 0, 0, 1, 1), 2, 2},
      {"uniform, one cell", scattered(600, 0, 0, 1, 1), 0, 0},
      {"few", scattered(40, 0, 0, 1, 1), 5, 5},
      {"long", scattered(4000, 0, 0, 1, 1.0 / 64), 11, 5},
      {"tall", scattered(4000, 0, 0, 1.0 / 64, 1), 5, 11},
      {"row of cells", scattered(2000, 0, 0, 1, 1.0 / 1024), 10, 0},
      {"lattice", lattice(90, 80, 0x1p-7), 9, 9},
      {"lattice on the cells' borders", lattice(65, 65, 0x1p-7), 8, 8},
      {"lattice, thirds", lattice(61, 61, 1.0 / 61), 8, 8},
      {"crowd in the last cell", together(scattered(800, 0, 0, 1, 1), scattered(3000, 0.95, 0.95, 0.05, 0.05)), 6, 6},
      {"crowd in the last column", together(scattered(800, 0, 0, 1, 1), scattered(3000, 0.97, 0.4, 0.03, 0.03)), 6, 6},
      {"crowd in the first cell", together(scattered(800, 0, 0, 1, 1), scattered(3000, 0, 0, 0.05, 0.05)), 6, 6},
      {"half empty", together(scattered(3000, 0, 0, 0.4, 0.4), scattered(60, 0, 0, 1, 1)), 8, 8},
      {"two words", scattered(8000, 0, 0, 1, 1), 12, 12, 5},
      {"long, two words", scattered(4000, 0, 0, 1, 1.0 / 64), 14, 8, 3},
      {"lattice, two words", lattice(61, 61, 1.0 / 61), 20, 20, 12},
      {"clusters, two words",
       together(scattered(2000, 0.2, 0.3, 1e-5, 1e-5),
                together(scattered(3000, 0.7, 0.6, 1e-4, 1e-4), {{0, 0}, {1, 1}})),
       26, 26, 15},
      {"rings",
       [&] {
         std::vector<cadt_point> points;
         for (int ring = 0; ring < 40; ++ring)
           for (int k = 0; k < 12; ++k) {
             const double x = 0.1 + 0.8 * unit(), y = 0.1 + 0.8 * unit();
             for (const auto& [dx, dy] : {std::pair(3, 4), {4, 3}, {-3, 4}, {-4, 3}, {3, -4}, {4, -3}, {0, 5}, {5, 0}})
               points.push_back({std::floor(x * 256) / 256 + dx * 0x1p-12, std::floor(y * 256) / 256 + dy * 0x1p-12});
           }
         std::ranges::sort(points, {}, [](const cadt_point& p) { return std::pair(p.x, p.y); });
         const auto same = [](const cadt_point& a, const cadt_point& b) { return a.x == b.x && a.y == b.y; };
         points.erase(std::unique(points.begin(), points.end(), same), points.end());
         return points;
       }(),
       8, 8},
  };
}

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

/// Neighbours of each vertex counterclockwise, from the mesh of the library; empty for those of the hull.
std::vector<std::vector<std::uint32_t>> links_of(const Sorted& s) {
  cadt::Options options;
  options.backend = cadt::Backend::host;
  options.threads = 1;
  options.strategy = cadt::Strategy::locks;
  std::vector<double> xy;
  for (const cadt_point& p : s.points) xy.insert(xy.end(), {p.x, p.y});
  const cadt::Triangulation mesh = cadt::triangulate(std::span<const double>(xy), options);
  std::vector<std::map<std::uint32_t, std::uint32_t>> next(s.size());
  const auto triangles = mesh.triangles();
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = [&](std::size_t i) { return static_cast<std::uint32_t>(triangles[t + (k + i) % 3]); };
      next[v(0)][v(1)] = v(2);
    }
  }
  std::vector<std::vector<std::uint32_t>> star_vertices(s.size());
  for (std::uint32_t v = 0; v < s.size(); ++v) {
    std::uint32_t at = next[v].begin()->first;
    for (std::size_t k = 0; k < next[v].size(); ++k) {
      const auto found = next[v].find(at);
      if (found == next[v].end()) break;
      star_vertices[v].push_back(at);
      at = found->second;
    }
    if (star_vertices[v].size() != next[v].size() || at != star_vertices[v].front()) star_vertices[v].clear();
  }
  return star_vertices;
}

/// What cadt_prove_stars finds, as if a sample of one tile had said this of its points.
std::vector<std::uint32_t> after_a_sample(std::uint32_t unproven, std::uint32_t crowded) {
  std::vector<std::uint32_t> found(CADT_STARS_WORDS);
  const std::uint32_t sample[] = {1, 1U << 24, unproven, crowded};
  std::ranges::copy(sample, found.begin() + CADT_STARS_SAMPLED_TILES);
  return found;
}

/// Stars of all tiles, a row of words for each vertex.
struct StarsOf {
  std::vector<std::uint32_t> stars, sizes, found;

  StarsOf(const Sorted& s, std::vector<std::uint32_t> before, bool cautious) : found(std::move(before)) {
    const auto n = s.size(), count = static_cast<std::uint32_t>(s.tiles.size() - 1);
    stars.resize(std::size_t{n} * CADT_STAR_DEGREE);
    sizes.resize(n);
    cadt_prove_stars(0, 1, s.points.data(), s.keys.data(), s.low_keys(), s.low_bits, n, s.grid.half_min_x,
                     s.grid.half_min_y, s.grid.scale, s.grid.bits_x, s.grid.bits_y, s.most.x, s.most.y, 0, nullptr,
                     nullptr, s.tiles.data(), count, 1, cautious ? 1 : 0, count, stars.data(), nullptr, sizes.data(), 0,
                     0, found.data());
  }
  [[nodiscard]] auto proven() const {
    return std::ranges::count_if(sizes, [](std::uint32_t size) { return size != 0; });
  }
};

/// Compares all stars with the mesh; the shares that are proven. `part` as in sorted(); `many`: with many candidates.
void check_stars(double part, bool many, std::map<std::string, double>& shares) {
  for (const NamedPoints& set : sets()) {
    SCOPED_TRACE(set.name);
    const Sorted s = sorted(set, part);
    const StarsOf made(s, after_a_sample(0, many ? 1U << 24 : 0), false);
    const auto star_vertices = links_of(s);
    for (std::uint32_t v = 0; v < s.size(); ++v) {
      if (made.sizes[v] == 0) continue;
      const std::uint32_t* row = &made.stars[std::size_t{v} * CADT_STAR_DEGREE];
      std::vector<std::uint32_t> star(row, row + made.sizes[v]);
      std::ranges::rotate(star, std::ranges::min_element(star));
      auto link = star_vertices[v];
      ASSERT_FALSE(link.empty()) << "vertex " << v << " of the hull has a star";
      std::ranges::rotate(link, std::ranges::min_element(link));
      ASSERT_EQ(star, link) << "vertex " << v;
    }
    EXPECT_EQ(made.found[CADT_STARS_POINTS], s.size());
    EXPECT_EQ(made.found[CADT_STARS_POINTS] - made.found[CADT_STARS_UNPROVEN], made.proven());
    shares[set.name] = static_cast<double>(made.proven()) / s.size();
  }
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
