// SPDX-License-Identifier: Apache-2.0
// How much device memory is taken, when, from whom, and what happens when there is none.
#include "tests/system/resident/resident_memory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cadt::test {
namespace {

TEST_P(ResidentMemory, BoundOfTheCaller) {
  const Known many(uniform_points(100000)), few(uniform_points(1000, 2));
  Triangulator triangulator(options());
  const DevicePoints points = upload(many.xy), fewer = upload(few.xy);
  constexpr std::size_t bound = 1'000'000;
  for (int round = 0; round < 2; ++round) {
    triangulator.options().max_memory = bound;
    if (const auto error = thrown<OutOfMemory>([&] { (void)triangulator.triangulate(points); }); error != nullptr) {
      EXPECT_GE(error->needed(), (triangulator.device().gpu ? 71 : 124) * many.size());
      EXPECT_EQ(error->available(), bound);
    }
    (void)thrown<OutOfMemory>([&] { (void)triangulator.triangulate(std::span<const double>(many.xy)); });
    (void)thrown<OutOfMemory>([&] { triangulator.reserve(many.size()); });
    const DeviceTriangulation small = triangulator.triangulate(fewer);
    expect_same(*memory, small, few.mesh);
    EXPECT_LE(small.statistics().bytes_device_peak, bound);
    triangulator.options().max_memory = 0;
    expect_same(*memory, triangulator.triangulate(points), many.mesh);
  }
}

/// With the input of 16 and the result of 48 bytes a point these are 101, and 87 where memory is saved.
TEST_P(ResidentMemory, LittleWithTheStarStage) {
  const Known known(uniform_points(200000, 9));
  const DevicePoints points = upload(known.xy);
  for (const Order order : {Order::canonical, Order::fast}) {
    for (const std::size_t each : {85, 71}) {
      SCOPED_TRACE(std::to_string(each) + " bytes a point");
      Options with = options();
      with.tuning.strategy = Strategy::stars;
      with.order = order;
      with.max_memory = each * known.size() + 131072;
      Triangulator triangulator(with);
      for (int call = 0; call < 2; ++call) {
        const DeviceTriangulation mesh = triangulator.triangulate(points);
        EXPECT_GT(mesh.statistics().proven_stars, known.size() * 9 / 10);
        EXPECT_LE(mesh.statistics().bytes_device_peak, with.max_memory);
        if (each == 85) {
          EXPECT_GT(mesh.statistics().bytes_device_peak, 80 * known.size()) << "memory is saved without need";
        }
        const Triangulation copy = mesh.download();
        EXPECT_EQ(copy.hash(), known.mesh.hash());
        if (order == Order::canonical) expect_same(copy, known.mesh);
      }
      triangulator.options().max_memory = 71 * known.size();
      EXPECT_NE(thrown<OutOfMemory>([&] { (void)triangulator.triangulate(points); }), nullptr);
      triangulator.options().max_memory = 83 * known.size() + 131072;  // with the input of the host's
      const Triangulation mesh = triangulator.triangulate(std::span<const double>(known.xy));
      EXPECT_LE(mesh.statistics().bytes_device_peak, triangulator.options().max_memory);
      EXPECT_EQ(mesh.hash(), known.mesh.hash());
    }
  }
}

/// With the input of 8 and the result of 48 bytes a point these are less than 80, whatever the layout.
TEST_P(ResidentMemory, LittleWithFloats) {
  const Points xy = uniform_points(200000, 10);
  const std::vector<float> single(xy.begin(), xy.end());
  const Known known(Points(single.begin(), single.end()));
  std::vector<float> x, y;
  for (std::size_t i = 0; i < single.size(); i += 2) x.push_back(single[i]), y.push_back(single[i + 1]);
  const void* together = memory->upload(std::span<const float>(single));
  const void *x_alone = memory->upload(std::span<const float>(x)), *y_alone = memory->upload(std::span<const float>(y));
  for (const Order order : {Order::canonical, Order::fast}) {
    for (const bool apart : {false, true}) {
      for (const bool bounded : {false, true}) {
        SCOPED_TRACE(std::string(apart ? "coordinates apart" : "interleaved") + (bounded ? ", bounded" : ""));
        Options with = options();
        with.tuning.strategy = Strategy::stars;
        with.order = order;
        if (bounded)
          with.max_memory = 71 * known.size() + 131072;
        else
          with.allocator = counting();  // nothing is cached, so the peak is what the call needs
        Triangulator triangulator(with);
        const DevicePoints points{.x = apart ? x_alone : together,
                                  .y = apart ? y_alone : nullptr,
                                  .size = known.size(),
                                  .scalar = Scalar::float32};
        const DeviceTriangulation mesh = triangulator.triangulate(points);
        EXPECT_GT(mesh.statistics().proven_stars, known.size() * 9 / 10);
        EXPECT_LE(mesh.statistics().bytes_device_peak, 72 * known.size());
        const Triangulation copy = mesh.download();
        EXPECT_EQ(copy.hash(), known.mesh.hash());
        if (order == Order::canonical) expect_same(copy, known.mesh);
      }
    }
  }
}

/// Points that are gathered once more from floats, from coordinates apart or from doubles are those of before, in any
/// range: the certification of a lattice, all of whose circles are ties, finds nothing.
TEST_P(ResidentMemory, GatheredAgain) {
  for (const int exponent : {-500, -100, 100, 500}) {
    std::vector<double> x, y;
    for (const double p : grid_points(150, 150)) (x.size() == y.size() ? x : y).push_back(std::ldexp(p, exponent));
    Points xy;
    for (std::size_t i = 0; i < x.size(); ++i) xy.insert(xy.end(), {x[i], y[i]});
    const bool has_floats = std::abs(exponent) <= 100;
    const std::vector<float> single(xy.begin(), has_floats ? xy.end() : xy.begin() + 2);
    const Known known(xy);
    Options with = options();
    with.tuning.strategy = Strategy::stars;
    Triangulator triangulator(with);
    const DevicePoints floats{
        .x = memory->upload(std::span<const float>(single)), .size = known.size(), .scalar = Scalar::float32};
    const DevicePoints apart{.x = memory->upload(std::span<const double>(x)),
                             .y = memory->upload(std::span<const double>(y)),
                             .size = known.size()};
    for (const DevicePoints& points : {floats, apart, upload(xy)}) {
      if (points.scalar == Scalar::float32 && !has_floats) continue;
      const DeviceTriangulation mesh = triangulator.triangulate(points);
      EXPECT_GT(mesh.statistics().proven_stars, known.size() / 2);
      expect_same(mesh.download(), known.mesh);
    }
  }
}

/// Vertices of triangles take the place of stars where that is free. Here it is not: of columns on both sides of the
/// middle, the closer the nearer to it, the left half comes first, and the triangles between the halves belong to it
/// too.
TEST_P(ResidentMemory, StarsThatMustStay) {
  Points xy;
  double away = 0, step = 1.0 / 16000;
  for (int column = 0; step < 0.05; ++column) {
    const auto count = static_cast<std::size_t>(1 / step);
    const Points shift = uniform_points(2 * count, static_cast<std::uint64_t>(column));
    for (std::size_t i = 0; i < 2 * count; ++i) {
      const double x = away + step * (0.25 + 0.5 * shift[2 * i]);
      xy.push_back(i < count ? 0.5 - x : 0.5 + x);
      xy.push_back(step * (static_cast<double>(i % count) + 0.25 + 0.5 * shift[2 * i + 1]));
    }
    away += step;
    step *= 1.2;
  }
  xy.insert(xy.end(), {0, 0, 1, 1});
  const std::vector<float> single(xy.begin(), xy.end());
  const Known known(Points(single.begin(), single.end()));
  Options with = options();
  with.tuning.strategy = Strategy::stars;
  Triangulator triangulator(with);
  const DeviceTriangulation mesh = triangulator.triangulate(DevicePoints{
      .x = memory->upload(std::span<const float>(single)), .size = known.size(), .scalar = Scalar::float32});
  EXPECT_GT(mesh.statistics().proven_stars, known.size() * 4 / 5);
  expect_same(mesh.download(), known.mesh);
}

/// So many bytes a point are enough, whatever is cached, and a call under that bound stays within it.
TEST_P(ResidentMemory, BoundOfWhatIsNeeded) {
  const Known known(uniform_points(50000)), few(uniform_points(7000, 2));
  const DevicePoints points = upload(known.xy), fewer = upload(few.xy);
  for (const Order order : {Order::canonical, Order::fast}) {
    Triangulator triangulator(options());
    const bool stars = triangulator.device().gpu;
    const std::size_t bound = stars ? 101 * known.size() + 131072 : 124 * known.size() + 65536;
    const std::size_t least = stars ? 71 * known.size() + 131072 : bound;  // of points on the device
    EXPECT_GE(triangulator.memory_needed(known.size()), bound);
    triangulator.options().order = order;
    triangulator.options().max_memory = least - 1;
    (void)thrown<OutOfMemory>([&] { (void)triangulator.triangulate(points); });
    triangulator.options().max_memory = bound;
    for (int call = 0; call < 4; ++call) {
      {
        const DeviceTriangulation mesh = triangulator.triangulate(points);
        EXPECT_LE(mesh.statistics().bytes_device_peak, bound) << call;
        EXPECT_EQ(mesh.number_of_triangles(), known.mesh.number_of_triangles());
      }
      if (call % 2 == 0) {
        EXPECT_EQ(triangulator.triangulate(fewer).download().hash(), few.mesh.hash());
      }
    }
    triangulator.reserve(known.size());
    EXPECT_EQ(triangulator.triangulate(points).number_of_triangles(), known.mesh.number_of_triangles());
    EXPECT_EQ(triangulator.triangulate(std::span<const double>(known.xy)).hash(), known.mesh.hash());
    triangulator.options().max_memory = triangulator.memory_needed(known.size());
    triangulator.reserve(known.size());
    EXPECT_EQ(triangulator.triangulate(points).number_of_triangles(), known.mesh.number_of_triangles());
  }
}

TEST_P(ResidentMemory, PeakIsWithinWhatIsNeeded) {
  for (const std::size_t n : {1000, 3000, 10000, 30000, 100000, 300000}) {
    const Points xy = uniform_points(n, n);
    const DevicePoints points = upload(xy);
    for (const Order order : {Order::canonical, Order::fast}) {
      Options with = options();
      with.order = order;
      Triangulator on_device(with), from_host(with);
      const std::size_t needed = on_device.memory_needed(n);
      const auto a_point = [&](std::size_t bytes) { return static_cast<double>(bytes) / static_cast<double>(n); };
      for (int call = 0; call < 2; ++call) {
        const DeviceTriangulation mesh = on_device.triangulate(points);
        EXPECT_LE(mesh.statistics().bytes_device_peak, needed)
            << n << " points, call " << call << ": " << a_point(mesh.statistics().bytes_device_peak) << " a point";
        EXPECT_GT(mesh.statistics().bytes_device_peak, n * 48);
        const Triangulation copy = from_host.triangulate(std::span<const double>(xy));
        EXPECT_LE(copy.statistics().bytes_device_peak, needed)
            << n << " points, call " << call << ": " << a_point(copy.statistics().bytes_device_peak) << " a point";
      }
    }
  }
}

/// With an allocator the memory is the caller's: nothing is cached.
TEST_P(ResidentMemory, NothingOfTheAllocatorIsCached) {
  const Known known(uniform_points(20000));
  const auto allocator = counting();
  Options with = options();
  with.allocator = allocator;
  Triangulator triangulator(with);
  triangulator.reserve(known.size());
  EXPECT_EQ(allocator->live(), 0U);
  for (int call = 0; call < 2; ++call) {
    const DeviceTriangulation mesh = triangulator.triangulate(upload(known.xy));
    EXPECT_EQ(allocator->live(), 2U);
    EXPECT_EQ(allocator->bytes_live, 2 * 3 * sizeof(std::int32_t) * known.mesh.number_of_triangles());
    EXPECT_LE(mesh.statistics().bytes_device_peak, 124 * known.size() + 65536);
  }
  EXPECT_EQ(allocator->live(), 0U);
}

TEST_P(ResidentMemory, ReleasedMemory) {
  const Known known(uniform_points(30000));
  const DevicePoints points = upload(known.xy);
  const auto allocator = counting();
  {
    Options with = options();
    with.allocator = allocator;
    Triangulator triangulator(with);
    triangulator.release_memory();
    DeviceTriangulation mesh = triangulator.triangulate(points);
    triangulator.release_memory();
    const std::size_t of_the_result = 2 * 3 * sizeof(std::int32_t) * mesh.number_of_triangles();
    EXPECT_EQ(allocator->bytes_live, of_the_result);
    expect_same(*memory, mesh, known.mesh);
    mesh = DeviceTriangulation();
    triangulator.release_memory();
    EXPECT_EQ(allocator->live(), 0U);
    triangulator.reserve(known.size());
    triangulator.release_memory();
    EXPECT_EQ(allocator->live(), 0U);
    expect_same(*memory, triangulator.triangulate(points), known.mesh);
  }
  EXPECT_EQ(allocator->live(), 0U);
  EXPECT_EQ(allocator->fault, "");
  Triangulator own(options());
  expect_same(*memory, own.triangulate(points), known.mesh);
  own.release_memory();
  expect_same(*memory, own.triangulate(points), known.mesh);
}

TEST_P(ResidentMemory, AllocatorGetsEverythingBack) {
  const Known known(set_of_all_kinds());
  const auto allocator = counting();
  DeviceTriangulation result, second;
  {
    Options with = options();
    with.allocator = allocator;
    Triangulator triangulator(with);
    result = triangulator.triangulate(upload(known.xy));
    second = triangulator.triangulate(upload(known.xy));
    expect_same(triangulator.triangulate(std::span<const double>(known.xy)), known.mesh);
    EXPECT_TRUE(triangulator.verify(upload(known.xy), second).ok);
  }
  EXPECT_GT(allocator->calls, 20U);
  EXPECT_GT(allocator->live(), 0U);
  expect_same(*memory, result, known.mesh);
  result = DeviceTriangulation();
  expect_same(*memory, second, known.mesh);
  second = DeviceTriangulation();
  EXPECT_EQ(allocator->live(), 0U);
  EXPECT_EQ(allocator->fault, "");
}

/// The k-th request is refused, with and without the ones after it, for every k.
TEST_P(ResidentMemory, EveryRequestMayBeRefused) {
  const Known known(set_of_all_kinds());
  const DevicePoints points = upload(known.xy);
  for (const bool and_later : {true, false}) {
    std::size_t k = 0, failed = 0;
    for (bool done = false; !done && k < 1000; ++k) {
      SCOPED_TRACE("request " + std::to_string(k) + (and_later ? " and all later ones" : ""));
      const auto allocator = counting();
      {
        Options with = options();
        with.allocator = allocator;
        Triangulator triangulator(with);
        const std::size_t at_first = allocator->live();
        allocator->fail_at(k, and_later);
        try {
          expect_same(*memory, triangulator.triangulate(points), known.mesh);
          done = allocator->refused == 0;
          EXPECT_EQ(allocator->refused, 0U);
        } catch (const OutOfMemory& error) {
          ++failed;
          EXPECT_GT(error.needed(), 0U);
        }
        allocator->fail_at(CountingAllocator::never);
        triangulator.release_memory();
        EXPECT_EQ(allocator->live(), at_first);
        expect_same(*memory, triangulator.triangulate(points), known.mesh);
      }
      EXPECT_EQ(allocator->live(), 0U);
      EXPECT_EQ(allocator->fault, "");
      if (HasFailure()) return;
    }
    EXPECT_GT(failed, 20U);
  }
}

/// The same for the other calls that take memory.
TEST_P(ResidentMemory, EveryRequestOfOtherCallsMayBeRefused) {
  const Known known(set_of_all_kinds());
  const DevicePoints points = upload(known.xy);
  const auto allocator = counting();
  {
    Options with = options();
    with.allocator = allocator;
    Triangulator triangulator(with);
    const DeviceTriangulation mesh = triangulator.triangulate(points);
    const auto refuse = [&](const char* what, const auto& call) {
      for (std::size_t k = 0; k < 1000; ++k) {
        SCOPED_TRACE(std::string(what) + ", request " + std::to_string(k));
        triangulator.release_memory();
        const std::size_t before = allocator->live();
        allocator->fail_at(k);
        bool failed = false;
        try {
          call();
        } catch (const OutOfMemory&) {
          failed = true;
        }
        EXPECT_EQ(failed, allocator->refused != 0);
        allocator->fail_at(CountingAllocator::never);
        triangulator.release_memory();
        EXPECT_EQ(allocator->live(), before);
        if (!failed || HasFailure()) return;
      }
    };
    refuse("reserve", [&] { triangulator.reserve(10 * known.size()); });
    refuse("download", [&] { expect_same(mesh.download(), known.mesh); });
    refuse("verify", [&] { EXPECT_TRUE(triangulator.verify(points, mesh).ok); });
    refuse("host", [&] { expect_same(triangulator.triangulate(std::span<const double>(known.xy)), known.mesh); });
    expect_same(*memory, mesh, known.mesh);
    expect_same(*memory, triangulator.triangulate(points), known.mesh);
  }
  EXPECT_EQ(allocator->live(), 0U);
  EXPECT_EQ(allocator->fault, "");
}

/// Memory that the self-test of a new triangulator does not get.
TEST_P(ResidentMemory, RefusedWhenOpened) {
  const Known known(uniform_points(500));
  for (std::size_t k = 0; k < 10; ++k) {
    const auto allocator = counting();
    Options with = options();
    with.allocator = allocator;
    allocator->fail_at(k);
    try {
      const Triangulator triangulator(with);
    } catch (const OutOfMemory&) {
    }
    EXPECT_EQ(allocator->live(), 0U);
    allocator->fail_at(CountingAllocator::never);
    Triangulator triangulator(with);
    expect_same(*memory, triangulator.triangulate(upload(known.xy)), known.mesh);
    EXPECT_EQ(allocator->fault, "");
  }
}

CADT_ON_MAIN_BACKENDS(ResidentMemory);

}  // namespace
}  // namespace cadt::test
