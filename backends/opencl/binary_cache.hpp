// SPDX-License-Identifier: Apache-2.0
// Built programs on disk. A convenience only: nothing here throws, and whatever is wrong with a file or the directory
// means that the program is built from source.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cadt::opencl {

/// 128 bits over a list of texts; their lengths count, so that ("ab", "c") differs from ("a", "bc").
struct Digest {
  std::uint64_t high = 0, low = 0;
  friend bool operator==(const Digest&, const Digest&) = default;
  [[nodiscard]] std::string hex() const;
};
[[nodiscard]] Digest digest_of(std::span<const std::string> texts);
[[nodiscard]] Digest digest_of(std::span<const unsigned char> bytes);

/// $CADT_CACHE_DIR, else $XDG_CACHE_HOME/cadt, else $HOME/.cache/cadt. Empty (no cache) if CADT_CACHE_DIR is set to
/// nothing, or no variable tells where.
[[nodiscard]] std::filesystem::path cache_directory();

/// The binary that was stored for this key, if its file is there, complete and undamaged.
[[nodiscard]] std::optional<std::vector<unsigned char>> load_binary(const std::filesystem::path& directory, Digest key);

/// Replaces the file in one step: readers see the old one or the new one, whole. True if it was written.
bool store_binary(const std::filesystem::path& directory, Digest key, std::span<const unsigned char> binary) noexcept;

/// Where `store_binary` puts it.
[[nodiscard]] std::filesystem::path cache_file(const std::filesystem::path& directory, Digest key);

}  // namespace cadt::opencl
