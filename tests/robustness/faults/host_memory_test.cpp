// SPDX-License-Identifier: Apache-2.0
// The host's own memory gives out: every request of the calling thread is refused in turn. Only on the host's back end:
// runtimes of devices, and the compilers in them, are not made for it. Requests are also the moments at which a call is
// stopped while no device works.
#include <cadt/cadt.hpp>
#include <cadt/constrained.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "common/c_interface/convert.hpp"
#include "tests/support/families.hpp"

namespace {

constexpr std::size_t never = ~std::size_t{0};
thread_local std::size_t until_refusal = never;
thread_local std::size_t asked = 0, refused = 0;
thread_local std::size_t until_stop = never;
thread_local cadt::stop_source* to_stop = nullptr;
std::atomic<long> live{0};

void* give(std::size_t size, std::size_t alignment) {
  ++asked;
  if (until_refusal != never && until_refusal-- == 0) {
    until_refusal = never;
    ++refused;
    throw std::bad_alloc();
  }
  if (until_stop != never && until_stop-- == 0) {
    until_stop = never;
    to_stop->request_stop();
  }
  void* memory = alignment <= alignof(std::max_align_t)
                     ? std::malloc(size == 0 ? 1 : size)
                     : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  live.fetch_add(1, std::memory_order_relaxed);
  return memory;
}

void take_back(void* memory) noexcept {
  if (memory == nullptr) return;
  live.fetch_sub(1, std::memory_order_relaxed);
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return give(size, 1); }
void* operator new[](std::size_t size) { return give(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return give(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return give(size, static_cast<std::size_t>(alignment));
}
// With a sanitizer these are its own, whose memory it wants back by its own operator.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return give(size, 1);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return operator new(size, std::nothrow); }
void operator delete(void* memory) noexcept { take_back(memory); }
void operator delete[](void* memory) noexcept { take_back(memory); }
void operator delete(void* memory, std::size_t) noexcept { take_back(memory); }
void operator delete[](void* memory, std::size_t) noexcept { take_back(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { take_back(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { take_back(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { take_back(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { take_back(memory); }

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

Options on_host() {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  return options;
}

Points some_points() {
  Points xy = uniform_points(400, 3);
  const Points lattice = grid_points(9, 9);
  xy.insert(xy.end(), lattice.begin(), lattice.end());
  for (std::size_t i = 0; i < 40; ++i) xy.push_back(xy[i]);
  return xy;
}

/// Refuses the k-th request of `call` for every k; `call` returns what must be the same each time.
void refuse_each(const std::function<std::string()>& call) {
  const std::string expected = call();
  ASSERT_EQ(call(), expected);
  asked = 0;
  ASSERT_EQ(call(), expected);
  const std::size_t all = asked;
  EXPECT_GT(all, 5U);
  long before = 0;  // within the loop: GoogleTest takes memory for its trace
  std::size_t thrown = 0;
  for (std::size_t k = 0; k < all && !testing::Test::HasFailure(); ++k) {
    SCOPED_TRACE("request " + std::to_string(k) + " of " + std::to_string(all));
    const long at_first = live;
    if (k == 0) before = live;
    refused = 0;
    until_refusal = k;
    try {
      const bool same = call() == expected;  // the library may do without
      until_refusal = never;
      EXPECT_TRUE(same);
    } catch (const std::bad_alloc&) {
      ++thrown;
    } catch (const OutOfMemory&) {
      ++thrown;
    }
    until_refusal = never;
    EXPECT_EQ(refused, 1U);
    EXPECT_LE(live, at_first + 1);  // a list that is cached
    EXPECT_EQ(call(), expected);
    EXPECT_LE(live, before + 1);
  }
  EXPECT_GT(4 * thrown, 3 * all);
}

TEST(HostMemory, OneCall) {
  const Points xy = some_points();
  refuse_each([&] { return triangulate(Reals(xy), on_host()).hash().to_string(); });
}

/// Lists that a triangulator keeps grow in its first call.
TEST(HostMemory, NewTriangulator) {
  const Points xy = some_points();
  refuse_each([&] {
    cadt::Triangulator triangulator(on_host());
    return triangulator.triangulate(Reals(xy)).hash().to_string();
  });
}

TEST(HostMemory, Triangulator) {
  const Points xy = some_points();
  Triangulator triangulator(on_host());
  refuse_each([&] { return triangulator.triangulate(Reals(xy)).hash().to_string(); });
  const DevicePoints points{.x = xy.data(), .size = xy.size() / 2};
  refuse_each([&] { return triangulator.triangulate(points).download().hash().to_string(); });
  refuse_each([&] {
    const DeviceTriangulation mesh = triangulator.triangulate(points);
    return triangulator.verify(points, mesh).summary();
  });
  triangulator.options().tuning.strategy = Strategy::stars;
  refuse_each([&] { return triangulator.triangulate(Reals(xy)).hash().to_string(); });
}

TEST(HostMemory, Segments) {
  const Points xy = some_points();
  const std::vector<Segment> segments = {{0, 7}, {400, 480}, {408, 440}, {408, 440}};
  Triangulator triangulator(on_host());
  ConstraintOptions constraints;
  for (const Domain domain : {Domain::hull, Domain::layers, Domain::seeds}) {
    constraints.domain = domain;
    refuse_each([&] {
      const ConstrainedTriangulation mesh = triangulator.triangulate_constrained(Reals(xy), segments, constraints);
      return mesh.hash().to_string() + std::to_string(mesh.constrained_edges().size());
    });
  }
  const ConstrainedTriangulation mesh = triangulator.triangulate_constrained(Reals(xy), segments, constraints);
  VerifyOptions alone;
  alone.threads = 1;
  refuse_each([&] { return verify(Reals(xy), segments, mesh, constraints, alone).summary(); });
  constraints.crossing = Crossing::exact;
  std::vector<Segment> crossed = segments;
  crossed.push_back({1, 2});
  crossed.push_back({3, 4});
  crossed.push_back({5, 6});
  refuse_each([&] { return triangulator.triangulate_constrained(Reals(xy), crossed, constraints).hash().to_string(); });
}

/// The caller stops the call while segments that cross are handled on the host: it ends soon.
TEST(HostMemory, StoppedWhereSegmentsCross) {
  const Points xy = uniform_points(400, 3);
  std::vector<Segment> segments;
  for (std::int32_t i = 0; i + 1 < 400; i += 2) segments.push_back({i, i + 1});
  Triangulator triangulator(on_host());
  ConstraintOptions constraints;
  constraints.grid = 0x1p-10;
  for (const Crossing crossing : {Crossing::error, Crossing::exact, Crossing::grid}) {
    SCOPED_TRACE(static_cast<int>(crossing));
    constraints.crossing = crossing;
    const auto call = [&] {
      try {
        (void)triangulator.triangulate_constrained(Reals(xy), segments, constraints);
      } catch (const CrossingError&) {
      }
    };
    call();
    asked = 0;
    call();
    const std::size_t all = asked;
    std::size_t stops = 0, stopped = 0, most_later = 0;
    for (std::size_t k = 0; k < all; k += 1 + all / 40, ++stops) {
      stop_source source;
      to_stop = &source;
      triangulator.options().stop = source.get_token();
      asked = 0;
      until_stop = k;
      try {
        call();
      } catch (const Cancelled&) {
        ++stopped;
        most_later = std::max(most_later, asked - k);
      }
      until_stop = never;
    }
    triangulator.options().stop = {};
    EXPECT_GE(10 * stopped, 9 * stops) << stops;
    EXPECT_LT(most_later, all / 2);
  }
}

TEST(HostMemory, SeveralSets) {
  Points xy = uniform_points(300, 1);
  const std::vector<std::size_t> offsets = {0, 100, 100, 103, 300};
  Triangulator triangulator(on_host());
  refuse_each([&] {
    const TriangulationBatch batch = triangulator.triangulate_batch(Reals(xy), offsets);
    std::string all;
    for (std::size_t s = 0; s < batch.size(); ++s) all += batch.triangulation(s).hash().to_string();
    return all;
  });
}

TEST(HostMemory, Verification) {
  const Points xy = some_points();
  const Triangulation mesh = triangulate(Reals(xy), on_host());
  VerifyOptions alone;
  alone.threads = 1;
  refuse_each([&] { return verify(Reals(xy), mesh, alone).summary(); });
}

/// The same through the interface of C, which no exception may leave.
void require_ok(cadt_status status) {
  cadt_error error{};
  error.size = sizeof error;
  EXPECT_EQ(cadt_last_error(&error), CADT_OK);
  if (status == CADT_OK) return;
  EXPECT_EQ(status, CADT_OUT_OF_MEMORY);
  EXPECT_EQ(error.status, status);
  EXPECT_NE(error.message[0], '\0');
  throw std::bad_alloc();
}

TEST(HostMemory, CInterface) {
  const Points xy = some_points();
  const cadt_points points{xy.data(), nullptr, xy.size() / 2, 0, CADT_FLOAT64};
  const cadt_device_points on_device{xy.data(), nullptr, xy.size() / 2, 0, CADT_FLOAT64};
  const std::size_t offsets[] = {0, 100, xy.size() / 2};
  cadt_options options{};
  require_ok(cadt_options_init(&options, sizeof options));
  options.backend = CADT_BACKEND_HOST;
  options.threads = 1;
  options.cancelled = [](void*) { return 0; };
  struct Handles {
    ~Handles() {
      cadt_triangulator_free(triangulator);
      cadt_triangulation_free(mesh);
      cadt_device_triangulation_free(on_device);
      cadt_batch_free(batch);
      cadt_report_free(report);
    }
    cadt_triangulator* triangulator = nullptr;
    cadt_triangulation* mesh = nullptr;
    cadt_device_triangulation* on_device = nullptr;
    cadt_batch* batch = nullptr;
    cadt_report* report = nullptr;
  };
  refuse_each([&] {
    Handles h;
    require_ok(cadt_triangulate(&points, &options, &h.mesh));
    return h.mesh->mesh.hash().to_string();
  });
  refuse_each([&] {
    Handles h;
    require_ok(cadt_triangulator_open(&options, &h.triangulator));
    require_ok(cadt_triangulator_triangulate_device(h.triangulator, &on_device, &h.on_device));
    require_ok(cadt_device_triangulation_download(h.on_device, &h.mesh));
    require_ok(cadt_triangulator_triangulate_batch(h.triangulator, &points, offsets, 2, &h.batch));
    std::size_t count = 0;
    std::vector<std::int32_t> words(2 * 3 * xy.size());
    require_ok(cadt_triangulation_edges(h.mesh, words.data(), words.size(), &count));
    return std::to_string(count) + h.mesh->mesh.hash().to_string();
  });
  const Triangulation mesh = triangulate(Reals(xy), on_host());
  refuse_each([&] {
    Handles h;
    require_ok(cadt_triangulation_adopt(&points, mesh.triangles().data(), nullptr, mesh.number_of_triangles(), 1,
                                        CADT_KEEP_COPY, &h.mesh));
    require_ok(cadt_triangulation_verify(h.mesh, &points, nullptr, &h.report));
    return h.report->summary;
  });
  const std::int32_t segments[] = {0, 1, 2, 3, 4, 5};
  cadt_constraint_options how{};
  how.size = sizeof how;
  how.crossing = CADT_CROSSING_EXACT;
  how.domain = CADT_DOMAIN_LAYERS;
  refuse_each([&] {
    struct Constrained {
      ~Constrained() {
        cadt_queries_free(queries);
        cadt_constrained_free(mesh);
        cadt_report_free(report);
      }
      cadt_constrained* mesh = nullptr;
      cadt_queries* queries = nullptr;
      cadt_report* report = nullptr;
    } h;
    require_ok(cadt_triangulate_constrained(&points, segments, 3, &how, &options, &h.mesh));
    require_ok(cadt_queries_open_constrained(&points, h.mesh, &options, &h.queries));
    const double where[] = {0.5, 0.5};
    const cadt_points asked{where, nullptr, 1, 0, CADT_FLOAT64};
    std::int32_t triangle = -1;
    std::size_t count = 0;
    const std::int32_t* edges = nullptr;
    require_ok(cadt_queries_locate(h.queries, &asked, &triangle, 1, &count));
    require_ok(cadt_constrained_edges(h.mesh, &edges, &count));
    return std::to_string(triangle) + " " + std::to_string(count);
  });
  const std::int64_t rings[] = {0, 4, 9}, polygons[] = {0, 1, 2};
  refuse_each([&] {
    cadt_polygon_triangles* triangles = nullptr;
    const cadt_status status = cadt_triangulate_polygons(&points, rings, 2, polygons, 2, &options, &triangles);
    const std::unique_ptr<cadt_polygon_triangles, decltype(&cadt_polygon_triangles_free)> owned(
        triangles, &cadt_polygon_triangles_free);
    require_ok(status);
    const std::int64_t* triangle_offsets = nullptr;
    const std::int32_t* vertices = nullptr;
    std::size_t count = 0;
    require_ok(cadt_polygon_triangles_get(triangles, &triangle_offsets, &count, &vertices));
    return std::to_string(triangle_offsets[count]);
  });
  // A message that finds no memory: the status tells all the same.
  until_refusal = 0;
  EXPECT_EQ(cadt_triangulate(nullptr, &options, nullptr), CADT_OUT_OF_MEMORY);
  until_refusal = never;
}

}  // namespace
}  // namespace cadt::test
