// SPDX-License-Identifier: Apache-2.0
#include "viewer/growth/recording.hpp"

#include <cadt/triangulation.hpp>
#include <cadt/verify.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cadt::viewer {
namespace {

std::vector<std::uint16_t> narrowed(std::span<const std::uint32_t> counts) {
  constexpr std::uint32_t most = std::numeric_limits<std::uint16_t>::max();
  std::vector<std::uint16_t> result(counts.size());
  std::ranges::transform(counts, result.begin(),
                         [=](std::uint32_t c) { return static_cast<std::uint16_t>(std::min(c, most)); });
  return result;
}

/// Bytes of a snapshot of all points: two triangles a point of three vertices and two counts.
constexpr std::size_t bytes_a_point = 2 * (3 * sizeof(std::int32_t) + 2 * sizeof(std::uint16_t));

/// Points a launch for so many steps, if they have room; 0: levels alone.
std::size_t points_of_step(std::size_t points, const RecordingLimits& limits) {
  if (limits.steps == 0 || points == 0) return 0;
  // Levels take as much as three snapshots of the whole, a snapshot on the way half of one.
  const std::size_t whole = points * bytes_a_point;
  const std::size_t room = limits.most_bytes / whole > 3 ? 2 * (limits.most_bytes / whole - 3) : 0;
  const std::size_t steps = std::min(limits.steps, room);
  return steps == 0 ? 0 : std::max<std::size_t>(1, points / steps);
}

}  // namespace

std::size_t Recording::Frame::bytes() const noexcept {
  return triangles.size() * sizeof(std::int32_t) + (flips.size() + lost_locks.size()) * sizeof(std::uint16_t);
}

Recording::Recording(std::span<const double> xy, Options options, const RecordingLimits& limits)
    : xy_(xy), most_bytes_(limits.most_bytes), levels_(xy.size() / 2, std::numeric_limits<float>::quiet_NaN()) {
  options.order = Order::fast;
  options.tuning.strategy = Strategy::locks;
  options.tuning.watch_points = points_of_step(xy.size() / 2, limits);
  std::exception_ptr failure;  // watch must not throw
  options.tuning.watch = [&](const Snapshot& snapshot) {
    if (failure) return;
    try {
      keep(snapshot);
    } catch (...) {
      failure = std::current_exception();
    }
  };
  static_cast<void>(triangulate(PointsView(xy), options));
  if (failure) std::rethrow_exception(failure);
}

void Recording::keep(const Snapshot& snapshot) {
  for (const std::int32_t v : snapshot.triangles) {
    float& level = levels_[static_cast<std::size_t>(v)];
    if (std::isnan(level)) level = static_cast<float>(snapshot.level);
  }
  Frame frame;
  GrowthCounters& c = frame.counters;
  const Statistics& s = snapshot.statistics;
  c.level = snapshot.level;
  c.points = snapshot.points;
  c.triangles = snapshot.triangles.size() / 3;
  c.flips = s.flips;
  c.lost_locks = s.lock_failures;
  c.deferred_points = s.deferred_points;
  c.waiting_points = snapshot.waiting_points;
  c.waiting_edges = snapshot.waiting_edges;
  c.complete = snapshot.complete;
  frame.triangles.assign(snapshot.triangles.begin(), snapshot.triangles.end());
  frame.flips = narrowed(snapshot.flips);
  frame.lost_locks = narrowed(snapshot.lost_locks);
  const std::size_t bytes = frame.bytes();
  // The latest is the largest: without it there is most room for others.
  while (!frames_.empty() && bytes_ + bytes > most_bytes_) {
    bytes_ -= frames_.back().bytes();
    frames_.pop_back();
    ++dropped_;
  }
  bytes_ += bytes;
  frames_.push_back(std::move(frame));
}

std::vector<float> Recording::values(std::size_t frame, GrowthValue value) const {
  const Frame& of = frames_[frame];
  const std::vector<std::uint16_t>& counts = value == GrowthValue::flips ? of.flips : of.lost_locks;
  return {counts.begin(), counts.end()};
}

std::uint64_t Recording::illegal_edges(std::size_t frame) const {
  MeshView mesh;
  mesh.triangles = frames_[frame].triangles;
  VerifyOptions options;
  options.canonical_ties = false;
  const VerifyReport report = verify(PointsView(xy_), mesh, options);
  const auto found = std::ranges::find(report.checks, "delaunay", &Check::name);
  return found == report.checks.end() ? 0 : found->failures;
}

std::size_t Recording::frame_with_points(double points) const noexcept {
  const auto found =
      std::ranges::find_if(frames_, [&](const Frame& f) { return static_cast<double>(f.counters.points) >= points; });
  return found == frames_.end() ? frames_.size() - 1 : static_cast<std::size_t>(found - frames_.begin());
}

std::size_t Recording::frame_at(double share) const noexcept {
  if (share >= 1 || frames_.size() < 2) return frames_.size() - 1;
  const auto all = static_cast<double>(frames_.back().counters.points);
  // The last snapshot that has no more points than are due.
  const double due = std::max(0.0, share) * std::max(0.0, share) * all;
  std::size_t frame = 0;
  while (frame + 1 < frames_.size() && static_cast<double>(frames_[frame + 1].counters.points) <= due) ++frame;
  return frame;
}

}  // namespace cadt::viewer
