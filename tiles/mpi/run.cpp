// SPDX-License-Identifier: Apache-2.0
#include "tiles/mpi/run.hpp"

#include <cadt/errors.hpp>

#include "tiles/cells.hpp"
#include "tiles/mpi/nodes.hpp"
#include "tiles/mpi/owners.hpp"
#include "tiles/mpi/plan.hpp"
#include "tiles/mpi/reports.hpp"
#include "tiles/run_parts.hpp"
#include "tiles/stopwatch.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

namespace cadt::tiles::mpi {
namespace {

/// One run of one rank.
class Run {
 public:
  Run(Communicator& ranks, const PointSource& source, const RunOptions& options)
      : ranks_(ranks), source_(source), options_(options) {}

  RunResult operator()() {
    preflight(ranks_, source_, options_);
    Stopwatch watch;
    tell("sample", 0);
    result_.plan = make_plan(ranks_, source_, options_, [this](double f) { tell("sample", f); });
    result_.nodes.resize(tree().size());
    valid_.assign(tree().size(), false);
    result_.sample_seconds = watch.lap();
    if (!options_.output.empty()) open_store();
    if (!complete_) make(watch);
    tell("links", 0);
    finish();
    result_.links_seconds = watch.lap();
    for (const NodeReport& node : result_.nodes) result_.most_open = std::max(result_.most_open, node.open);
    return std::move(result_);
  }

 private:
  [[nodiscard]] const TileTree& tree() const noexcept { return result_.plan.tree; }
  [[nodiscard]] bool is_first() const noexcept { return ranks_.rank() == 0; }

  void tell(std::string_view phase, double fraction, std::uint32_t nodes_done = 0) const {
    if (is_first() && options_.progress)
      options_.progress({.phase = phase,
                         .fraction = fraction,
                         .nodes_done = nodes_done,
                         .nodes = nodes_done == 0 ? 0 : tree().size()});
  }

  void open_store() {
    ranks_.agree([&] {
      if (is_first())
        store_.emplace(options_.output, result_.plan, options_.resume ? Store::Start::resume : Store::Start::create);
    });
    Words complete{is_first() && store_->complete() ? 1U : 0U};
    ranks_.broadcast(complete, 0);
    complete_ = complete[0] != 0;
    if (complete_) return;
    ranks_.agree([&] {
      if (!is_first()) store_.emplace(options_.output, result_.plan, Store::Start::join);
    });
    if (options_.resume) find_valid();
  }

  /// Each rank looks at some nodes: that reads all of their files.
  void find_valid() {
    Words found(tree().size());
    ranks_.agree([&] {
      const auto step = static_cast<std::uint32_t>(ranks_.size());
      for (auto i = static_cast<std::uint32_t>(ranks_.rank()); i < tree().size(); i += step) {
        if (options_.stop.stop_requested()) throw Cancelled();
        if (!store_->is_valid(i)) continue;
        found[i] = 1;
        append(reports_, i, report_of(store_->read_record(i)));
        tell("check", static_cast<double>(i) / tree().size());
      }
    });
    ranks_.sum(found);
    for (std::uint32_t i = 0; i < tree().size(); ++i) valid_[i] = found[i] != 0;
  }

  void make(Stopwatch& watch) {
    const std::vector<int> owner = owners(tree(), valid_, ranks_.size());
    std::vector<Triangulators> devices;
    ranks_.agree([&] {
      const Options chosen = device_options(options_.devices.front(), options_, stop_.get_token());
      devices.push_back({Triangulator(chosen), Triangulator(chosen)});
    });
    result_.devices = gather_texts(ranks_, devices.front().leaves.device().name + " on " + ranks_.host());
    shuffle_points(owner);
    result_.shuffle_seconds = watch.lap();
    compute(devices, owner);
    result_.nodes_seconds = watch.lap();
  }

  void shuffle_points(const std::vector<int>& owner) {
    if (in_cells(source_, options_.tile_points)) return;
    std::vector<bool> wanted = valid_;
    wanted.flip();
    ShuffleOptions mine;
    mine.scratch = options_.scratch;
    mine.first_id = options_.first_id;
    mine.content = result_.plan.content;
    mine.memory = shuffle_memory(ranks_, source_, options_);
    mine.stop = options_.stop;
    mine.progress = [this](std::uint64_t points) {
      tell("shuffle", static_cast<double>(points) / static_cast<double>(source_.size()));
    };
    std::uint64_t bytes = 0;
    for (std::uint32_t i = 0; i < tree().size(); ++i) {
      mine.wanted.push_back(wanted[i] && owner[i] == ranks_.rank());
      if (mine.wanted[i] && tree().node(i).is_leaf()) bytes += tree().node(i).points * bytes_per_shuffled_point;
    }
    ranks_.agree([&] { result_.scratch_used = needs_scratch(tree(), mine); });
    require_scratch(ranks_, mine.scratch, result_.scratch_used ? bytes : 0);
    const auto leaves = tree().leaves();
    if (std::none_of(leaves.begin(), leaves.end(), [&](std::uint32_t leaf) { return wanted[leaf]; })) return;
    tell("shuffle", 0);
    const Deal deal{.owner = owner, .wanted = wanted, .options = mine, .threads = options_.devices.front().threads};
    leaves_ = shuffle(ranks_, source_, tree(), deal);
  }

  void compute(std::vector<Triangulators>& devices, const std::vector<int>& owner) {
    Job job(tree(), {});
    if (in_cells(source_, options_.tile_points)) {
      job.read_leaf = cells_of_leaves(source_, tree(), options_.first_id);
    } else {
      job.read_leaf = [this](std::uint32_t leaf) { return leaves_->take(leaf); };
    }
    job.read_open = [this](std::uint32_t node) { return store_.value().read_open(node); };
    job.compute.arrays = takes_arrays(options_);
    job.compute.consumer = options_.consumer;
    job.keep_open = job.compute.arrays;
    job.finished = [this](unsigned, NodeData&& data) {
      NodeReport report{.times = data.times,
                        .points = data.sums.points,
                        .triangles = data.sums.triangles,
                        .open = data.open_vertices,
                        .device = static_cast<unsigned>(ranks_.rank()),
                        .resumed = false,
                        .statistics = std::move(data.statistics)};
      result_.whole += data.sums;
      Stopwatch watch;
      if (store_) store_->write(data);
      report.times.write = watch.lap();
      append(reports_, data.node, report);
      result_.nodes[data.node] = std::move(report);
      if (options_.collect) options_.collect(std::move(data));
    };
    const auto before = static_cast<std::uint32_t>(std::count(valid_.begin(), valid_.end(), true));
    const auto progress = [this, before](std::uint32_t done) {
      tell("tiles", static_cast<double>(before + done) / tree().size(), before + done);
    };
    tell("tiles", 0);
    make_nodes(ranks_, devices, std::move(job),
               {.owner = owner, .valid = valid_, .progress = progress, .interrupted = options_.stop, .stop = stop_});
    leaves_.reset();
  }

  /// All nodes are there: rank 0 completes the directory, and all know the sums.
  void finish() {
    ranks_.agree([&] {
      if (!store_ || !is_first()) return;
      const Manifest manifest = store_->finish();
      result_.whole = manifest.whole;
      if (complete_)
        for (std::uint32_t i = 0; i < tree().size(); ++i) append(reports_, i, report_of(manifest.nodes[i]));
    });
    Words sums = pack(result_.whole);
    if (!options_.output.empty()) {
      ranks_.broadcast(sums, 0);
      result_.whole = unpack_sums(sums);
    } else {
      const Exchanged all = ranks_.all_gather(sums);
      result_.whole = {};
      for (int r = 0; r < ranks_.size(); ++r) result_.whole += unpack_sums(all.from(r));
    }
    ranks_.agree([&] { require_complete(result_.whole, tree()); });
    result_.hash = hash_of(result_.whole);
    read_reports(ranks_.all_gather(reports_).words, result_.nodes);
  }

  Communicator& ranks_;
  const PointSource& source_;
  const RunOptions& options_;
  RunResult result_;
  std::optional<Store> store_;
  bool complete_ = false;  // before the run
  std::vector<bool> valid_;
  cadt::stop_source stop_;
  std::unique_ptr<LeafStore> leaves_;
  Words reports_;  // of this rank's nodes
};

}  // namespace

RunResult run(Communicator& ranks, const PointSource& source, const RunOptions& options) {
  ranks.agree([&] {
    if (options.devices.size() != 1) throw std::invalid_argument("a rank has one device");
  });
  return Run(ranks, source, options)();
}

}  // namespace cadt::tiles::mpi
