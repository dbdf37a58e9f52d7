// SPDX-License-Identifier: Apache-2.0
#include "common/driver/early_arrays.hpp"

#include <algorithm>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

#include "common/platform/parallel.hpp"

namespace cadt {
namespace {

constexpr std::size_t page_words = 4096 / sizeof(std::int32_t);                     // or a part of a page
constexpr std::size_t block_words = (std::size_t{2} << 20) / sizeof(std::int32_t);  // a huge page, or a part of it

}  // namespace

void EarlyArrays::begin(std::size_t most, unsigned threads) {
  stop();
  threads = platform::threads_or_all(threads);
  if (most < fewest_words || threads < 2) return;
  most_ = most;
  for (Words& array : arrays_) array = make_words(most);
  next_ = 0;
  try {
    leader_ = std::thread([this, count = std::min(threads - 1, most_threads)] {
      std::vector<std::thread> others;
      try {
        others.reserve(count);
        for (unsigned i = 1; i < count; ++i) others.emplace_back([this] { make_pages(); });
      } catch (const std::exception&) {  // those that run make all
      }
      make_pages();
      for (std::thread& other : others) other.join();
    });
  } catch (const std::system_error&) {  // no thread: the copy makes the pages
  }
}

void EarlyArrays::make_pages() noexcept {
  const std::size_t blocks = (most_ - 1) / block_words + 1;
  for (std::size_t block; (block = next_.fetch_add(1, std::memory_order_relaxed)) < 2 * blocks;) {
    std::int32_t* const array = arrays_[block / blocks].get();
    const std::size_t first = block % blocks * block_words, end = std::min(first + block_words, most_);
    for (std::size_t i = first; i < end; i += page_words) static_cast<volatile std::int32_t*>(array)[i] = 0;
  }
}

void EarlyArrays::stop() noexcept {
  if (!leader_.joinable()) return;
  next_ = std::numeric_limits<std::size_t>::max() / 2;
  leader_.join();
}

Words EarlyArrays::take(std::size_t count) {
  if (leader_.joinable()) leader_.join();
  for (Words& array : arrays_) {
    if (array == nullptr || count > most_) continue;
    return cut_words(std::move(array), most_, count);
  }
  return make_words(count);
}

}  // namespace cadt
