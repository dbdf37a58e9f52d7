// SPDX-License-Identifier: Apache-2.0
// Who may outlive whom, and several triangulators at a time.
#include "tests/support/portable.hpp"
#include "tests/system/resident/resident.hpp"

#include <numeric>
#include <optional>
#include <thread>
#include <utility>

namespace cadt::test {
namespace {

class ResidentLifetime : public ResidentTest {
 protected:
  const Known first{uniform_points(4000)}, second{grid_points(50, 40)};
};

TEST_P(ResidentLifetime, ResultOutlivesTheTriangulator) {
  std::optional<Triangulator> triangulator(options());
  const DeviceTriangulation mesh = triangulator->triangulate(upload(first.xy));
  triangulator.reset();
  expect_same(*memory, mesh, first.mesh);
}

/// Points in a device's memory need the caller's queue; those of the host do not.
using LifetimeOnTheHost = ResidentLifetime;

TEST_P(LifetimeOnTheHost, ResultOutlivesATriangulatorWithoutQueue) {
  DeviceTriangulation mesh;
  {
    Options own = options();
    own.queue.reset();
    mesh = Triangulator(own).triangulate(upload(first.xy));
  }
  expect_same(*memory, mesh, first.mesh);
}

/// Of Triangulator::allocate, for results of queries.
TEST_P(ResidentLifetime, MemoryOutlivesTheTriangulator) {
  std::optional<Triangulator> triangulator(options());
  EXPECT_EQ(triangulator->allocate(0), nullptr);
  const DevicePoints points = upload(first.xy);
  const DeviceTriangulation mesh = triangulator->triangulate(points);
  const std::size_t words = first.size();
  const std::shared_ptr<void> found = triangulator->allocate(4 * words), other = triangulator->allocate(4 * words);
  EXPECT_NE(found.get(), other.get());
  {
    MeshQueries queries(*triangulator, points, mesh);
    EXPECT_EQ(queries.nearest_vertices(points, 1, {found.get(), words}), words);
    EXPECT_EQ(queries.nearest_vertices(points, 1, {other.get(), words}), words);
  }
  std::vector<std::int32_t> themselves(words);
  std::iota(themselves.begin(), themselves.end(), 0);
  EXPECT_EQ(memory->download<std::int32_t>(found.get(), words), themselves);
  triangulator->options().max_memory = 1;
  EXPECT_THROW(static_cast<void>(triangulator->triangulate(points)), OutOfMemory);
  EXPECT_THROW(static_cast<void>(triangulator->allocate(4 * words)), OutOfMemory);
  triangulator.reset();
  EXPECT_EQ(memory->download<std::int32_t>(other.get(), words), themselves);
}

TEST_P(ResidentLifetime, TwoResultsAtATime) {
  Triangulator triangulator(options());
  const DeviceTriangulation a = triangulator.triangulate(upload(first.xy));
  const DeviceTriangulation b = triangulator.triangulate(upload(second.xy));
  const DeviceTriangulation c = triangulator.triangulate(upload(first.xy));
  EXPECT_NE(a.triangles(), c.triangles());
  expect_same(*memory, a, first.mesh);
  expect_same(*memory, b, second.mesh);
  expect_same(*memory, c, first.mesh);
  triangulator.release_memory();
  expect_same(*memory, a, first.mesh);
}

TEST_P(ResidentLifetime, MovedObjects) {
  Triangulator triangulator(options());
  DeviceTriangulation mesh = triangulator.triangulate(upload(first.xy));
  void* const handle = mesh.triangles();
  DeviceTriangulation moved(std::move(mesh));
  EXPECT_EQ(moved.triangles(), handle);
  expect_same(*memory, moved, first.mesh);
  mesh = triangulator.triangulate(upload(second.xy));  // what was moved from can be assigned to
  expect_same(*memory, mesh, second.mesh);
  mesh = std::move(moved);
  expect_same(*memory, mesh, first.mesh);
  Triangulator other(std::move(triangulator));
  expect_same(*memory, other.triangulate(upload(second.xy)), second.mesh);
  triangulator = Triangulator(options());
  expect_same(*memory, triangulator.triangulate(upload(second.xy)), second.mesh);
  triangulator = std::move(other);
  expect_same(*memory, triangulator.triangulate(upload(first.xy)), first.mesh);
  expect_same(*memory, mesh, first.mesh);
}

TEST_P(ResidentLifetime, TwoTriangulatorsInOneThread) {
  Triangulator a(options()), b(options());
  const DevicePoints points = upload(first.xy), others = upload(second.xy);
  EXPECT_EQ(a.device().name, b.device().name);
  for (int round = 0; round < 3; ++round) {
    const DeviceTriangulation x = a.triangulate(points), y = b.triangulate(others);
    expect_same(*memory, x, first.mesh);
    expect_same(*memory, y, second.mesh);
  }
}

TEST_P(ResidentLifetime, FourThreads) {
  constexpr int threads = 4, calls = 10;
  std::vector<JoinedThread> all;
  for (int t = 0; t < threads; ++t)
    all.emplace_back([&, t] {
      const auto mine = device_memory(GetParam().backend, device_index(GetParam().backend));
      Options with = options();
      if (with.queue) with.queue = mine->queue();
      Triangulator triangulator(with);
      for (int call = 0; call < calls; ++call) {
        const Known& known = (call + t) % 2 == 0 ? first : second;
        const void* handle = mine->upload(std::span<const double>(known.xy));
        const DeviceTriangulation mesh = triangulator.triangulate(DevicePoints{.x = handle, .size = known.size()});
        expect_same(*mine, mesh, known.mesh);
        if (call % 4 == 3) expect_same(triangulator.triangulate(std::span<const double>(known.xy)), known.mesh);
        if (call % 4 == 1) triangulator.release_memory();
      }
    });
}

/// The same with queues of the library's own, which share a context.
TEST_P(ResidentLifetime, FourThreadsWithoutQueues) {
  std::vector<JoinedThread> all;
  for (int t = 0; t < 4; ++t)
    all.emplace_back([&, t] {
      Options with = options();
      with.queue.reset();
      Triangulator triangulator(with);
      for (int call = 0; call < 10; ++call) {
        const Known& known = (call + t) % 2 == 0 ? first : second;
        expect_same(triangulator.triangulate(std::span<const double>(known.xy)), known.mesh);
      }
    });
}

CADT_ON_MAIN_BACKENDS(ResidentLifetime);
CADT_ON(host, LifetimeOnTheHost, main_host_case);

}  // namespace
}  // namespace cadt::test
