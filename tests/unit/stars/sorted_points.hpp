// SPDX-License-Identifier: Apache-2.0
// Sorted points of all kinds, and the stars that the kernel proves among them.
#pragma once

#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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
inline Sorted sorted(const NamedPoints& set, double part = 1) {
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
  std::array<std::uint32_t, 2> found{};
  cadt_tile_flags(0, 1, s.keys.data(), s.low_keys(), s.low_bits, nullptr, nullptr, flags.data(), n, levels, n,
                  found.data());
  EXPECT_EQ(found[0], 0u);
  std::exclusive_scan(flags.begin(), flags.end(), ranks.begin(), 0u);
  s.tiles.resize(ranks[n] + 1);
  cadt_tile_pack(0, 1, s.keys.data(), s.low_keys(), s.low_bits, nullptr, nullptr, ranks.data(), s.tiles.data(), n,
                 levels, n);
  return s;
}

inline std::vector<NamedPoints> sets() {
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

/// Neighbours of each vertex counterclockwise, from the mesh of the library; empty for those of the hull.
inline std::vector<std::vector<std::uint32_t>> links_of(const Sorted& s) {
  cadt::Options options;
  options.backend = cadt::Backend::host;
  options.threads = 1;
  options.tuning.strategy = cadt::Strategy::locks;
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
inline std::vector<std::uint32_t> after_a_sample(std::uint32_t unproven, std::uint32_t crowded) {
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
inline void check_stars(double part, bool many, std::map<std::string, double>& shares) {
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

}  // namespace
