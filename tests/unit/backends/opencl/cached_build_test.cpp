// SPDX-License-Identifier: Apache-2.0
// The program cache as a device uses it: a hit saves the build, and nothing about it is ever fatal.
#include <charconv>
#include <fstream>

#include "backends/opencl/binary_cache.hpp"
#include "tests/unit/backends/opencl/support.hpp"

namespace cadt::test {
namespace {

namespace fs = std::filesystem;

class OpenClCachedBuild : public OpenClTest {
 protected:
  /// Opens in a new context and tells whether the program came from disk.
  bool hit(const std::string& options = {}) const {
    bool from_cache = false;
    opencl::OpenRequest request = small();
    request.extra_options = options;
    request.from_cache = &from_cache;
    const auto device = opencl::open_device(request);
    EXPECT_EQ(counted_items(*device, 100), 100u);
    return from_cache;
  }
};

TEST_F(OpenClCachedBuild, SecondBuildIsAHit) {
  EXPECT_FALSE(hit());
  ASSERT_EQ(cache.files().size(), 1u);
  EXPECT_TRUE(hit());
  EXPECT_EQ(cache.files().size(), 1u);
}

TEST_F(OpenClCachedBuild, OtherOptionsAreAnotherProgram) {
  EXPECT_FALSE(hit());
  EXPECT_FALSE(hit("-DCADT_TEST_MARK=2"));
  EXPECT_EQ(cache.files().size(), 2u);
  EXPECT_TRUE(hit("-DCADT_TEST_MARK=2"));
}

TEST_F(OpenClCachedBuild, DamagedFileIsReplaced) {
  ASSERT_FALSE(hit());
  const fs::path file = cache.files().at(0);
  {
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(static_cast<std::streamoff>(fs::file_size(file) / 2));
    stream.write("damage!", 7);
  }
  EXPECT_FALSE(hit());
  EXPECT_TRUE(hit());
}

TEST_F(OpenClCachedBuild, TruncatedFileIsReplaced) {
  ASSERT_FALSE(hit());
  const fs::path file = cache.files().at(0);
  for (const std::uintmax_t size : {fs::file_size(file) - 1, std::uintmax_t{20}, std::uintmax_t{0}}) {
    fs::resize_file(file, size);
    EXPECT_FALSE(hit()) << size;
    EXPECT_TRUE(hit()) << size;
  }
}

// Undamaged as a file, but no program: the driver has to notice.
TEST_F(OpenClCachedBuild, BinaryThatTheDriverRefusesIsReplaced) {
  ASSERT_FALSE(hit());
  const std::string name = cache.files().at(0).filename();
  opencl::Digest digest;
  std::from_chars(name.data(), name.data() + 16, digest.high, 16);
  std::from_chars(name.data() + 16, name.data() + 32, digest.low, 16);
  ASSERT_TRUE(opencl::load_binary(cache.path(), digest));
  const std::vector<unsigned char> rubbish(5000, 0x42);
  ASSERT_TRUE(opencl::store_binary(cache.path(), digest, rubbish));
  EXPECT_FALSE(hit());
  EXPECT_NE(opencl::load_binary(cache.path(), digest), rubbish);
  EXPECT_TRUE(hit());
}

TEST_F(OpenClCachedBuild, UnwritableDirectoryIsNoObstacle) {
  std::ofstream(cache.path() / "file") << "in the way";
  for (const std::string& directory : {(cache.path() / "file" / "below").string(), std::string("/proc/cadt")}) {
    const ScopedVariable variable("CADT_CACHE_DIR", directory.c_str());
    EXPECT_FALSE(hit()) << directory;
    EXPECT_FALSE(hit()) << directory;
  }
}

TEST_F(OpenClCachedBuild, EmptyVariableTurnsItOff) {
  const ScopedVariable variable("CADT_CACHE_DIR", "");
  const ScopedVariable home("XDG_CACHE_HOME", cache.path().c_str());
  EXPECT_FALSE(hit());
  EXPECT_FALSE(hit());
  EXPECT_TRUE(cache.files().empty());
}

// Drivers that keep programs themselves are left alone, unless a folder is named.
TEST_F(OpenClCachedBuild, DriversCacheIsEnough) {
  const ScopedVariable unset("CADT_CACHE_DIR", nullptr);
  const ScopedVariable home("XDG_CACHE_HOME", cache.path().c_str());
  const bool caches = info.platform == "Portable Computing Language" || info.platform == "NVIDIA CUDA";
  EXPECT_FALSE(hit("-DCADT_TEST_MARK=3"));
  EXPECT_EQ(hit("-DCADT_TEST_MARK=3"), !caches);
}

}  // namespace
}  // namespace cadt::test
