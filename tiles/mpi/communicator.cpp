// SPDX-License-Identifier: Apache-2.0
#include "tiles/mpi/communicator.hpp"

#include <cadt/errors.hpp>

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <climits>
#include <cstdlib>
#include <list>
#include <thread>
#include <tuple>

namespace cadt::tiles::mpi {
namespace {

constexpr int message_tag = 1;
constexpr std::size_t header_words = 3;  // kind, node, words that follow
constexpr std::size_t least_message_bytes = 256;

/// Non-blocking calls and this, since the waiting of MPI itself takes a whole core.
void finish(MPI_Request request) {
  Patience patience;
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
    patience.wait();
  }
}

std::size_t message_limit() {
  constexpr std::size_t usual = std::size_t{1} << 28;
  const char* text = std::getenv("CADT_MPI_MESSAGE_BYTES");
  if (text == nullptr) return usual;
  const unsigned long long bytes = std::strtoull(text, nullptr, 10);
  return std::clamp<std::size_t>(bytes, least_message_bytes, usual);
}

int to_int(std::size_t n) {
  if (n > INT_MAX) throw InternalError("a message of " + std::to_string(n) + " words is more than MPI can count");
  return static_cast<int>(n);
}

}  // namespace

void Patience::wait() {
  constexpr unsigned yields = 200, naps = 2000;
  ++waits_;
  if (waits_ < yields) {
    std::this_thread::yield();
  } else {
    std::this_thread::sleep_for(std::chrono::microseconds(waits_ < naps ? 100 : 1000));
  }
}

struct Communicator::Data {
  MPI_Comm world = MPI_COMM_NULL, local = MPI_COMM_NULL;
  int rank = 0, size = 1, local_rank = 0, local_size = 1;
  std::string host;
  std::size_t message_bytes = 0;
  bool settled = false;

  struct Outgoing {
    Words words;
    std::vector<MPI_Request> requests;
  };
  struct Incoming {
    Words words;            // with the header
    std::size_t whole = 0;  // words of the whole message; 0: nothing has come
  };
  Words exchanged;  // what exchange() sends
  std::list<Outgoing> outgoing;
  std::vector<Incoming> incoming;                           // by source
  std::vector<std::uint64_t> pieces_sent, pieces_received;  // by rank

  [[nodiscard]] std::size_t piece_words() const noexcept { return message_bytes / sizeof(std::uint64_t); }
  void forget_what_is_sent() {
    std::erase_if(outgoing, [](Outgoing& o) {
      int done = 0;
      MPI_Testall(static_cast<int>(o.requests.size()), o.requests.data(), &done, MPI_STATUSES_IGNORE);
      return done != 0;
    });
  }
  /// Takes one piece that has arrived.
  std::optional<Message> take(const MPI_Status& status) {
    int count = 0;
    MPI_Get_count(&status, MPI_UINT64_T, &count);
    const auto source = static_cast<std::size_t>(status.MPI_SOURCE);
    Incoming& in = incoming[source];
    const std::size_t had = in.words.size();
    in.words.resize(had + static_cast<std::size_t>(count));
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Irecv(in.words.data() + had, count, MPI_UINT64_T, status.MPI_SOURCE, message_tag, world, &request);
    finish(request);
    ++pieces_received[source];
    if (in.whole == 0) in.whole = header_words + in.words.at(2);
    if (in.words.size() < in.whole) return std::nullopt;
    Message message{.source = status.MPI_SOURCE, .kind = Kind{in.words[0]}, .node = in.words[1], .words = {}};
    in.words.erase(in.words.begin(), in.words.begin() + header_words);
    message.words = std::exchange(in, {}).words;
    return message;
  }
  template <class Number>
  void reduce(std::span<Number> values, MPI_Datatype type, MPI_Op operation) {
    const std::size_t most = message_bytes / sizeof(Number);
    while (!values.empty()) {
      const std::span<Number> part = values.first(std::min(most, values.size()));
      MPI_Request request = MPI_REQUEST_NULL;
      MPI_Iallreduce(MPI_IN_PLACE, part.data(), to_int(part.size()), type, operation, world, &request);
      finish(request);
      values = values.subspan(part.size());
    }
  }
  Words gather(std::span<const std::uint64_t> words, MPI_Comm among, int ranks) const {
    Words all(words.size() * static_cast<std::size_t>(ranks));
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallgather(words.data(), to_int(words.size()), MPI_UINT64_T, all.data(), to_int(words.size()), MPI_UINT64_T,
                   among, &request);
    finish(request);
    return all;
  }
};

Communicator::Communicator(int& argc, char**& argv) : data_(std::make_unique<Data>()) {
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  Data& d = *data_;
  MPI_Comm_dup(MPI_COMM_WORLD, &d.world);
  MPI_Comm_rank(d.world, &d.rank);
  MPI_Comm_size(d.world, &d.size);
  MPI_Comm_split_type(d.world, MPI_COMM_TYPE_SHARED, d.rank, MPI_INFO_NULL, &d.local);
  MPI_Comm_rank(d.local, &d.local_rank);
  MPI_Comm_size(d.local, &d.local_size);
  std::array<char, MPI_MAX_PROCESSOR_NAME> name{};
  int length = 0;
  MPI_Get_processor_name(name.data(), &length);
  d.host.assign(name.data(), static_cast<std::size_t>(length));
  d.message_bytes = message_limit();
  const auto ranks = static_cast<std::size_t>(d.size);
  d.incoming.resize(ranks);
  d.pieces_sent.resize(ranks);
  d.pieces_received.resize(ranks);
}

Communicator::~Communicator() {
  MPI_Comm_free(&data_->local);
  MPI_Comm_free(&data_->world);
  MPI_Finalize();
}

int Communicator::rank() const noexcept { return data_->rank; }
int Communicator::size() const noexcept { return data_->size; }
int Communicator::local_rank() const noexcept { return data_->local_rank; }
int Communicator::local_size() const noexcept { return data_->local_size; }
const std::string& Communicator::host() const noexcept { return data_->host; }
std::size_t Communicator::message_bytes() const noexcept { return data_->message_bytes; }

void Communicator::sum(std::span<std::uint64_t> values) { data_->reduce(values, MPI_UINT64_T, MPI_SUM); }
void Communicator::least(std::span<double> values) { data_->reduce(values, MPI_DOUBLE, MPI_MIN); }
void Communicator::most(std::span<double> values) { data_->reduce(values, MPI_DOUBLE, MPI_MAX); }

Words Communicator::local_gather(std::span<const std::uint64_t> words) {
  return data_->gather(words, data_->local, data_->local_size);
}

Exchanged Communicator::all_gather(std::span<const std::uint64_t> words) {
  const auto ranks = static_cast<std::size_t>(data_->size);
  const std::uint64_t mine = words.size();
  const Words sizes = data_->gather(std::span(&mine, 1), data_->world, data_->size);
  Exchanged all;
  all.begin.assign(1, 0);
  for (const std::uint64_t n : sizes) all.begin.push_back(all.begin.back() + n);
  all.words.resize(all.begin.back());
  // In pieces, each of which is received from all ranks at once.
  const std::size_t piece = std::max<std::size_t>(1, data_->piece_words() / ranks);
  const std::size_t longest = *std::max_element(sizes.begin(), sizes.end());
  Words buffer;
  for (std::size_t at = 0; at < longest; at += piece) {
    std::vector<int> counts, begins;
    std::size_t sum = 0;
    for (const std::uint64_t n : sizes) {
      counts.push_back(to_int(n <= at ? 0 : std::min<std::size_t>(piece, n - at)));
      begins.push_back(to_int(sum));
      sum += static_cast<std::size_t>(counts.back());
    }
    buffer.resize(sum);
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallgatherv(words.data() + std::min(at, words.size()), counts[static_cast<std::size_t>(data_->rank)],
                    MPI_UINT64_T, buffer.data(), counts.data(), begins.data(), MPI_UINT64_T, data_->world, &request);
    finish(request);
    for (std::size_t r = 0; r < ranks; ++r)
      std::copy_n(buffer.data() + begins[r], counts[r], all.words.data() + all.begin[r] + std::min(at, sizes[r]));
  }
  return all;
}

void Communicator::broadcast(Words& words, int root) {
  std::uint64_t size = words.size();
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibcast(&size, 1, MPI_UINT64_T, root, data_->world, &request);
  finish(request);
  words.resize(size);
  for (std::size_t at = 0; at < words.size(); at += data_->piece_words()) {
    MPI_Ibcast(words.data() + at, to_int(std::min(data_->piece_words(), words.size() - at)), MPI_UINT64_T, root,
               data_->world, &request);
    finish(request);
  }
}

void Communicator::exchange(const std::vector<Words>& to, Exchanged& came) {
  const auto ranks = static_cast<std::size_t>(data_->size);
  Words sizes(ranks), coming(ranks);
  for (std::size_t r = 0; r < ranks; ++r) sizes[r] = to[r].size();
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ialltoall(sizes.data(), 1, MPI_UINT64_T, coming.data(), 1, MPI_UINT64_T, data_->world, &request);
  finish(request);
  std::vector<int> send_counts, send_begins, counts, begins;
  Words& out = data_->exchanged;
  out.clear();
  came.begin.assign(1, 0);
  for (std::size_t r = 0; r < ranks; ++r) {
    send_counts.push_back(to_int(sizes[r]));
    send_begins.push_back(to_int(out.size()));
    out.insert(out.end(), to[r].begin(), to[r].end());
    counts.push_back(to_int(coming[r]));
    begins.push_back(to_int(came.begin.back()));
    came.begin.push_back(came.begin.back() + coming[r]);
  }
  came.words.resize(came.begin.back());
  MPI_Ialltoallv(out.data(), send_counts.data(), send_begins.data(), MPI_UINT64_T, came.words.data(), counts.data(),
                 begins.data(), MPI_UINT64_T, data_->world, &request);
  finish(request);
}

void Communicator::settle(const std::exception_ptr& error) {
  enum Weight : std::uint64_t { point, any, cancelled, none };
  std::array<std::uint64_t, 2> mine{none, 0};
  try {
    if (error) std::rethrow_exception(error);
  } catch (const InputError& e) {
    mine = {point, e.index()};
  } catch (const Cancelled&) {
    mine = {cancelled, 0};
  } catch (...) {
    mine = {any, 0};
  }
  const Words all = data_->gather(mine, data_->world, data_->size);
  std::size_t teller = 0;
  for (std::size_t r = 1; r < all.size() / 2; ++r) {
    if (std::tie(all[2 * r], all[2 * r + 1]) < std::tie(all[2 * teller], all[2 * teller + 1])) teller = r;
  }
  if (all[2 * teller] == none) return;
  data_->settled = true;
  if (static_cast<int>(teller) == data_->rank) std::rethrow_exception(error);
  throw OtherRankFailed(static_cast<int>(teller));
}

bool Communicator::has_settled() const noexcept { return data_->settled; }

void Communicator::abort(int code) noexcept {
  MPI_Abort(data_->world, code);
  std::_Exit(code);
}

void Communicator::send(int to, Kind kind, std::uint64_t node, std::span<const std::uint64_t> words) {
  Data::Outgoing& out = data_->outgoing.emplace_back();
  out.words.reserve(header_words + words.size());
  out.words.assign({static_cast<std::uint64_t>(kind), node, words.size()});
  out.words.insert(out.words.end(), words.begin(), words.end());
  for (std::size_t at = 0; at < out.words.size(); at += data_->piece_words()) {
    MPI_Isend(out.words.data() + at, to_int(std::min(data_->piece_words(), out.words.size() - at)), MPI_UINT64_T, to,
              message_tag, data_->world, &out.requests.emplace_back());
    ++data_->pieces_sent[static_cast<std::size_t>(to)];
  }
}

std::optional<Message> Communicator::receive() {
  data_->forget_what_is_sent();
  for (;;) {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, message_tag, data_->world, &there, &status);
    if (there == 0) return std::nullopt;
    if (std::optional<Message> message = data_->take(status)) return message;
  }
}

void Communicator::finish_messages() {
  const auto ranks = static_cast<std::size_t>(data_->size);
  Words coming(ranks);
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ialltoall(data_->pieces_sent.data(), 1, MPI_UINT64_T, coming.data(), 1, MPI_UINT64_T, data_->world, &request);
  finish(request);
  Patience patience;
  while (data_->pieces_received != coming) {
    if (receive()) patience.reset();
    patience.wait();
  }
  while (!data_->outgoing.empty()) {
    data_->forget_what_is_sent();
    patience.wait();
  }
  std::fill(data_->pieces_sent.begin(), data_->pieces_sent.end(), 0);
  std::fill(data_->pieces_received.begin(), data_->pieces_received.end(), 0);
}

}  // namespace cadt::tiles::mpi
