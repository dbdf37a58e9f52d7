// SPDX-License-Identifier: Apache-2.0
// Output appears under its name only when it is complete.
#include "io/support/atomic_file.hpp"
#include "tests/unit/io/io_test_support.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <csignal>
#include <stdexcept>

namespace cadt::io::test {
namespace {

using detail::AtomicFile;
namespace fs = std::filesystem;

TEST(AtomicFileTest, AppearsOnlyAtCommit) {
  const Folder folder;
  const std::string path = folder.file("a", "old");
  {
    AtomicFile out(path);
    out.write("new");
    EXPECT_EQ(content_of(path), "old");
    EXPECT_EQ(folder.entries(), 2U);
    out.commit();
    EXPECT_EQ(content_of(path), "new");
  }
  EXPECT_EQ(content_of(path), "new");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFileTest, AnExceptionLeavesNothing) {
  const Folder folder;
  const std::string path = folder.file("a", "old");
  const auto fail = [&] {
    AtomicFile out(path);
    out.write(std::string(1 << 20, 'x'));  // more than the buffer: it is on the disk already
    throw std::runtime_error("no");
  };
  EXPECT_THROW(fail(), std::runtime_error);
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFileTest, BlocksOfAllSizesStayInOrder) {
  const Folder folder;
  std::string expected;
  AtomicFile out(folder / "a");
  for (std::size_t size = 0; size < 700000; size = size * 3 + 1) {
    const std::string block(size, static_cast<char>('a' + size % 26));
    out.write(block);
    char* at = out.room(2);
    at[0] = '<', at[1] = '>';
    out.advance(at + 2);
    expected += block + "<>";
  }
  out.commit();
  EXPECT_EQ(content_of(folder / "a"), expected);
}

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

TEST(AtomicFileTest, DashIsStandardOutput) {
  ::testing::internal::CaptureStdout();
  write_points("-", {{1, 2}, {}, {}}, "xy");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "1 2\n");
  EXPECT_FALSE(fs::exists("-"));
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

TEST(AtomicFileTest, PlacesThatCannotBeWritten) {
  const Folder folder;
  const PointSet points{{1, 2}, {}, {}};
  const std::string missing = folder / "no/p.xy";
  expect_file_error([&] { write_points(missing, points); }, missing, 0, "cannot be created: No such file");
  fs::create_directory(folder / "d.xy");
  expect_file_error([&] { write_points(folder / "d.xy", points); }, folder / "d.xy", 0, "is a directory");
  expect_file_error([&] { write_points("", points, "xy"); }, "", 0, "needs a name");
}

TEST(AtomicFileTest, RelativeNames) {
  const Folder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder / "");
  write_points("p.xy", {{1, 2}, {}, {}});
  fs::current_path(before);
  EXPECT_EQ(content_of(folder / "p.xy"), "1 2\n");
  EXPECT_EQ(folder.entries(), 1U);
}

}  // namespace
}  // namespace cadt::io::test
