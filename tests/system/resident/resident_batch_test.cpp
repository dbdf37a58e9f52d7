// SPDX-License-Identifier: Apache-2.0
// Sets of points in device memory to meshes in device memory.
#include "tests/system/resident/resident.hpp"

#include <algorithm>

namespace cadt::test {
namespace {

struct Sets {
  Points xy;
  std::vector<std::size_t> offsets = {0};
  std::vector<Points> each;
  void add(const Points& set) {
    xy.insert(xy.end(), set.begin(), set.end());
    offsets.push_back(xy.size() / 2);
    each.push_back(set);
  }
};

/// Small ones, one without points, one of equal points, one too large to go with others.
Sets some_sets() {
  Sets sets;
  for (std::size_t s = 0; s < 20; ++s) sets.add(uniform_points(100 + 13 * s, s));
  sets.add({});
  sets.add(Points(60, 1.5));
  sets.add(uniform_points(40000, 99));
  Points twice = uniform_points(200, 3);
  const Points again = twice;
  twice.insert(twice.end(), again.begin(), again.end());
  sets.add(twice);
  return sets;
}

class ResidentBatch : public ResidentTest {
 protected:
  void expect_sets(const DeviceTriangulationBatch& found, const Sets& sets) {
    ASSERT_EQ(found.size(), sets.each.size());
    const auto offsets = found.triangle_offsets();
    const auto on_device = memory->download<std::uint32_t>(found.device_triangle_offsets(), offsets.size());
    EXPECT_TRUE(std::ranges::equal(on_device, offsets));
    const auto triangles = memory->download<std::int32_t>(found.triangles(), 3 * offsets.back());
    const auto neighbors = memory->download<std::int32_t>(found.neighbors(), 3 * offsets.back());
    const TriangulationBatch copy = found.download();
    EXPECT_TRUE(std::ranges::equal(copy.triangles(), triangles));
    EXPECT_TRUE(std::ranges::equal(copy.neighbors(), neighbors));
    for (std::size_t s = 0; s < sets.each.size() && !HasFailure(); ++s) {
      SCOPED_TRACE(s);
      expect_same(copy.triangulation(s), on_host(std::span<const double>(sets.each[s])));
      EXPECT_EQ(found.dimension(s), copy.dimension(s));
      EXPECT_TRUE(std::ranges::equal(found.duplicates(s), copy.duplicates(s)));
    }
  }
};

TEST_P(ResidentBatch, EveryKindOfSet) {
  const Sets sets = some_sets();
  Triangulator triangulator(options());
  for (int call = 0; call < 2; ++call) expect_sets(triangulator.triangulate_batch(upload(sets.xy), sets.offsets), sets);
}

// Behind other points, as floats, x and y apart.
TEST_P(ResidentBatch, PointsInOtherForms) {
  Sets sets;
  std::vector<float> x(7, 0), y(7, 0);
  for (std::size_t s = 0; s < 10; ++s) {
    Points set = uniform_points(300, s);
    for (double& value : set) value = static_cast<double>(static_cast<float>(value));
    sets.add(set);
  }
  for (std::size_t i = 0; i < sets.xy.size(); i += 2) {
    x.push_back(static_cast<float>(sets.xy[i]));
    y.push_back(static_cast<float>(sets.xy[i + 1]));
  }
  Triangulator triangulator(options());
  const DevicePoints points{.x = memory->upload(std::span<const float>(x)),
                            .y = memory->upload(std::span<const float>(y)),
                            .size = sets.offsets.back(),
                            .scalar = Scalar::float32,
                            .skip = 7};
  expect_sets(triangulator.triangulate_batch(points, sets.offsets), sets);
}

TEST_P(ResidentBatch, WithoutTriangles) {
  Sets sets;
  for (int s = 0; s < 3; ++s) sets.add({});
  Triangulator triangulator(options());
  expect_sets(triangulator.triangulate_batch(DevicePoints{}, sets.offsets), sets);
  sets.add({1, 2});
  sets.add({1, 2, 3, 4});
  sets.add({1, 1, 2, 2, 3, 3, 4, 4});
  const DeviceTriangulationBatch found = triangulator.triangulate_batch(upload(sets.xy), sets.offsets);
  expect_sets(found, sets);
  EXPECT_EQ(found.triangles(), nullptr);
  EXPECT_EQ(found.neighbors(), nullptr);
}

// Every allocation of the caller's fails once: nothing is lost, and the triangulator goes on.
TEST_P(ResidentBatch, AllocationsFail) {
  Sets sets;
  for (std::size_t s = 0; s < 5; ++s) sets.add(uniform_points(100, s));
  sets.add(grid_points(9, 9));
  Options with = options();
  const auto allocator = counting();
  with.allocator = allocator;
  Triangulator triangulator(with);
  const DevicePoints points = upload(sets.xy);
  { const auto result = triangulator.triangulate_batch(points, sets.offsets); }
  const std::size_t calls = allocator->calls;
  ASSERT_GT(calls, 10U);
  EXPECT_EQ(allocator->live(), 0U);
  for (std::size_t k = 0; k < calls / 2; ++k) {
    allocator->fail_at(k);
    EXPECT_THROW((void)triangulator.triangulate_batch(points, sets.offsets), OutOfMemory) << k;
    EXPECT_EQ(allocator->live(), 0U) << k;
  }
  allocator->fail_at(CountingAllocator::never);
  expect_sets(triangulator.triangulate_batch(points, sets.offsets), sets);
  EXPECT_EQ(allocator->fault, "");
}

CADT_ON_MAIN_BACKENDS(ResidentBatch);

}  // namespace
}  // namespace cadt::test
