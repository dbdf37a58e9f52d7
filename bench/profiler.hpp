// SPDX-License-Identifier: Apache-2.0
// Counters of CUDA kernels from NVIDIA's profiler, where it is installed.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::bench {

/// Of all launches of a kernel.
struct Profiled {
  double issue_active = 0;  ///< cycles with an instruction issued, in per cent of those with work; mean over the time
  double dram_throughput = 0;  ///< per cent of what the memory can do, by the profiler; mean over the time
  double dram_bytes = 0;
  double operations = 0;  ///< additions and multiplications in floating point, single and double; a fused pair is two
  double nanoseconds = 0;
};

struct Profile {
  std::map<std::string, Profiled, std::less<>> kernels;  ///< by the names of Statistics::kernels
  std::string failure;                                   ///< why there are none, else empty
};

/// Reads what `ncu --csv --page raw --print-units base` wrote.
[[nodiscard]] Profile read_profile(std::string_view text);

/// Runs a command under ncu. Slow: each kernel is replayed several times.
[[nodiscard]] Profile profile(const std::vector<std::string>& command, double timeout_seconds);

}  // namespace cadt::bench
