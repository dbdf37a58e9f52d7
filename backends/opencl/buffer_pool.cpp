// SPDX-License-Identifier: Apache-2.0
#include "backends/opencl/buffer_pool.hpp"

#include <algorithm>
#include <utility>

namespace cadt::opencl {
namespace {

/// Smaller buffers are not pooled: all of them take little memory, and caching them saves time.
constexpr std::size_t least_pooled = std::size_t{1} << 18;
/// Parts begin at multiples of this, or of what the device asks for.
constexpr std::size_t part_step = 4096;
/// Pooled buffers are larger by what this alignment costs a few parts.
constexpr std::size_t slack = 4 * part_step;

}  // namespace

BufferPool::BufferPool(std::size_t alignment, std::uint64_t largest_buffer) noexcept
    : step_(std::max(part_step, alignment)), largest_buffer_(largest_buffer) {}

bool BufferPool::pools(std::size_t bytes) const noexcept { return !bounded() && bytes >= least_pooled; }

std::size_t BufferPool::new_size(std::size_t bytes, Lifetime lifetime) const noexcept {
  if (!pools(bytes)) return BufferCache::new_size(bytes, lifetime);
  if (lifetime != Lifetime::kept) return bytes;
  const std::size_t more = bytes + slack;
  return largest_buffer_ == 0 || more <= largest_buffer_ ? more
                                                         : std::max(bytes, static_cast<std::size_t>(largest_buffer_));
}

std::unique_ptr<Buffer> BufferPool::take(std::size_t bytes, Lifetime lifetime) {
  if (lifetime == Lifetime::unpooled) return nullptr;
  if (lifetime == Lifetime::kept) return BufferCache::take(bytes, lifetime);
  return take_part(bytes, lifetime == Lifetime::ends_first);
}

std::size_t BufferPool::room(const Parted& from, std::size_t bytes) noexcept {
  std::size_t at = 0;
  for (const Part& part : from.parts) {
    if (part.begin - at >= bytes) return at;
    at = part.end;
  }
  return from.whole->bytes() - at >= bytes ? at : from.whole->bytes();
}

std::unique_ptr<Buffer> BufferPool::take_part(std::size_t bytes, bool ends_first) {
  // What ends first may use the largest buffer, which is asked for next; else the smallest with room.
  const auto better = [&](const Buffer& one, const Buffer* best) {
    return best == nullptr || (ends_first ? one.bytes() > best->bytes() : one.bytes() < best->bytes());
  };
  Buffer* best = nullptr;
  std::size_t at = parted_.size(), unused = idle().size();
  for (std::size_t i = 0; i < parted_.size(); ++i) {
    Buffer& whole = *parted_[i].whole;
    if (room(parted_[i], bytes) < whole.bytes() && better(whole, best)) best = &whole, at = i;
  }
  for (std::size_t i = 0; i < idle().size(); ++i)  // a buffer that just fits will be asked for as a whole
    if (idle()[i]->bytes() / 5 * 4 >= bytes && better(*idle()[i], best)) best = idle()[i].get(), unused = i;
  if (best == nullptr) return nullptr;

  // Until the part is made nothing changes: that may fail.
  const bool first = unused < idle().size();
  Parted fresh;
  if (first) parted_.reserve(parted_.size() + 1);
  std::vector<Part>& parts = first ? fresh.parts : parted_[at].parts;
  parts.reserve(parts.size() + 1);
  const std::size_t begin = first ? 0 : room(parted_[at], bytes),
                    end = std::min((begin + bytes + step_ - 1) / step_ * step_, best->bytes());
  std::unique_ptr<Buffer> made = best->part(begin, bytes);
  parts.insert(std::ranges::find_if(parts, [&](const Part& p) { return p.begin >= end; }), {made.get(), begin, end});
  if (first) {
    fresh.whole = take_idle(unused);
    parted_bytes_ += best->bytes();
    parted_.push_back(std::move(fresh));
  }
  return made;
}

std::size_t BufferPool::put(std::unique_ptr<Buffer> buffer, Lifetime lifetime) noexcept {
  if (lifetime == Lifetime::kept) return BufferCache::put(std::move(buffer), lifetime);
  for (auto from = parted_.begin(); from != parted_.end(); ++from) {
    const auto part = std::ranges::find(from->parts, buffer.get(), &Part::buffer);
    if (part == from->parts.end()) continue;
    buffer.reset();
    from->parts.erase(part);
    if (!from->parts.empty()) return 0;
    auto whole = std::move(from->whole);
    parted_.erase(from);
    parted_bytes_ -= whole->bytes();
    return BufferCache::put(std::move(whole), Lifetime::kept);
  }
  return buffer->bytes();  // its own memory
}

}  // namespace cadt::opencl
