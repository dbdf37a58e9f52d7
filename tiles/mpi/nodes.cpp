// SPDX-License-Identifier: Apache-2.0
#include "tiles/mpi/nodes.hpp"

#include <cadt/errors.hpp>

#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace cadt::tiles::mpi {
namespace {

/// The thread that speaks with the other ranks; another runs the schedule.
class Speaker {
 public:
  Speaker(Communicator& ranks, std::vector<Triangulators>& devices, Job&& job, const Nodes& nodes)
      : ranks_(ranks), nodes_(nodes), job_(std::move(job)) {
    const std::uint32_t size = job_.tree.size();
    job_.done.assign(size, true);
    job_.awaited.assign(size, false);
    for (std::uint32_t i = 0; i < size; ++i) {
      if (nodes.valid[i]) continue;
      ++all_;
      const std::uint32_t parent = job_.tree.node(i).parent;
      const bool mine = is_mine(i);
      job_.awaited[i] = !mine && parent != no_node && is_mine(parent) && !nodes.valid[parent];
      job_.done[i] = !mine && !job_.awaited[i];
    }
    job_.stop = nodes.stop.get_token();
    job_.computed = [this](const NodeData& data) { post(data); };
    const auto finished = job_.finished;
    job_.finished = [this, finished](unsigned device, NodeData&& data) {
      const std::uint32_t node = data.node;
      finished(device, std::move(data));
      const std::scoped_lock guard(lock_);
      outbox_.push_back({.to = 0, .kind = Kind::done, .node = node, .words = {}});
    };
    schedule_.emplace(devices, job_);
  }

  void run() {
    std::thread worker([this] {
      std::exception_ptr error;
      try {
        schedule_->run();
      } catch (...) {
        error = std::current_exception();
      }
      const std::scoped_lock guard(lock_);
      error_ = std::move(error);
      over_ = true;
    });
    std::exception_ptr error;
    try {
      speak();
    } catch (...) {
      error = std::current_exception();
      nodes_.stop.request_stop();
      schedule_->fail(error);
    }
    worker.join();
    if (error_) error = error_;
    if (error && !stopped_) {
      for (int r = 0; r < ranks_.size(); ++r)
        if (r != ranks_.rank()) ranks_.send(r, Kind::failed, 0);
    }
    ranks_.finish_messages();
    ranks_.settle(error);
  }

 private:
  struct Letter {
    int to = 0;
    Kind kind = Kind::open;
    std::uint32_t node = 0;
    Words words;
  };

  [[nodiscard]] bool is_mine(std::uint32_t node) const { return nodes_.owner[node] == ranks_.rank(); }

  /// What is open goes to the rank of the parent, if that is another. On the threads of the devices.
  void post(const NodeData& data) {
    const std::uint32_t parent = job_.tree.node(data.node).parent;
    if (parent == no_node || is_mine(parent) || nodes_.valid[parent]) return;
    Letter letter{.to = nodes_.owner[parent], .kind = Kind::open, .node = data.node, .words = pack(data.open)};
    const std::scoped_lock guard(lock_);
    outbox_.push_back(std::move(letter));
  }

  void speak() {
    Patience patience;
    for (;;) {
      std::vector<Letter> letters;
      bool over = false, failed = false;
      {
        const std::scoped_lock guard(lock_);
        letters.swap(outbox_);
        over = over_;
        failed = error_ != nullptr;
      }
      bool idle = letters.empty();
      for (const Letter& letter : letters) {
        if (letter.to == ranks_.rank()) {
          note_done();
        } else {
          ranks_.send(letter.to, letter.kind, letter.node, letter.words);
        }
      }
      while (std::optional<Message> message = ranks_.receive()) {
        idle = false;
        take(std::move(*message));
      }
      // Rank 0 stays to the end, to tell how far all are.
      if (over && (failed || ranks_.rank() != 0 || done_ == all_)) return;
      if (nodes_.interrupted.stop_requested()) throw Cancelled();
      if (!idle) patience.reset();
      patience.wait();
    }
  }

  void take(Message&& message) {
    switch (message.kind) {
      case Kind::open:
        schedule_->deliver(static_cast<std::uint32_t>(message.node), unpack_open(message.words));
        break;
      case Kind::done:
        note_done();
        break;
      case Kind::failed:
        stopped_ = true;
        throw Cancelled();  // settle() finds what happened
    }
  }

  void note_done() {
    ++done_;
    if (nodes_.progress) nodes_.progress(done_);
  }

  Communicator& ranks_;
  const Nodes& nodes_;
  Job job_;
  std::optional<Schedule> schedule_;
  std::uint32_t all_ = 0, done_ = 0;
  bool stopped_ = false;  // by another rank
  std::mutex lock_;
  std::vector<Letter> outbox_;
  std::exception_ptr error_;  // of the schedule
  bool over_ = false;
};

}  // namespace

void make_nodes(Communicator& ranks, std::vector<Triangulators>& devices, Job&& job, const Nodes& nodes) {
  Speaker(ranks, devices, std::move(job), nodes).run();
}

}  // namespace cadt::tiles::mpi
