// SPDX-License-Identifier: Apache-2.0
// Memory and disk that a run may take.
#pragma once

#include <cstdint>
#include <string>

#include "io/support/human_bytes.hpp"

namespace cadt::tiles {

/// Bytes of memory that this process can still get: what the system has available and what the limit of the address
/// space (ulimit -v) leaves. ~0 if unknown.
[[nodiscard]] std::uint64_t available_memory() noexcept;

/// Bytes that can be written to the file system of a path, or of the folder that it will be made in. \throws
/// io::FileError if there is no such folder
[[nodiscard]] std::uint64_t available_disk(const std::string& path);
/// \throws io::FileError if that is less than `bytes`
void require_disk(const std::string& path, std::uint64_t bytes);
/// Of regular files in a folder and below; 0 if there is none.
[[nodiscard]] std::uint64_t bytes_in_folder(const std::string& path) noexcept;
/// Whether both are on one file system.
[[nodiscard]] bool same_disk(const std::string& a, const std::string& b) noexcept;

using io::detail::human_bytes;

}  // namespace cadt::tiles
