// SPDX-License-Identifier: Apache-2.0
// Cache of built programs on disk. Nothing here throws: if a file or the directory is unusable, the program is built
// from source.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cadt::opencl {

/// 128-bit hash of a list of texts; it covers their lengths, so that ("ab", "c") differs from ("a", "bc").
struct Digest {
  std::uint64_t high = 0, low = 0;
  friend bool operator==(const Digest&, const Digest&) = default;
  [[nodiscard]] std::string hex() const;
};
[[nodiscard]] Digest digest_of(std::span<const std::string> texts);
[[nodiscard]] Digest digest_of(std::span<const unsigned char> bytes);

/// $CADT_CACHE_DIR, else $XDG_CACHE_HOME/cadt, else $HOME/.cache/cadt. Empty (no cache) if CADT_CACHE_DIR is empty, or
/// none of the variables is set.
[[nodiscard]] std::filesystem::path cache_directory();

/// The binary stored for this key, if its file exists, complete and undamaged.
[[nodiscard]] std::optional<std::vector<unsigned char>> load_binary(const std::filesystem::path& directory, Digest key);

/// Replaces the file atomically: readers see the old or the new one, complete. Returns whether it was written.
bool store_binary(const std::filesystem::path& directory, Digest key, std::span<const unsigned char> binary) noexcept;

/// The file that store_binary writes.
[[nodiscard]] std::filesystem::path cache_file(const std::filesystem::path& directory, Digest key);

}  // namespace cadt::opencl
