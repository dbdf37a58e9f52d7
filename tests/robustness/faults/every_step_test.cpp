// SPDX-License-Identifier: Apache-2.0
// Every allocation, launch, copy, fill and wait of every kind of call fails once, on every back end: a typed error,
// nothing stays allocated, and the same triangulator goes on. Then the device is lost at each of them.
#include "tests/robustness/faults/every_step.hpp"
#include "tests/system/finalization/tile_mesh.hpp"

#include <cadt/batch.hpp>
#include <cadt/uniform_cells.hpp>

#include "common/driver/registry.hpp"
#include "common/self_test/self_test.hpp"

namespace cadt::test {
namespace {

/// A few that fill and cross the limits of small sets: an empty one, one of equal points, one on a line.
struct Sets {
  Points xy;
  std::vector<std::size_t> offsets = {0};
  Sets() {
    for (const Points& set : {uniform_points(150, 1), Points{}, Points(20, 1.5), Points{0, 0, 1, 1, 3, 3},
                              hub_points(60), uniform_points(3, 2)}) {
      xy.insert(xy.end(), set.begin(), set.end());
      offsets.push_back(xy.size() / 2);
    }
  }
};

TEST_P(EveryStep, PointsOfTheHost) {
  const Points xy = some_points();
  const Call call = [&](Triangulator& t) { return outcome_of(t.triangulate(Reals(xy))); };
  for (const bool warm : {false, true}) fail_each(options(), call, warm);
}

TEST_P(EveryStep, PointsOfTheDevice) {
  const Points xy = some_points();
  const DevicePoints points = upload(xy);
  const Call call = [&](Triangulator& t) { return outcome_of(t.triangulate(points).download()); };
  Options with = options();
  with.order = Order::fast;
  with.tuning.strategy = Strategy::locks;
  fail_each(with, call);
}

TEST_P(EveryStep, Stars) {
  const Points xy = some_points();
  const Call call = [&](Triangulator& t) { return outcome_of(t.triangulate(Reals(xy))); };
  Options with = options();
  with.tuning.strategy = Strategy::stars;
  fail_each(with, call);
}

TEST_P(EveryStep, PointsOnALine) {
  Points xy;
  for (int i = 0; i < 300; ++i) xy.insert(xy.end(), {3.0 * (i % 290), 2.0 * (i % 290)});
  const Call call = [&](Triangulator& t) { return outcome_of(t.triangulate(Reals(xy))); };
  fail_each(options(), call);
}

TEST_P(EveryStep, Clocks) {
  const Points xy = some_points();
  const Call call = [&](Triangulator& t) {
    const Triangulation mesh = t.triangulate(Reals(xy));
    EXPECT_FALSE(mesh.statistics().kernels.empty());
    EXPECT_FALSE(mesh.statistics().milliseconds.empty());
    return outcome_of(mesh);
  };
  Options with = without_queue();
  with.tuning.kernel_times = true;
  with.statistics = StatisticsDetail::counters;
  fail_each(with, call);
}

TEST_P(EveryStep, Snapshots) {
  const Points xy = some_points();
  const Call call = [&](Triangulator& t) { return outcome_of(t.triangulate(Reals(xy))); };
  Options with = options();
  with.tuning.watch = [](const Snapshot&) {};
  with.tuning.stabilize = Stabilize::defer;
  fail_each(with, call);
}

TEST_P(EveryStep, SeveralSets) {
  const Sets sets;
  const DevicePoints points = upload(sets.xy);
  fail_each(options(), [&](Triangulator& t) { return outcome_of(t.triangulate_batch(Reals(sets.xy), sets.offsets)); });
  fail_each(options(),
            [&](Triangulator& t) { return outcome_of(t.triangulate_batch(points, sets.offsets).download()); });
}

TEST_P(EveryStep, Verification) {
  const Points xy = some_points();
  const DevicePoints points = upload(xy);
  const auto text = [](const VerifyReport& report) { return Outcome{report.summary(), 0}; };
  fail_each(options(), [&](Triangulator& t) {
    const DeviceTriangulation mesh = t.triangulate(points);
    return text(t.verify(points, mesh));
  });
}

/// Every question to a mesh, on the device and from the host.
TEST_P(EveryStep, Queries) {
  const Points xy = uniform_points(60, 3), where = uniform_points(20, 4);
  const std::vector<double> values(60, 1.5);
  const DevicePoints points = upload(xy), queries = upload(where);
  const DeviceArray heights{memory->upload(std::span<const double>(values)), values.size()};
  const std::vector<double> room(400);
  const DeviceArray numbers{memory->upload(std::span<const double>(room)), 800};
  const Box box{-1, -1, 2, 2};
  const Grid grid{0, 0, 0.1, 0.1, 10, 10};
  fail_each(options(), [&](Triangulator& t) {
    const DeviceTriangulation mesh = t.triangulate(points);
    MeshQueries asked(t, points, mesh);
    Outcome all;
    const auto add = [&](const auto& list) {
      for (const auto value : list) all.hash += std::to_string(value) + ' ';
    };
    (void)asked.locate(queries, numbers);
    add(memory->download<std::int32_t>(numbers.memory, 20));
    (void)asked.interpolate(heights, queries, {numbers.memory, 20}, Interpolation::natural, Outside::nearest);
    add(memory->download<double>(numbers.memory, 20));
    (void)t.triangulate(points, numbers, {});
    add(memory->download<std::int32_t>(numbers.memory, 60));
    return all;
  });
  const Triangulation mesh = on_host(Reals(xy));
  fail_each(options(), [&](Triangulator& t) {
    MeshQueries asked(Reals(xy), MeshView{mesh.triangles(), mesh.neighbors(), {}, {}}, t.options());
    Outcome all;
    const auto add = [&](const auto& list) {
      for (const auto value : list) all.hash += std::to_string(value) + ' ';
    };
    add(asked.locate_barycentric(where).barycentric);
    add(asked.nearest_vertices(where, 3));
    add(asked.interpolate(values, where));
    add(asked.rasterize(grid, values, Interpolation::linear, 0.3));
    add(asked.rasterize(grid, values, Interpolation::nearest, 0.3));
    add(asked.voronoi().cells);
    add(asked.voronoi_polygons(box).begin);
    add(asked.outline(0.2).edges);
    for (const Circle& circle : asked.largest_empty_circles(3)) add(std::vector{circle.triangle});
    return all;
  });
}

TEST_P(EveryStep, LeavesAndJoins) {
  const Points xy = some_points();
  TileOptions tiles;
  tiles.tile_points = 200;
  const UniformCells cells(300, 3);
  fail_each(options(), [&](Triangulator& t) {
    const auto made = t.allocate(600 * sizeof(double));
    cells.generate(t, 0, 300, {made.get(), 600});
    const FinishedNode whole = finish_leaf(t, DevicePoints{.x = made.get(), .size = 300}, {.first = 7}, {}, 0);
    return Outcome{hash_of(triangulate_by_tiles(t, xy, tiles).sums).to_string() + whole.part.hash().to_string(), 0};
  });
}

/// The memory of reserve() as well.
TEST_P(EveryStep, ReservedMemory) {
  const Points xy = some_points();
  const Call call = [&](Triangulator& t) {
    t.reserve(1000);
    return outcome_of(t.triangulate(Reals(xy)));
  };
  fail_each(options(), call);
}

/// What the self-tests of a device need when it is opened.
TEST_P(EveryStep, SelfTest) {
  const auto faults = std::make_shared<Faults>();
  const auto tests = [](Device& device) {
    run_selftest(device);
    run_lock_test(device);
  };
  {
    const auto device = faulty_device(open_device(without_queue()), faults);
    tests(*device);
    const std::size_t all = faults->count();
    EXPECT_GT(all, 7U);
    std::size_t thrown = 0;
    for (std::size_t s = 0; s < steps; ++s)
      for (std::size_t k = 0; k < all; ++k) {
        faults->fail(static_cast<Step>(s), k);
        try {
          tests(*device);
          EXPECT_EQ(faults->failed(), 0U);
        } catch (const OutOfMemory&) {
          ++thrown;
        } catch (const DeviceError&) {
          ++thrown;
        }
        EXPECT_EQ(faults->live_buffers(), 0U);
      }
    EXPECT_EQ(thrown, all);
    faults->clear();
    tests(*device);
  }
}

/// The device goes away at each step of a call, and stays away: one typed error a call, no more than a few steps are
/// tried after the first that failed, nothing is thrown or asked for by destructors. A device that is opened anew
/// works.
TEST_P(EveryStep, DeviceIsLost) {
  constexpr std::size_t few = 1;
  const Points xy = some_points();
  const DevicePoints points = upload(xy);
  const auto faults = std::make_shared<Faults>();
  const Injection injection(faults);
  const Call call = [&](Triangulator& t) { return outcome_of(t.triangulate(points).download()); };
  std::size_t count = 0;
  const std::string expected = [&] {
    Triangulator triangulator(options());
    const DeviceTriangulation before = triangulator.triangulate(points);
    faults->clear();
    const Outcome found = call(triangulator);
    count = faults->count();
    return found.hash;
  }();
  EXPECT_GT(count, 40U);
  // Each step on the host; opening other devices takes longer.
  const std::size_t stride = GetParam().backend == Backend::host ? 1 : 1 + count / 40;
  for (std::size_t k = 0; k < count && !HasFailure(); k += stride) {
    SCOPED_TRACE("step " + std::to_string(k) + " of " + std::to_string(count));
    {
      Triangulator triangulator(options());
      const DeviceTriangulation before = triangulator.triangulate(points);
      faults->lose(k);
      bool noticed = false;
      try {
        (void)call(triangulator);
      } catch (const DeviceError& error) {
        noticed = true;
        EXPECT_EQ(error.code(), injected_code);
      }
      EXPECT_EQ(noticed, faults->failed() != 0);
      // Conflicts between threads change the number of launches.
      EXPECT_TRUE(noticed || 4 * k >= 3 * count);
      EXPECT_LE(faults->failed(), few);
      for (int again = 0; noticed && again < 2; ++again) {
        const std::size_t failed = faults->failed();
        (void)thrown<DeviceError>([&] { (void)call(triangulator); });
        (void)thrown<DeviceError>([&] { (void)before.download(); });
        (void)thrown<DeviceError>([&] { (void)triangulator.verify(points, before); });
        EXPECT_LE(faults->failed() - failed, 3 * few);
      }
      triangulator.release_memory();
    }
    EXPECT_EQ(faults->live_buffers(), 0U);
    faults->clear();
    Triangulator fresh(options());
    EXPECT_EQ(call(fresh).hash, expected);
  }
  EXPECT_EQ(faults->live_buffers(), 0U);
}

TEST_P(EveryStep, Cancelled) {
  const Points xy = some_points();
  for (const Strategy strategy : {Strategy::locks, Strategy::stars}) {
    Options with = options();
    with.tuning.strategy = strategy;
    cancel_each(with, [&](Triangulator& t) { return outcome_of(t.triangulate(Reals(xy))); });
  }
}

CADT_ON_MAIN_BACKENDS(EveryStep);

}  // namespace
}  // namespace cadt::test
