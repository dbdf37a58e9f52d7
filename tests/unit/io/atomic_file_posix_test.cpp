// SPDX-License-Identifier: Apache-2.0
// Output on systems that have permissions, links, devices and pipes.
#include "tests/unit/io/io_test_support.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <csignal>

namespace cadt::io::test {
namespace {

namespace fs = std::filesystem;

TEST(AtomicFileTest, FullDeviceIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const PointSet few{{1, 2}, {}, {}};
  const PointSet many{Values(1 << 18, 0.125), {}, {}};
  for (const PointSet* points : {&few, &many}) {
    expect_file_error([&] { write_points("/dev/full", *points, "xy"); }, "/dev/full", 0,
                      "cannot be written: No space left");
  }
  EXPECT_TRUE(fs::is_character_file("/dev/full"));  // it was not replaced
}

TEST(AtomicFileTest, FullDiskLeavesTheOldFile) {
  const Folder folder;
  const std::string path = folder.file("p.xy", "old");
  // A limit on the size of files stands for a full disk; the signal that comes with it must not end the test.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{4096, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  try {
    write_points(path, {Values(100000, 0.125), {}, {}});
  } catch (const FileError& error) {
    message = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(message, path + ": cannot be written: File too large");
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFileTest, DevicesAndPipesAreWrittenDirectly) {
  write_points("/dev/null", {{1, 2}, {}, {}}, "xy");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const Folder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  FILE* reader = ::popen(("cat '" + pipe + "'").c_str(), "r");
  ASSERT_NE(reader, nullptr);
  write_points(pipe, {{1, 2}, {}, {}}, "xy");
  char text[16] = {};
  EXPECT_EQ(std::fread(text, 1, sizeof text, reader), 4U);
  ::pclose(reader);
  EXPECT_STREQ(text, "1 2\n");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(AtomicFileTest, LinksAndPermissionsStay) {
  const Folder folder;
  const std::string target = folder.file("target.xy", "old");
  ASSERT_EQ(::chmod(target.c_str(), 0640), 0);
  fs::create_symlink(target, folder / "link.xy");
  write_points(folder / "link.xy", {{1, 2}, {}, {}});
  EXPECT_TRUE(fs::is_symlink(folder / "link.xy"));
  EXPECT_EQ(content_of(target), "1 2\n");
  EXPECT_EQ(fs::status(target).permissions(), fs::perms(0640));
}

TEST(AtomicFileTest, NewFilesFollowTheUmask) {
  const Folder folder;
  const mode_t before = ::umask(027);
  write_points(folder / "p.xy", {{1, 2}, {}, {}});
  ::umask(before);
  EXPECT_EQ(fs::status(folder / "p.xy").permissions(), fs::perms(0640));
}

}  // namespace
}  // namespace cadt::io::test
