// SPDX-License-Identifier: Apache-2.0
// Long flip cascades, each flip made necessary by the one before, are replaced by one retriangulation
// (common/insertion/cavity_retriangulation.hpp).
#include "common/driver/device_text.hpp"
#include "common/driver/registry.hpp"
#include "common/insertion/insertion.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/linked_faces.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace cadt::test {
namespace {

using namespace device_text;
class CavityRetriangulation : public BackendTest {};

// Points of half a parabola, whose mesh is a fan of the first one. Three others have parts of the fan, each of which
// takes a flip cascade from its end.
TEST_P(CavityRetriangulation, FansOfWrongHubs) {
  constexpr std::uint32_t part = 100000, n = 3 * part + 10;
  constexpr std::array<std::uint32_t, 3> hubs = {35, part + 7, 2 * part + 1};
  std::vector<double> points;
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto x = static_cast<double>(i);
    points.insert(points.end(), {x * 0x1p-19, x * x * 0x1p-38});
  }
  std::vector<Face> faces;
  std::uint32_t next = 1;
  for (const std::uint32_t hub : hubs) {
    const std::uint32_t end = hub / part * part + part;
    for (; next < hub; ++next) faces.push_back({0, next, next + 1});
    for (; next + 1 < end; ++next) faces.push_back({hub, next + 1, next + 2});
    faces.push_back({0, hub, end});
    ++next;
  }
  for (; next + 1 < n; ++next) faces.push_back({0, next, next + 1});
  ASSERT_EQ(faces.size(), n - 2);

  const Options options = GetParam().options();
  const auto device = open_device(options);
  Memory memory(*device, true);
  Statistics statistics;
  cadt::Context ctx(*device, memory, options, statistics);
  SortedPoints order;
  order.distinct = n;
  order.points = memory.allocate(points.size() * sizeof(double));
  device->write(*order.points, 0, points.data(), points.size() * sizeof(double));
  for (std::uint32_t v = 0; v < n; ++v) faces.push_back({CADT_GHOST, (v + 1) % n, v});
  auto triangles = linked_faces<cadt_locked_triangle>(faces, 2 * std::size_t{n});
  Allocation on_device = memory.allocate(triangles.size() * sizeof(cadt_locked_triangle));
  device->write(*on_device, 0, triangles.data(), triangles.size() * sizeof(cadt_locked_triangle));
  const LockedTriangles mesh = sweep_legality(ctx, order, std::move(on_device), 3 * std::uint64_t{n} - 3);

  EXPECT_EQ(statistics.certified_edges, 3 * std::uint64_t{n} - 3);
  EXPECT_LE(statistics.sweep_repairs, 20U);  // besides the cascades, what the floating-point filter does not decide
  EXPECT_GE(statistics.cavities, 1U);
  EXPECT_LT(ctx.launcher.launches(), 60U);  // 16384 flips a launch on processors, 16 on cards
  device->read(*mesh.triangles, 0, triangles.data(), triangles.size() * sizeof(cadt_locked_triangle));
  std::uint32_t around = 0;
  for (const cadt_locked_triangle& r : triangles)
    for (std::uint32_t k = 0; k < 3 && r.word[CADT_WORD_LOCK] != 0; ++k) around += r.word[k] == 0 ? 1 : 0;
  EXPECT_EQ(around, n);  // n - 2 triangles and two ghosts
}
CADT_ON_MAIN_BACKENDS(CavityRetriangulation);

}  // namespace
}  // namespace cadt::test
