// SPDX-License-Identifier: Apache-2.0
// Arrays of a result that are allocated before its size is known.
#include "common/driver/early_arrays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>

#include <vector>
#endif

namespace cadt {
namespace {

constexpr std::size_t few_words = EarlyArrays::fewest_words - 1, many = 3 * EarlyArrays::fewest_words + 1234;

void write_all(const Words& words, std::size_t count) { std::fill_n(words.get(), count, 7); }

TEST(EarlyArrays, GiveWhatIsAskedFor) {
  for (const unsigned threads : {0U, 1U, 2U, 3U, 100U})
    for (const std::size_t most : {std::size_t{0}, few_words, few_words + 1, many})
      for (const std::size_t count : {std::size_t{0}, std::size_t{1}, most / 2, most, most + 1}) {
        EarlyArrays arrays;
        arrays.begin(most, threads);
        std::set<const std::int32_t*> different;
        std::vector<Words> taken;
        for (int i = 0; i < 3; ++i) {  // one more than there are
          taken.push_back(arrays.take(count));
          ASSERT_NE(taken.back(), nullptr);
          write_all(taken.back(), count);
          different.insert(taken.back().get());
        }
        EXPECT_EQ(different.size(), 3U);
      }
}

TEST(EarlyArrays, MayBeLeft) {
  for (int i = 0; i < 20; ++i) {
    EarlyArrays arrays;
    arrays.begin(many, 4);
    if (i % 2 == 0) arrays.begin(2 * many, 4);
    if (i % 4 == 1) write_all(arrays.take(many), many);
  }
}

#if defined(__linux__)
std::size_t resident_pages(const Words& words, std::size_t first, std::size_t count) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  auto* const begin = reinterpret_cast<std::byte*>(words.get() + first);
  std::vector<unsigned char> pages(count * sizeof(std::int32_t) / page);
  EXPECT_EQ(::mincore(begin, pages.size() * page, pages.data()), 0);
  return static_cast<std::size_t>(std::count_if(pages.begin(), pages.end(), [](unsigned char p) { return p & 1U; }));
}

TEST(EarlyArrays, MakePagesAndReturnThem) {
  constexpr std::size_t most = std::size_t{1} << 22, count = std::size_t{1} << 20;
  EarlyArrays arrays;
  arrays.begin(most, 3);
  const Words whole = arrays.take(most), part = arrays.take(count);
  const std::size_t page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) / sizeof(std::int32_t);
  EXPECT_EQ(resident_pages(whole, 0, most), most / page);
  EXPECT_EQ(resident_pages(part, 0, count), count / page);
  EXPECT_EQ(resident_pages(part, count, most - count), 0U);
}
#endif

}  // namespace
}  // namespace cadt
