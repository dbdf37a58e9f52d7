// SPDX-License-Identifier: Apache-2.0
// How a mesh is made: one decision, a function of the device, the options and what the points are like. No stage asks
// again.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>

#include "common/driver/device.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// What the decision asks of a device.
struct DeviceTraits {
  bool contiguous = true;    ///< a work-item takes neighbouring elements, as on CPUs
  bool gpu = false;          ///< many cheap lanes
  bool floats_only = false;  ///< no double precision
};
[[nodiscard]] DeviceTraits traits_of(const Device& device) noexcept;

/// What the decision asks of sorted points.
struct PointProfile {
  std::size_t distinct = 0;
  bool wide = false;         ///< exponents span too much for the narrow kernels
  unsigned finest_bits = 0;  ///< of the sort keys, along the axis that has more
  PointShapes shapes;
};
[[nodiscard]] PointProfile profile_of(const SortedPoints& points) noexcept;

struct BuildStrategy {
  enum class Method {
    insertion,  ///< points into one shared mesh, with locks
    wrapping,   ///< every star by gift wrapping, and insertion if that takes too long
    stars       ///< local stars, then gift wrapping or insertion of the residual vertices
  };
  Method method = Method::insertion;
  std::size_t most_wrapped = 0;           ///< gift wrapping of a whole mesh: this many points at most
  std::size_t most_residual_wrapped = 0;  ///< and of residual vertices
  std::size_t least_points_of_tile = 0;   ///< fewer on average, and the star stage is not for them; 0: any number
  bool cautious = false;                  ///< the star stage stops early where it proves too little
  friend bool operator==(const BuildStrategy&, const BuildStrategy&) = default;
};

/// Whether the star stage may be chosen, as far as device and options tell: then the sort keeps its keys, and memory is
/// planned for it.
[[nodiscard]] bool may_use_stars(const DeviceTraits& device, const Options& options) noexcept;

/// The decision.
[[nodiscard]] BuildStrategy choose_strategy(const DeviceTraits& device, const Options& options,
                                            const PointProfile& profile) noexcept;

/// Points of a set up to which gift wrapping is faster than insertion; it looks at a share of all points for each.
[[nodiscard]] std::size_t most_wrapped_by(const DeviceTraits& device) noexcept;
/// The fewest points for which the star stage may need its memory.
[[nodiscard]] std::size_t fewest_for_stars(const Options& options) noexcept;

/// Whether insertion of n points gives each thread a partition of them (common/insertion/partitioned.dev.h).
[[nodiscard]] bool inserts_partitions(const DeviceTraits& device, const Options& options, std::size_t n) noexcept;
/// Points of a partition at least.
constexpr std::size_t least_partition = std::size_t{1} << 14;

/// Points of a set that may be batched at most; a larger one is a call of its own. 0: so is every set.
[[nodiscard]] std::size_t most_points_of_batched_set(const DeviceTraits& device) noexcept;
/// Whether small sets are batched, rather than triangulated one by one in their place among the others.
[[nodiscard]] bool batches_sets(const DeviceTraits& device, const Options& options) noexcept;
/// Whether batched sets are inserted, each by one thread, rather than made of stars.
[[nodiscard]] bool inserts_batched_sets(const DeviceTraits& device, const Options& options) noexcept;

}  // namespace cadt
