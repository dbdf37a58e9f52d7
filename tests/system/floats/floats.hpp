// SPDX-License-Identifier: Apache-2.0
// A device without double precision, and its meshes against those of the host and of CGAL.
#pragma once

#include "tests/support/backends.hpp"

#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

namespace cadt::test {

using Floats = std::vector<float>;
using FloatSpan = std::span<const float>;

[[nodiscard]] bool are_floats(const std::vector<double>& xy);  ///< all coordinates, exactly
/// Rounded; those beyond the largest float become that.
[[nodiscard]] Floats floats_of(const std::vector<double>& xy);
[[nodiscard]] std::vector<double> doubles_of(const Floats& xy);

[[nodiscard]] Options float_options();
[[nodiscard]] Options host_options();

/// Skips where there is no OpenCL device, or fails if it is required.
class FloatTest : public testing::Test {
 protected:
  void SetUp() override;

  /// The mesh is that of the host for the same floats, byte for byte, and CGAL's (or the verifier accepts it).
  static void check(const Floats& xy, const std::string& name, Options options = float_options());
};

}  // namespace cadt::test
