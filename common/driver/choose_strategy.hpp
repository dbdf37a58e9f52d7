// SPDX-License-Identifier: Apache-2.0
// How a mesh is made: one decision, a pure function of device, options and the profile of the points. No stage decides
// again; where stars or gift wrapping prove too little, they hand over to insertion.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>

#include "common/driver/device.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// What the decision depends on of the device.
struct DeviceTraits {
  bool contiguous = true;    ///< a work-item takes contiguous elements, as on CPUs
  bool gpu = false;          ///< many lightweight work-items
  bool floats_only = false;  ///< no double precision
  unsigned threads = 0;      ///< of the host; 0: another device
};
[[nodiscard]] DeviceTraits traits_of(const Device& device) noexcept;

/// What the decision depends on of the sorted points.
struct PointProfile {
  std::size_t distinct = 0;
  bool wide = false;         ///< exponents span too many binades for the narrow kernels
  unsigned finest_bits = 0;  ///< most bits of a sort key along one axis
  PointShapes shapes;
};
[[nodiscard]] PointProfile profile_of(const SortedPoints& points) noexcept;

struct BuildStrategy {
  enum class Method {
    insertion,  ///< points are inserted into one shared mesh, with locks
    wrapping,   ///< all stars by gift wrapping; insertion if that takes too long
    stars       ///< local stars, then gift wrapping or insertion of the residual vertices
  };
  Method method = Method::insertion;
  std::size_t most_wrapped = 0;           ///< most points of a mesh that is wrapped as a whole
  std::size_t most_residual_wrapped = 0;  ///< most residual vertices that are wrapped
  std::size_t least_points_of_tile = 0;   ///< with fewer on average there is no star stage; 0: no bound
  bool cautious = false;                  ///< the star stage stops early if it proves too few stars
};

/// Whether device and options allow the star stage: if so, the sort keeps its keys and memory is planned for it.
[[nodiscard]] bool may_use_stars(const DeviceTraits& device, const Options& options) noexcept;

/// The decision: the only place where a strategy is chosen.
[[nodiscard]] BuildStrategy choose_strategy(const DeviceTraits& device, const Options& options,
                                            const PointProfile& profile) noexcept;

/// Most points for which gift wrapping is faster than insertion; for each point it looks at a share of all.
[[nodiscard]] std::size_t most_wrapped_by(const DeviceTraits& device) noexcept;
/// The fewest points for which the star stage may need its memory.
[[nodiscard]] std::size_t fewest_for_stars(const Options& options) noexcept;

/// Whether one work-item inserts all n points, without locks and without waking a thread.
[[nodiscard]] bool inserts_serially(const DeviceTraits& device, const Options& options, std::size_t n) noexcept;

/// Most points of a call that the calling thread does alone, with a device that it keeps: opening one with threads
/// takes longer than they save.
constexpr std::size_t most_points_of_calling_thread = (std::size_t{1} << 14) - 1;

/// Whether each thread inserts a partition of the n points (common/insertion/partitioned.dev.h).
[[nodiscard]] bool inserts_partitions(const DeviceTraits& device, const Options& options, std::size_t n) noexcept;
/// Fewest points of a partition.
constexpr std::size_t least_partition = std::size_t{1} << 12;

/// Most points of a set that may be batched; a larger set is triangulated individually. 0: so is every set.
[[nodiscard]] std::size_t most_points_of_batched_set(const DeviceTraits& device) noexcept;
/// Whether small sets are batched; else each is triangulated individually, in the order of the sets.
[[nodiscard]] bool batches_sets(const DeviceTraits& device, const Options& options) noexcept;
/// Whether batched sets are triangulated by insertion, each by one thread; else by stars.
[[nodiscard]] bool inserts_batched_sets(const DeviceTraits& device, const Options& options) noexcept;

}  // namespace cadt
