// SPDX-License-Identifier: Apache-2.0
// Residual vertices that are inserted into a wrapped mesh of some of them (common/insertion/base_mesh.dev.h), as on
// cards, where it takes more than 65,536: here by a device that is driven like one.
#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include <cadt/cadt.hpp>

#include "common/driver/context.hpp"
#include "common/points/import.hpp"
#include "common/stars/mesh_from_stars.hpp"
#include "tests/unit/backends/opencl/support.hpp"

namespace cadt::test {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// With the lowest vertex first, in order.
std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::ranges::rotate(t, std::ranges::min_element(t));
  std::ranges::sort(triangles);
  return triangles;
}

class BaseOnDevice : public OpenClTest {
 protected:
  /// The mesh of these points as residual vertices that are too many to be wrapped.
  [[nodiscard]] std::vector<Triangle> insert(const std::vector<double>& xy, Statistics& statistics) const {
    opencl::OpenRequest request;
    request.index = index;
    const auto device = opencl::open_device(request);
    EXPECT_FALSE(device->shape().contiguous);
    Memory memory(*device, true);
    Options options;
    options.backend = Backend::opencl;
    Context ctx(*device, memory, options, statistics);
    const InputPoints input{PointsView(xy)};
    SortedPoints points = sort_spatially(ctx, input.import(ctx), input.size(), false);
    const Mesh mesh = wrap_or_insert(ctx, std::move(points), {}, MeshUse::part, input.size());
    EXPECT_EQ(mesh.all, 2 * input.size() - 2);
    const auto vertices = device->read_values(*mesh.vertices.device, 3 * mesh.all);
    const auto across = device->read_values(*mesh.across.device, 3 * mesh.all);
    const auto ids = device->read_values(*mesh.input_ids, input.size());
    std::vector<Triangle> triangles;
    for (std::size_t t = 0; t < mesh.all; ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t other = across[3 * t + k];
        EXPECT_EQ(across[3 * (other / 4) + other % 4], 4 * t + k);
      }
      if (t < mesh.triangles)
        triangles.push_back({ids[vertices[3 * t]], ids[vertices[3 * t + 1]], ids[vertices[3 * t + 2]]});
    }
    return sorted(std::move(triangles));
  }

 private:
  ScopedVariable as_gpu_{"CADT_OPENCL_AS_GPU", "32"};
  ScopedVariable no_cache_{"CADT_CACHE_DIR", ""};
  ScopedVariable not_optimised_{"POCL_EXTRA_BUILD_FLAGS", "-cl-opt-disable"};  // PoCL compiles for longer than it runs
};

void expect_mesh(const std::vector<Triangle>& triangles, const std::vector<double>& xy) {
  const Triangulation host = triangulate(xy, {});
  std::vector<Triangle> expected;
  for (std::size_t t = 0; t < host.number_of_triangles(); ++t) {
    Triangle& one = expected.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) one[k] = static_cast<std::uint32_t>(host.triangles()[3 * t + k]);
  }
  EXPECT_EQ(triangles, sorted(std::move(expected)));
}

TEST_F(BaseOnDevice, TheOthersAreInsertedIntoIt) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0, 1);
  for (const std::size_t n : {301, 4000}) {
    std::vector<double> xy(2 * n);
    for (double& x : xy) x = place(random);
    Statistics statistics;
    expect_mesh(insert(xy, statistics), xy);
    // Far fewer than without a base, which three points begin.
    EXPECT_LE(statistics.splits + statistics.edge_splits, n - n / 8);
    EXPECT_GE(statistics.splits + statistics.edge_splits, n - n / 4 - 1);
    EXPECT_EQ(statistics.wrapped_stars, 0U);
  }
}

// All points on a parabola: there is a star that is too large to be wrapped, or too much to do.
TEST_F(BaseOnDevice, WithoutOneWhereItCannotBeWrapped) {
  std::vector<double> xy;
  for (int i = 0; i < 20000; ++i) {
    const double x = i * 1e-4;
    xy.insert(xy.end(), {x, x * x});
  }
  Statistics statistics;
  expect_mesh(insert(xy, statistics), xy);
  EXPECT_EQ(statistics.splits + statistics.edge_splits, xy.size() / 2 - 3);
}

}  // namespace
}  // namespace cadt::test
