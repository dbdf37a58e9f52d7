// SPDX-License-Identifier: Apache-2.0
#include "tiles/shuffle.hpp"

#include <cadt/errors.hpp>
#include <cadt/io/errors.hpp>

#include "io/support/system_file.hpp"
#include "tiles/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

namespace cadt::tiles {
namespace {

namespace fs = std::filesystem;
namespace system_file = io::detail::system_file;

class MemoryLeaves : public LeafStore {
 public:
  explicit MemoryLeaves(const TileTree& tree) : tree_(tree), leaves_(tree.size()) {}
  void add(std::uint32_t leaf, std::span<const double> xy, std::span<const std::uint64_t> ids) override {
    const Room room = add_room(leaf, ids.size());
    std::copy(xy.begin(), xy.end(), room.xy);
    std::copy(ids.begin(), ids.end(), room.ids);
  }
  [[nodiscard]] Room add_room(std::uint32_t leaf, std::size_t count) override {
    LeafPoints& to = leaves_[leaf];
    const std::size_t at = to.ids.size();
    if (at == 0) {  // nothing moves later
      to.xy.reserve(2 * tree_.node(leaf).points);
      to.ids.reserve(tree_.node(leaf).points);
    }
    if (at + count > tree_.node(leaf).points) fail_changed();
    to.xy.resize(2 * (at + count));
    to.ids.resize(at + count);
    return {to.xy.data() + 2 * at, to.ids.data() + at};
  }
  void finish() override {}
  [[nodiscard]] LeafPoints take(std::uint32_t leaf) override { return std::exchange(leaves_[leaf], {}); }

 private:
  const TileTree& tree_;
  std::vector<LeafPoints> leaves_;
};

/// In the file of a leaf of n points are n x 16 bytes of coordinates, then n x 8 bytes of ids.
class FileLeaves : public LeafStore {
 public:
  FileLeaves(const TileTree& tree, const std::string& scratch, std::uint64_t memory)
      : tree_(tree), folder_(new_folder(scratch)), leaves_(tree.size()) {
    constexpr std::uint64_t least = 512, most = std::uint64_t{1} << 18;
    buffer_points_ = std::clamp(memory / bytes_per_shuffled_point / tree.leaves().size(), least, most);
  }
  ~FileLeaves() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  void add(std::uint32_t leaf, std::span<const double> xy, std::span<const std::uint64_t> ids) override {
    LeafPoints& to = leaves_[leaf].waiting;
    while (!ids.empty()) {
      const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(ids.size(), buffer_points_ - to.ids.size()));
      to.xy.insert(to.xy.end(), xy.begin(), xy.begin() + static_cast<std::ptrdiff_t>(2 * n));
      to.ids.insert(to.ids.end(), ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(n));
      if (to.ids.size() == buffer_points_) flush(leaf);
      xy = xy.subspan(2 * n), ids = ids.subspan(n);
    }
  }
  [[nodiscard]] Room add_room(std::uint32_t /*leaf*/, std::size_t /*count*/) override { return {}; }
  void finish() override {
    for (const std::uint32_t leaf : tree_.leaves()) {
      flush(leaf);
      leaves_[leaf].waiting = {};
    }
  }

  [[nodiscard]] LeafPoints take(std::uint32_t leaf) override {
    LeafPoints points;
    const std::uint64_t n = leaves_[leaf].written;
    if (n == 0) return points;
    const std::string path = path_of(leaf);
    points.xy.resize(2 * n);
    points.ids.resize(n);
    const system_file::Descriptor file(system_file::open_to_read(path));
    if (!file.is_open()) fail(path, "cannot be opened");
    if (!read(file.get(), points.xy.data(), 16 * n, 0) || !read(file.get(), points.ids.data(), 8 * n, 16 * total(leaf)))
      fail(path, "cannot be read");
    system_file::remove(path);
    return points;
  }

 private:
  struct Leaf {
    LeafPoints waiting;
    std::uint64_t written = 0;
  };

  static std::string new_folder(const std::string& scratch) {
    static std::atomic<unsigned> serial{0};
    std::error_code code;
    for (int tries = 0; tries < 1000; ++tries) {
      std::string folder = scratch + "/cadt-points-" + std::to_string(system_file::process_number()) + "-" +
                           std::to_string(serial.fetch_add(1));
      if (fs::create_directory(folder, code)) return folder;
      if (code) break;
    }
    throw io::FileError(scratch, 0, "no folder can be made in it: " + code.message());
  }
  [[noreturn]] static void fail(const std::string& path, const char* what) {
    const int code = errno;
    throw io::FileError(path, 0, std::string(what) + ": " + std::generic_category().message(code == 0 ? EIO : code));
  }
  [[nodiscard]] std::string path_of(std::uint32_t leaf) const { return folder_ + "/leaf-" + std::to_string(leaf); }
  [[nodiscard]] std::uint64_t total(std::uint32_t leaf) const noexcept { return tree_.node(leaf).points; }

  static bool read(int file, void* to, std::uint64_t size, std::uint64_t at) {
    auto* bytes = static_cast<char*>(to);
    while (size != 0) {
      errno = 0;
      const std::ptrdiff_t got = system_file::read_at(file, bytes, size, at);
      if (got <= 0) return false;
      bytes += got, size -= static_cast<std::uint64_t>(got), at += static_cast<std::uint64_t>(got);
    }
    return true;
  }
  static bool write(int file, const void* from, std::uint64_t size, std::uint64_t at) {
    const auto* bytes = static_cast<const char*>(from);
    while (size != 0) {
      const std::ptrdiff_t put = system_file::write_at(file, bytes, size, at);
      if (put < 0) return false;
      bytes += put, size -= static_cast<std::uint64_t>(put), at += static_cast<std::uint64_t>(put);
    }
    return true;
  }
  void flush(std::uint32_t leaf) {
    Leaf& from = leaves_[leaf];
    const std::uint64_t n = from.waiting.ids.size();
    if (n == 0) return;
    if (from.written + n > total(leaf)) fail_changed();
    const std::string path = path_of(leaf);
    system_file::Descriptor file(from.written == 0 ? system_file::create(path) : system_file::open_to_write(path));
    if (!file.is_open()) fail(path, "cannot be created");
    if (!write(file.get(), from.waiting.xy.data(), 16 * n, 16 * from.written) ||
        !write(file.get(), from.waiting.ids.data(), 8 * n, 16 * total(leaf) + 8 * from.written) || !file.close())
      fail(path, "cannot be written");
    from.written += n;
    from.waiting.xy.clear();
    from.waiting.ids.clear();
  }

  const TileTree& tree_;
  std::string folder_;
  std::vector<Leaf> leaves_;
  std::uint64_t buffer_points_;
};

}  // namespace

void fail_changed() {
  throw io::FileError("the input", 0, "it has changed while it was read; nothing may write to it meanwhile");
}

std::unique_ptr<LeafStore> leaves_in_memory(const TileTree& tree) { return std::make_unique<MemoryLeaves>(tree); }

std::unique_ptr<LeafStore> leaves_in_files(const TileTree& tree, const std::string& scratch, std::uint64_t memory) {
  return std::make_unique<FileLeaves>(tree, scratch, memory);
}

BlockSorter::BlockSorter(const TileTree& tree) : tree_(tree), count_(tree.size()) {}

std::span<const LeafRun> BlockSorter::sort(std::uint64_t first_id, std::span<const double> xy) {
  const std::size_t n = xy.size() / 2;
  leaf_.resize(n), xy_.resize(2 * n), ids_.resize(n);
  touched_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    leaf_[i] = tree_.leaf_of(xy[2 * i], xy[2 * i + 1]);
    if (count_[leaf_[i]]++ == 0) touched_.push_back(leaf_[i]);
  }
  std::sort(touched_.begin(), touched_.end());
  std::uint32_t sum = 0;
  for (const std::uint32_t leaf : touched_) sum += std::exchange(count_[leaf], sum);  // now where its points begin
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t to = count_[leaf_[i]]++;
    xy_[2 * to] = xy[2 * i], xy_[2 * to + 1] = xy[2 * i + 1];
    ids_[to] = first_id + i;
  }
  runs_.clear();
  std::size_t begin = 0;
  for (const std::uint32_t leaf : touched_) {
    const std::size_t size = std::exchange(count_[leaf], 0) - begin;
    runs_.push_back({leaf, std::span(xy_).subspan(2 * begin, 2 * size), std::span(ids_).subspan(begin, size)});
    begin += size;
  }
  return runs_;
}

bool needs_scratch(std::uint64_t bytes, std::uint64_t memory, const std::string& scratch) {
  if (memory == 0 || bytes <= memory) return false;
  if (scratch.empty()) {
    throw OutOfMemory(
        "the points of all tiles do not fit into memory; name a folder for them with --scratch, or allow "
        "more with --host-memory",
        bytes, memory);
  }
  return true;
}

bool needs_scratch(const TileTree& tree, const ShuffleOptions& options) {
  std::uint64_t points = 0;
  for (const std::uint32_t leaf : tree.leaves())
    if (options.wanted.empty() || options.wanted[leaf]) points += tree.node(leaf).points;
  return needs_scratch(points * bytes_per_shuffled_point, options.memory, options.scratch);
}

namespace {

/// A thread of the shuffle: the runs of its block, and where they go.
struct Worker {
  explicit Worker(const TileTree& tree) : sorter(tree) {}
  BlockSorter sorter;
  std::span<const LeafRun> runs;
  std::vector<Room> rooms;
  Hash128 content;
};

}  // namespace

std::unique_ptr<LeafStore> shuffle(const PointSource& source, const TileTree& tree, const ShuffleOptions& options) {
  std::unique_ptr<LeafStore> leaves = needs_scratch(tree, options)
                                          ? leaves_in_files(tree, options.scratch, options.memory / 2)
                                          : leaves_in_memory(tree);
  const std::uint64_t blocks = (source.size() + block_points - 1) / block_points;
  PerThread<Worker> workers(threads_for(blocks, options.threads), [&] { return Worker(tree); });
  std::uint64_t done = 0;
  BlockWork work;
  work.look = [&](unsigned thread, std::uint64_t first, std::span<const double> xy) {
    Worker& mine = workers.of(thread);
    if (options.content) add_block_hash(mine.content, first, xy);
    mine.runs = mine.sorter.sort(options.first_id + first, xy);
  };
  work.in_turn = [&](unsigned thread) {
    Worker& mine = workers.of(thread);
    mine.rooms.assign(mine.runs.size(), {});
    for (std::size_t i = 0; i < mine.runs.size(); ++i) {
      const LeafRun& run = mine.runs[i];
      done += run.ids.size();
      if (!options.wanted.empty() && !options.wanted[run.leaf]) continue;
      mine.rooms[i] = leaves->add_room(run.leaf, run.ids.size());
      if (mine.rooms[i].ids == nullptr) leaves->add(run.leaf, run.xy, run.ids);
    }
    if (options.progress) options.progress(done);
  };
  work.then = [&](unsigned thread) {
    const Worker& mine = workers.of(thread);
    for (std::size_t i = 0; i < mine.runs.size(); ++i) {
      if (mine.rooms[i].ids == nullptr) continue;
      std::copy(mine.runs[i].xy.begin(), mine.runs[i].xy.end(), mine.rooms[i].xy);
      std::copy(mine.runs[i].ids.begin(), mine.runs[i].ids.end(), mine.rooms[i].ids);
    }
  };
  each_block(source, 0, source.size(), options.threads, options.stop, work);
  Hash128 content;
  workers.each([&](const Worker& worker) { content.high += worker.content.high, content.low += worker.content.low; });
  if (options.content && content != *options.content) fail_changed();
  leaves->finish();
  return leaves;
}

}  // namespace cadt::tiles
