// SPDX-License-Identifier: Apache-2.0
// Constrained edges from the mesh to the result: the same edges in both orders and both memory plans, wherever the
// triangles go and however they are turned.
#include "common/driver/registry.hpp"
#include "common/output/renumber.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace cadt::test {
namespace {

using Word = std::uint32_t;
using Edge = std::pair<Word, Word>;
constexpr Word no_edge = 0xFFFFFFFF;

Edge edge(Word a, Word b) { return std::minmax(a, b); }

/// The mesh of some points as a stage hands it over: vertices and triangles in another order than in the result,
/// triangles turned, half-edges across.
struct MeshInArrays {
  explicit MeshInArrays(const Triangulation& result) {
    const auto triangles = result.triangles(), neighbors = result.neighbors();
    const std::size_t count = triangles.size() / 3;
    input_ids = shuffled(result.number_of_points());
    std::vector<Word> position(input_ids.size());
    for (Word v = 0; v < input_ids.size(); ++v) position[input_ids[v]] = v;
    const std::vector<Word> place = shuffled(count);
    // where edge k of triangle t of the result is, as a half-edge
    const auto half_edge = [&](std::size_t t, std::size_t k) {
      return 4 * place[t] + static_cast<Word>((k + place[t]) % 3);
    };
    vertices.resize(3 * count);
    half_edges.resize(3 * count, no_edge);
    edge_flags.resize(count);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const std::size_t t = i / 3, k = i % 3;
      const Word here = half_edge(t, k), at = here / 4 * 3 + here % 4;
      vertices[at] = position[static_cast<std::size_t>(triangles[i])];
      const bool boundary = neighbors[i] < 0;
      const auto n = static_cast<std::size_t>(std::max(neighbors[i], 0));
      for (std::size_t j = 0; !boundary && j < 3; ++j)
        if (neighbors[3 * n + j] == static_cast<std::int32_t>(t)) half_edges[at] = half_edge(n, j);
      if (!boundary && (n < t || random_() % 3 != 0)) continue;
      edge_flags[here / 4] |= 1U << here % 4;
      if (!boundary) edge_flags[half_edges[at] / 4] |= 1U << half_edges[at] % 4;
      constrained.insert(
          edge(static_cast<Word>(triangles[3 * t + (k + 1) % 3]), static_cast<Word>(triangles[3 * t + (k + 2) % 3])));
    }
  }

  std::vector<Word> input_ids, vertices, half_edges, edge_flags;
  std::set<Edge> constrained;  ///< pairs of input ids

 private:
  std::vector<Word> shuffled(std::size_t count) {
    std::vector<Word> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    std::ranges::shuffle(numbers, random_);
    return numbers;
  }
  std::mt19937 random_{4};
};

class ConstrainedOutput : public BackendTest {};

TEST_P(ConstrainedOutput, SameEdgesInBothOrders) {
  const auto device = open_device(GetParam().options());
  for (const std::size_t n : {300U, 40000U}) {  // without and with pooled memory
    const std::vector<double> xy = uniform_points(n, 12);
    const Triangulation expected = triangulate(std::span<const double>(xy), GetParam().options());
    const MeshInArrays from(expected);
    ASSERT_GT(from.constrained.size(), n / 2);
    for (const Order order : {Order::fast, Order::canonical}) {
      for (const bool compact : {false, true}) {
        SCOPED_TRACE(std::string(order == Order::fast ? "fast" : "canonical") + (compact ? ", compact" : ""));
        Options options = GetParam().options();
        options.order = order;
        Memory memory(*device, true);
        Statistics statistics;
        MemoryPlan plan;
        plan.compact = compact;
        Context ctx(*device, memory, options, statistics, plan);
        const auto upload = [&](const std::vector<Word>& words) {
          Allocation array = memory.allocate(words.size() * sizeof(Word));
          device->write(*array, 0, words.data(), words.size() * sizeof(Word));
          return array;
        };
        Mesh mesh;
        mesh.triangles = mesh.all = expected.number_of_triangles();
        mesh.input_ids = upload(from.input_ids);
        mesh.vertices.device = upload(from.vertices);
        mesh.across.device = upload(from.half_edges);
        mesh.edge_flags = upload(from.edge_flags);
        write_result(ctx, mesh, n);
        ASSERT_EQ(mesh.triangles, expected.number_of_triangles());
        const std::size_t count = mesh.triangles;
        const std::vector<Word> triangles = device->read_values(*mesh.vertices.device, 3 * count),
                                neighbors = device->read_values(*mesh.across.device, 3 * count),
                                flags = device->read_values(*mesh.edge_flags, count);
        std::set<Edge> constrained;
        std::size_t wrong = 0, one_sided = 0;
        for (Word i = 0; i < triangles.size(); ++i) {
          const Word t = i / 3 * 3, from_vertex = triangles[t + (i + 1) % 3], to_vertex = triangles[t + (i + 2) % 3];
          const bool flagged = (flags[i / 3] >> i % 3 & 1U) != 0;
          if (flagged) constrained.insert(edge(from_vertex, to_vertex));
          const Word s = neighbors[i];
          if (s == no_edge) continue;
          std::size_t back = 3;
          for (std::size_t j = 0; j < 3; ++j)
            if (neighbors[3 * s + j] == i / 3 && triangles[3 * s + (j + 1) % 3] == to_vertex) back = j;
          wrong += back == 3;
          one_sided += back != 3 && flagged != ((flags[s] >> back & 1U) != 0);
        }
        EXPECT_EQ(wrong + one_sided, 0U);
        EXPECT_TRUE(constrained == from.constrained);
        if (order == Order::canonical && GetParam().options().order == Order::canonical) {
          EXPECT_TRUE(std::ranges::equal(triangles, expected.triangles(), {}, {},
                                         [](std::int32_t v) { return static_cast<Word>(v); }));
        }
      }
    }
  }
}
CADT_ON_MAIN_BACKENDS(ConstrainedOutput);

}  // namespace
}  // namespace cadt::test
