// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "backends/opencl/cl.hpp"
#include "backends/opencl/platform.hpp"
#include "common/driver/kernel_id.hpp"

namespace cadt::opencl {

/// How the atomics are chosen; the last two are for tests.
enum class AtomicsChoice { automatic, always_probe, best_effort };

/// One way to build the atomics.
struct AtomicsPath {
  std::string text;     ///< for DeviceInfo::atomics
  std::string options;  ///< for the compiler
};

/// Acquire/release at device scope if the device advertises them or its compiler accepts them, else the OpenCL 1.2
/// path.
[[nodiscard]] AtomicsPath choose_atomics(const cl::Context& context, const FoundDevice& device, AtomicsChoice choice);

/// Compiler options of one variant of the kernels.
[[nodiscard]] std::string build_options(const FoundDevice& device, const AtomicsPath& atomics, KernelVariant variant,
                                        const std::string& extra);

/// Builds the source, or loads an earlier build from disk; `from_cache` (may be null) says which. \throws
/// KernelBuildError with the compiler's log, DeviceError
[[nodiscard]] cl::Program build_program(const cl::Context& context, const FoundDevice& device,
                                        const std::string& source, const std::string& options, bool* from_cache);

}  // namespace cadt::opencl
