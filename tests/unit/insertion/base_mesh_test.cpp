// SPDX-License-Identifier: Apache-2.0
// Points inserted into a mesh of some of them that was made otherwise, by the text of GPUs.
#include "gpu_insertion.hpp"

#include <random>

#include <gtest/gtest.h>

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/insertion/base_mesh.dev.h"
#pragma GCC diagnostic pop

using Words = std::vector<cadt_u32>;

struct Arrays {
  Words vertices, across;
};

void insert(SeededMesh& m, cadt_u32 i, cadt_u32 start) {
  CADT_DECLARE_WORKLIST(work);
  cadt_worklist_begin(&work, i, 1U << 20);
  work.apex_point = m.points[i];
  work.size = cadt_try_insert(&m.mesh, i, m.points[i], &start, work.half_edge, &m.counters);
  ASSERT_GT(work.size, 0U);
  m.hints[i] = start;
  cadt_legalize(&m.mesh, &work, &m.deferred, &m.counters);
}

/// The mesh of points in arrays without gaps.
Arrays arrays_of(const std::vector<cadt_point>& points) {
  SeededMesh m(points);
  for (cadt_u32 i = 3; i < m.size(); ++i) insert(m, i, m.hints[0]);
  Words number(m.locked.size());
  cadt_u32 used = 0;
  for (std::size_t t = 0; t < number.size(); ++t)
    if (m.locked[t].word[CADT_WORD_LOCK] != 0) number[t] = used++;
  Arrays arrays;
  for (const cadt_locked_triangle& t : m.locked)
    for (std::size_t k = 0; k < 3 && t.word[CADT_WORD_LOCK] != 0; ++k) {
      const cadt_u32 across = t.word[CADT_WORD_HALF_EDGE + k];
      arrays.vertices.push_back(t.word[k]);
      arrays.across.push_back(CADT_HALF_EDGE(number[CADT_TRIANGLE_OF(across)], CADT_EDGE_OF(across)));
    }
  return arrays;
}

/// Two slots are not used, half-edges fit, triangles are counterclockwise and no edge is illegal.
void expect_delaunay(SeededMesh& m, std::size_t unused) {
  for (std::size_t t = 0; t < m.locked.size(); ++t) {
    const auto& word = m.locked[t].word;
    ASSERT_EQ(word[CADT_WORD_LOCK] == 0, t == unused || t == unused + 1) << t;
    if (word[CADT_WORD_LOCK] == 0) continue;
    EXPECT_EQ(word[CADT_WORD_LOCK] & 1U, 0U);
    const bool real = word[0] != CADT_GHOST && word[1] != CADT_GHOST && word[2] != CADT_GHOST;
    if (real) {
      EXPECT_GT(cadt_orientation(m.points[word[0]], m.points[word[1]], m.points[word[2]], &m.counters), 0);
    }
    for (cadt_u32 k = 0; k < 3; ++k) {
      const cadt_u32 across = word[CADT_WORD_HALF_EDGE + k];
      const auto& other = m.locked[CADT_TRIANGLE_OF(across)].word;
      EXPECT_EQ(other[CADT_WORD_HALF_EDGE + CADT_EDGE_OF(across)], CADT_HALF_EDGE(static_cast<cadt_u32>(t), k));
      const cadt_u32 apex = other[CADT_EDGE_OF(across)];
      if (!real || apex == CADT_GHOST) continue;
      EXPECT_LE(cadt_incircle(m.points[word[0]], m.points[word[1]], m.points[word[2]], m.points[apex], &m.counters), 0);
    }
  }
}

TEST(BaseMesh, OthersAreInsertedIntoIt) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, 1);
  for (const cadt_u32 n : {37U, 500U, 1025U}) {
    for (const cadt_u32 level : {2U, 3U}) {
      std::vector<cadt_point> sorted;
      for (cadt_u32 i = 0; i < n; ++i) sorted.push_back({(i + place(random)) / n, place(random)});
      const cadt_u32 count = cadt_blocks_of(level, n);
      std::vector<cadt_point> picked(count), by_level(n);
      cadt_pick_base(0, 1, sorted.data(), n, level, count, count, picked.data());
      for (cadt_u32 i = 0; i < n; ++i) by_level[cadt_rank_of(0, i, n)] = sorted[i];
      const Arrays base = arrays_of(picked);
      ASSERT_EQ(base.vertices.size(), 3 * (2 * std::size_t{count} - 2));

      SeededMesh m(by_level);
      m.locked.assign(m.locked.size(), {});
      m.hints.assign(n, CADT_NONE);
      const auto all = static_cast<cadt_u32>(base.vertices.size() / 3);
      cadt_lock_base(0, 1, m.locked.data(), m.points.data(), m.hints.data(), nullptr, m.mesh.center.x, m.mesh.center.y,
                     0, 1, 2, 0, 0, 0, base.vertices.data(), base.across.data(), n, level, all, all);
      for (cadt_u32 v = 0; v < n; ++v) {
        ASSERT_EQ(m.hints[v] == CADT_NONE, v >= count);
        if (v >= count) continue;
        const auto& word = m.locked[m.hints[v]].word;
        EXPECT_TRUE(word[0] == v || word[1] == v || word[2] == v);
      }
      for (cadt_u32 below = level; below-- > 0;)
        for (cadt_u32 block = 0; block < cadt_blocks_of(below, n) / 2; ++block) {
          const cadt_u32 i = cadt_blocks_of(below + 1, n) + block;
          insert(m, i, cadt_start_beside(&m.mesh, below + 1, i, n, m.points[i]));
        }
      ASSERT_EQ(m.counts[1], 0U);
      expect_delaunay(m, 2 * std::size_t{count} - 2);
    }
  }
}

}  // namespace
