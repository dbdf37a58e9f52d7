// SPDX-License-Identifier: Apache-2.0
#include <cadt/errors.hpp>

#include "tiles/mpi/plan.hpp"
#include "tiles/parallel.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <future>

namespace cadt::tiles::mpi {
namespace {

/// A message is a list of runs: leaf, number of points, their coordinates, their ids.
constexpr std::size_t words_per_point = 3, words_per_run = 2;
/// That a rank reads in a round: whole blocks, whose messages stay in the cache of a core.
constexpr std::uint64_t part_points = 2 * block_points;
/// Less for a thread is not worth to start it.
constexpr std::size_t least_points = std::size_t{1} << 14;

struct Part {
  std::uint64_t first = 0;
  std::vector<double> xy;
  Hash128 content;
};

/// Sorts parts of the input into a message for each rank.
class Dealer {
 public:
  Dealer(const TileTree& tree, const Deal& deal, std::size_t ranks)
      : deal_(deal),
        ranks_(ranks),
        threads_(std::max(1U, deal.threads)),
        sorters_(threads_, [&tree] { return BlockSorter(tree); }),
        sorted_(threads_, std::vector<Words>(ranks)) {}

  /// Pieces of a part by several threads, put together in their order. Valid until the next call.
  const std::vector<Words>& operator()(const Part& part) {
    const std::size_t points = part.xy.size() / 2;
    const std::size_t pieces = std::clamp<std::size_t>(points / least_points, 1, threads_);
    std::vector<std::future<void>> helpers;
    for (std::size_t p = 0; p < pieces; ++p) {
      const std::size_t begin = points * p / pieces, end = points * (p + 1) / pieces;
      helpers.push_back(std::async(p + 1 == pieces ? std::launch::deferred : std::launch::async, [&, p, begin, end] {
        sort(sorters_.of(static_cast<unsigned>(p)), part.first + begin,
             std::span(part.xy).subspan(2 * begin, 2 * (end - begin)), sorted_[p]);
      }));
    }
    for (auto& helper : helpers) helper.wait();
    for (auto& helper : helpers) helper.get();
    for (std::size_t p = 1; p < pieces; ++p) {
      for (std::size_t r = 0; r < ranks_; ++r)
        sorted_[0][r].insert(sorted_[0][r].end(), sorted_[p][r].begin(), sorted_[p][r].end());
    }
    return sorted_[0];
  }

 private:
  void sort(BlockSorter& sorter, std::uint64_t first, std::span<const double> xy, std::vector<Words>& to) const {
    for (Words& words : to) words.clear();
    for (const LeafRun& run : sorter.sort(deal_.options.first_id + first, xy)) {
      if (!deal_.wanted[run.leaf]) continue;
      Words& words = to[static_cast<std::size_t>(deal_.owner[run.leaf])];
      words.insert(words.end(), {run.leaf, run.ids.size()});
      const std::size_t at = words.size();
      words.resize(at + run.xy.size());
      std::memcpy(words.data() + at, run.xy.data(), run.xy.size_bytes());
      words.insert(words.end(), run.ids.begin(), run.ids.end());
    }
  }

  const Deal& deal_;
  std::size_t ranks_;
  unsigned threads_;
  PerThread<BlockSorter> sorters_;
  std::vector<std::vector<Words>> sorted_;  // of each thread, for each rank
};

void keep(LeafStore& leaves, std::span<const std::uint64_t> words) {
  std::vector<double> xy;
  while (!words.empty()) {
    const auto leaf = static_cast<std::uint32_t>(words[0]);
    const auto n = static_cast<std::size_t>(words[1]);
    xy.resize(2 * n);
    std::memcpy(xy.data(), words.data() + words_per_run, xy.size() * sizeof xy[0]);
    leaves.add(leaf, xy, words.subspan(words_per_run + 2 * n, n));
    words = words.subspan(words_per_run + words_per_point * n);
  }
}

}  // namespace

std::unique_ptr<LeafStore> shuffle(Communicator& ranks, const PointSource& source, const TileTree& tree,
                                   const Deal& deal) {
  std::unique_ptr<LeafStore> leaves;
  ranks.agree([&] {
    leaves = needs_scratch(tree, deal.options) ? leaves_in_files(tree, deal.options.scratch, deal.options.memory / 2)
                                               : leaves_in_memory(tree);
  });
  const auto size = static_cast<std::uint64_t>(ranks.size()), all = source.size();
  const std::uint64_t parts = (all + part_points - 1) / part_points;
  // Even if all points of a round are for one rank, each in a run of its own, that rank receives message_bytes() at
  // most, or one part. So with many ranks some of them read in a round, and the others in the next ones.
  const std::uint64_t readers = std::clamp<std::uint64_t>(
      ranks.message_bytes() / sizeof(std::uint64_t) / (words_per_point + words_per_run) / part_points, 1, size);
  const auto read = [&](std::uint64_t p) {
    Part part{.first = std::min(all, p * part_points), .xy = {}, .content = {}};
    part.xy.resize(2 * std::min(part_points, all - part.first));
    source.read(part.first, part.xy.size() / 2, part.xy.data());
    add_blocks_hash(part.content, part.first, part.xy);
    return part;
  };
  Dealer dealer(tree, deal, static_cast<std::size_t>(ranks.size()));
  auto mine = static_cast<std::uint64_t>(ranks.rank());  // the next part of this rank, which reads each size-th one
  std::future<Part> next = std::async(std::launch::async, read, mine);
  std::array<std::uint64_t, 2> content{};
  Exchanged came;
  for (std::uint64_t begin = 0; begin < parts; begin += readers) {
    const std::uint64_t end = std::min(parts, begin + readers);
    const std::vector<Words>* to = nullptr;
    ranks.agree([&] {
      if (deal.options.stop.stop_requested()) throw Cancelled();
      Part part;  // none of this rank in this round
      if (mine < end) {
        part = next.get();
        mine += size;
        next = std::async(std::launch::async, read, mine);
      }
      content[0] += part.content.high, content[1] += part.content.low;
      to = &dealer(part);
    });
    ranks.exchange(*to, came);
    ranks.agree([&] {
      for (std::uint64_t p = begin; p < end; ++p) keep(*leaves, came.from(static_cast<int>(p % size)));
    });
    if (deal.options.progress) deal.options.progress(std::min(all, end * part_points));
  }
  ranks.sum(content);
  ranks.agree([&] {
    if (deal.options.content && Hash128{content[0], content[1]} != *deal.options.content) fail_changed();
    leaves->finish();
  });
  return leaves;
}

}  // namespace cadt::tiles::mpi
