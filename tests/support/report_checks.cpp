// SPDX-License-Identifier: Apache-2.0
#include "tests/support/report_checks.hpp"

#include <gtest/gtest.h>

namespace cadt::test {

void expect_same_report(const VerifyReport& device, const VerifyReport& host) {
  EXPECT_EQ(device.ok, host.ok) << device.summary() << "; host: " << host.summary();
  EXPECT_EQ(device.points, host.points);
  EXPECT_EQ(device.triangles_examined, host.triangles_examined);
  EXPECT_EQ(device.edges_examined, host.edges_examined);
  EXPECT_EQ(device.hull_vertices, host.hull_vertices);
  EXPECT_EQ(device.ties, host.ties);
  EXPECT_EQ(device.unusual_ties, host.unusual_ties);
  ASSERT_EQ(device.checks.size(), host.checks.size());
  for (std::size_t i = 0; i < host.checks.size(); ++i) {
    const Check &d = device.checks[i], &h = host.checks[i];
    EXPECT_EQ(d.name, h.name);
    EXPECT_EQ(d.passed, h.passed) << h.name;
    EXPECT_EQ(d.failures, h.failures) << h.name;
    EXPECT_EQ(d.first, h.first) << h.name;
    EXPECT_EQ(d.what, h.what) << h.name;
  }
}

}  // namespace cadt::test
