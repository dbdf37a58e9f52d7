// SPDX-License-Identifier: Apache-2.0
#include "common/driver/choose_strategy.hpp"

#include <algorithm>

#include "common/driver/device_text.hpp"
#include "common/points/device_points.hpp"
#include "common/stars/local_stars.hpp"

namespace cadt {
namespace {

using namespace device_text;
using Method = BuildStrategy::Method;

/// Most points that are wrapped if many lie on circles or on a lattice, where exact tests take longer, or on a ring,
/// where circles are large and each step looks at many points.
constexpr std::size_t most_wrapped_on_circles = 20000, most_wrapped_on_lattice = 20480, most_wrapped_on_ring = 28672;

/// Most points to wrap as a whole mesh: `most`, or less for these shapes.
std::size_t most_wrapped_of(std::size_t most, const PointShapes& shapes) noexcept {
  if (shapes.on_circles) return std::min(most, most_wrapped_on_circles);
  if (shapes.on_lattice) return std::min(most, most_wrapped_on_lattice);
  return shapes.on_ring ? std::min(most, most_wrapped_on_ring) : most;
}

/// Whether neither stars nor gift wrapping suits the points: there are no triangles, or the floating-point filter
/// decides few of them.
bool are_for_insertion(const PointProfile& profile) noexcept {
  const PointShapes& shapes = profile.shapes;
  const bool convex = (shapes.on_circle && profile.distinct > CADT_WRAP_HULL_EXACT) ||
                      (shapes.on_hull && profile.distinct > CADT_WRAP_HULL);
  return shapes.on_line || convex || shapes.on_rays;
}

/// Fewest points that are inserted in partitions. One thread gains nothing by them but short launches.
std::size_t fewest_partitioned(const DeviceTraits& device) noexcept {
  return (device.threads > 1 ? 4 : 16) * least_partition;
}

}  // namespace

DeviceTraits traits_of(const Device& device) noexcept {
  return {device.shape().contiguous, device.info().gpu, takes_floats_only(device),
          device.info().backend == Backend::host ? device.threads() : 0};
}

PointProfile profile_of(const SortedPoints& points) noexcept {
  const KeyGrid grid = grid_for_stars(points.grid);
  return {points.distinct, points.wide, std::max(grid.bits_x, grid.bits_y), points.shapes};
}

bool may_use_stars(const DeviceTraits& device, const Options& options) noexcept {
  if (options.tuning.strategy != Strategy::automatic) return options.tuning.strategy == Strategy::stars;
  // CPUs are faster by insertion.
  return device.gpu && !device.floats_only && options.tuning.stabilize == Stabilize::off && !options.tuning.watch &&
         options.statistics != StatisticsDetail::timing;
}

BuildStrategy choose_strategy(const DeviceTraits& device, const Options& options,
                              const PointProfile& profile) noexcept {
  BuildStrategy how;
  if (!may_use_stars(device, options) || profile.wide) return how;
  const bool automatic = options.tuning.strategy == Strategy::automatic;
  if (automatic && are_for_insertion(profile)) return how;
  const std::size_t most = most_wrapped_by(device);
  how.most_residual_wrapped = device.contiguous ? most : std::size_t{CADT_WRAP_MOST};
  how.most_wrapped = automatic ? most_wrapped_of(most, profile.shapes) : most;
  how.cautious = automatic;
  how.least_points_of_tile = automatic ? least_points_of_tile : 0;
  const bool few = profile.distinct <= how.most_wrapped;
  const bool for_stars = profile.distinct >= 3 && profile.finest_bits <= most_key_bits_of_stars &&
                         !(automatic && (few || profile.shapes.overfull));
  how.method = for_stars ? Method::stars : few ? Method::wrapping : Method::insertion;
  return how;
}

std::size_t most_wrapped_by(const DeviceTraits& device) noexcept { return device.contiguous ? 2048 : 32768; }

std::size_t fewest_for_stars(const Options& options) noexcept {
  return options.tuning.strategy == Strategy::stars ? 0 : most_wrapped_on_circles + 1;
}

bool inserts_serially(const DeviceTraits& device, const Options& options, std::size_t n) noexcept {
  return device.threads != 0 && n < fewest_partitioned(device) && options.tuning.strategy == Strategy::automatic &&
         options.tuning.grain == 0 && options.tuning.stabilize == Stabilize::off && !options.tuning.watch;
}

bool inserts_partitions(const DeviceTraits& device, const Options& options, std::size_t n) noexcept {
  return device.contiguous && n >= fewest_partitioned(device) && options.tuning.grain == 0 &&
         options.tuning.stabilize == Stabilize::off && !options.tuning.watch;
}

std::size_t most_points_of_batched_set(const DeviceTraits& device) noexcept {
  if (device.floats_only) return 0;
  // One core inserts each set: larger sets are better shared among cores, and a stop would wait for them.
  constexpr std::size_t most_of_core = 8192;
  return device.contiguous ? most_of_core : most_wrapped_by(device);
}

bool batches_sets(const DeviceTraits& device, const Options& options) noexcept {
  const bool insertion = device.contiguous || options.tuning.strategy != Strategy::locks;
  return insertion && options.tuning.stabilize == Stabilize::off;
}

bool inserts_batched_sets(const DeviceTraits& device, const Options& options) noexcept {
  return device.contiguous && options.tuning.strategy != Strategy::stars;
}

}  // namespace cadt
