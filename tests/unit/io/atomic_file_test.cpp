// SPDX-License-Identifier: Apache-2.0
// Output appears under its name only when it is complete.
#include "io/support/atomic_file.hpp"
#include "tests/unit/io/io_test_support.hpp"

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

TEST(AtomicFileTest, DashIsStandardOutput) {
  ::testing::internal::CaptureStdout();
  write_points("-", {{1, 2}, {}, {}}, "xy");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "1 2\n");
  EXPECT_FALSE(fs::exists("-"));
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
