// SPDX-License-Identifier: Apache-2.0
#include "common/driver/gpu_bound.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <string>
#include <vector>

#include <cadt/triangulation.hpp>

namespace cadt {
namespace {

/// Scattered points, the same in each process.
std::vector<double> sample_points() {
  std::vector<double> xy(2 * GpuBound::sample);
  std::uint64_t state = 1;
  for (double& v : xy) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    v = static_cast<double>(state >> 11);
  }
  return xy;
}

}  // namespace

std::size_t GpuBound::crossing(double host_seconds, double gpu_seconds) noexcept {
  const double points = static_cast<double>(sample) * gpu_seconds / host_seconds;
  return static_cast<std::size_t>(std::clamp(points, 1e3, 1e8));
}

GpuBound& gpu_bound() noexcept {
  static GpuBound bound;
  return bound;
}

void measure_gpu_bound(const DeviceInfo& gpu, const Options& used) noexcept {
  const auto seconds_of_call = [&](Backend backend) {
    static const std::vector<double> xy = sample_points();
    Options options;
    options.threads = used.threads;
    options.backend = backend;
    if (backend == gpu.backend) options.device = std::to_string(gpu.index);
    const auto start = std::chrono::steady_clock::now();
    (void)triangulate(std::span<const double>(xy), options);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  gpu_bound().measure([&] { return seconds_of_call(Backend::host); }, [&] { return seconds_of_call(gpu.backend); });
}

}  // namespace cadt
