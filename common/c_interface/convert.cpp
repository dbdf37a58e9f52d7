// SPDX-License-Identifier: Apache-2.0
#include "common/c_interface/convert.hpp"

#include <limits>
#include <memory>

namespace cadt::c_interface {
namespace {

static_assert(static_cast<int>(Backend::automatic) == CADT_BACKEND_AUTO &&
              static_cast<int>(Backend::host) == CADT_BACKEND_HOST);
static_assert(static_cast<int>(Backend::opencl) == CADT_BACKEND_OPENCL &&
              static_cast<int>(Backend::cuda) == CADT_BACKEND_CUDA);
static_assert(static_cast<int>(Order::canonical) == CADT_ORDER_CANONICAL &&
              static_cast<int>(Order::fast) == CADT_ORDER_FAST);
static_assert(static_cast<int>(KeepPoints::no) == CADT_KEEP_NO_POINTS &&
              static_cast<int>(KeepPoints::copy) == CADT_KEEP_COPY &&
              static_cast<int>(KeepPoints::view) == CADT_KEEP_VIEW);
static_assert(static_cast<int>(StatisticsDetail::none) == CADT_STATISTICS_NONE &&
              static_cast<int>(StatisticsDetail::counters) == CADT_STATISTICS_COUNTERS &&
              static_cast<int>(StatisticsDetail::timing) == CADT_STATISTICS_TIMING);
static_assert(static_cast<int>(Strategy::automatic) == CADT_STRATEGY_AUTO &&
              static_cast<int>(Strategy::locks) == CADT_STRATEGY_LOCKS &&
              static_cast<int>(Strategy::stars) == CADT_STRATEGY_STARS);
static_assert(static_cast<int>(Scalar::float64) == CADT_FLOAT64 && static_cast<int>(Scalar::float32) == CADT_FLOAT32);
static_assert(sizeof(Duplicate) == sizeof(cadt_duplicate) &&
              offsetof(Duplicate, point) == offsetof(cadt_duplicate, point) &&
              offsetof(Duplicate, representative) == offsetof(cadt_duplicate, representative));

class CallersAllocator : public DeviceAllocator {
 public:
  explicit CallersAllocator(const cadt_options& options) : options_(options) {}
  void* allocate(std::size_t bytes, void* queue) noexcept override {
    return options_.allocate(bytes, queue, options_.user);
  }
  void deallocate(void* memory, std::size_t bytes, void* queue) noexcept override {
    options_.deallocate(memory, bytes, queue, options_.user);
  }

 private:
  cadt_options options_;
};

}  // namespace

CallOptions::CallOptions(const cadt_options* from) {
  if (from == nullptr) return;
  const cadt_options given = take(from, "options");
  options_.backend = constant<Backend>(given.backend, CADT_BACKEND_CUDA, "options->backend");
  options_.order = constant<Order>(given.order, CADT_ORDER_FAST, "options->order");
  options_.keep_points = constant<KeepPoints>(given.keep_points, CADT_KEEP_VIEW, "options->keep_points");
  options_.statistics = constant<StatisticsDetail>(given.statistics, CADT_STATISTICS_TIMING, "options->statistics");
  options_.tuning.strategy = constant<Strategy>(given.strategy, CADT_STRATEGY_STARS, "options->strategy");
  options_.tuning.work_group_size = given.work_group_size;
  if (given.device != nullptr) options_.device = given.device;
  options_.threads = given.threads;
  options_.max_memory = static_cast<std::size_t>(given.max_memory);
  if (given.has_queue != 0) options_.queue = given.queue;
  if ((given.allocate == nullptr) != (given.deallocate == nullptr))
    throw InvalidArgument("options->allocate", "allocate and deallocate are given together or not at all");
  if (given.allocate != nullptr) options_.allocator = std::make_shared<CallersAllocator>(given);
  callbacks_ = given;
}

Options CallOptions::begin_call() const {
  Options options = options_;
  if (callbacks_.progress == nullptr && callbacks_.cancelled == nullptr) return options;
  cadt::stop_source stop;
  options.stop = stop.get_token();
  if (callbacks_.cancelled != nullptr && callbacks_.cancelled(callbacks_.user) != 0) stop.request_stop();
  options.progress = [asked = callbacks_, stop](const Progress& now) mutable {
    // The names of phases are literals, which end with a zero.
    if (asked.progress != nullptr) asked.progress(now.phase.data(), now.fraction, asked.user);
    if (asked.cancelled != nullptr && asked.cancelled(asked.user) != 0) stop.request_stop();
  };
  return options;
}

PointsView points_of(const cadt_points* points) {
  const cadt_points& p = required(points, "points");
  const auto scalar = constant<Scalar>(p.scalar, CADT_FLOAT32, "points->scalar");
  const std::size_t size = scalar == Scalar::float64 ? sizeof(double) : sizeof(float),
                    least = p.y != nullptr ? size : 2 * size;
  const std::size_t stride = p.stride != 0 ? p.stride : least;
  if (p.count == 0) return {};
  require(p.x, "points->x");
  if (stride < least)
    throw InvalidArgument("points->stride",
                          "it is " + std::to_string(stride) + " bytes, a point has " + std::to_string(least));
  const auto* x = static_cast<const std::byte*>(p.x);
  const std::byte* y = p.y != nullptr ? static_cast<const std::byte*>(p.y) : x + size;
  if (scalar == Scalar::float64)
    return PointsView::strided(reinterpret_cast<const double*>(x), reinterpret_cast<const double*>(y), p.count, stride);
  return PointsView::strided(reinterpret_cast<const float*>(x), reinterpret_cast<const float*>(y), p.count, stride);
}

DevicePoints points_of(const cadt_device_points* points) {
  const cadt_device_points& p = required(points, "points");
  const auto scalar = constant<Scalar>(p.scalar, CADT_FLOAT32, "points->scalar");
  if (p.count != 0) require(p.x, "points->x");
  return {.x = p.x, .y = p.y, .size = p.count, .scalar = scalar, .skip = p.skip};
}

std::span<const std::size_t> offsets_of(const std::size_t* offsets, std::size_t sets) {
  require(offsets, "offsets");
  if (sets > max_points())
    throw LimitError("at most " + std::to_string(max_points()) + " sets in one call", sets, max_points());
  return {offsets, sets + 1};
}

std::size_t indices_of(std::size_t triangles) {
  constexpr std::size_t most = 2 * max_points();
  if (triangles > most) throw LimitError("at most " + std::to_string(most) + " triangles", triangles, most);
  return 3 * triangles;
}

KeepPoints keep_points_of(std::int32_t number) { return constant<KeepPoints>(number, CADT_KEEP_VIEW, "keep_points"); }

void give_statistics(const Statistics& from, cadt_statistics* to) {
  cadt_statistics s{};
  s.backend = from.backend.c_str();
  s.device = from.device.c_str();
  s.threads = from.threads;
  s.points = from.points;
  s.distinct = from.distinct;
  s.launches = from.launches;
  s.lock_attempts = from.lock_attempts;
  s.lock_failures = from.lock_failures;
  s.flips = from.flips;
  s.exact_orientations = from.exact_orientations;
  s.exact_incircles = from.exact_incircles;
  s.ties = from.ties;
  s.proven_stars = from.proven_stars;
  s.wrapped_stars = from.wrapped_stars;
  s.sets = from.sets;
  s.batched_sets = from.batched_sets;
  s.bytes_device_peak = from.bytes_device_peak;
  for (const auto& [phase, milliseconds] : from.milliseconds) s.milliseconds += milliseconds;
  s.certified = from.certified ? 1 : 0;
  s.bytes_to_device = from.bytes_to_device;
  s.bytes_from_device = from.bytes_from_device;
  s.inserted_segments = from.inserted_segments;
  s.segment_retries = from.segment_retries;
  give(to, s, "statistics");
}

void give_device(const DeviceInfo& from, cadt_device_info* to) {
  cadt_device_info d{};
  d.backend = static_cast<std::int32_t>(from.backend);
  d.index = from.index;
  d.platform = from.platform.c_str();
  d.name = from.name.c_str();
  d.driver = from.driver.c_str();
  d.reason = from.reason.c_str();
  d.atomics = from.atomics.c_str();
  d.memory_bytes = from.memory_bytes;
  d.largest_buffer_bytes = from.largest_buffer_bytes;
  d.compute_units = from.compute_units;
  d.usable = from.usable ? 1 : 0;
  d.fp64 = from.fp64 ? 1 : 0;
  d.gpu = from.gpu ? 1 : 0;
  d.watchdog = from.watchdog ? 1 : 0;
  give(to, d, "info");
}

const cadt_duplicate* list_of(std::span<const Duplicate> duplicates) noexcept {
  return reinterpret_cast<const cadt_duplicate*>(duplicates.data());
}

}  // namespace cadt::c_interface
