// SPDX-License-Identifier: Apache-2.0
// Sort and scan of the device's own, against the standard library. On a CPU they are what CADT_OPENCL_AS_GPU makes run.
#include <algorithm>
#include <functional>
#include <numeric>
#include <random>

#include "tests/unit/backends/opencl/support.hpp"

namespace cadt::test {
namespace {

using Words = std::vector<std::uint32_t>;

// With more than 16 tiles of 4096 a sort scans its counts, with more than 256 a scan the sums of its tiles.
constexpr std::size_t sizes[] = {
    0, 1, 2, 255, 256, 257, 4095, 4096, 4097, 65536, 65537, 100003, std::size_t{1} << 20, (std::size_t{1} << 20) + 1};

Words random_words(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  Words words(count);
  for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random());
  return words;
}

class OpenClPrimitives : public OpenClTest {
 protected:
  void SetUp() override {
    OpenClTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    opencl::OpenRequest request;
    request.index = index;
    request.fresh = true;
    device = opencl::open_device(request);
    own = device->primitives();
    ASSERT_NE(own, nullptr);
  }

  [[nodiscard]] std::unique_ptr<Buffer> buffer_of(const Words& words) const {
    auto buffer = device->allocate(words.size() * 4);
    device->write(*buffer, 0, words.data(), words.size() * 4);
    return buffer;
  }
  [[nodiscard]] Words words_of(const Buffer& buffer, std::size_t count) const {
    Words words(count);
    device->read(buffer, 0, words.data(), count * 4);
    return words;
  }
  /// Scratch memory with a guard behind it.
  [[nodiscard]] std::unique_ptr<Buffer> scratch_of(std::size_t bytes) const {
    auto scratch = device->allocate(bytes + 4);
    device->fill(*scratch, 0, bytes + 4, guard);
    return scratch;
  }
  void expect_guarded(const Buffer& scratch, std::size_t bytes) const {
    std::uint32_t behind = 0;
    device->read(scratch, bytes, &behind, 4);
    EXPECT_EQ(behind, guard) << "written beyond the scratch memory";
  }

  void expect_sorted(const Words& keys, unsigned bits) const {
    const std::size_t count = keys.size();
    const std::uint32_t mask = bits == 32 ? 0xFFFFFFFFu : (1u << bits) - 1;
    Words order(count);
    std::iota(order.begin(), order.end(), 0u);
    Words expected_values = order, expected_keys(count);
    // The values are the places, so the order of equal keys shows.
    std::stable_sort(expected_values.begin(), expected_values.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return (keys[a] & mask) < (keys[b] & mask); });
    std::transform(expected_values.begin(), expected_values.end(), expected_keys.begin(),
                   [&](std::uint32_t i) { return keys[i]; });

    const auto first_keys = buffer_of(keys), first_values = buffer_of(order);
    const auto second_keys = device->allocate(count * 4), second_values = device->allocate(count * 4);
    const std::size_t bytes = own->sort_scratch(count, bits);
    const auto scratch = scratch_of(bytes);
    for (const bool places : {false, true}) {
      SCOPED_TRACE(places ? "of places that nobody has written" : "");
      if (places) {
        if (!own->sorts_places(count)) continue;
        device->write(*first_keys, 0, keys.data(), count * 4);
        device->fill(*first_values, 0, count * 4, guard);
        device->fill(*scratch, 0, bytes, guard);
      }
      const bool second =
          own->sort(*scratch, *first_keys, *first_values, *second_keys, *second_values, count, bits, places);
      EXPECT_TRUE(words_of(second ? *second_keys : *first_keys, count) == expected_keys);
      EXPECT_TRUE(words_of(second ? *second_values : *first_values, count) == expected_values);
      expect_guarded(*scratch, bytes);
    }
  }

  void expect_scanned(const Words& words) const {
    Words expected(words.size());
    std::exclusive_scan(words.begin(), words.end(), expected.begin(), 0u);
    const auto data = buffer_of(words);
    const std::size_t bytes = own->scan_scratch(words.size());
    const auto scratch = scratch_of(bytes);
    own->scan(*scratch, *data, words.size());
    EXPECT_TRUE(words_of(*data, words.size()) == expected);
    expect_guarded(*scratch, bytes);
  }

  static constexpr std::uint32_t guard = 0xABADCAFEu;
  std::unique_ptr<Device> device;
  Primitives* own = nullptr;

 private:
  ScopedVariable as_gpu_{"CADT_OPENCL_AS_GPU", "1"};
  ScopedVariable no_cache_{"CADT_CACHE_DIR", ""};  // to store a program PoCL compiles all of its kernels
};

TEST_F(OpenClPrimitives, SortsRandomKeysByAnyBits) {
  for (const std::size_t count : sizes) {
    for (const unsigned bits : {1u, 4u, 7u, 8u, 13u, 28u, 32u}) {
      if (count > 100003 && bits != 32 && (bits != 13 || count % 2 == 0)) continue;  // minutes for the largest
      SCOPED_TRACE(std::to_string(count) + " keys, " + std::to_string(bits) + " bits");
      expect_sorted(random_words(count, 1), bits);
    }
  }
}

TEST_F(OpenClPrimitives, SortsKeysInAnyOrder) {
  struct Case {
    const char* name;
    std::function<std::uint32_t(std::uint32_t i, std::uint32_t count)> key;
  };
  const Case cases[] = {
      {"equal", [](std::uint32_t, std::uint32_t) { return 0x12345678u; }},
      {"zero", [](std::uint32_t, std::uint32_t) { return 0u; }},
      {"largest", [](std::uint32_t, std::uint32_t) { return 0xFFFFFFFFu; }},
      {"sorted", [](std::uint32_t i, std::uint32_t) { return i * 3u; }},
      {"reversed", [](std::uint32_t i, std::uint32_t count) { return (count - i) * 3u; }},
      {"two values", [](std::uint32_t i, std::uint32_t) { return i % 3u == 0u ? 0u : 0xFFFFFFFFu; }},
      {"largest and others",
       [](std::uint32_t i, std::uint32_t) { return i % 2u == 0u ? i * 2654435761u : 0xFFFFFFFFu; }},
  };
  for (const Case& c : cases) {
    for (const std::size_t count : sizes) {
      if (count > 100003) continue;
      Words keys(count);
      for (std::uint32_t i = 0; i < keys.size(); ++i) keys[i] = c.key(i, static_cast<std::uint32_t>(count));
      for (const unsigned bits : {8u, 13u, 32u}) {
        SCOPED_TRACE(std::string(c.name) + ", " + std::to_string(count) + " keys, " + std::to_string(bits) + " bits");
        expect_sorted(keys, bits);
      }
    }
  }
}

TEST_F(OpenClPrimitives, Scans) {
  for (const std::size_t count : sizes) {
    SCOPED_TRACE(count);
    expect_scanned(random_words(count, 2));  // sums wrap around
    expect_scanned(Words(count, 1u));
    expect_scanned(Words(count, 0xFFFFFFFFu));
  }
}

// One more level of sums than the sizes above need.
TEST_F(OpenClPrimitives, ScansTilesOfTilesOfTiles) { expect_scanned(random_words((std::size_t{1} << 24) + 1, 3)); }

TEST_F(OpenClPrimitives, NoBitsNeedScratchOfOne) { EXPECT_EQ(own->sort_scratch(5000, 0), own->sort_scratch(5000, 1)); }

TEST_F(OpenClPrimitives, ProgramWithoutTheirKernelsHasNone) { EXPECT_EQ(open_small()->primitives(), nullptr); }

}  // namespace
}  // namespace cadt::test
