// SPDX-License-Identifier: Apache-2.0
// Which checks reject a mesh; on all devices the same.
#pragma once

#include "devices.hpp"
#include "small_delaunay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

using cadt::Check;
using cadt::VerifyReport;
using Names = std::vector<std::string>;

inline Names failed(const VerifyReport& report) {
  Names names;
  for (const Check& c : report.checks)
    if (!c.passed && c.what.rfind("not examined", 0) != 0) names.push_back(c.name);
  return names;
}

inline const Check& check_of(const VerifyReport& report, const std::string& name) {
  return *std::ranges::find(report.checks, name, &Check::name);
}

/// Rejected, and by `name`, with a place or a reason.
inline void expect_killed_by(const VerifyReport& report, const std::string& name) {
  EXPECT_FALSE(report.ok);
  const Check& c = check_of(report, name);
  EXPECT_FALSE(c.passed) << report.summary();
  EXPECT_GT(c.failures, 0U) << name << ": " << c.what;
  EXPECT_FALSE(c.what.empty());
}

inline VerifyReport verify_full(const TestMesh& m, bool canonical = true) {
  return on_host_and_devices(m.points(), m.view(), {2, canonical});
}
inline VerifyReport verify_bare(const TestMesh& m) { return on_host_and_devices(m.points(), m.bare(), {2, true}); }
