// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "backends/opencl/cl.hpp"
#include "common/driver/device.hpp"

namespace cadt::opencl {

/// Kernel times by the events of their launches; gaps between launches do not count.
class ClClock final : public KernelClock {
 public:
  explicit ClClock(std::string device) : device_(std::move(device)) {}
  /// Event for the next launch; null outside of begin and end.
  [[nodiscard]] cl::Event* next() { return running_ ? &current_.emplace_back() : nullptr; }

  void begin() override {
    current_.clear();
    running_ = true;
  }
  void end() override {
    done_.push_back(std::move(current_));
    current_.clear();
    running_ = false;
  }
  [[nodiscard]] std::vector<double> read() override;
  void clear() noexcept override {
    current_.clear();
    done_.clear();
    running_ = false;
  }

 private:
  std::string device_;
  std::vector<cl::Event> current_;            ///< launches since begin
  std::vector<std::vector<cl::Event>> done_;  ///< a primitive has several launches
  bool running_ = false;
};

}  // namespace cadt::opencl
