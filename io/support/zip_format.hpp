// SPDX-License-Identifier: Apache-2.0
// Numbers of the ZIP format that its writer and reader share.
#pragma once

#include <zlib.h>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace cadt::io::detail::zip {

inline constexpr std::uint32_t local_signature = 0x04034b50;
inline constexpr std::uint32_t entry_signature = 0x02014b50;
inline constexpr std::uint32_t end_signature = 0x06054b50;
inline constexpr std::uint32_t end64_signature = 0x06064b50;
inline constexpr std::uint32_t locator64_signature = 0x07064b50;

inline constexpr std::size_t local_size = 30, entry_size = 46, end_size = 22, end64_size = 56, locator64_size = 20;

inline constexpr std::uint32_t in_extra = 0xffffffff;  ///< the number is in the 64-bit extra field
inline constexpr std::uint16_t extra64 = 1;            ///< tag of that field
inline constexpr std::uint16_t stored = 0, deflated = 8;

/// CRC-32 of one block after another, starting from 0.
[[nodiscard]] inline std::uint32_t checksum(std::uint32_t crc, std::string_view bytes) {
  if (bytes.empty()) return crc;  // zlib starts anew for a null pointer
  return static_cast<std::uint32_t>(::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace cadt::io::detail::zip
