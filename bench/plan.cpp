// SPDX-License-Identifier: Apache-2.0
#include "bench/plan.hpp"

namespace cadt::bench {
namespace {

constexpr std::size_t M = 1000000;
constexpr std::size_t no_limit = static_cast<std::size_t>(-1);

Plan full() {
  Plan plan{};
  plan.warm_up = 1;
  plan.runs = 5;           // "recorded after 5 trials as average" (paper, section 5.2)
  plan.limit_seconds = 7;  // so that all of it takes less than ten minutes
  for (std::size_t n = 1 << 20; n <= std::size_t{1} << 27; n *= 2) plan.sizes.push_back(n);
  plan.sizes.insert(plan.sizes.begin(), {8192, 65536, 524288});
  plan.one_thread_up_to = 1 << 21;
  plan.block_points = {8192, 131072, 1048576, 8388608};
  plan.blocks = {32, 64, 128, 256, 512, 1024};
  plan.breakdown_points = 8388608;
  // 8 m^2 points each, which `circles` makes exactly: times per point are compared.
  plan.distribution_sizes = {131072, 2097152, 8388608};
  plan.others_up_to = 2097152;
  plan.real_points_least = 30000;
  plan.real_points_most = no_limit;
  plan.snapshot_points = 2048;
  plan.flips_uniform = 100000;
  plan.flips_circles = M;
  plan.threshold_points = 524288;
  plan.largest_threshold = 10;
  plan.works = {477, M, 21214412};
  plan.statistics_points = 16777216;
  plan.device_sizes = {524288, 8388608};
  plan.kernel_points = 8388608;
  plan.copied_bytes = std::size_t{1} << 30;
  return plan;
}

Plan small() {
  Plan plan = full();
  plan.runs = 3;
  plan.limit_seconds = 8;
  plan.sizes = {8192, 65536, 524288, 1048576, 2097152};
  plan.one_thread_up_to = 524288;
  plan.block_points = {8192, 131072};
  plan.breakdown_points = 524288;
  plan.distribution_sizes = {32768, 131072};
  plan.real_points_most = 200000;
  plan.threshold_points = 131072;
  plan.statistics_points = 524288;
  plan.device_sizes = {32768, 524288};
  plan.kernel_points = 1048576;
  plan.copied_bytes = std::size_t{1} << 28;
  return plan;
}

Plan tiny() {
  Plan plan = small();
  plan.warm_up = 0;
  plan.runs = 2;
  plan.limit_seconds = 2;
  plan.sizes = {500, 2000};
  plan.one_thread_up_to = 500;
  plan.block_points = {2000};
  plan.blocks = {64, 256};
  plan.breakdown_points = 2048;
  plan.distribution_sizes = {512};
  plan.real_points_most = 32000;
  plan.flips_uniform = 2000;
  plan.flips_circles = 3200;
  plan.threshold_points = 512;
  plan.largest_threshold = 3;
  plan.works = {477, 1000};
  plan.statistics_points = 2000;
  plan.device_sizes = {512};
  plan.kernel_points = 4000;
  plan.copied_bytes = std::size_t{1} << 22;
  return plan;
}

}  // namespace

std::string_view to_string(Scale scale) noexcept {
  return scale == Scale::tiny ? "tiny" : scale == Scale::small ? "small" : "full";
}

Plan plan_of(Scale scale) { return scale == Scale::tiny ? tiny() : scale == Scale::small ? small() : full(); }

}  // namespace cadt::bench
