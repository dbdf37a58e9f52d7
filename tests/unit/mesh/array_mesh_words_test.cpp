// SPDX-License-Identifier: Apache-2.0
// The certificate of a mesh in arrays, each word of which is changed to each value that it could have: what the kernel
// counts is what the definition says, edge by edge.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/certify/certify.dev.h"
#pragma GCC diagnostic pop

using Word = std::uint32_t;
using Face = std::array<Word, 3>;

constexpr Word g = CADT_GHOST;

/// A square with its centre, and a point to the right of it; triangles of the ghost come last.
const std::vector<cadt_point> points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 2}, {7, 2}};
const std::vector<Face> square = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 5, 2},
                                  {g, 1, 0}, {g, 5, 1}, {g, 2, 5}, {g, 3, 2}, {g, 0, 3}};
constexpr Word real = 5;

struct Mesh {
  std::vector<Face> vertices = square, half_edges{square.size()};
  Mesh() {
    std::map<std::pair<Word, Word>, Word> sides;
    for (Word t = 0; t < square.size(); ++t)
      for (Word k = 0; k < 3; ++k) sides[{square[t][(k + 1) % 3], square[t][(k + 2) % 3]}] = CADT_HALF_EDGE(t, k);
    for (Word t = 0; t < square.size(); ++t)
      for (Word k = 0; k < 3; ++k) half_edges[t][k] = sides.at({square[t][(k + 2) % 3], square[t][(k + 1) % 3]});
  }
  /// From where to where edge k of a triangle leads.
  [[nodiscard]] std::pair<Word, Word> side(Word t, Word k) const {
    return {vertices[t][(k + 1) % 3], vertices[t][(k + 2) % 3]};
  }
};

struct Counts {
  Word examined = 0, wrong = 0, illegal_or_back = 0;
};

/// By the definition.
Counts expected(const Mesh& mesh) {
  Counts c;
  const auto all = static_cast<Word>(mesh.vertices.size());
  for (Word t = 0; t < all; ++t) {
    const bool of_ghost = std::ranges::count(mesh.vertices[t], g) != 0;
    if (of_ghost != (t >= real)) ++c.wrong;
    for (Word k = 0; k < 3; ++k) {
      const Word u = mesh.half_edges[t][k] / 4, j = mesh.half_edges[t][k] % 4;
      if (u < t) continue;
      ++c.examined;
      const bool mutual = u < all && j < 3 && mesh.half_edges[u][j] == 4 * t + k;
      const auto here = mesh.side(t, k);
      if (!mutual || mesh.side(u, j) != std::pair(here.second, here.first)) ++c.wrong;
    }
  }
  return c;
}

Counts found(const Mesh& mesh) {
  const auto all = static_cast<Word>(mesh.vertices.size());
  std::vector<Word> words((1 + CADT_COUNTER_ROWS) * CADT_COUNTER_STRIDE);
  cadt_certify(0, 1, points.data(), mesh.vertices[0].data(), mesh.half_edges[0].data(), nullptr, real, all, 2, 0, all,
               all, words.data(), 0, 1);
  return {words[0], words[2], words[1] + words[3]};
}

void expect_counted(const Mesh& mesh) {
  const Counts is = found(mesh), wanted = expected(mesh);
  EXPECT_EQ(is.examined, wanted.examined);
  EXPECT_EQ(is.wrong, wanted.wrong);
}

TEST(ArrayMeshWords, NoneIsWrong) {
  const Counts c = found(Mesh());
  EXPECT_EQ(c.examined, 15U);
  EXPECT_EQ(c.wrong + c.illegal_or_back, 0U);
  expect_counted(Mesh());
}

/// A vertex is an end of two of the triangle's edges: both no longer fit, and no mesh with such a word is certified.
TEST(ArrayMeshWords, EachVertex) {
  std::size_t alone = 0;  // changes that nothing but the ends of edges tells
  for (Word t = 0; t < square.size(); ++t) {
    for (Word k = 0; k < 3; ++k) {
      for (const Word v : {0U, 1U, 2U, 3U, 4U, 5U, g}) {
        if (v == square[t][k]) continue;
        SCOPED_TRACE("vertex " + std::to_string(k) + " of triangle " + std::to_string(t) + " is " + std::to_string(v));
        Mesh mesh;
        mesh.vertices[t][k] = v;
        expect_counted(mesh);
        const Counts c = found(mesh);
        EXPECT_GE(c.wrong, 2U);
        if (c.illegal_or_back == 0) ++alone;
      }
    }
  }
  EXPECT_GT(alone, 10U);
}

TEST(ArrayMeshWords, EachLink) {
  for (Word t = 0; t < square.size(); ++t) {
    for (Word k = 0; k < 3; ++k) {
      for (Word link = 0; link < 4 * square.size() + 4; ++link) {
        Mesh mesh;
        if (link == mesh.half_edges[t][k]) continue;
        SCOPED_TRACE("link " + std::to_string(k) + " of triangle " + std::to_string(t) + " is " + std::to_string(link));
        mesh.half_edges[t][k] = link;
        expect_counted(mesh);
        const Counts c = found(mesh);
        EXPECT_TRUE(c.wrong != 0 || c.examined != 15U);
      }
    }
  }
}

}  // namespace
