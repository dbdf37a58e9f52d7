// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <unistd.h>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

namespace cadt::tiles {

/// Bytes that the system can give to processes, its cache of files included. Allocates nothing: it is asked when there
/// is no memory left.
[[nodiscard]] inline std::optional<std::uint64_t> memory_of_system() noexcept {
  const int file = ::open("/proc/meminfo", O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  std::array<char, 1024> buffer{};
  const ::ssize_t size = ::read(file, buffer.data(), buffer.size());
  ::close(file);
  constexpr std::string_view key = "MemAvailable:";  // among the first lines
  const std::string_view text(buffer.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  std::size_t at = text.find(key);
  if (at != text.npos) at = text.find_first_not_of(' ', at + key.size());
  std::uint64_t kib = 0;
  if (at == text.npos || std::from_chars(text.data() + at, text.data() + text.size(), kib).ec != std::errc())
    return std::nullopt;
  return kib << 10;
}

}  // namespace cadt::tiles
