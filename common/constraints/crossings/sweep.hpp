// SPDX-License-Identifier: Apache-2.0
// A part of the sweep that makes an arrangement.
#pragma once

#include "common/constraints/crossings/arrangement.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cadt::constraints {

/// What a sweep finds in one slab. A wall is a part of a line that segments cover which overlap; it goes by one of
/// them.
struct SlabFindings {
  /// A wall begins, ends or runs through a vertex: the rank of a point, or -1 - the index of a crossing of this slab.
  /// In lexicographic order of vertices; at each, from the lowest wall to the highest just before it, then what begins
  /// there.
  struct Contact {
    std::int32_t wall, vertex;
  };
  std::vector<exact::Place> crossings;
  std::vector<Contact> contacts;
  /// A segment, and the one that the wall goes by which it is part of. Segments alone are left out.
  std::vector<std::array<std::int32_t, 2>> parts;
};

/// Finds what is after point first - 1 and not after point last - 1, in the lexicographic order of the arrangement's
/// points. `starts`: the first segment whose lower end is at or after each point. J. L. Bentley, T. A. Ottmann,
/// "Algorithms for reporting and counting geometric intersections" (IEEE Trans. Computers 28, 1979), for any input: all
/// segments through a vertex are handled at once, as in M. de Berg et al., "Computational Geometry", chapter 2.
/// O((n + contacts) log n). Reads the arrangement's points, segments and lines only. `vertices`: points, and crossings
/// of all slabs so far. \pre first < last \throws Cancelled; LimitError for more vertices than max_points()
[[nodiscard]] SlabFindings sweep_slab(const Arrangement& arrangement, const std::vector<std::int32_t>& starts,
                                      std::int32_t first, std::int32_t last, std::atomic<std::size_t>& vertices,
                                      const StopCheck& check_stop = {});

}  // namespace cadt::constraints
