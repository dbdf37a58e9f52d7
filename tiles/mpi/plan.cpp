// SPDX-License-Identifier: Apache-2.0
#include "tiles/mpi/plan.hpp"

#include "tiles/cells.hpp"
#include "tiles/mpi/owners.hpp"
#include "tiles/run_parts.hpp"

#include <array>
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

Plan make_plan(Communicator& ranks, const PointSource& source, const RunOptions& options,
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
  const auto part = slice(source.size(), block_points, ranks.rank(), ranks.size());
  const auto tell = [&](std::uint64_t done) {
    if (progress) progress(static_cast<double>(done) / static_cast<double>(part.second - part.first));
  };
  for (bool first_pass = true; first_pass || !builder.done(); first_pass = false) {
    TreePass pass;
    Hash128 hash;
    ranks.agree([&] {
      pass = plan_pass(source, part.first, part.second, options, builder, first_pass ? &hash : nullptr, tell);
    });
    std::array<std::uint64_t, 2> content{hash.high, hash.low};
    ranks.sum(content);
    plan.content.high += content[0], plan.content.low += content[1];
    if (builder.done()) continue;
    reduce(ranks, pass);
    ranks.agree([&] { builder.finish_pass(std::move(pass)); });
  }
  plan.tree = builder.take();
  return plan;
}

}  // namespace cadt::tiles::mpi
