// SPDX-License-Identifier: Apache-2.0
// Where somebody is in a recording: step, play, slow motion, back.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cadt::viewer {

/// A position between the first and the last of `frames` snapshots.
class Playback {
 public:
  explicit Playback(std::size_t frames = 0) noexcept : last_(frames == 0 ? 0 : static_cast<double>(frames - 1)) {}

  /// Snapshots a second; negative: back, below 1: slow motion, 0: pause. From the end (or the start, back) it begins
  /// anew.
  void play(double speed) noexcept {
    speed_ = speed;
    if (speed > 0 && position_ >= last_) position_ = 0;
    if (speed < 0 && position_ <= 0) position_ = last_;
  }
  void pause() noexcept { speed_ = 0; }
  /// Time has passed. Stops at the ends.
  void advance(double seconds) noexcept {
    seek(position_ + speed_ * seconds);
    if ((speed_ > 0 && position_ >= last_) || (speed_ < 0 && position_ <= 0)) speed_ = 0;
  }
  /// So many snapshots on, or back; from between two the first step leads to one of them. Pauses.
  void step(int by) noexcept {
    pause();
    seek((by < 0 ? std::ceil(position_) : std::floor(position_)) + by);
  }
  void seek(double position) noexcept { position_ = std::clamp(position, 0.0, last_); }

  [[nodiscard]] bool playing() const noexcept { return speed_ != 0; }
  [[nodiscard]] double speed() const noexcept { return speed_; }
  [[nodiscard]] double position() const noexcept { return position_; }
  [[nodiscard]] double last() const noexcept { return last_; }
  /// The snapshot that is shown.
  [[nodiscard]] std::size_t frame() const noexcept { return static_cast<std::size_t>(position_); }

 private:
  double last_ = 0, position_ = 0, speed_ = 0;
};

}  // namespace cadt::viewer
