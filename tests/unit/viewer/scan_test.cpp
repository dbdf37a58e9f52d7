// SPDX-License-Identifier: Apache-2.0
#include "viewer/gl/scan.hpp"

#include "tests/unit/viewer/with_display.hpp"

#include <numeric>
#include <random>

namespace cadt::viewer {
namespace {

using ScanTest = WithDisplay;

TEST_F(ScanTest, EqualsThatOfTheHostForSizesAroundThoseOfGroups) {
  gl::Scan scan;
  std::mt19937 random(3);
  for (const std::size_t n : {0u, 1u, 7u, 8u, 255u, 2047u, 2048u, 2049u, 100'000u, 2048u * 2048u, 5'000'000u}) {
    std::vector<std::uint32_t> words(n + 1);
    for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random() % 5);  // the last one is overwritten
    const gl::Buffer buffer((n + 1) * sizeof(std::uint32_t));
    glNamedBufferSubData(buffer.id(), 0, static_cast<GLsizeiptr>(buffer.bytes()), words.data());
    scan.exclusive(buffer, n);
    std::vector<std::uint32_t> expected(n + 1);
    std::exclusive_scan(words.begin(), words.end(), expected.begin(), 0u);
    EXPECT_EQ(buffer.read_values<std::uint32_t>(n + 1), expected) << n;
  }
}

}  // namespace
}  // namespace cadt::viewer
