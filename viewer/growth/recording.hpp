// SPDX-License-Identifier: Apache-2.0
// A mesh while it grows, kept to be looked at: forwards, backwards, slowly. No OpenGL.
#pragma once

#include <cadt/options.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::viewer {

struct RecordingLimits {
  /// Of all snapshots together. The complete mesh is kept in any case.
  std::size_t most_bytes = std::size_t{1} << 30;
  /// Snapshots wanted, beside one for each level. As many as `most_bytes` has room for; 0: levels alone.
  std::size_t steps = 0;
};

/// The counters of one moment.
struct GrowthCounters {
  unsigned level = 0;
  std::size_t points = 0, triangles = 0;
  std::uint64_t flips = 0, lost_locks = 0, deferred_points = 0;  ///< so far
  std::uint64_t waiting_points = 0, waiting_edges = 0;           ///< for the next launch
  bool complete = false;
};

/// What a triangle can be coloured by while the mesh grows.
enum class GrowthValue {
  flips,      ///< of its three edges so far
  lost_locks  ///< attempts to lock it that failed (timed kernels alone)
};

/// All snapshots of one triangulation by insertion with locks.
class Recording {
 public:
  /// Triangulates. `options` are the caller's but for strategy and watch; its stop token and progress are heeded. Lost
  /// locks of triangles are recorded with StatisticsDetail::timing alone. \pre xy (interleaved) outlives the recording
  /// \throws what triangulate() throws
  Recording(std::span<const double> xy, Options options, const RecordingLimits& limits = {});

  /// 0 for points without triangles.
  [[nodiscard]] std::size_t size() const noexcept { return frames_.size(); }
  /// Snapshots that had no room.
  [[nodiscard]] std::size_t dropped() const noexcept { return dropped_; }
  /// Of the triangles and values that are kept.
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

  /// n x 3 indices of points. \pre frame < size(), as for all below
  [[nodiscard]] std::span<const std::int32_t> triangles(std::size_t frame) const { return frames_[frame].triangles; }
  [[nodiscard]] const GrowthCounters& counters(std::size_t frame) const { return frames_[frame].counters; }
  /// One a triangle. Counts above 65,535 are that. Empty for lost locks that were not recorded.
  [[nodiscard]] std::vector<float> values(std::size_t frame, GrowthValue value) const;
  /// One a point: the level at which it was inserted; NaN for duplicates. A triangle has the level of its youngest
  /// vertex.
  [[nodiscard]] std::span<const float> levels() const noexcept { return levels_; }
  /// Interior edges that are not Delaunay yet, by exact arithmetic. O(triangles) each time.
  [[nodiscard]] std::uint64_t illegal_edges(std::size_t frame) const;

  /// The first snapshot with at least so many points, or the last one.
  [[nodiscard]] std::size_t frame_with_points(double points) const noexcept;
  /// The frame for a share of the time of a film, 0 to 1: points grow with the square of time, so that the first levels
  /// can be seen. 1 is the complete mesh.
  [[nodiscard]] std::size_t frame_at(double share) const noexcept;

 private:
  struct Frame {
    GrowthCounters counters;
    std::vector<std::int32_t> triangles;
    std::vector<std::uint16_t> flips, lost_locks;
    [[nodiscard]] std::size_t bytes() const noexcept;
  };

  void keep(const Snapshot& snapshot);

  std::span<const double> xy_;
  std::size_t most_bytes_, bytes_ = 0, dropped_ = 0;
  std::vector<Frame> frames_;
  std::vector<float> levels_;
};

}  // namespace cadt::viewer
