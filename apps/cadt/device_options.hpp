// SPDX-License-Identifier: Apache-2.0
// The options that say where to compute, shared by the commands that triangulate.
#pragma once

#include <cadt/triangulation.hpp>

#include <CLI/CLI.hpp>

#include <string>

namespace cadt::cli {

struct DeviceOptions {
  std::string backend = "auto", device, max_memory;
  unsigned threads = 0;
};

/// Adds --backend, --device and --threads.
void add_device_options(CLI::App& command, DeviceOptions& options);
/// Adds --max-memory.
void add_memory_option(CLI::App& command, DeviceOptions& options);
/// The library's options with these set. Throws Failure (usage) for a size that is none.
[[nodiscard]] Options library_options(const DeviceOptions& options);

}  // namespace cadt::cli
