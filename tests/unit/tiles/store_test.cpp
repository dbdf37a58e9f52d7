// SPDX-License-Identifier: Apache-2.0
#include "tiles/store.hpp"

#include "tests/unit/tiles/tiles_support.hpp"
#include "tiles/files.hpp"

#include <cadt/io/errors.hpp>

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>
#include <fstream>
#include <map>

namespace cadt::tiles {
namespace {

class StoreTest : public testing::Test {
 protected:
  std::vector<double> xy_ = points_of("duplicates", 600);
  Nodes made_ = nodes_of(xy_, 100);
  Folder folder_;
  std::string path_ = folder_ / "mesh.cadt";

  void write_all(const Store& store) const {
    for (const NodeData& node : made_.nodes) store.write(node);
  }
  [[nodiscard]] std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path_))
      if (entry.is_regular_file()) all[entry.path().string()] = read_text(entry.path().string());
    return all;
  }
};

TEST_F(StoreTest, LargeNodesOnThreads) {
  const Nodes large = nodes_of(points_of("uniform", 200'000), 120'000);
  ASSERT_GT(large.nodes.front().triangles.size() * sizeof(std::int32_t), std::size_t{2} << 20);
  std::map<unsigned, std::map<std::string, std::string>> all;
  for (const unsigned threads : {1U, 2U, 4U, 9U}) {
    path_ = folder_ / ("mesh-" + std::to_string(threads) + ".cadt");
    Store store(path_, large.plan, Store::Start::create);
    for (const NodeData& node : large.nodes) store.write(node, threads);
    for (std::uint32_t i = 0; i < large.plan.tree.size(); ++i) EXPECT_TRUE(store.is_valid(i));
    (void)store.finish();
    for (auto& [name, text] : contents()) all[threads][name.substr(path_.size())] = std::move(text);
    EXPECT_EQ(all[threads], all[1]);
    const MeshDirectory mesh(path_);
    for (const NodeData& node : large.nodes) {
      const NodeArrays arrays = mesh.node(node.node);
      EXPECT_TRUE(std::ranges::equal(arrays.triangles, node.triangles));
      EXPECT_TRUE(std::ranges::equal(arrays.neighbors, node.neighbors));
      EXPECT_TRUE(std::ranges::equal(arrays.xy, node.xy));
      EXPECT_TRUE(std::ranges::equal(arrays.ids, node.ids));
    }
  }
}

TEST_F(StoreTest, RunsWithSeveralWriters) {
  const auto source = in_memory(points_of("uniform", 60'000));
  std::map<unsigned, std::map<std::string, std::string>> all;
  for (const unsigned threads : {1U, 3U, 16U}) {  // a writer for each four
    path_ = folder_ / ("run-" + std::to_string(threads) + ".cadt");
    RunOptions options;
    options.tile_points = 3'000;
    options.devices.front().backend = Backend::host;
    options.devices.front().threads = threads;
    options.output = path_;
    const RunResult result = run(*source, options);
    EXPECT_EQ(result.nodes.size(), result.plan.tree.size());
    for (auto& [name, text] : contents()) all[threads][name.substr(path_.size())] = std::move(text);
    EXPECT_EQ(all[threads], all[1]);
    EXPECT_TRUE(verify(MeshDirectory(path_)).ok);
  }
}

TEST_F(StoreTest, ReadsBackWhatWasWritten) {
  Store store(path_, made_.plan, Store::Start::create);
  write_all(store);
  for (std::uint32_t i = 0; i < made_.plan.tree.size(); ++i) EXPECT_TRUE(store.is_valid(i));
  for (const NodeData& node : made_.nodes) {
    EXPECT_EQ(store.read_open(node.node).ids, node.open.ids);
    EXPECT_EQ(store.read_open(node.node).sides, node.open.sides);
    EXPECT_EQ(store.read_record(node.node).sums, node.sums);
  }
  EXPECT_THROW(MeshDirectory{path_}, io::FileError) << "not complete";
  const Manifest manifest = store.finish();
  EXPECT_TRUE(store.complete());
  EXPECT_FALSE(std::filesystem::exists(path_ + "/unfinished"));
  const MeshDirectory mesh(path_);
  const CollectedMesh nodes(made_.plan.tree, made_.nodes);
  std::uint64_t base = 0;
  for (std::uint32_t i = 0; i < made_.plan.tree.size(); ++i) {
    const NodeArrays a = mesh.node(i), b = nodes.node(i);
    const auto same = [](const auto& x, const auto& y) { return std::equal(x.begin(), x.end(), y.begin(), y.end()); };
    EXPECT_TRUE(same(a.xy, b.xy) && same(a.ids, b.ids) && same(a.triangles, b.triangles) &&
                same(a.neighbors, b.neighbors) && same(a.links, b.links) && same(a.duplicates, b.duplicates));
    EXPECT_EQ(manifest.base[i], base);
    base += a.number_of_triangles();
  }
  EXPECT_EQ(manifest.hash, triangulate(PointsView(std::span<const double>(xy_))).hash());
  EXPECT_TRUE(verify(mesh).ok);
}

TEST_F(StoreTest, OrderOfNodesAndWritersDoesNotMatter) {
  Store store(path_, made_.plan, Store::Start::create);
  write_all(store);
  store.finish();
  const auto expected = contents();
  std::filesystem::remove_all(path_);
  Store first(path_, made_.plan, Store::Start::create);
  Store second(path_, made_.plan, Store::Start::join);
  for (std::size_t i = made_.nodes.size(); i-- > 0;) (i % 2 == 0 ? first : second).write(made_.nodes[i]);
  first.finish();
  EXPECT_EQ(contents(), expected);
}

TEST_F(StoreTest, OneRunAtATime) {
  const auto refused = [&](Store::Start start) {
    try {
      const Store store(path_, made_.plan, start);
      ADD_FAILURE() << "there are two";
    } catch (const ResumeError& e) {
      EXPECT_NE(std::string(e.what()).find("another run"), std::string::npos) << e.what();
    }
  };
  for (const Store::Start start : {Store::Start::create, Store::Start::resume}) {
    const Store store(path_, made_.plan, start);
    refused(Store::Start::resume);
    const Store of_another_rank(path_, made_.plan, Store::Start::join);
    write_all(store);
  }
  const Store after(path_, made_.plan, Store::Start::resume);
  std::filesystem::remove_all(path_);
  std::filesystem::create_directory(path_);  // another run is just beginning
  FolderLock lock;
  EXPECT_TRUE(lock.take(path_));
  refused(Store::Start::create);
  refused(Store::Start::resume);
}

TEST_F(StoreTest, ALockEndsWithItsStoreThoughAChildLives) {
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  pid_t child = 0;
  {
    const Store store(path_, made_.plan, Store::Start::create);
    child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {  // has the descriptor until the pipe is closed
      ::close(pipe[1]);
      char none = 0;
      ::_exit(static_cast<int>(::read(pipe[0], &none, 1)));
    }
  }
  EXPECT_NO_THROW(Store(path_, made_.plan, Store::Start::resume));
  {
    const Store store(path_, made_.plan, Store::Start::resume);
    const pid_t other = ::fork();
    if (other == 0) {
      store.~Store();  // as in a child that ends orderly
      ::_exit(0);
    }
    ::waitpid(other, nullptr, 0);
    EXPECT_THROW(Store(path_, made_.plan, Store::Start::resume), ResumeError);
  }
  ::close(pipe[0]);
  ::close(pipe[1]);
  ::waitpid(child, nullptr, 0);
}

TEST_F(StoreTest, AFolderThatCannotBeOpenedIsNotLocked) {
  FolderLock lock;
  EXPECT_THROW((void)lock.take(folder_ / "none"), io::FileError);
}

TEST_F(StoreTest, EachDamagedFileMakesItsNodeInvalid) {
  const Store store(path_, made_.plan, Store::Start::create);
  write_all(store);
  const std::map<std::string, std::string> files = contents();
  std::size_t damaged = 0;
  for (const auto& [name, text] : files) {
    if (name.find("node-000000") == std::string::npos) continue;
    ++damaged;
    std::string changed = text;
    changed[changed.size() / 2] ^= 1;
    for (const std::string& wrong : {changed, text.substr(0, text.size() - 2), text + "x", std::string()}) {
      std::ofstream(name, std::ios::binary) << wrong;
      EXPECT_FALSE(store.is_valid(0)) << name;
    }
    std::filesystem::remove(name);
    EXPECT_FALSE(store.is_valid(0)) << name;
    std::ofstream(name, std::ios::binary) << text;
    EXPECT_TRUE(store.is_valid(0)) << name;
  }
  EXPECT_EQ(damaged, 9U);
}

TEST_F(StoreTest, ARecordOfAnotherNodeMakesItsNodeInvalid) {
  const Store store(path_, made_.plan, Store::Start::create);
  write_all(store);
  std::filesystem::copy_file(path_ + "/unfinished/node-000001/node.json", path_ + "/unfinished/node-000000/node.json",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_FALSE(store.is_valid(0)) << "all files that it names are intact";
  EXPECT_TRUE(store.is_valid(1));
}

TEST_F(StoreTest, OthersJoinTheirOwnRunAlone) {
  const auto join = [&](const Plan& plan) { const Store store(path_, plan, Store::Start::join); };
  EXPECT_THROW(join(made_.plan), io::FileError) << "it is not there";
  Store store(path_, made_.plan, Store::Start::create);
  EXPECT_NO_THROW(join(made_.plan));
  Plan other = made_.plan;
  other.content.low ^= 1;
  EXPECT_THROW(join(other), ResumeError);
  write_all(store);
  store.finish();
  EXPECT_THROW(join(made_.plan), ResumeError) << "it is complete";
  EXPECT_TRUE(verify(MeshDirectory(path_)).ok);
}

TEST_F(StoreTest, SumsOfOtherPointsAreRefused) {
  made_.nodes[0].sums.points += 1;  // as if there were another duplicate
  Store store(path_, made_.plan, Store::Start::create);
  write_all(store);
  EXPECT_THROW(store.finish(), InternalError);
}

TEST_F(StoreTest, MissingNodesAndOtherPlans) {
  {
    Store store(path_, made_.plan, Store::Start::create);
    for (std::size_t i = 1; i < made_.nodes.size(); ++i) store.write(made_.nodes[i]);
    EXPECT_THROW(store.finish(), io::FileError);
  }
  EXPECT_THROW(Store(path_, made_.plan, Store::Start::create), ResumeError);
  EXPECT_FALSE(Store(path_, made_.plan, Store::Start::resume).is_valid(made_.nodes[0].node));
  Plan other = made_.plan;
  other.content.low ^= 1;
  EXPECT_THROW(Store(path_, other, Store::Start::resume), ResumeError);
  other = made_.plan;
  other.first_id = 1;
  EXPECT_THROW(Store(path_, other, Store::Start::resume), ResumeError);
  other = made_.plan;
  other.tree = tree_of(points_of("uniform", 600), 100);
  EXPECT_THROW(Store(path_, other, Store::Start::resume), ResumeError);
  std::ofstream(path_ + "/manifest.json") << "{";
  EXPECT_THROW(Store(path_, made_.plan, Store::Start::resume), io::FileError);
}

TEST_F(StoreTest, SumsThatAreNotThoseOfAMeshAreRefused) {
  made_.nodes[0].sums.certified_edges += 1;
  Store store(path_, made_.plan, Store::Start::create);
  write_all(store);
  EXPECT_THROW(store.finish(), InternalError);
}

TEST(Links, EachRowIsToldOnce) {
  std::vector<TriangleId> links{pending_triangle, 5, pending_triangle};
  std::vector<Link> messages{{triangle_id(3, 0), 0, 7}, {triangle_id(3, 1), 2, 8}};
  apply_messages(3, messages, links);
  EXPECT_EQ(links, (std::vector<TriangleId>{7, 5, 8}));
  EXPECT_THROW(apply_messages(3, messages, links), InternalError) << "twice";
  links = {pending_triangle, pending_triangle, pending_triangle};
  EXPECT_THROW(apply_messages(3, messages, links), InternalError) << "never";
  messages[0].row = 3;
  EXPECT_THROW(apply_messages(3, messages, links), InternalError) << "no such row";
  const auto ignore = [](std::uint32_t, std::span<const Link>) {};
  EXPECT_NO_THROW(complete_links(messages, 4, ignore));
  EXPECT_THROW(complete_links(messages, 3, ignore), InternalError) << "no such node";
}

}  // namespace
}  // namespace cadt::tiles
