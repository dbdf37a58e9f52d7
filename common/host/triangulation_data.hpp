// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace cadt {

/// What a Triangulation holds.
struct Triangulation::Data {
  std::size_t points = 0;
  std::size_t triangle_count = 0;
  std::unique_ptr<std::int32_t[]> triangles, neighbors;  ///< 3 * triangle_count each, left uninitialised until filled
  std::vector<std::int32_t> hull;
  std::vector<Duplicate> duplicates;
  int dimension = -1;
  Statistics statistics;
};

}  // namespace cadt
