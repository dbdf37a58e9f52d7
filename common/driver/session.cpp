// SPDX-License-Identifier: Apache-2.0
#include "common/driver/session.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "common/points/device_points.hpp"
#include "common/stars/mesh_from_stars.hpp"

namespace cadt {
namespace {

constexpr std::size_t word = sizeof(std::uint32_t);
constexpr std::size_t fixed = std::size_t{1} << 16;  // counters, partial results

/// Words a point of the buffers that a call without new ones needs: records, points sorted and not, results, their
/// numbers, and lists of a word or less.
constexpr std::size_t kept_words[] = {16, 6, 6, 4, 4, 2, 1, 1, 1, 1, 1, 1};

/// Bytes of the largest buffer of the star stage, the stars (allocate_stars of local_stars.cpp): 25 a point, some for
/// each tile and 49,216 for all.
constexpr std::size_t star_pool_bytes(std::size_t n) { return fixed + 26 * n; }

/// With the star stage besides: stars, lists, and what the rest of the points needs.
constexpr std::size_t kept_star_words[] = {7, 1, 1, 1, 1, 1, 1};

/// The same where steps borrow of each other: records, results, numbers of triangles, labels and what is as large. With
/// the star stage, stars.
constexpr std::size_t pooled_words[] = {16, 6, 6, 2, 1, 1, 1};

/// Words a point of each buffer that reserve() asks for.
std::vector<std::size_t> reserved_words(const Memory& memory, std::size_t n, bool stars) {
  if (memory.pools(n * word)) {
    std::vector<std::size_t> all(std::begin(pooled_words), std::end(pooled_words));
    if (stars) all.push_back(kept_star_words[0]);
    return all;
  }
  std::vector<std::size_t> all(std::begin(kept_words), std::end(kept_words));
  if (stars) all.insert(all.end(), std::begin(kept_star_words), std::end(kept_star_words));
  return all;
}

void require_rules(const Options& options, const Device& device) {
  constexpr unsigned most_flips = 1000;  // counters have ten bits
  if (options.flip_threshold > most_flips)
    throw OptionError("flip_threshold", std::to_string(options.flip_threshold) + " is more than " +
                                            std::to_string(most_flips) + ", the most flips that are told apart");
  if (options.strategy == Strategy::stars && (options.stabilize != Stabilize::off || options.watch))
    throw OptionError("strategy", "stars goes with neither stabilize nor watch: they are about insertion");
  if (options.strategy == Strategy::stars && takes_floats_only(device))
    throw OptionError("strategy", "stars needs double precision, which '" + device.info().name +
                                      "' has not: take locks (or automatic, which does)");
  if (!(options.quality_epsilon >= 0)) throw OptionError("quality_epsilon", "must be a number and not negative");
}

}  // namespace

std::size_t least_bytes(std::size_t n, bool result_elsewhere) { return fixed + n * (result_elsewhere ? 97 : 124); }

std::size_t star_bytes(std::size_t n, bool input_stays, bool saves_memory) {
  const std::size_t each = saves_memory ? (input_stays ? 71 : 83) : (input_stays ? 85 : 101);
  return 2 * fixed + n * each;
}

bool prefers_stars(const Options& options, const Device& device) {
  if (options.strategy != Strategy::automatic) return options.strategy == Strategy::stars;
  return device.info().gpu && !takes_floats_only(device) && options.stabilize == Stabilize::off && !options.watch &&
         options.statistics != StatisticsDetail::timing;
}

std::size_t most_bytes(const Memory& memory, std::size_t n, bool stars) {
  if (!memory.keeps()) return least_bytes(n, false);
  const std::vector<std::size_t> words = reserved_words(memory, n, stars);
  const std::size_t small = memory.pools(n * word) ? 1 : 0;  // those that are not lent
  return 4 * fixed + n * word * std::accumulate(words.begin(), words.end(), small);
}

void reserve_buffers(Memory& memory, std::size_t n, bool stars) {
  std::vector<Allocation> together;
  // Sums have one more; what is larger may be all that fits the device's largest buffer.
  for (const std::size_t words : reserved_words(memory, n, stars))
    together.push_back(memory.allocate((n * words + (words <= 2 ? 1 : 0)) * word));
}

void require_size(std::size_t points) {
  if (points <= max_points()) return;
  throw LimitError("at most " + std::to_string(max_points()) + " points can be triangulated in one call, not " +
                       std::to_string(points) + ": split the input",
                   points, max_points());
}

void begin_budget(Triangulator::State& state, std::size_t n) {
  if (state.memory.dropped()) state.forget_sizes();
  // Of what is lent there are few, and each is for what is as large.
  const bool any_serves = n <= state.reserved_points && !state.memory.pools(state.reserved_points * word);
  state.memory.begin(state.options.max_memory, any_serves);
}

void begin_call(Triangulator::State& state, std::size_t n, Statistics& statistics) {
  require_rules(state.options, *state.device);
  const DeviceInfo& info = state.device->info();
  statistics.points = n;
  statistics.certified = true;  // no edge is illegal until one is found
  statistics.backend = to_string(info.backend);
  statistics.device = info.name;
  statistics.threads = state.device->threads();
  begin_budget(state, n);
}

std::size_t record_bytes(std::size_t n) { return n * 16 * word; }

bool fits_buffers(const Triangulator::State& state, std::size_t bytes) {
  const std::uint64_t largest = state.device->info().largest_buffer_bytes;
  return state.options.allocator != nullptr || largest == 0 || bytes <= largest;  // an allocator knows its own limits
}

void require_buffer(const Triangulator::State& state, std::size_t bytes) {
  if (fits_buffers(state, bytes)) return;
  const DeviceInfo& info = state.device->info();
  throw OutOfMemory("this needs a buffer of " + std::to_string(bytes) + " bytes and the largest of '" + info.name +
                        "' has " + std::to_string(info.largest_buffer_bytes) +
                        ": use fewer points or a device with larger buffers",
                    bytes, static_cast<std::size_t>(info.largest_buffer_bytes));
}

bool require_memory(Triangulator::State& state, std::size_t n, const CallShape& call) {
  const bool stars = prefers_stars(state.options, *state.device) &&
                     (state.options.strategy == Strategy::stars || n > most_wrapped_on_circles);
  require_buffer(state, stars ? star_pool_bytes(n) : record_bytes(n));
  const bool bounded = state.options.max_memory != 0;
  if (!stars) {
    if (n > state.known_points || bounded) state.memory.require(least_bytes(n, call.result_elsewhere));
    return false;
  }
  if (n <= state.known_star_points && !bounded) return call.saves_memory();
  if (!call.saves_memory() && state.memory.allows(star_bytes(n, call.input_stays, false))) return false;
  if (n > state.known_saving_points || bounded) state.memory.require(star_bytes(n, call.input_stays, true));
  return true;
}

void end_call(Triangulator::State& state, Context& ctx, bool ordered) {
  Statistics& statistics = ctx.statistics;
  const bool measured = ctx.options.statistics != StatisticsDetail::none || ctx.options.kernel_times;
  if (measured || !ordered || !ctx.options.queue) ctx.finish();
  statistics.launches = ctx.launcher.launches();
  statistics.kernels = ctx.launcher.kernel_times();
  statistics.bytes_device_peak = state.memory.peak();
  ctx.check("collect", 1);
}

void remember_size(Triangulator::State& state, const Statistics& statistics, bool saved_memory) {
  const auto n = static_cast<std::size_t>(statistics.points);
  state.known_points = std::max(state.known_points, n);
  if (statistics.proven_stars == 0) return;
  std::size_t& known = saved_memory ? state.known_saving_points : state.known_star_points;
  known = std::max(known, n);
}

}  // namespace cadt
