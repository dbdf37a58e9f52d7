// SPDX-License-Identifier: Apache-2.0
// Points and segments in device memory: the mesh there is that of the same points on the host.
#pragma once

#include <cadt/constrained.hpp>

#include <span>
#include <vector>

#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"

namespace cadt::test {

/// Compares all arrays, those in device memory and those that are downloaded, or the errors; on devices that take no
/// doubles, of the nearest floats.
void expect_same_in_device_memory(const Options& options, const Points& xy, const std::vector<Segment>& segments,
                                  const ConstraintOptions& constraints);

}  // namespace cadt::test
