// SPDX-License-Identifier: Apache-2.0
// The largest call, without its memory: arrays for 2^29 - 2 points are mapped, 90 GB of addresses, and only pages that
// are written take memory. So records, links, triangles and edges have numbers near 2^30 and 2^32, in the kernels' own
// text. The meshes must be those of the same points with small numbers.
#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "tests/support/sparse.hpp"

namespace {

using cadt::test::Sparse;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/insertion/drop_locks.dev.h"
#include "common/insertion/legality_sweep.dev.h"
#include "common/insertion/seed_triangle.dev.h"
#include "common/output/canonical_order.dev.h"
#include "common/output/hull.dev.h"
#include "common/verify/device/verify.dev.h"
#pragma GCC diagnostic pop

const auto n = static_cast<std::uint32_t>(cadt::max_points());
const std::uint32_t slots = 2 * n, all_triangles = 2 * n - 2;  // with ghosts

/// A lattice, whose ties need the exact stages, and points without order.
std::vector<cadt_point> some_points(std::size_t count) {
  std::vector<cadt_point> points;
  std::mt19937_64 random(5);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 3 == 0)
      points.push_back({static_cast<double>(i / 3 % 37), static_cast<double>(i / 3 / 37)});
    else
      points.push_back(
          {std::ldexp(static_cast<double>(random() >> 11), -47), std::ldexp(static_cast<double>(random() >> 11), -48)});
  }
  return points;
}

class Offsets : public testing::Test {
 protected:
  void SetUp() override {
    if (!points || !records || !hints) GTEST_SKIP() << "no address space for 50 GB of pages that nobody writes";
  }

  void start(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    first = a, second = b, third = c;
    for (const std::uint32_t v : {a, b, c}) center.x += points[v].x / 3, center.y += points[v].y / 3;
    call(cadt_seed_mesh);
  }

  /// A kernel over the mesh as one work-item.
  template <class Kernel, class... Args>
  void call(Kernel kernel, Args... args) {
    kernel(0, 1, records.data(), points.data(), hints.data(), nullptr, center.x, center.y, first, second, third,
           CADT_STABILIZE_OFF, 0U, 0.0, args...);
  }

  /// `above`: the level before.
  void insert(const std::uint32_t* list, std::uint32_t listed, std::uint32_t count, std::uint32_t above) {
    call(cadt_insert, list, listed, 0U, count, n, above, count, deferred_points.data(), deferred_edges.data(),
         deferred_counts.data(), static_cast<std::uint32_t>(deferred_edges.size()), counters.data());
    EXPECT_EQ(deferred_counts[0], 0U) << "points are left";
    EXPECT_EQ(deferred_counts[1], 0U) << "edges are left";
    deferred_counts[2] = 0;
  }

  /// The closing pass over the records of these vertices: all edges, all legal.
  void expect_certified(const std::vector<std::uint32_t>& vertices) {
    for (const std::uint32_t v : vertices)
      call(cadt_legality_sweep, 2 * v, 2U, 2U, 0U, deferred_edges.data(), deferred_counts.data(),
           static_cast<std::uint32_t>(deferred_edges.size()), counters.data());
    const std::vector<std::uint32_t> found(deferred_counts.begin() + CADT_DEFERRED_COUNTS, deferred_counts.end());
    EXPECT_EQ(found, (std::vector<std::uint32_t>{static_cast<std::uint32_t>(3 * vertices.size() - 3), 0, 0, 0, 0}));
  }

  Sparse<cadt_point> points{n};
  Sparse<cadt_locked_triangle> records{slots};
  Sparse<std::uint32_t> hints{n};
  cadt_point center{};
  std::uint32_t first = 0, second = 0, third = 0;
  std::vector<std::uint32_t> deferred_points = std::vector<std::uint32_t>(1 << 16);
  std::vector<std::uint32_t> deferred_edges = std::vector<std::uint32_t>(1 << 16);
  std::vector<std::uint32_t> deferred_counts = std::vector<std::uint32_t>(CADT_DEFERRED_COUNTS + 5);
  std::vector<std::uint32_t> counters = std::vector<std::uint32_t>(CADT_COUNTER_ROWS * CADT_COUNTER_STRIDE);
};

cadt::Triangulation small_mesh(const std::vector<cadt_point>& points) {
  std::vector<double> xy;
  for (const cadt_point& p : points) xy.insert(xy.end(), {p.x, p.y});
  cadt::Options options;
  options.backend = cadt::Backend::host;
  options.threads = 1;
  return cadt::triangulate(std::span<const double>(xy), options);
}

using Face = std::array<std::uint32_t, 3>;
Face rotated(Face f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}

/// The first levels of the largest call: vertices from all over the range, by the hash that chooses them.
TEST_F(Offsets, FirstLevelsOfTheLargestCall) {
  constexpr std::uint32_t last_level = 17;
  const auto levels = static_cast<std::uint32_t>(std::bit_width(n - 1));
  ASSERT_EQ(levels, 29U);
  std::uint32_t root = 0;
  cadt_first_representative(0, 1, n, levels, &root);
  std::set<std::uint32_t> chosen{n / 2};
  for (std::uint32_t block = 0; block <= (n - 1) >> last_level; ++block)
    chosen.insert(cadt_representative(last_level, block, n));
  ASSERT_TRUE(chosen.contains(root));
  ASSERT_GE(chosen.size(), 4096U);
  ASSERT_LT(*chosen.rbegin(), n);
  EXPECT_GT(*chosen.rbegin(), n - (1U << last_level));
  const std::vector<std::uint32_t> vertices(chosen.begin(), chosen.end());
  std::vector<cadt_point> compact = some_points(vertices.size());
  std::ranges::shuffle(compact, std::mt19937(3));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    points[vertices[i]] = compact[i];
    hints[vertices[i]] = CADT_NONE;
  }
  const cadt::Triangulation expected = small_mesh(compact);
  ASSERT_TRUE(expected.duplicates().empty());
  start(root, n / 2, vertices[7] == root ? vertices[8] : vertices[7]);
  for (std::uint32_t level = levels; level-- > last_level;) insert(nullptr, 0, (((n - 1) >> level) + 1) / 2, level + 1);
  expect_certified(vertices);
  std::set<Face> found, wanted;
  for (const std::uint32_t v : vertices)
    for (const std::uint32_t r : {2 * v, 2 * v + 1})
      if (records[r].word[CADT_WORD_LOCK] != 0 && cadt_ghost_slot(&records[r]) == 3)
        found.insert(rotated({records[r].word[0], records[r].word[1], records[r].word[2]}));
  const auto triangles = expected.triangles();
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const auto vertex = [&](std::size_t k) { return vertices[static_cast<std::size_t>(triangles[i + k])]; };
    wanted.insert(rotated({vertex(0), vertex(1), vertex(2)}));
  }
  EXPECT_TRUE(found == wanted);
  std::uint32_t highest = 0;
  for (const std::uint32_t v : vertices)
    for (std::size_t k = 0; k < 3; ++k) highest = std::max(highest, records[2 * v].word[CADT_WORD_HALF_EDGE + k]);
  EXPECT_GT(highest, 0xFF000000U);
}

/// The last vertices of the largest call, their triangles at the end of the largest result, and its check.
TEST_F(Offsets, LastTrianglesOfTheLargestCall) {
  constexpr std::uint32_t count = 3000;
  const std::uint32_t base = n - count;
  const std::vector<cadt_point> compact = some_points(count);
  const cadt::Triangulation expected = small_mesh(compact);
  ASSERT_TRUE(expected.duplicates().empty());
  std::vector<std::uint32_t> vertices(count);
  std::iota(vertices.begin(), vertices.end(), base);
  for (std::uint32_t i = 0; i < count; ++i) points[base + i] = compact[i];
  start(n - 1, n - 2, n - 3);
  for (const std::uint32_t v : vertices) hints[v] = 2 * (n - 1);
  insert(vertices.data(), count, count, 0);
  expect_certified(vertices);
  EXPECT_EQ(records[slots - 1].word[CADT_WORD_LOCK] % 2, 0U);

  const auto real = static_cast<std::uint32_t>(expected.number_of_triangles());
  // As if all triangles of the vertices before had no ghost.
  const std::uint32_t before = 2 * base, last = before + real;
  Sparse<std::uint32_t> labels(n), buckets(std::size_t{n} + 2), places(std::size_t{n} + 2),
      numbers(std::size_t{slots} + 1), used(n);
  Sparse<std::uint32_t> vertices_of(std::size_t{3} * all_triangles), half_edges(std::size_t{3} * all_triangles);
  Sparse<std::uint32_t> triangles(std::size_t{3} * all_triangles), neighbors(std::size_t{3} * all_triangles);
  Sparse<cadt_member> members(all_triangles);
  if (!labels || !buckets || !places || !numbers || !used || !vertices_of || !half_edges || !triangles || !neighbors ||
      !members)
    GTEST_SKIP() << "no address space for 50 GB more";
  for (const std::uint32_t v : vertices) labels[v] = v;
  // One work-item for each element of the range, as if there were as many for all of them.
  const auto over = [](std::uint32_t begin, std::uint32_t end, const auto& kernel) {
    for (std::uint32_t i = begin; i < end; ++i) kernel(i);
  };
  constexpr std::uint32_t grain = 1;
  std::vector<std::uint32_t> flips(CADT_COUNTER_ROWS * CADT_FLIP_BINS);

  // Without locks: the ghosts behind the others.
  over(before, slots, [&](std::uint32_t item) {
    cadt_flag_triangles(item, slots, records.data(), numbers.data(), slots, grain, flips.data());
  });
  std::uint32_t sum = before;
  numbers[slots] = 0;
  for (std::uint32_t r = before; r <= slots; ++r) sum += std::exchange(numbers[r], sum);
  ASSERT_EQ(numbers[slots], last);
  over(before, slots, [&](std::uint32_t item) {
    cadt_drop_locks(item, slots, records.data(), nullptr, numbers.data(), slots, 2 * third, nullptr, grain,
                    vertices_of.data(), half_edges.data(), nullptr);
  });
  for (std::uint32_t t = before; t < all_triangles; ++t) {
    const std::size_t at = std::size_t{3} * t;
    const bool ghost =
        vertices_of[at] == CADT_GHOST || vertices_of[at + 1] == CADT_GHOST || vertices_of[at + 2] == CADT_GHOST;
    ASSERT_EQ(ghost, t >= last) << t;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t across = half_edges[at + k];
      ASSERT_EQ(half_edges[std::size_t{3} * (across >> 2) + (across & 3U)], t << 2 | k) << t;
    }
  }

  const auto expect_result = [&](const char* what) {
    const auto t = expected.triangles(), s = expected.neighbors();
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
      const std::size_t at = std::size_t{3} * before + i;
      wrong += triangles[at] != base + static_cast<std::uint32_t>(t[i]);
      wrong += neighbors[at] != (s[i] < 0 ? CADT_NONE : before + static_cast<std::uint32_t>(s[i]));
    }
    EXPECT_EQ(wrong, 0U) << what;
  };
  over(before, last, [&](std::uint32_t item) {
    cadt_count_triangles(item, last, vertices_of.data(), labels.data(), buckets.data(), numbers.data(), last, grain);
  });
  over(base, n, [&](std::uint32_t item) {
    cadt_sizes_by_input(item, n, buckets.data(), labels.data(), places.data(), n, grain);
  });
  for (auto* const scanned : {&buckets, &places}) {
    sum = before;
    for (std::uint32_t v = base; v <= n; ++v) sum += std::exchange((*scanned)[v], sum);
    EXPECT_EQ((*scanned)[n], last);
  }
  over(before, last, [&](std::uint32_t item) {
    cadt_bucket_triangles(item, last, vertices_of.data(), labels.data(), buckets.data(), numbers.data(), members.data(),
                          0U, n, 0U, last, grain);
  });
  std::uint32_t skipped = 0;
  over(base, n, [&](std::uint32_t item) {
    cadt_number_buckets(item, n, buckets.data(), members.data(), labels.data(), places.data(), numbers.data(), 0U, n,
                        0U, CADT_NONE, grain, &skipped);
  });
  EXPECT_EQ(skipped, 0U);
  const auto write = [&](const std::uint32_t* order) {
    over(before, last, [&](std::uint32_t item) {
      cadt_write_triangles(item, last, nullptr, vertices_of.data(), half_edges.data(), nullptr, last, all_triangles, 2U,
                           labels.data(), order, triangles.data(), neighbors.data(), nullptr, 0, grain);
    });
  };
  write(numbers.data());
  expect_result("canonical order");
  for (std::uint32_t word = 3 * before; word < 3 * last; ++word) triangles[word] = neighbors[word] = 0;
  const std::uint32_t groups = (last - 1) / CADT_OUTPUT_LANES + 1;
  over(before / CADT_OUTPUT_LANES, groups, [&](std::uint32_t item) {
    cadt_write_numbered(item, groups, nullptr, vertices_of.data(), half_edges.data(), nullptr, last, all_triangles, 2U,
                        labels.data(), numbers.data(), triangles.data(), neighbors.data(), nullptr, 0, groups, grain);
  });
  expect_result("canonical order by teams");

  // The boundary.
  std::uint32_t size = 0;
  std::vector<std::uint32_t> pairs(2 * expected.hull().size());
  over(before, last, [&](std::uint32_t item) {
    cadt_boundary_edges(item, last, triangles.data(), neighbors.data(), last, grain, pairs.data(), &size,
                        static_cast<std::uint32_t>(expected.hull().size()));
  });
  EXPECT_EQ(size, expected.hull().size());
  const auto hull = expected.hull();
  std::map<std::uint32_t, std::uint32_t> next;
  for (std::size_t i = 0; i < pairs.size(); i += 2) next[pairs[i]] = pairs[i + 1];
  for (std::size_t i = 0; i < hull.size(); ++i)
    EXPECT_EQ(next[base + static_cast<std::uint32_t>(hull[i])],
              base + static_cast<std::uint32_t>(hull[(i + 1) % hull.size()]));

  // The verifier accepts them, and names the one that is turned around.
  const auto verify = [&] {
    std::vector<std::uint32_t> results(CADT_FOUND_ROWS * CADT_FOUND_WORDS);
    for (std::size_t row = 0; row < results.size(); row += CADT_FOUND_WORDS)
      for (const int finding :
           {CADT_FOUND_RANGE, CADT_FOUND_NEIGHBORS, CADT_FOUND_ORIENTATION, CADT_FOUND_EDGES, CADT_FOUND_TIES})
        results[row + static_cast<std::size_t>(finding) + 2] = CADT_NONE;
    over(before, last, [&](std::uint32_t item) {
      cadt_verify_structure(item, last, points.data(), triangles.data(), neighbors.data(), nullptr, last, last, 0U, n,
                            grain, used.data(), results.data());
    });
    std::vector<std::uint32_t> lists(4 * real), sizes(1), left(1);
    cadt_verify_filter(0, 1, points.data(), triangles.data(), neighbors.data(), nullptr, last, last, 0U, before, real,
                       1, real, 1, lists.data(), sizes.data(), 4 * real, results.data());
    cadt_verify_exact(0, 1, points.data(), triangles.data(), neighbors.data(), nullptr, last, last, 0U, before, 1,
                      lists.data(), sizes.data(), 4 * real, left.data(), results.data());
    EXPECT_EQ(left[0], 0U);
    std::vector<std::uint32_t> sums(CADT_FOUND_WORDS), least(CADT_FOUND_WORDS, CADT_NONE);
    for (std::size_t i = 0; i < results.size(); ++i) {
      sums[i % CADT_FOUND_WORDS] += results[i];
      least[i % CADT_FOUND_WORDS] = std::min(least[i % CADT_FOUND_WORDS], results[i]);
    }
    EXPECT_EQ(sums[CADT_FOUND_RANGE], real);
    EXPECT_EQ(sums[CADT_FOUND_EDGES], (3 * real - hull.size()) / 2);
    EXPECT_EQ(sums[CADT_FOUND_ORIENTATION], real);
    return std::array{sums[CADT_FOUND_RANGE + 1] + sums[CADT_FOUND_NEIGHBORS + 1] + sums[CADT_FOUND_EDGES + 1] +
                          sums[CADT_FOUND_TIES + 1],
                      sums[CADT_FOUND_ORIENTATION + 1], least[CADT_FOUND_ORIENTATION + 2],
                      sums[CADT_FOUND_NEIGHBORS + 1], least[CADT_FOUND_NEIGHBORS + 2]};
  };
  EXPECT_EQ(verify(), (std::array<std::uint32_t, 5>{0, 0, CADT_NONE, 0, CADT_NONE}));
  const std::uint32_t turned = last - 5;
  std::swap(triangles[std::size_t{3} * turned + 1], triangles[std::size_t{3} * turned + 2]);
  const auto found = verify();
  EXPECT_EQ(found[1], 1U);
  EXPECT_EQ(found[2], turned);
  EXPECT_GT(found[3], 0U);
  EXPECT_GT(found[4], 3U * before);
  std::swap(triangles[std::size_t{3} * turned + 1], triangles[std::size_t{3} * turned + 2]);

  // In the order of the mesh: the same triangles.
  std::set<Face> canonical, ranked;
  const auto collect = [&](std::set<Face>& into) {
    for (std::uint32_t t = before; t < last; ++t) {
      const std::size_t at = std::size_t{3} * t;
      into.insert(rotated({triangles[at], triangles[at + 1], triangles[at + 2]}));
      for (std::size_t k = 0; k < 3; ++k) triangles[at + k] = 0;
    }
  };
  collect(canonical);
  write(nullptr);
  EXPECT_EQ(verify(), (std::array<std::uint32_t, 5>{0, 0, CADT_NONE, 0, CADT_NONE}));
  collect(ranked);
  EXPECT_EQ(ranked.size(), real);
  EXPECT_TRUE(canonical == ranked);
}

/// Every product of an index that the kernels form fits 32 bits in the largest call, and the one after it would not.
TEST(IndexLimits, OfTheLargestCall) {
  const std::uint64_t most = cadt::max_points(), word = std::uint64_t{1} << 32;
  EXPECT_LT(4 * (2 * most - 1) + 3, word - 1);               // a link, and no link is CADT_NONE
  EXPECT_EQ(CADT_HALF_EDGE(slots - 1, 3U) >> 2, slots - 1);  // which keeps its record
  EXPECT_GE(4 * (2 * (most + 2)), word);                     // two points more, and a link does not fit
  EXPECT_LT(3 * (2 * most - 5), word - 1);                   // an edge 3 * triangle + k
  EXPECT_LT(3 * (2 * most), word - 1);                       // the same by record (stitch.dev.h)
  EXPECT_LT(2 * most, std::uint64_t{1} << 31);               // triangles are int32 in the result
  EXPECT_LT(most, std::uint64_t{std::numeric_limits<std::int32_t>::max()});
}

}  // namespace
