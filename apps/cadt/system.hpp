// SPDX-License-Identifier: Apache-2.0
// What the program asks of the operating system.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace cadt::cli {

/// Whether somebody watches standard error, and how wide the line is.
[[nodiscard]] bool errors_go_to_terminal() noexcept;
[[nodiscard]] std::size_t terminal_width() noexcept;

/// Memory that the system can give, in bytes, without allocating any.
[[nodiscard]] std::optional<std::uint64_t> free_memory() noexcept;

/// Whether this process may write there; else errno says why. A folder: whether it may make files in it.
[[nodiscard]] bool may_write(const std::string& path) noexcept;

[[nodiscard]] long process_number() noexcept;

}  // namespace cadt::cli
