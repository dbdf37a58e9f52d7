// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

#include "failure.hpp"
#include "system.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cadt::cli {
namespace {

std::string rate(double per_second) {
  if (per_second >= 1e6) return fmt::format("{:.1f}M points/s", per_second / 1e6);
  if (per_second >= 1e3) return fmt::format("{:.0f}k points/s", per_second / 1e3);
  return fmt::format("{:.0f} points/s", per_second);
}

}  // namespace

ProgressLine::ProgressLine(bool quiet) : shown_(!quiet && errors_go_to_terminal()) {}

void ProgressLine::step(std::string_view text) {
  if (shown_) draw(text);
}

void ProgressLine::start(std::size_t points) {
  points_ = points;
  start_ = Clock::now();
  last_ = start_ - std::chrono::seconds(1);
}

void ProgressLine::update(const Progress& progress) noexcept {
  if (!shown_) return;
  const auto now = Clock::now();
  if (now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  try {
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double done = progress.fraction * static_cast<double>(points_);
    std::string line = fmt::format("{:<10} {:3.0f} %", progress.phase, 100 * progress.fraction);
    if (seconds > 0 && done > 0) line += fmt::format("  {}", rate(done / seconds));
    draw(line);
  } catch (...) {  // a line that cannot be drawn is no reason to stop
  }
}

void ProgressLine::clear() noexcept {
  if (length_ == 0) return;
  try {
    say(fmt::format("\r{:{}}\r", "", length_));
  } catch (...) {
    say("\n");
  }
  length_ = 0;
}

void ProgressLine::draw(std::string_view text) {
  // A line that wraps cannot be overwritten, so it is cut to the terminal.
  const std::string_view cut = text.substr(0, terminal_width() - 1);
  say(fmt::format("\r{:<{}}", cut, std::max(cut.size(), length_)));
  length_ = std::max(cut.size(), length_);
}

}  // namespace cadt::cli
