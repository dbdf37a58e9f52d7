// SPDX-License-Identifier: Apache-2.0
#include "tiles/schedule.hpp"

#include <cadt/errors.hpp>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace cadt::tiles {

class Schedule::Work {
 public:
  Work(std::vector<Triangulators>& devices, const Job& job) : devices_(devices), job_(job), done_(job.done) {
    opens_.resize(job.tree.size());
    for (std::uint32_t i = 0; i < job.tree.size(); ++i) {
      if (done_[i]) ++count_done_, points_done_ += job.tree.node(i).is_leaf() ? job.tree.node(i).points : 0;
    }
    for (std::uint32_t i = 0; i < job.tree.size(); ++i) offer_join(i);
  }

  void run() {
    std::vector<std::thread> threads;
    guarded([&] {
      threads.emplace_back([this] { guarded([this] { read(); }); });
      for (unsigned w = 0; w < job_.writers; ++w) threads.emplace_back([this] { guarded([this] { write(); }); });
      for (unsigned d = 0; d < devices_.size(); ++d) {
        threads.emplace_back([this, d] { guarded([this, d] { compute_leaves(d); }); });
        threads.emplace_back([this, d] { guarded([this, d] { compute_joins(d); }); });
      }
    });
    for (std::thread& thread : threads) thread.join();
    const std::scoped_lock guard(lock_);  // fail() may still be called
    if (error_) std::rethrow_exception(error_);
  }

  void deliver(std::uint32_t node, Open&& open) {
    const std::scoped_lock guard(lock_);
    set_done(node, std::move(open));
  }
  void fail(std::exception_ptr error) {
    const std::scoped_lock guard(lock_);
    if (!error_) error_ = std::move(error);
    changed_.notify_all();
  }

 private:
  struct Loaded {
    LeafPoints points;
    double seconds = 0;
  };

  template <class Step>
  void guarded(const Step& step) {
    try {
      step();
    } catch (...) {
      fail(std::current_exception());
    }
  }

  void read() {
    for (const std::uint32_t leaf : job_.tree.leaves()) {
      if (job_.done[leaf] || is_awaited(leaf)) continue;
      {
        std::unique_lock guard(lock_);
        changed_.wait(guard, [&] { return loaded_.size() <= devices_.size() || error_; });
        if (error_) return;
      }
      if (job_.stop.stop_requested()) throw Cancelled();
      const auto start = std::chrono::steady_clock::now();
      Loaded loaded{.points = job_.read_leaf(leaf)};
      loaded.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const std::scoped_lock guard(lock_);
      loaded_.emplace(leaf, std::move(loaded));
      changed_.notify_all();
    }
    const std::scoped_lock guard(lock_);
    leaves_taken_ = true;
    changed_.notify_all();
  }

  /// Makes a join ready once its children are done. \pre locked
  void offer_join(std::uint32_t node) {
    if (node == no_node || done_[node] || is_awaited(node) || job_.tree.node(node).is_leaf()) return;
    if (done_[job_.tree.node(node).left] && done_[job_.tree.node(node).right]) joins_.insert(node);
  }

  void compute_leaves(unsigned device) {
    for (;;) {
      std::unique_lock guard(lock_);
      changed_.wait(guard, [&] { return !loaded_.empty() || leaves_taken_ || error_; });
      if (loaded_.empty() || error_) return;
      const std::uint32_t node = loaded_.begin()->first;
      Loaded loaded = std::move(loaded_.begin()->second);
      loaded_.erase(loaded_.begin());
      changed_.notify_all();  // there is room for another
      guard.unlock();
      NodeData data =
          compute_leaf(devices_[device].leaves, std::move(loaded.points), job_.tree.node(node).box, node, job_.compute);
      data.times.read = loaded.seconds;
      finish(device, std::move(data));
    }
  }

  void compute_joins(unsigned device) {
    for (;;) {
      std::unique_lock guard(lock_);
      changed_.wait(guard, [&] { return !joins_.empty() || count_done_ == done_.size() || error_; });
      if (joins_.empty() || error_) return;
      const std::uint32_t node = *joins_.begin();
      joins_.erase(joins_.begin());
      const TreeNode& where = job_.tree.node(node);
      std::vector<std::optional<Open>> given;
      for (const std::uint32_t child : {where.left, where.right}) given.push_back(std::exchange(opens_[child], {}));
      guard.unlock();
      std::vector<Open> children;
      for (std::size_t i = 0; i < given.size(); ++i)
        children.push_back(given[i] ? std::move(*given[i]) : job_.read_open(i == 0 ? where.left : where.right));
      finish(device, compute_join(devices_[device].joins, children, where.box, node, job_.compute));
    }
  }

  [[nodiscard]] bool is_awaited(std::uint32_t node) const { return !job_.awaited.empty() && job_.awaited[node]; }

  /// \pre locked
  void set_done(std::uint32_t node, Open&& open) {
    opens_[node] = std::move(open);
    done_[node] = true;
    ++count_done_;
    offer_join(job_.tree.node(node).parent);
    changed_.notify_all();
  }

  void finish(unsigned device, NodeData&& data) {
    if (job_.computed) job_.computed(data);
    const std::uint32_t node = data.node, parent = job_.tree.node(node).parent;
    Open open;
    if (parent != no_node && !done_parent(parent)) open = job_.keep_open ? data.open : std::move(data.open);
    std::unique_lock guard(lock_);
    changed_.wait(guard, [&] { return finished_.size() < devices_.size() || error_; });
    if (error_) return;
    finished_.emplace_back(device, std::move(data));
    set_done(node, std::move(open));
  }

  /// What was done before the run needs no open vertices of its children.
  [[nodiscard]] bool done_parent(std::uint32_t parent) const { return job_.done[parent]; }

  void write() {
    for (;;) {
      std::pair<unsigned, NodeData> next;
      {
        std::unique_lock guard(lock_);
        changed_.wait(guard, [&] { return !finished_.empty() || count_done_ == done_.size() || error_; });
        if (error_ || finished_.empty()) return;
        next = std::move(finished_.front());
        finished_.pop_front();
        changed_.notify_all();
      }
      const TreeNode& where = job_.tree.node(next.second.node);
      if (job_.write) job_.write(next.second);
      const std::scoped_lock one(finishing_);
      job_.finished(next.first, std::move(next.second));
      ++written_;
      if (where.is_leaf()) points_done_ += where.points;
      if (job_.progress) job_.progress(written_, points_done_);
    }
  }

  std::vector<Triangulators>& devices_;
  const Job& job_;
  std::mutex lock_;
  std::condition_variable changed_;
  std::exception_ptr error_;
  std::vector<bool> done_;
  std::size_t count_done_ = 0;
  std::mutex finishing_;  // of the writers; with it:
  std::uint32_t written_ = 0;
  std::uint64_t points_done_ = 0;
  std::map<std::uint32_t, Loaded> loaded_;
  bool leaves_taken_ = false;  // no more are read
  std::set<std::uint32_t> joins_;
  std::vector<std::optional<Open>> opens_;
  std::deque<std::pair<unsigned, NodeData>> finished_;
};

Schedule::Schedule(std::vector<Triangulators>& devices, const Job& job) : work_(std::make_unique<Work>(devices, job)) {}
Schedule::~Schedule() = default;
void Schedule::run() { work_->run(); }
void Schedule::deliver(std::uint32_t node, Open&& open) { work_->deliver(node, std::move(open)); }
void Schedule::fail(std::exception_ptr error) { work_->fail(std::move(error)); }

void run_nodes(std::vector<Triangulators>& devices, const Job& job) { Schedule(devices, job).run(); }

}  // namespace cadt::tiles
