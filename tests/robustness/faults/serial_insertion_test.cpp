// SPDX-License-Identifier: Apache-2.0
// Small sets that one work-item inserts, where it reports that it could not: all work-items begin anew, with nothing of
// what it left.
#include "tests/robustness/faults/faulty_device.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include "common/driver/device_text.hpp"

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

TEST(SerialInsertion, BeginsAnewIfAPointIsLost) {
  const auto faults = std::make_shared<Faults>();
  const Injection injection(faults);
  for (const unsigned threads : {1U, 3U}) {
    Options options;
    options.backend = Backend::host;
    options.threads = threads;
    Triangulator triangulator(options);
    for (const Points& xy : {uniform_points(2000, 7), shuffled(grid_points(30, 40), 3), hub_points(500)}) {
      const ExpectedMesh expected = expected_mesh(xy);
      std::size_t failures = 0;
      faults->after_launch = [&](KernelId kernel, std::span<const Arg> args, Device& device, double) {
        if (kernel != KernelId::cadt_batch_insert) return;
        constexpr std::uint32_t lost = device_text::CADT_SET_FAILURE;
        constexpr std::size_t states = 5;  // its place among the kernel's parameters
        device.write(*args[states].buffer(), 0, &lost, sizeof lost);
        ++failures;
      };
      const Triangulation mesh = triangulator.triangulate(Reals(xy));
      EXPECT_EQ(failures, 1U);
      EXPECT_TRUE(same_mesh(mesh, expected));
      const Statistics& s = mesh.statistics();
      EXPECT_EQ(s.splits + s.edge_splits, s.distinct - 3) << "what was counted before counts twice";
      EXPECT_EQ(s.lock_attempts, s.lock_failures + s.splits + s.edge_splits + s.flips);
      faults->after_launch = nullptr;
      EXPECT_TRUE(same_mesh(triangulator.triangulate(Reals(xy)), expected));
    }
  }
}

}  // namespace
}  // namespace cadt::test
