// SPDX-License-Identifier: Apache-2.0
#include "tiles/run.hpp"

#include <cadt/errors.hpp>
#include <cadt/io/errors.hpp>

#include "tiles/cells.hpp"
#include "tiles/machine.hpp"
#include "tiles/parallel.hpp"
#include "tiles/run_parts.hpp"
#include "tiles/schedule.hpp"
#include "tiles/stopwatch.hpp"

#include <algorithm>
#include <future>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

namespace cadt::tiles {
namespace {

void tell(const RunOptions& options, std::string_view phase, std::uint64_t done, std::uint64_t all,
          std::uint32_t nodes_done = 0, std::uint32_t nodes = 0) {
  if (!options.progress) return;
  const double fraction = all == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(all);
  options.progress({.phase = phase, .fraction = fraction, .nodes_done = nodes_done, .nodes = nodes});
}

constexpr unsigned large_files = 4;  // of a node

/// Nodes that are written at the same time. A file takes one thread, since the system lets one at a time write to it;
/// so a node takes a few, and as many nodes as there are threads for, while a quarter of the memory holds them.
unsigned writers(const PointSource& source, const RunOptions& options) {
  if (options.output.empty()) return 1;
  const std::uint64_t node = std::min(source.size(), options.tile_points) * written_bytes;
  const unsigned most = std::max(1U, threads_for(~std::uint64_t{0}, threads_of(options)) / large_files);
  return static_cast<unsigned>(
      std::clamp<std::uint64_t>(available_memory() / 4 / std::max<std::uint64_t>(node, 1), 1, most));
}

std::uint64_t shuffle_memory(const PointSource& source, const RunOptions& options) {
  return shuffle_memory(options, available_memory(), leaf_memory(source, options, writers(source, options)));
}

/// Opens all devices at the same time. GPUs take the memory of their tiles now: the first call would wait for it.
std::vector<Triangulators> open_devices(const RunOptions& options, std::uint64_t points) {
  const auto open = [&](const Options& given) {
    const Options chosen = device_options(given, options, options.stop);
    Triangulators opened{Triangulator(chosen), Triangulator(chosen)};
    if (opened.leaves.device().gpu) {
      try {
        opened.leaves.reserve(static_cast<std::size_t>(std::min(points, options.tile_points)));
      } catch (const OutOfMemory&) {  // NOLINT: it is an upper bound; leaves may need less, or say what they need
      }
    }
    return opened;
  };
  std::vector<std::future<Triangulators>> opening;
  for (const Options& chosen : options.devices) opening.push_back(std::async(std::launch::async, open, chosen));
  std::vector<Triangulators> devices;
  for (std::future<Triangulators>& device : opening) devices.push_back(device.get());
  return devices;
}

LeafPoints all_points(const PointSource& source, const RunOptions& options, const Hash128& content) {
  LeafPoints points;
  points.xy.resize(2 * source.size());
  points.ids.resize(source.size());
  const unsigned threads = threads_for((source.size() + block_points - 1) / block_points, threads_of(options));
  std::vector<Hash128> hashes(threads);
  BlockWork work;
  work.look = [&](unsigned thread, std::uint64_t first, std::span<const double> xy) {
    add_block_hash(hashes[thread], first, xy);
    std::copy(xy.begin(), xy.end(), points.xy.begin() + static_cast<std::ptrdiff_t>(2 * first));
    const auto ids = std::span(points.ids).subspan(first, xy.size() / 2);
    std::iota(ids.begin(), ids.end(), options.first_id + first);
  };
  each_block(source, 0, source.size(), threads, options.stop, work);
  Hash128 found;
  for (const Hash128& hash : hashes) found.high += hash.high, found.low += hash.low;
  if (found != content) fail_changed();
  return points;
}

NodeReport report_of(const NodeData& data, unsigned device) {
  return {.times = data.times,
          .points = data.sums.points,
          .triangles = data.sums.triangles,
          .open = data.open_vertices,
          .device = device,
          .resumed = false,
          .statistics = data.statistics};
}

/// One run, after its plan is known.
class Run {
 public:
  Run(const PointSource& source, const RunOptions& options, RunResult& result)
      : source_(source), options_(options), result_(result), tree_(result.plan.tree) {}

  void operator()(std::vector<Triangulators>& devices) {
    result_.nodes.resize(tree_.size());
    if (!options_.output.empty()) open_store();
    if (store_ && store_->complete()) {
      const Manifest manifest = store_->finish();
      for (std::uint32_t i = 0; i < tree_.size(); ++i) result_.nodes[i] = report_of(manifest.nodes[i]);
      return complete(manifest);
    }
    find_done();
    Stopwatch watch;
    shuffle_points();
    result_.shuffle_seconds = watch.lap();
    compute(devices);
    result_.nodes_seconds = watch.lap();
    tell(options_, "links", 0, 1);
    if (store_) {
      complete(store_->finish());
    } else {
      require_complete(result_.whole, tree_);
      result_.hash = hash_of(result_.whole);
    }
    result_.links_seconds = watch.lap();
  }

 private:
  void open_store() {
    store_.emplace(options_.output, result_.plan, options_.resume ? Store::Start::resume : Store::Start::create);
  }

  void find_done() {
    done_.assign(tree_.size(), false);
    if (!store_ || !options_.resume) return;
    for (std::uint32_t i = 0; i < tree_.size(); ++i) {
      if (options_.stop.stop_requested()) throw Cancelled();
      done_[i] = store_->is_valid(i);
      if (done_[i]) result_.nodes[i] = report_of(store_->read_record(i));
      tell(options_, "check", i + 1, tree_.size());
    }
  }

  void shuffle_points() {
    if (tree_.size() == 1 || in_cells(source_, options_.tile_points)) return;
    ShuffleOptions shuffling;
    shuffling.scratch = options_.scratch;
    shuffling.first_id = options_.first_id;
    shuffling.content = result_.plan.content;
    shuffling.memory = shuffle_memory(source_, options_);
    shuffling.wanted = done_;
    shuffling.wanted.flip();
    shuffling.threads = threads_of(options_);
    shuffling.stop = options_.stop;
    shuffling.progress = [&](std::uint64_t points) { tell(options_, "shuffle", points, source_.size()); };
    const auto leaves = tree_.leaves();
    if (std::all_of(leaves.begin(), leaves.end(), [&](std::uint32_t leaf) { return done_[leaf]; })) return;
    result_.scratch_used = needs_scratch(tree_, shuffling);
    leaves_ = shuffle(source_, tree_, shuffling);
  }

  void compute(std::vector<Triangulators>& devices) {
    Job job(tree_, done_);
    if (in_cells(source_, options_.tile_points)) {
      job.read_leaf = cells_of_leaves(source_, tree_, options_.first_id);
    } else {
      job.read_leaf = [&](std::uint32_t leaf) {
        return leaves_ ? leaves_->take(leaf) : all_points(source_, options_, result_.plan.content);
      };
    }
    job.read_open = [&](std::uint32_t node) { return store_.value().read_open(node); };
    job.compute.arrays = takes_arrays(options_);
    job.compute.consumer = options_.consumer;
    job.keep_open = job.compute.arrays;
    job.writers = writers(source_, options_);
    job.write = [&](NodeData& data) {
      Stopwatch watch;
      if (store_) store_->write(data, threads_for(large_files, threads_of(options_)));
      data.times.write = watch.lap();
    };
    job.finished = [&](unsigned device, NodeData&& data) {
      result_.nodes[data.node] = report_of(data, device);
      result_.whole += data.sums;
      if (options_.collect) options_.collect(std::move(data));
    };
    const auto all = static_cast<std::uint32_t>(tree_.size());
    const auto before = static_cast<std::uint32_t>(std::count(done_.begin(), done_.end(), true));
    job.progress = [&, all, before](std::uint32_t nodes, std::uint64_t points) {
      tell(options_, "tiles", points, source_.size(), before + nodes, all);
    };
    job.stop = options_.stop;
    run_nodes(devices, job);
    leaves_.reset();
  }

  void complete(const Manifest& manifest) {
    result_.whole = manifest.whole;
    result_.hash = manifest.hash;
  }

  const PointSource& source_;
  const RunOptions& options_;
  RunResult& result_;
  const TileTree& tree_;
  std::optional<Store> store_;
  std::vector<bool> done_;
  std::unique_ptr<LeafStore> leaves_;
};

}  // namespace

Plan make_plan(const PointSource& source, const RunOptions& options) {
  Plan plan;
  plan.tile_points = options.tile_points;
  plan.first_id = options.first_id;
  if (const UniformCells* cells = source.cells())
    if (std::optional<TileTree> tree = tree_of_cells(*cells, options.tile_points)) {
      plan.content = content_of_cells(*cells);
      plan.tree = std::move(*tree);
      return plan;
    }
  TreeBuilder builder(source.size(), options.tile_points);
  for (bool first_pass = true; first_pass || !builder.done(); first_pass = false) {
    TreePass pass = plan_pass(source, 0, source.size(), options, builder, first_pass ? &plan.content : nullptr,
                              [&](std::uint64_t done) { tell(options, "sample", done, source.size()); });
    if (!builder.done()) builder.finish_pass(std::move(pass));
  }
  plan.tree = builder.take();
  return plan;
}

void preflight(const PointSource& source, const RunOptions& options) {
  require_tile_points(options);
  // Memory: that of the leaves at work, and of the points of all leaves unless they go to scratch.
  const bool shuffles = source.size() > options.tile_points && !in_cells(source, options.tile_points);
  const std::uint64_t available = available_memory(), leaf = leaf_memory(source, options, writers(source, options));
  if (leaf > available) {
    throw OutOfMemory("the tiles at work do not fit into memory", leaf, available);
  }
  const std::uint64_t shuffled = shuffles ? source.size() * bytes_per_shuffled_point : 0;
  const bool scratch = needs_scratch(shuffled, shuffle_memory(options, available, leaf), options.scratch);
  const std::uint64_t output = output_bytes(source, options);
  const bool one_disk = scratch && output != 0 && same_disk(options.output, options.scratch);
  if (output != 0) require_disk(options.output, output + (one_disk ? shuffled : 0));
  if (scratch && !one_disk) require_disk(options.scratch, shuffled);
}

RunResult run(const PointSource& source, const RunOptions& options) {
  if (options.devices.empty()) throw std::invalid_argument("a run needs a device");
  preflight(source, options);
  if (!options.output.empty() && !options.resume) check_new_directory(options.output);
  std::vector<Triangulators> devices = open_devices(options, source.size());
  RunResult result;
  for (const Triangulators& device : devices) result.devices.push_back(device.leaves.device().name);
  Stopwatch watch;
  result.plan = make_plan(source, options);
  result.sample_seconds = watch.lap();
  Run(source, options, result)(devices);
  for (const NodeReport& node : result.nodes) result.most_open = std::max(result.most_open, node.open);
  return result;
}

}  // namespace cadt::tiles
