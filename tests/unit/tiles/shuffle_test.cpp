// SPDX-License-Identifier: Apache-2.0
#include "tiles/shuffle.hpp"

#include "tests/unit/tiles/tiles_support.hpp"

#include <cadt/errors.hpp>
#include <cadt/io/errors.hpp>

#include <gtest/gtest.h>

#include <dlfcn.h>
#include <cerrno>
#include <utility>

namespace {
thread_local int error_of_close = 0;  // the next one closes, and fails
}  // namespace

extern "C" int close(int descriptor) {
  static const auto real = reinterpret_cast<int (*)(int)>(dlsym(RTLD_NEXT, "close"));
  const int result = real(descriptor);
  if (error_of_close == 0) return result;
  errno = std::exchange(error_of_close, 0);
  return -1;
}

namespace cadt::tiles {
namespace {

/// Each leaf has its points, in the order of the input, with their ids.
void expect_leaves_of(LeafStore& leaves, const TileTree& tree, const std::vector<double>& xy, std::uint64_t first_id) {
  std::vector<LeafPoints> expected(tree.size());
  for (std::size_t i = 0; i < xy.size() / 2; ++i) {
    LeafPoints& leaf = expected[tree.leaf_of(xy[2 * i], xy[2 * i + 1])];
    leaf.xy.insert(leaf.xy.end(), {xy[2 * i], xy[2 * i + 1]});
    leaf.ids.push_back(first_id + i);
  }
  for (const std::uint32_t leaf : tree.leaves()) {
    const LeafPoints got = leaves.take(leaf);
    EXPECT_EQ(got.xy, expected[leaf].xy);
    EXPECT_EQ(got.ids, expected[leaf].ids);
  }
}

TEST(Shuffle, InMemoryAndInFiles) {
  const Folder folder;
  for (const auto& [n, tile] : {std::pair(1000, 10), std::pair(300'000, 200'000), std::pair(1'300'000, 700'000)}) {
    const std::vector<double> xy = points_of("uniform", static_cast<std::size_t>(n));
    const TileTree tree = tree_of(xy, static_cast<std::uint64_t>(tile));
    ShuffleOptions options;
    options.first_id = std::uint64_t{1} << 35;
    const auto source = in_memory(xy);
    expect_leaves_of(*shuffle(*source, tree, options), tree, xy, options.first_id);
    options.memory = xy.size() * 4;
    options.scratch = folder / "";
    {
      const auto leaves = shuffle(*source, tree, options);
      EXPECT_FALSE(folder.empty());
      expect_leaves_of(*leaves, tree, xy, options.first_id);
    }
    EXPECT_TRUE(folder.empty());
  }
}

TEST(Shuffle, WantedLeavesAlone) {
  const std::vector<double> xy = points_of("uniform", 1000);
  const TileTree tree = tree_of(xy, 100);
  ShuffleOptions options;
  options.wanted.assign(tree.size(), false);
  options.wanted[tree.leaves()[1]] = true;
  options.memory = 24 * 100;  // that of one leaf
  const auto leaves = shuffle(*in_memory(xy), tree, options);
  EXPECT_EQ(leaves->take(tree.leaves()[0]).ids.size(), 0U);
  EXPECT_EQ(leaves->take(tree.leaves()[1]).ids.size(), tree.node(tree.leaves()[1]).points);
}

TEST(Shuffle, TooLittleMemoryWithoutScratch) {
  const std::vector<double> xy = points_of("uniform", 1000);
  const TileTree tree = tree_of(xy, 100);
  ShuffleOptions options;
  options.memory = 23'999;
  try {
    (void)shuffle(*in_memory(xy), tree, options);
    FAIL() << "no error";
  } catch (const OutOfMemory& e) {
    EXPECT_EQ(e.needed(), 24'000U);
    EXPECT_EQ(e.available(), 23'999U);
  }
  options.memory = 24'000;
  EXPECT_NO_THROW((void)shuffle(*in_memory(xy), tree, options));
  options.memory = 1;
  options.scratch = "/nowhere/at/all";
  EXPECT_THROW((void)shuffle(*in_memory(xy), tree, options), io::FileError);
}

TEST(Shuffle, TellsWhyAFileCannotBeClosed) {
  const Folder folder;
  const TileTree tree(3);
  const auto leaves = leaves_in_files(tree, folder / "");
  leaves->add(0, std::vector<double>(6), std::vector<std::uint64_t>{0, 1, 2});
  error_of_close = ENOSPC;
  errno = 0;
  try {
    leaves->finish();
    FAIL() << "no error";
  } catch (const io::FileError& e) {
    EXPECT_NE(std::string(e.what()).find(std::generic_category().message(ENOSPC)), std::string::npos) << e.what();
  }
}

TEST(Shuffle, MorePointsThanTheTreeSays) {
  const Folder folder;
  const TileTree tree(3);
  const std::vector<double> xy(8);
  const std::vector<std::uint64_t> ids{0, 1, 2, 3};
  EXPECT_THROW(leaves_in_memory(tree)->add(0, xy, ids), io::FileError);
  const auto in_files = leaves_in_files(tree, folder / "");
  in_files->add(0, xy, ids);
  EXPECT_THROW(in_files->finish(), io::FileError);
}

/// Whose point 5 moves a little after so many readings.
class ChangingSource : public PointSource {
 public:
  explicit ChangingSource(int readings) : readings_(readings) {}
  [[nodiscard]] std::uint64_t size() const noexcept override { return xy_.size() / 2; }
  [[nodiscard]] std::string name_of(std::uint64_t /*index*/) const override { return "changing"; }
  [[nodiscard]] std::vector<std::string> names() const override { return {"changing"}; }

 protected:
  void read_raw(std::uint64_t first, std::size_t count, double* xy) const override {
    std::copy_n(xy_.begin() + static_cast<std::ptrdiff_t>(2 * first), 2 * count, xy);
    if (readings_-- <= 0) xy[10] += 0x1p-40;
  }

 private:
  std::vector<double> xy_ = points_of("uniform", 1000);
  mutable int readings_;  // of one block
};

TEST(Shuffle, InputThatChangesWhileItIsRead) {
  const Folder folder;
  const auto make = [&](int readings, std::uint64_t tile_points) {
    RunOptions options;
    options.devices.front().backend = Backend::host;
    options.tile_points = tile_points;
    options.output = folder / "mesh.cadt";
    return run(ChangingSource(readings), options);
  };
  for (const std::uint64_t tile_points : {100, 1000}) {  // the points of one leaf are read by themselves
    int readings = 1;
    for (bool fails = true; fails; ++readings) {
      try {
        (void)make(readings, tile_points);
        fails = false;
      } catch (const io::FileError& e) {
        EXPECT_NE(std::string(e.what()).find("changed while it was read"), std::string::npos) << e.what();
        EXPECT_FALSE(std::filesystem::exists(folder / "mesh.cadt/node-000000"));
      }
      std::filesystem::remove_all(folder / "mesh.cadt");
    }
    EXPECT_GT(readings, 2) << "the points are read more than once";
  }
}

TEST(Messages, PackedAndUnpacked) {
  Open open;
  open.xy = {1, 2, 3, 4, 5, 6};
  open.ids = {7, 8, std::uint64_t{1} << 63};
  open.sides = {{2, 1, 0.5, -0.25, triangle_id(17, 4), 9}};
  const std::vector<std::uint64_t> words = pack(open);
  const Open again = unpack_open(words);
  EXPECT_EQ(again.xy, open.xy);
  EXPECT_EQ(again.ids, open.ids);
  EXPECT_EQ(again.sides, open.sides);
  const std::vector<Link> messages{{triangle_id(1, 2), 3, outside_hull}, {4, 5, 6}};
  EXPECT_EQ(unpack_messages(pack(messages)), messages);
  // Damaged words are an error, and nothing is read beyond them.
  for (std::size_t n = 0; n < words.size(); ++n) EXPECT_THROW((void)unpack_open(std::span(words).first(n)), Error) << n;
  for (std::uint64_t bad : {std::uint64_t{4}, ~std::uint64_t{0}, ~std::uint64_t{0} / 3 + 2}) {
    std::vector<std::uint64_t> changed = words;
    changed[0] = bad;
    EXPECT_THROW((void)unpack_open(changed), Error);
    changed = words;
    changed[1] = bad;
    EXPECT_THROW((void)unpack_open(changed), Error);
    EXPECT_THROW((void)unpack_messages(std::vector<std::uint64_t>{bad, 1, 2, 3}), Error);
  }
  std::vector<std::uint64_t> changed = words;
  changed[words.size() - 5] = 3;  // a side from a vertex that is not there
  EXPECT_THROW((void)unpack_open(changed), Error);
  EXPECT_THROW((void)unpack_open({}), Error);
  EXPECT_THROW((void)unpack_messages({}), Error);
}

}  // namespace
}  // namespace cadt::tiles
