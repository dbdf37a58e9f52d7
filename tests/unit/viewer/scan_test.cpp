// SPDX-License-Identifier: Apache-2.0
#include "viewer/gl/scan.hpp"

#include "tests/unit/viewer/with_display.hpp"
#include "viewer/draw/renderer.hpp"
#include "viewer/gl/fill.hpp"

#include <cadt/errors.hpp>

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

TEST_F(ScanTest, FillReachesTheEndOfALargeBuffer) {
  constexpr std::size_t n = 40'000'001;  // 160 MB
  const gl::Fill fill;
  const gl::Buffer buffer(n * sizeof(std::uint32_t));
  fill(buffer, n, 7);
  fill(buffer, n - 1, 9);
  const auto word = [&](std::size_t i) { return buffer.read_values<std::uint32_t>(1, i * sizeof(std::uint32_t))[0]; };
  EXPECT_EQ(word(0), 9u);
  EXPECT_EQ(word(n / 2), 9u);
  EXPECT_EQ(word(n - 2), 9u);
  EXPECT_EQ(word(n - 1), 7u);
}

TEST_F(ScanTest, AMeshBeyondTheOffsetsOfProgramsIsRefused) {
  MeshBuffers mesh = MeshBuffers::with_room(3);
  mesh.triangle_count = 400'000'000;
  Renderer renderer;
  EXPECT_THROW(renderer.update(mesh), LimitError);
}

}  // namespace
}  // namespace cadt::viewer
