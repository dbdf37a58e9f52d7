// SPDX-License-Identifier: Apache-2.0
// Points on the device in every form to meshes on the device.
#include "tests/support/mesh_checks.hpp"
#include "tests/system/resident/resident.hpp"

#include <array>
#include <cstring>
#include <limits>

namespace cadt::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class Resident : public ResidentTest {
 protected:
  /// The coordinates as a caller may hold them: converted, taken apart, behind others that are no numbers.
  template <class Real>
  void expect_same_in_every_form(Triangulator& triangulator, const Points& xy) {
    const std::vector<Real> values(xy.begin(), xy.end());
    const std::size_t n = values.size() / 2;
    const Triangulation expected = on_host(std::span<const Real>(values));
    const Scalar scalar = sizeof(Real) == sizeof(double) ? Scalar::float64 : Scalar::float32;
    for (const std::size_t skip : {std::size_t{0}, std::size_t{1}, std::size_t{777}}) {
      SCOPED_TRACE("skip " + std::to_string(skip));
      const auto none = std::numeric_limits<Real>::quiet_NaN();
      std::vector<Real> both(2 * skip, none), x(skip, none), y(skip, none);
      both.insert(both.end(), values.begin(), values.end());
      for (std::size_t i = 0; i < n; ++i) {
        x.push_back(values[2 * i]);
        y.push_back(values[2 * i + 1]);
      }
      both.insert(both.end(), 2, none);
      const void* handle = memory->upload(std::span<const Real>(both));
      const void* handle_x = memory->upload(std::span<const Real>(x));
      const void* handle_y = memory->upload(std::span<const Real>(y));
      {
        SCOPED_TRACE("interleaved");
        expect_same(*memory,
                    triangulator.triangulate(DevicePoints{.x = handle, .size = n, .scalar = scalar, .skip = skip}),
                    expected);
      }
      {
        SCOPED_TRACE("separate");
        const DevicePoints points{.x = handle_x, .y = handle_y, .size = n, .scalar = scalar, .skip = skip};
        expect_same(*memory, triangulator.triangulate(points), expected);
      }
      // the caller's arrays are as they were
      EXPECT_EQ(
          std::memcmp(memory->download<Real>(handle, both.size()).data(), both.data(), both.size() * sizeof(Real)), 0);
    }
  }
  void expect_same_in_every_form(const Points& xy) {
    Triangulator triangulator(options());
    {
      SCOPED_TRACE("double");
      expect_same_in_every_form<double>(triangulator, xy);
    }
    SCOPED_TRACE("float");
    expect_same_in_every_form<float>(triangulator, xy);
  }
};

Points with_duplicates() {
  Points xy = uniform_points(3000, 5);
  for (std::size_t i = 0; i < 1000; ++i) xy.insert(xy.end(), {xy[2 * (i % 37)], xy[2 * (i % 37) + 1]});
  return shuffled(xy, 7);
}

TEST_P(Resident, UniformPointsInEveryForm) { expect_same_in_every_form(uniform_points(20000)); }
TEST_P(Resident, LatticeInEveryForm) { expect_same_in_every_form(grid_points(60, 50)); }
TEST_P(Resident, DuplicatesInEveryForm) { expect_same_in_every_form(with_duplicates()); }

TEST_P(Resident, EveryFamily) {
  Triangulator triangulator(options());
  for (const auto families : {tiny_families, scaled_families, duplicate_families, cluster_families, line_families})
    for (const Family& family : families()) {
      SCOPED_TRACE(family.name);
      const Known known(family.make());
      if (known.size() == 0) continue;
      const DeviceTriangulation mesh = triangulator.triangulate(upload(known.xy));
      expect_same(*memory, mesh, known.mesh);
      if (HasFailure()) return;
    }
}

TEST_P(Resident, PointsOnTheHostGiveTheSame) {
  const Known known(with_duplicates());
  Triangulator triangulator(options());
  expect_same(triangulator.triangulate(std::span<const double>(known.xy)), known.mesh);
  expect_same(triangulate(std::span<const double>(known.xy), options()), known.mesh);
  expect_same(*memory, triangulator.triangulate(upload(known.xy)), known.mesh);
  Options own = options();
  own.queue.reset();
  expect_same(Triangulator(own).triangulate(std::span<const double>(known.xy)), known.mesh);
}

TEST_P(Resident, FewPoints) {
  Triangulator triangulator(options());
  const std::array<Points, 9> sets = {Points{0.5, 0.25},        {0, 0, 1, 2},       {0, 0, 0, 0},
                                      {0, 0, 1, 0, 0, 1},       {0, 0, 1, 1, 2, 2}, {3, 4, 3, 4, 3, 4},
                                      {0, 0, 1, 0, 0, 1, 1, 0}, Points(2000, 0.5),  {0, 0, -0.0, 0, 1, 0, 1, -0.0}};
  for (const Points& xy : sets) {
    SCOPED_TRACE(std::to_string(xy.size() / 2) + " points");
    expect_same(*memory, triangulator.triangulate(upload(xy)), on_host(std::span<const double>(xy)));
  }
  Points line;
  for (int i = 0; i < 5000; ++i) line.insert(line.end(), {3.0 * ((i * 7) % 5000), -1.0 * ((i * 7) % 5000)});
  const DeviceTriangulation flat = triangulator.triangulate(upload(line));
  EXPECT_EQ(flat.dimension(), 1);
  expect_same(*memory, flat, on_host(std::span<const double>(line)));
}

TEST_P(Resident, NoPoints) {
  Triangulator triangulator(options());
  const Triangulation nothing = on_host(PointsView());
  expect_same(*memory, triangulator.triangulate(DevicePoints{}), nothing);
  const void* handle = memory->upload(std::span<const double>(Points{1, 2}));
  expect_same(*memory, triangulator.triangulate(DevicePoints{.x = handle, .size = 0}), nothing);
  expect_same(*memory, DeviceTriangulation(), nothing);
}

TEST_P(Resident, OrderMayChangeBetweenCalls) {
  const Known known(with_duplicates());
  const DevicePoints points = upload(known.xy);
  Triangulator triangulator(options());
  for (int round = 0; round < 2; ++round) {
    triangulator.options().order = Order::fast;
    const DeviceTriangulation fast = triangulator.triangulate(points);
    const auto triangles = memory->download<std::int32_t>(fast.triangles(), 3 * fast.number_of_triangles());
    EXPECT_TRUE(memory->download<std::int32_t>(fast.neighbors(), triangles.size()) == neighbors_of(triangles));
    EXPECT_TRUE(canonical_set(triangles) == canonical_set(known.mesh.triangles()));
    EXPECT_EQ(fast.download().hash(), known.mesh.hash());
    triangulator.options().order = Order::canonical;
    expect_same(*memory, triangulator.triangulate(points), known.mesh);
  }
}

TEST_P(Resident, StarsGiveTheSame) {
  Options with = options();
  with.tuning.strategy = Strategy::stars;
  Triangulator triangulator(with);
  for (const Points& xy : {uniform_points(20000, 3), grid_points(70, 60), with_duplicates(), Points{0, 0, 1, 0, 0, 1},
                           Points{0, 0, 1, 1, 2, 2}, regular_polygon(50, 0, 0, 1)}) {
    SCOPED_TRACE(std::to_string(xy.size() / 2) + " points");
    const Known known(xy);
    const DeviceTriangulation mesh = triangulator.triangulate(upload(known.xy));
    expect_same(*memory, mesh, known.mesh);
    if (known.size() > 1000) {
      EXPECT_GT(mesh.statistics().proven_stars, known.size() / 2);
    }
    EXPECT_TRUE(triangulator.verify(upload(known.xy), mesh).ok);
  }
}

TEST_P(Resident, NullHandle) {
  const Known known(uniform_points(100));
  Triangulator triangulator(options());
  const DevicePoints good = upload(known.xy);
  (void)thrown<InputError>([&] { (void)triangulator.triangulate(DevicePoints{.size = 3}); });
  (void)thrown<InputError>([&] { (void)triangulator.triangulate(DevicePoints{.y = good.x, .size = 3}); });
  expect_same(*memory, triangulator.triangulate(good), known.mesh);
}

TEST_P(Resident, NotFinite) {
  const Known known(uniform_points(5000));
  Triangulator triangulator(options());
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    for (const std::size_t at : {std::size_t{0}, std::size_t{1234}, std::size_t{4999}}) {
      Points xy = known.xy;
      xy[2 * at + at % 2] = bad;
      xy.back() = nan;  // only the first one is told
      const DevicePoints points = upload(xy);
      if (const auto error = thrown<InputError>([&] { (void)triangulator.triangulate(points); }); error != nullptr) {
        EXPECT_EQ(error->index(), at);
      }
      if (const auto error = thrown<InputError>([&] { (void)triangulator.triangulate(std::span<const double>(xy)); });
          error != nullptr) {
        EXPECT_EQ(error->index(), at);
      }
    }
    expect_same(*memory, triangulator.triangulate(upload(known.xy)), known.mesh);
  }
}

/// No memory of that size is there: nothing may look at it.
TEST_P(Resident, TooManyPoints) {
  const Known known(uniform_points(100));
  Triangulator triangulator(options());
  const DevicePoints good = upload(known.xy);
  for (const std::size_t n : {max_points() + 1, std::size_t{1} << 32, ~std::size_t{0}}) {
    if (const auto error =
            thrown<LimitError>([&] { (void)triangulator.triangulate(DevicePoints{.x = good.x, .size = n}); });
        error != nullptr) {
      EXPECT_EQ(error->count(), n);
      EXPECT_EQ(error->limit(), max_points());
    }
    (void)thrown<LimitError>([&] { triangulator.reserve(n); });
  }
  for (const std::size_t skip : {std::size_t{1} << 31, ~std::size_t{0} - 50})
    (void)thrown<LimitError>(
        [&] { (void)triangulator.triangulate(DevicePoints{.x = good.x, .size = 100, .skip = skip}); });
  expect_same(*memory, triangulator.triangulate(good), known.mesh);
}

TEST_P(Resident, Stopped) {
  const Known known(with_duplicates());
  const DevicePoints points = upload(known.xy);
  Triangulator triangulator(options());
  cadt::stop_source source;
  source.request_stop();
  triangulator.options().stop = source.get_token();
  (void)thrown<Cancelled>([&] { (void)triangulator.triangulate(points); });
  (void)thrown<Cancelled>([&] { (void)triangulator.triangulate(std::span<const double>(known.xy)); });
  triangulator.options().stop = {};
  expect_same(*memory, triangulator.triangulate(points), known.mesh);
}

TEST_P(Resident, StoppedAtEveryReport) {
  const Known known(with_duplicates());
  const DevicePoints points = upload(known.xy);
  const auto allocator = counting();
  {
    Options with = options();
    with.allocator = allocator;
    Triangulator triangulator(with);
    int reports = 0;
    double last = 0;
    triangulator.options().progress = [&](const Progress& progress) {
      ++reports;
      EXPECT_GE(progress.fraction, last);
      last = progress.fraction;
    };
    expect_same(*memory, triangulator.triangulate(points), known.mesh);
    EXPECT_EQ(last, 1);
    const int all = reports;
    EXPECT_GE(all, 5);
    for (int stop_at = 1; stop_at <= all; ++stop_at) {
      cadt::stop_source source;
      reports = 0;
      triangulator.options().stop = source.get_token();
      triangulator.options().progress = [&](const Progress&) {
        if (++reports == stop_at) source.request_stop();
      };
      (void)thrown<Cancelled>([&] { (void)triangulator.triangulate(points); });
      triangulator.release_memory();
      EXPECT_EQ(allocator->live(), 0U) << "after report " << stop_at;
    }
    triangulator.options().stop = {};
    triangulator.options().progress = nullptr;
    expect_same(*memory, triangulator.triangulate(points), known.mesh);
  }
  EXPECT_EQ(allocator->live(), 0U);
  EXPECT_EQ(allocator->fault, "");
}

CADT_ON_MAIN_BACKENDS(Resident);

}  // namespace
}  // namespace cadt::test
