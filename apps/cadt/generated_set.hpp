// SPDX-License-Identifier: Apache-2.0
// --generate, -n and --seed of commands that take a generated point set in place of files.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

namespace cadt::cli {

/// `n` holds its default.
void add_generated_set(CLI::App& command, std::string& set, std::string& n, std::uint64_t& seed);

}  // namespace cadt::cli
