// SPDX-License-Identifier: Apache-2.0
// A progress line on the terminal; nothing when standard error is not a terminal.
#pragma once

#include <cadt/triangulation.hpp>

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace cadt::cli {

class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// A step of unknown length, e.g. "reading in.xy".
  void step(std::string_view text);
  /// Start of the triangulation of `points` points.
  void start(std::size_t points);
  /// At most ten lines a second are drawn. Never throws: the library calls it.
  void update(const Progress& progress) noexcept;
  /// Removes the line, so that messages start at the left edge.
  void clear() noexcept;

 private:
  using Clock = std::chrono::steady_clock;
  void draw(std::string_view text);

  bool shown_;
  std::size_t length_ = 0;  // of the line on the screen
  std::size_t points_ = 0;
  Clock::time_point start_, last_;
};

}  // namespace cadt::cli
