// SPDX-License-Identifier: Apache-2.0
// What the commands do with a directory of cadt tiles.
#pragma once

#include <cadt/verify.hpp>

#include <string>

namespace cadt::cli {

/// False in a program without the engine for tiles.
[[nodiscard]] bool is_mesh_directory(const std::string& path);
/// cadt info: prints what its manifest says. Returns the exit code.
int print_directory(const std::string& path, bool json);
/// cadt verify: prints the checks. Returns the exit code; throws Failure if one has failed.
int verify_directory(const std::string& path, unsigned threads, bool quiet);

/// A check as a line of cadt verify.
[[nodiscard]] std::string check_line(const Check& check);

}  // namespace cadt::cli
