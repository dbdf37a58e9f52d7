// SPDX-License-Identifier: Apache-2.0
// What the engine needs of MPI: collectives and messages of 64-bit words, of any length. Waiting leaves the core to
// others. All calls on the thread that made the communicator (MPI_THREAD_FUNNELED).
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cadt::tiles::mpi {

using Words = std::vector<std::uint64_t>;

/// Another rank has failed, and tells why on its standard error; this one stops with it.
class OtherRankFailed : public std::exception {
 public:
  explicit OtherRankFailed(int rank) : rank_(rank), text_("rank " + std::to_string(rank) + " has failed") {}
  [[nodiscard]] int rank() const noexcept { return rank_; }
  [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

 private:
  int rank_;
  std::string text_;
};

/// What messages are about.
enum class Kind : std::uint64_t {
  open,    ///< of a node, for its parent
  done,    ///< a node is finished, for the progress of rank 0
  failed,  ///< the sender has an error: stop
};
struct Message {
  int source = 0;
  Kind kind = Kind::open;
  std::uint64_t node = 0;
  Words words;
};

/// What came from each rank, in the order of ranks.
struct Exchanged {
  Words words;
  std::vector<std::size_t> begin;  ///< size() + 1 offsets in `words`
  [[nodiscard]] std::span<const std::uint64_t> from(int rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return std::span(words).subspan(begin[r], begin[r + 1] - begin[r]);
  }
};

/// All ranks that the MPI runtime has started: one object a process. Errors of MPI itself end all ranks.
class Communicator {
 public:
  /// Initialises MPI.
  Communicator(int& argc, char**& argv);
  /// Finalises it: all ranks must come here.
  ~Communicator();
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  [[nodiscard]] int rank() const noexcept;
  [[nodiscard]] int size() const noexcept;
  /// Among the ranks that share a memory: those of a node of the cluster.
  [[nodiscard]] int local_rank() const noexcept;
  [[nodiscard]] int local_size() const noexcept;
  [[nodiscard]] const std::string& host() const noexcept;
  /// Bytes that one message has at most: 2^28, far below the 2^31 elements that MPI can count, so that the messages of
  /// an exchange need no more memory. The environment variable CADT_MPI_MESSAGE_BYTES lowers it, for tests.
  [[nodiscard]] std::size_t message_bytes() const noexcept;

  // Collective: all ranks call them in the same order.

  /// Sums, modulo 2^64, and extremes over all ranks, element by element.
  void sum(std::span<std::uint64_t> values);
  void least(std::span<double> values);
  void most(std::span<double> values);
  /// The words of all ranks. Any length.
  [[nodiscard]] Exchanged all_gather(std::span<const std::uint64_t> words);
  /// The same among the ranks that share a memory, with equally many words each.
  [[nodiscard]] Words local_gather(std::span<const std::uint64_t> words);
  /// Those of rank `root`.
  void broadcast(Words& words, int root);
  /// Words for each rank. Those of all ranks for one must be less than 2^31. `came`: its memory is used again.
  void exchange(const std::vector<Words>& to, Exchanged& came);

  /// Ends a step that each rank does by itself: `error` is what this one has, or null. If any rank has one, it is
  /// thrown on all: the error itself on the rank that tells, OtherRankFailed on the others. That with the smallest
  /// index of a point tells, then the lowest rank; Cancelled counts only where nothing else is wrong.
  void settle(const std::exception_ptr& error);
  /// Whether settle() has thrown. An error that comes without is known to this rank alone, and abort() is the way out.
  [[nodiscard]] bool has_settled() const noexcept;
  /// Ends all ranks at once.
  [[noreturn]] void abort(int code) noexcept;
  /// Does the step, and settles it. The step must not communicate.
  template <class Step>
  void agree(const Step& step) {
    std::exception_ptr error;
    try {
      step();
    } catch (...) {
      error = std::current_exception();
    }
    settle(error);
  }

  // Messages from one rank to another, in the order in which they were sent.

  /// Begins to send; receive() goes on with it. Any length.
  void send(int to, Kind kind, std::uint64_t node, std::span<const std::uint64_t> words = {});
  /// The next message that has arrived as a whole, from any rank; nothing if there is none.
  [[nodiscard]] std::optional<Message> receive();
  /// Collective: ends a time of messages. Takes, and drops, what has not been received.
  void finish_messages();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Waits that grow: short ones first, then some that leave the core to others.
class Patience {
 public:
  void wait();
  void reset() noexcept { waits_ = 0; }

 private:
  unsigned waits_ = 0;
};

}  // namespace cadt::tiles::mpi
