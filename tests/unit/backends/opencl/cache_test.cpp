// SPDX-License-Identifier: Apache-2.0
// The program cache as files, without a device.
#include <array>
#include <fstream>
#include <iterator>
#include <thread>

#include "backends/opencl/binary_cache.hpp"
#include "tests/unit/backends/opencl/support.hpp"

namespace cadt::test {
namespace {

namespace fs = std::filesystem;
using opencl::Digest;
using Bytes = std::vector<unsigned char>;

const Digest key{0x0123456789ABCDEFu, 0xFEDCBA9876543210u};

Bytes content(std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<unsigned char>(i * 37 + i / 256);
  return bytes;
}

Bytes read_all(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_all(const fs::path& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

TEST(OpenClCacheFile, RoundTrip) {
  const ScratchDirectory scratch;
  for (const std::size_t size : {1u, 7u, 8u, 9u, 100000u}) {
    const Bytes bytes = content(size);
    ASSERT_TRUE(opencl::store_binary(scratch.path() / "new" / "folder", key, bytes));
    EXPECT_EQ(opencl::load_binary(scratch.path() / "new" / "folder", key), bytes) << size;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path() / "new" / "folder"), fs::directory_iterator()), 1);
}

TEST(OpenClCacheFile, EveryDamagedByteIsNoticed) {
  const ScratchDirectory scratch;
  ASSERT_TRUE(opencl::store_binary(scratch.path(), key, content(60)));
  const fs::path path = opencl::cache_file(scratch.path(), key);
  const Bytes good = read_all(path);
  ASSERT_GT(good.size(), 60u);
  for (std::size_t i = 0; i < good.size(); ++i)
    for (const auto bit : std::array<unsigned char, 2>{0x01, 0x80}) {
      Bytes bad = good;
      bad[i] ^= bit;
      write_all(path, bad);
      EXPECT_FALSE(opencl::load_binary(scratch.path(), key)) << "byte " << i;
    }
  write_all(path, good);
  EXPECT_TRUE(opencl::load_binary(scratch.path(), key));
}

TEST(OpenClCacheFile, EveryTruncationAndAnyTailIsNoticed) {
  const ScratchDirectory scratch;
  ASSERT_TRUE(opencl::store_binary(scratch.path(), key, content(60)));
  const fs::path path = opencl::cache_file(scratch.path(), key);
  const Bytes good = read_all(path);
  for (std::size_t size = 0; size < good.size(); ++size) {
    write_all(path, Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)));
    EXPECT_FALSE(opencl::load_binary(scratch.path(), key)) << size;
  }
  Bytes longer = good;
  longer.push_back(0);
  write_all(path, longer);
  EXPECT_FALSE(opencl::load_binary(scratch.path(), key));
}

TEST(OpenClCacheFile, FileOfAnotherKeyIsForeign) {
  const ScratchDirectory scratch;
  const Digest other{key.high, key.low + 1};
  ASSERT_TRUE(opencl::store_binary(scratch.path(), other, content(60)));
  fs::rename(opencl::cache_file(scratch.path(), other), opencl::cache_file(scratch.path(), key));
  EXPECT_FALSE(opencl::load_binary(scratch.path(), key));
}

TEST(OpenClCacheFile, FailureToStoreLeavesNothing) {
  const ScratchDirectory scratch;
  write_all(scratch.path() / "file", content(3));
  EXPECT_FALSE(opencl::store_binary(scratch.path() / "file" / "below", key, content(60)));
  EXPECT_FALSE(opencl::store_binary("/proc/cadt", key, content(60)));
  EXPECT_FALSE(opencl::store_binary({}, key, content(60)));
  // A folder in the place of the file: the rename fails when everything else has worked.
  fs::create_directories(opencl::cache_file(scratch.path(), key) / "occupied");
  EXPECT_FALSE(opencl::store_binary(scratch.path(), key, content(60)));
  EXPECT_EQ(scratch.files().size(), 2u);
}

TEST(OpenClCacheFile, ReadersSeeWholeFilesWhileWritersReplaceThem) {
  const ScratchDirectory scratch;
  const std::array<Bytes, 2> versions = {content(200000), Bytes(150000, 0x5A)};
  ASSERT_TRUE(opencl::store_binary(scratch.path(), key, versions[0]));
  std::array<std::thread, 2> writers;
  for (std::size_t w = 0; w < 2; ++w)
    writers[w] = std::thread([&, w] {
      for (int i = 0; i < 50; ++i) opencl::store_binary(scratch.path(), key, versions[w]);
    });
  int misses = 0, strange = 0;
  for (int i = 0; i < 200; ++i) {
    const auto found = opencl::load_binary(scratch.path(), key);
    misses += !found;
    strange += found && *found != versions[0] && *found != versions[1];
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(misses, 0);
  EXPECT_EQ(strange, 0);
  EXPECT_EQ(scratch.files().size(), 1u);
}

TEST(OpenClCacheKey, DependsOnEveryTextAndOnItsBorders) {
  const auto digest = [](std::vector<std::string> texts) {
    return opencl::digest_of(std::span<const std::string>(texts));
  };
  const Digest base = digest({"ab", "c"});
  EXPECT_EQ(base, digest({"ab", "c"}));
  EXPECT_NE(base, digest({"a", "bc"}));
  EXPECT_NE(base, digest({"abc", ""}));
  EXPECT_NE(base, digest({"ab", "c", ""}));
  EXPECT_NE(base, digest({"ab", std::string("c\0", 2)}));
  EXPECT_EQ(base.hex().size(), 32u);
  EXPECT_EQ((Digest{1, 255}.hex()), "000000000000000100000000000000ff");
}

TEST(OpenClCacheDirectory, FollowsTheVariables) {
  const ScopedVariable home("HOME", "/home/someone");
  const ScopedVariable xdg("XDG_CACHE_HOME", "/xdg");
  {
    const ScopedVariable own("CADT_CACHE_DIR", "/own");
    EXPECT_EQ(opencl::cache_directory(), "/own");
  }
  {
    const ScopedVariable own("CADT_CACHE_DIR", "");
    EXPECT_EQ(opencl::cache_directory(), "");
  }
  const ScopedVariable own("CADT_CACHE_DIR", nullptr);
  EXPECT_EQ(opencl::cache_directory(), "/xdg/cadt");
  const ScopedVariable relative("XDG_CACHE_HOME", "relative");
  EXPECT_EQ(opencl::cache_directory(), "/home/someone/.cache/cadt");
  const ScopedVariable homeless("HOME", nullptr);
  EXPECT_EQ(opencl::cache_directory(), "");
}

}  // namespace
}  // namespace cadt::test
