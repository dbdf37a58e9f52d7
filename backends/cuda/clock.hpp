// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "backends/cuda/context.hpp"
#include "common/driver/device.hpp"

namespace cadt::cuda {

/// Kernel times by events before and after them in the stream. A kernel launched into an empty stream begins some
/// microseconds after the event; that gap is part of its time.
class CudaClock final : public KernelClock {
 public:
  explicit CudaClock(std::shared_ptr<Stream> stream) noexcept : stream_(std::move(stream)) {}
  ~CudaClock() override;
  CudaClock(const CudaClock&) = delete;
  CudaClock& operator=(const CudaClock&) = delete;

  void begin() override { record(2 * pairs_); }
  void end() override {
    record(2 * pairs_ + 1);
    ++pairs_;
  }
  [[nodiscard]] std::vector<double> read() override;
  void clear() noexcept override { pairs_ = 0; }

 private:
  void record(std::size_t number);
  void check_call(cudaError_t code, const char* call) const { check(code, call, stream_->name()); }

  std::shared_ptr<Stream> stream_;
  std::vector<cudaEvent_t> events_;  ///< cached for later runs
  std::size_t pairs_ = 0;            ///< pairs in use
};

}  // namespace cadt::cuda
