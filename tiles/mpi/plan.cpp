// SPDX-License-Identifier: Apache-2.0
#include "tiles/mpi/plan.hpp"

#include "tiles/cells.hpp"
#include "tiles/mpi/schedule.hpp"
#include "tiles/parallel.hpp"

#include <array>
#include <atomic>
#include <bit>
#include <utility>

namespace cadt::tiles::mpi {
namespace {

/// Adds up the passes of all ranks.
void reduce(Communicator& ranks, TreePass& pass) {
  ranks.sum(pass.counts);
  std::vector<double> lower, upper;
  for (std::size_t i = 0; i < pass.bounds.size(); ++i) (i % 4 < 2 ? lower : upper).push_back(pass.bounds[i]);
  ranks.least(lower);
  ranks.most(upper);
  for (std::size_t i = 0; i < pass.bounds.size(); ++i) pass.bounds[i] = (i % 4 < 2 ? lower : upper)[i / 4 * 2 + i % 2];
  Words words;
  for (const double v : pass.sample) words.push_back(std::bit_cast<std::uint64_t>(v));
  const Exchanged all = ranks.all_gather(words);
  pass.sample.clear();
  for (const std::uint64_t word : all.words) pass.sample.push_back(std::bit_cast<double>(word));
}

}  // namespace

Plan make_plan(Communicator& ranks, const PointSource& source, const RunOptions& options, const cadt::stop_token& stop,
               const std::function<void(double)>& progress) {
  Plan plan;
  plan.tile_points = options.tile_points;
  plan.first_id = options.first_id;
  if (in_cells(source, options.tile_points)) {
    ranks.agree([&] {
      plan.content = content_of_cells(*source.cells());
      plan.tree = tree_of_cells(*source.cells(), options.tile_points).value();
    });
    return plan;
  }
  TreeBuilder builder(source.size(), options.tile_points);
  const auto [begin, end] = slice(source.size(), block_points, ranks.rank(), ranks.size());
  const unsigned threads =
      threads_for((end - begin + block_points - 1) / block_points, options.devices.front().threads);
  for (bool first_pass = true; first_pass || !builder.done(); first_pass = false) {
    PerThread<TreePass> passes(threads, [&] { return builder.new_pass(); });
    std::vector<Hash128> hashes(threads);
    ranks.agree([&, begin = begin, end = end] {
      std::atomic<std::uint64_t> done{0};
      BlockWork work;
      work.look = [&](unsigned thread, std::uint64_t first, std::span<const double> xy) {
        if (first_pass) add_block_hash(hashes[thread], first, xy);
        if (!builder.done()) builder.look_at(passes.of(thread), first, xy);
        done += xy.size() / 2;
        if (thread == 0 && progress) progress(static_cast<double>(done.load()) / static_cast<double>(end - begin));
      };
      each_block(source, begin, end, threads, stop, work);
    });
    std::array<std::uint64_t, 2> content{};
    for (const Hash128& hash : hashes) content[0] += hash.high, content[1] += hash.low;
    ranks.sum(content);
    plan.content.high += content[0], plan.content.low += content[1];
    if (builder.done()) continue;
    TreePass sum = builder.new_pass();
    passes.each([&](const TreePass& pass) { sum += pass; });
    reduce(ranks, sum);
    ranks.agree([&] { builder.finish_pass(std::move(sum)); });
  }
  plan.tree = builder.take();
  return plan;
}

}  // namespace cadt::tiles::mpi
