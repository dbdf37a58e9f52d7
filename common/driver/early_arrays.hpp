// SPDX-License-Identifier: Apache-2.0
// The arrays of a large result while a GPU still computes it.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <thread>

#include "common/driver/triangulation_data.hpp"

namespace cadt {

/// Allocates two arrays before their size is known, and makes their pages by several threads meanwhile: the first write
/// to a page takes longer than the copy of what comes there.
class EarlyArrays {
 public:
  /// Below, starting threads takes longer than the pages.
  static constexpr std::size_t fewest_words = std::size_t{1} << 20;
  static constexpr unsigned most_threads = 16;

  EarlyArrays() = default;
  ~EarlyArrays() { stop(); }
  EarlyArrays(const EarlyArrays&) = delete;
  EarlyArrays& operator=(const EarlyArrays&) = delete;

  /// Two arrays of `most` words. Without effect for few words, or for one thread. `threads`: at most, among them the
  /// caller's, which goes on; 0: one for each core. \throws std::bad_alloc
  void begin(std::size_t most, unsigned threads);
  /// An array of `count` words: one of the two while there are any, cut to size, once its pages are made, else a new
  /// one. \throws std::bad_alloc
  [[nodiscard]] Words take(std::size_t count);

 private:
  void make_pages() noexcept;
  void stop() noexcept;

  std::size_t most_ = 0;
  std::array<Words, 2> arrays_;
  std::atomic<std::size_t> next_ = 0;  ///< first block that no thread has taken
  std::thread leader_;                 ///< starts the other threads
};

}  // namespace cadt
