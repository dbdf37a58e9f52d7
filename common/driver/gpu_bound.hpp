// SPDX-License-Identifier: Apache-2.0
// From how many points on the free function triangulate() takes a GPU by itself.
#pragma once

#include <cadt/devices.hpp>
#include <cadt/options.hpp>

#include <atomic>
#include <cstddef>

namespace cadt {

class GpuBound {
 public:
  /// Until a GPU is open in the process: opening its context takes 200 milliseconds and more, and one core of the host
  /// triangulates so many points in 100.
  static constexpr std::size_t before_opening = 200'000;

  /// Fewest points for which the GPU is taken.
  [[nodiscard]] std::size_t points() const noexcept { return points_.load(std::memory_order_relaxed); }

  /// After the first call that took a GPU by itself: times whole calls of `sample` points on the host and on the GPU,
  /// the second of two each, and moves the bound to where the lines cross. Once; if a call fails, the bound stays.
  /// \param on_host, on_gpu  each makes a call and returns its seconds
  template <class OnHost, class OnGpu>
  void measure(OnHost on_host, OnGpu on_gpu) noexcept {
    if (measured_.test_and_set()) return;
    try {
      (void)on_host();
      (void)on_gpu();
      const double host_seconds = on_host();
      points_ = crossing(host_seconds, on_gpu());
    } catch (...) {  // the caller has the mesh; what could not be timed is no concern of theirs
    }
  }

  static constexpr std::size_t sample = 20'000;
  /// Points at which the host, whose time grows with them, takes as long as a GPU does for any small set. Between 1,000
  /// and 100 million.
  [[nodiscard]] static std::size_t crossing(double host_seconds, double gpu_seconds) noexcept;

 private:
  std::atomic<std::size_t> points_{before_opening};
  std::atomic_flag measured_;
};

/// That of the process: Backend::automatic always takes the same GPU.
[[nodiscard]] GpuBound& gpu_bound() noexcept;

/// After a call with `used` that took this device by itself.
void measure_gpu_bound(const DeviceInfo& gpu, const Options& used) noexcept;

}  // namespace cadt
