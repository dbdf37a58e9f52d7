// SPDX-License-Identifier: Apache-2.0
#include "tiles/hash.hpp"

#include <cadt/errors.hpp>

#define XXH_INLINE_ALL  // nothing to link
#include <xxhash.h>

#include <algorithm>
#include <new>

namespace cadt::tiles {

Hash128 hash_bytes(const void* bytes, std::size_t size, std::uint64_t seed) noexcept {
  const XXH128_hash_t hash = XXH3_128bits_withSeed(bytes, size, seed);
  return {hash.high64, hash.low64};
}

void add_block_hash(Hash128& content, std::uint64_t first, std::span<const double> xy) {
  const Hash128 block = hash_bytes(xy.data(), xy.size_bytes(), first);
  content.high += block.high;
  content.low += block.low;
}

void add_blocks_hash(Hash128& content, std::uint64_t first, std::span<const double> xy) {
  for (; !xy.empty(); first += block_points) {
    const std::size_t size = std::min(xy.size(), 2 * block_points);
    add_block_hash(content, first, xy.first(size));
    xy = xy.subspan(size);
  }
}

struct HashStream::State {
  XXH3_state_t* xxh = XXH3_createState();
  ~State() { XXH3_freeState(xxh); }
};

HashStream::HashStream() : state_(std::make_unique<State>()) {
  if (state_->xxh == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(state_->xxh);
}
HashStream::~HashStream() = default;
void HashStream::add(const void* bytes, std::size_t size) {
  if (size != 0) XXH3_128bits_update(state_->xxh, bytes, size);
}
Hash128 HashStream::value() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_->xxh);
  return {hash.high64, hash.low64};
}

Hash128 hash_from_string(const std::string& text) {
  const bool fits = text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!fits) throw Error("'" + text + "' is not a hash: 32 lower-case hexadecimal digits are expected");
  return {std::stoull(text.substr(0, 16), nullptr, 16), std::stoull(text.substr(16), nullptr, 16)};
}

}  // namespace cadt::tiles
