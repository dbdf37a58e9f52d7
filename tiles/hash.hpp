// SPDX-License-Identifier: Apache-2.0
// XXH3-128 of bytes: finds accidents, not malice.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace cadt::tiles {

[[nodiscard]] Hash128 hash_bytes(const void* bytes, std::size_t size, std::uint64_t seed = 0) noexcept;

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
