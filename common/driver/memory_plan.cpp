// SPDX-License-Identifier: Apache-2.0
#include "common/driver/memory_plan.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "common/driver/device_text.hpp"

namespace cadt {
namespace {

using device_text::word;
constexpr std::size_t fixed = std::size_t{1} << 16;  // bytes of counters and partial results
constexpr std::size_t fewest_points_batched = std::size_t{1} << 16;

/// Words a point of the buffers that must be cached for a call to allocate none: locked triangles, points sorted and
/// not, results, the triangles' numbers, and lists of a word or less.
constexpr std::size_t cached_words[] = {16, 6, 6, 4, 4, 2, 1, 1, 1, 1, 1, 1};

/// The same for the star stage, in addition: stars, lists, and what the residual vertices need.
constexpr std::size_t cached_star_words[] = {7, 1, 1, 1, 1, 1, 1};

/// The same where buffers are pooled: locked triangles, results, the triangles' numbers, input ids and what is as
/// large. With the star stage, stars in addition.
constexpr std::size_t pooled_words[] = {16, 6, 6, 2, 1, 1, 1};

/// Words a point of each buffer that reserve_buffers() asks for.
std::vector<std::size_t> reserved_words(const Memory& memory, std::size_t n, bool stars) {
  if (memory.pools(n * word)) {
    std::vector<std::size_t> all(std::begin(pooled_words), std::end(pooled_words));
    if (stars) all.push_back(cached_star_words[0]);
    return all;
  }
  std::vector<std::size_t> all(std::begin(cached_words), std::end(cached_words));
  if (stars) all.insert(all.end(), std::begin(cached_star_words), std::end(cached_star_words));
  return all;
}

/// Largest buffers: locked triangles; or stars (allocate_stars of common/stars/local_stars.cpp), 25 bytes a point, some
/// for each tile and 49,216 for all.
constexpr std::size_t locked_bytes(std::size_t n) noexcept { return n * 16 * word; }
constexpr std::size_t star_pool_bytes(std::size_t n) noexcept { return fixed + 26 * n; }

/// Whether the device can allocate one buffer of so many bytes.
bool fits_buffers(const Options& options, const DeviceInfo& device, std::size_t bytes) noexcept {
  const std::uint64_t largest = device.largest_buffer_bytes;
  return options.allocator != nullptr || largest == 0 || bytes <= largest;  // an allocator knows its own limits
}

void require_buffer(const Options& options, const DeviceInfo& device, std::size_t bytes) {
  if (fits_buffers(options, device, bytes)) return;
  throw OutOfMemory("this needs a buffer of " + std::to_string(bytes) + " bytes and the largest of '" + device.name +
                        "' has " + std::to_string(device.largest_buffer_bytes) +
                        ": use fewer points or a device with larger buffers",
                    bytes, static_cast<std::size_t>(device.largest_buffer_bytes));
}

/// Device bytes of a batch without its result.
constexpr std::size_t bytes_batched(std::size_t points, std::size_t sets) { return fixed + 176 * points + 1300 * sets; }

}  // namespace

MemoryPlan plan_memory(const CallShape& call, bool stars, bool compact) noexcept {
  const std::size_t n = call.points;
  if (!stars) return {false, false, call.input_stays, fixed + n * (call.result_elsewhere ? 97 : 124), locked_bytes(n)};
  const std::size_t each = compact ? (call.input_stays ? 71 : 83) : (call.input_stays ? 85 : 101);
  return {true, compact, call.input_stays, 2 * fixed + n * each, star_pool_bytes(n)};
}

MemoryPlan choose_memory_plan(Memory& memory, const Options& options, const DeviceInfo& device, const CallShape& call,
                              bool stars, const KnownSizes& known) {
  const std::size_t n = call.points;
  const MemoryPlan compact = plan_memory(call, stars, true);
  MemoryPlan fast = plan_memory(call, stars, false);
  // Lost locks of triangles (common/overlay/growth_snapshots.cpp).
  if (options.tuning.watch && options.statistics == StatisticsDetail::timing) fast.bytes += 2 * n * word;
  require_buffer(options, device, fast.largest_buffer);
  const bool bounded = options.max_memory != 0;
  if (!stars) {
    if (n > known.insertion || bounded) memory.require(fast.bytes);
    return fast;
  }
  if (n <= known.fast_stars && !bounded) return is_compact(call) ? compact : fast;
  if (!is_compact(call) && memory.allows(fast.bytes)) return fast;
  if (n > known.compact_stars || bounded) memory.require(compact.bytes);
  return compact;
}

std::size_t plan_batch(Memory& memory, const Options& options, const DeviceInfo& device,
                       std::span<const std::size_t> offsets, std::size_t most_of_set, std::size_t results,
                       const KnownSizes& known) {
  const std::size_t n = offsets.back(), sets = offsets.size() - 1;
  if (n <= known.batch && options.max_memory == 0) return most_points_batched;
  std::size_t largest = 0;
  for (std::size_t s = 0; s < sets; ++s) largest = std::max(largest, offsets[s + 1] - offsets[s]);
  std::size_t bytes_individual = 0;
  if (largest > most_of_set) {
    const MemoryPlan individual = plan_memory({largest, true, false, sizeof(double)}, false, false);
    require_buffer(options, device, individual.largest_buffer);
    bytes_individual = results + individual.bytes;
  }
  std::size_t most = most_points_batched;
  const auto bytes = [&] {
    const std::size_t points = std::min(n, most);
    return results + bytes_batched(points, std::min({sets, points, most_sets_batched}));
  };
  while (most > fewest_points_batched &&
         !(memory.allows(bytes()) && fits_buffers(options, device, locked_bytes(std::min(n, most)))))
    most /= 2;
  memory.require(std::max(bytes(), bytes_individual));
  return most;
}

std::size_t most_bytes(const Memory& memory, std::size_t n, bool stars) {
  if (!memory.caches()) {
    const CallShape call{n, false, false, sizeof(double)};
    const std::size_t insertion = plan_memory(call, false, false).bytes;
    // Of few points the stars need more: they have twice as much that does not grow with the points.
    return stars ? std::max(insertion, plan_memory(call, true, false).bytes) : insertion;
  }
  const std::vector<std::size_t> words = reserved_words(memory, n, stars);
  const std::size_t small = memory.pools(n * word) ? 1 : 0;  // buffers that are too small for the pool
  return 4 * fixed + n * word * std::accumulate(words.begin(), words.end(), small);
}

void reserve_buffers(Memory& memory, std::size_t n, bool stars) {
  std::vector<Allocation> buffers;
  // Prefix sums have one word more; a larger buffer may already be the largest that the device allows.
  for (const std::size_t words : reserved_words(memory, n, stars))
    buffers.push_back(memory.allocate((n * words + (words <= 2 ? 1 : 0)) * word));
}

}  // namespace cadt
