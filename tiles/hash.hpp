// SPDX-License-Identifier: Apache-2.0
// XXH3-128 of bytes: finds accidents, not malice.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace cadt::tiles {

[[nodiscard]] Hash128 hash_bytes(const void* bytes, std::size_t size, std::uint64_t seed = 0) noexcept;

/// Points that are read, and hashed, at a time: ranges of processes and threads begin at multiples of it.
inline constexpr std::size_t block_points = std::size_t{1} << 16;

/// Adds the hash of a block of points, x0 y0 x1 y1 ..., that begins with point `first`: those of all blocks in any
/// order give that of the content, whatever its files.
void add_block_hash(Hash128& content, std::uint64_t first, std::span<const double> xy);

/// The same of several blocks one after another, of which the first begins with point `first`.
void add_blocks_hash(Hash128& content, std::uint64_t first, std::span<const double> xy);

/// Of bytes that come in pieces.
class HashStream {
 public:
  HashStream();
  ~HashStream();
  HashStream(const HashStream&) = delete;
  HashStream& operator=(const HashStream&) = delete;
  void add(const void* bytes, std::size_t size);
  [[nodiscard]] Hash128 value() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// 32 hexadecimal digits, as Hash128::to_string writes them. \throws Error
[[nodiscard]] Hash128 hash_from_string(const std::string& text);

}  // namespace cadt::tiles
