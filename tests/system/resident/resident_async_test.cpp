// SPDX-License-Identifier: Apache-2.0
// Calls that do not keep the caller's thread, and results that are complete in the order of the caller's queue.
#include "tests/system/resident/resident.hpp"

#include <atomic>
#include <limits>
#include <thread>

namespace cadt::test {
namespace {

class ResidentAsync : public ResidentTest {};

TEST_P(ResidentAsync, SameMeshes) {
  const Known known(uniform_points(20000));
  Triangulator triangulator(options());
  const DevicePoints points = upload(known.xy);
  std::future<DeviceTriangulation> first = triangulator.triangulate_async(points);
  expect_same(*memory, first.get(), known.mesh);
  std::future<Triangulation> second = triangulator.triangulate_async(known.xy);
  expect_same(second.get(), known.mesh);
  const std::vector<std::size_t> offsets = {0, 20000};
  EXPECT_EQ(triangulator.triangulate_batch_async(points, offsets).get().download().triangulation(0).hash(),
            known.mesh.hash());
  EXPECT_EQ(triangulator.triangulate_batch_async(known.xy, offsets).get().triangulation(0).hash(), known.mesh.hash());
}

// The call returns while the work stands still.
TEST_P(ResidentAsync, DoesNotWait) {
  const Known known(uniform_points(5000));
  Options with = options();
  std::atomic<bool> go = false;
  const std::thread::id caller = std::this_thread::get_id();
  with.progress = [&](const Progress&) {
    EXPECT_NE(std::this_thread::get_id(), caller);
    go.wait(false);
  };
  Triangulator triangulator(with);
  std::future<DeviceTriangulation> future = triangulator.triangulate_async(upload(known.xy));
  EXPECT_EQ(future.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout);
  go = true;
  go.notify_all();
  expect_same(*memory, future.get(), known.mesh);
}

TEST_P(ResidentAsync, ErrorsAndCancel) {
  Points xy = uniform_points(5000);
  xy[2 * 17] = std::numeric_limits<double>::quiet_NaN();
  Options with = options();
  cadt::stop_source source;
  with.stop = source.get_token();
  Triangulator triangulator(with);
  std::future<DeviceTriangulation> bad = triangulator.triangulate_async(upload(xy));
  if (const auto error = thrown<InputError>([&] { (void)bad.get(); }); error != nullptr) {
    EXPECT_EQ(error->index(), 17U);
  }
  const Known known(uniform_points(3000));
  const DevicePoints points = upload(known.xy);
  expect_same(*memory, triangulator.triangulate_async(points).get(), known.mesh);
  source.request_stop();
  std::future<DeviceTriangulation> stopped = triangulator.triangulate_async(points);
  (void)thrown<Cancelled>([&] { (void)stopped.get(); });
}

// The triangulator may go before the call has ended.
TEST_P(ResidentAsync, OutlivesTheTriangulator) {
  const Known known(uniform_points(20000));
  std::future<DeviceTriangulation> future = Triangulator(options()).triangulate_async(upload(known.xy));
  expect_same(*memory, future.get(), known.mesh);
}

// Without statistics nobody waits for the last kernels: the arrays are right in the order of the queue, call after
// call.
TEST_P(ResidentAsync, CompleteInOrder) {
  const Known known(uniform_points(30000)), other(grid_points(90, 110));
  Options with = options();
  with.statistics = StatisticsDetail::none;
  Triangulator triangulator(with);
  const DevicePoints points = upload(known.xy), others = upload(other.xy);
  for (int call = 0; call < 10; ++call) {
    const DeviceTriangulation one = triangulator.triangulate(points), two = triangulator.triangulate(others);
    expect_same(*memory, one, known.mesh);
    expect_same(*memory, two, other.mesh);
    const DeviceTriangulation dropped = triangulator.triangulate(points);
  }
}

CADT_ON_MAIN_BACKENDS(ResidentAsync);

}  // namespace
}  // namespace cadt::test
