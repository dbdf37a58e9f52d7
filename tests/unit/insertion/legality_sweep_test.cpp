// SPDX-License-Identifier: Apache-2.0
// The closing pass sees a boundary that no sign of an orientation gives away.
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/linked_faces.hpp"

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/insertion/legality_sweep.dev.h"
#pragma GCC diagnostic pop

TEST(LegalitySweep, BoundaryThatTurnsBack) {
  const std::vector<cadt_point> points = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1, 5}, {0, 1}, {0, 2}, {0, 3}};
  cadt_locked_mesh mesh{};
  mesh.points = points.data();
  cadt_counters counters;
  cadt_counters_clear(&counters);
  const auto turns = [&](std::uint32_t p, std::uint32_t v, std::uint32_t q) {
    const std::uint32_t other = cadt_turns_back(&mesh, p, CADT_GHOST, v, q, &counters);
    EXPECT_EQ(cadt_turns_back(&mesh, p, v, CADT_GHOST, q, &counters), other);
    EXPECT_EQ(cadt_turns_back(&mesh, q, v, CADT_GHOST, p, &counters), other);
    return other == 1;
  };
  EXPECT_FALSE(turns(0, 1, 2));
  EXPECT_FALSE(turns(5, 6, 7));
  EXPECT_FALSE(turns(0, 3, 4));  // a corner
  EXPECT_TRUE(turns(0, 3, 2));
  EXPECT_TRUE(turns(0, 3, 1));
  EXPECT_TRUE(turns(1, 0, 2));
  EXPECT_TRUE(turns(6, 5, 7));
  EXPECT_EQ(cadt_turns_back(&mesh, 0, 2, 4, 1, &counters), 0u);  // no edge of the boundary
  EXPECT_EQ(cadt_turns_back(&mesh, CADT_GHOST, 0, 1, 2, &counters), 0u);
}

TEST(LegalitySweep, CountsIt) {
  const std::vector<cadt_point> points = {{0, 0}, {2, 0}, {1, 5}, {3, 0}, {4, 0}};
  const std::uint32_t g = CADT_GHOST;
  const auto pass = [&](const std::vector<cadt::test::Face>& faces) {
    auto records = cadt::test::linked_faces<cadt_locked_triangle>(faces, faces.size());
    std::vector<std::uint32_t> counts(CADT_DEFERRED_COUNTS + 5), edges(64), hints(5), counters(2048);
    const auto slots = static_cast<std::uint32_t>(records.size());
    cadt_legality_sweep(0, 1, records.data(), points.data(), hints.data(), nullptr, 0, 0, 0, 0, 0, CADT_STABILIZE_OFF,
                        0, 0.0, 0, slots, slots, 0, edges.data(), counts.data(), 64, counters.data());
    return std::vector<std::uint32_t>(counts.begin() + CADT_DEFERRED_COUNTS, counts.end());
  };
  // the boundary 0 1 3 4 2
  EXPECT_EQ(pass({{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {g, 1, 0}, {g, 3, 1}, {g, 4, 3}, {g, 2, 4}, {g, 0, 2}}),
            (std::vector<std::uint32_t>{12, 0, 0, 0, 0}));
  // the boundary 0 3 1 4 2: back from 3 to 1, and again to 4; a flat triangle, and no edge that is illegal
  EXPECT_EQ(pass({{0, 1, 2}, {0, 3, 1}, {1, 4, 2}, {g, 3, 0}, {g, 1, 3}, {g, 4, 1}, {g, 2, 4}, {g, 0, 2}}),
            (std::vector<std::uint32_t>{12, 0, 0, 0, 2}));
}

}  // namespace
