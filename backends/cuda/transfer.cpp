// SPDX-License-Identifier: Apache-2.0
#include "backends/cuda/transfer.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <utility>

#include "common/platform/parallel.hpp"

namespace cadt::cuda {
namespace {

constexpr std::size_t least_piece = Transfer::slot_bytes / 2;  // the bus takes as long to start as to copy a quarter
constexpr std::size_t huge_page = std::size_t{2} << 20;

/// Whether the driver copies this byte directly.
bool locked(const void* host) noexcept {
  cudaPointerAttributes attributes{};
  if (const cudaError_t code = cudaPointerGetAttributes(&attributes, host); code != cudaSuccess) {
    ignore(code);
    return false;
  }
  return attributes.type != cudaMemoryTypeUnregistered;
}

}  // namespace

struct Transfer::Piece {
  std::size_t offset = 0, bytes = 0;  ///< no bytes: nothing is left
};

/// One copy, which the lanes take block by block. Of each block, pieces go through the slots of one lane: no two
/// threads make the pages of one huge page.
struct Transfer::Job {
  std::byte* host;
  std::byte* device;
  std::size_t bytes, block, piece;
  bool to_host;
  std::atomic<std::size_t> next = 0;             ///< first byte that nobody has taken
  std::atomic<cudaError_t> error = cudaSuccess;  ///< the first one; ends the job

  [[nodiscard]] Piece take() noexcept {
    if (error.load(std::memory_order_relaxed) != cudaSuccess) return {};
    const std::size_t offset = next.fetch_add(block, std::memory_order_relaxed);
    return offset < bytes ? Piece{offset, std::min(block, bytes - offset)} : Piece{};
  }
  /// Whether the call succeeded.
  bool check(cudaError_t code) noexcept {
    if (code == cudaSuccess) return true;
    cudaGetLastError();
    cudaError_t none = cudaSuccess;
    error.compare_exchange_strong(none, code);
    return false;
  }
};

/// What one thread copies with.
struct Transfer::Lane {
  cudaStream_t stream = nullptr;
  std::array<cudaEvent_t, 2> done{};  ///< the bus has copied the slot
  std::array<std::byte*, 2> slots{};
  Piece rest;  ///< of the block that was taken last

  Lane() = default;
  ~Lane() {
    if (stream != nullptr) ignore(cudaStreamDestroy(stream));
    for (cudaEvent_t event : done)
      if (event != nullptr) ignore(cudaEventDestroy(event));
    if (slots[0] != nullptr) ignore(cudaFreeHost(slots[0]));
  }
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;

  [[nodiscard]] cudaError_t make() noexcept {
    void* memory = nullptr;
    cudaError_t code = cudaHostAlloc(&memory, 2 * slot_bytes, cudaHostAllocDefault);
    if (code != cudaSuccess) return code;
    slots = {static_cast<std::byte*>(memory), static_cast<std::byte*>(memory) + slot_bytes};
    code = cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking);
    for (cudaEvent_t& event : done)
      if (code == cudaSuccess) code = cudaEventCreateWithFlags(&event, cudaEventDisableTiming);
    return code;
  }

  [[nodiscard]] Piece take(Job& job) noexcept {
    if (rest.bytes == 0) rest = job.take();
    const Piece piece{rest.offset, std::min(job.piece, rest.bytes)};
    rest = {rest.offset + piece.bytes, rest.bytes - piece.bytes};
    return piece;
  }

  /// The bus copies a piece from or to a slot.
  bool start(Job& job, const Piece& piece, std::size_t slot) noexcept {
    std::byte* const there = job.device + piece.offset;
    const cudaError_t code = job.to_host
                                 ? cudaMemcpyAsync(slots[slot], there, piece.bytes, cudaMemcpyDeviceToHost, stream)
                                 : cudaMemcpyAsync(there, slots[slot], piece.bytes, cudaMemcpyHostToDevice, stream);
    return job.check(code) && job.check(cudaEventRecord(done[slot], stream));
  }

  void work(Job& job) noexcept {
    rest = {};
    if (job.to_host)
      fetch(job);
    else
      send(job);
    job.check(cudaStreamSynchronize(stream));  // after an error, too: the bus no longer uses the slots
  }

  void fetch(Job& job) noexcept {
    std::size_t slot = 0;
    Piece piece = take(job);
    if (piece.bytes == 0 || !start(job, piece, slot)) return;
    while (piece.bytes != 0) {
      if (!job.check(cudaEventSynchronize(done[slot]))) return;
      const Piece following = take(job);
      if (following.bytes != 0 && !start(job, following, 1 - slot)) return;
      std::memcpy(job.host + piece.offset, slots[slot], piece.bytes);
      piece = following;
      slot = 1 - slot;
    }
  }

  void send(Job& job) noexcept {
    std::size_t slot = 0;
    for (Piece piece = take(job); piece.bytes != 0; piece = take(job), slot = 1 - slot) {
      if (!job.check(cudaEventSynchronize(done[slot]))) return;  // an event of an earlier copy is done
      std::memcpy(slots[slot], job.host + piece.offset, piece.bytes);
      if (!start(job, piece, slot)) return;
    }
  }
};

Transfer::Transfer(std::shared_ptr<Stream> stream, unsigned threads) noexcept
    : stream_(std::move(stream)), threads_(std::min(platform::threads_or_all(threads), most_threads)) {}

Transfer::~Transfer() { release(); }

void Transfer::release() noexcept {
  const ContextScope scope(stream_->context());
  lanes_.clear();
  refused_ = false;
  copied_ = 0;
}

bool Transfer::prepare(const void* host, std::size_t bytes) {
  if (bytes < fewest_bytes || threads_ == 1) return false;
  const auto* last = static_cast<const std::byte*>(host) + (bytes - 1);
  if (locked(host) && locked(last)) return false;
  copied_ += bytes;
  return lanes_for(bytes) != 0;
}

std::size_t Transfer::lanes_for(std::size_t bytes) {
  const std::size_t wanted = std::min<std::size_t>(threads_, (bytes - 1) / slot_bytes + 1);
  const std::size_t earned = std::min(wanted, copied_ / bytes_a_lane), fewest = std::min(wanted, fewest_lanes);
  while (earned >= fewest && lanes_.size() < earned && !refused_) {
    auto lane = std::make_unique<Lane>();
    if (const cudaError_t code = lane->make(); code == cudaErrorMemoryAllocation) {
      cudaGetLastError();
      refused_ = true;
    } else {
      check(code, "cudaHostAlloc", stream_->name());
      lanes_.push_back(std::move(lane));
    }
  }
  const std::size_t lanes = std::min(lanes_.size(), wanted);
  return lanes >= fewest ? lanes : 0;
}

void Transfer::run(Job& job) {
  stream_->wait();  // the lanes' streams know nothing of it
  const std::size_t blocks = (job.bytes - 1) / job.block + 1, lanes = std::min(lanes_.size(), blocks);
  workers_.run(lanes, [&](std::size_t lane) {
    const ContextScope scope(stream_->context());
    lanes_[lane]->work(job);
  });
  check(job.error, job.to_host ? "a copy to the host" : "a copy to the device", stream_->name());
}

void Transfer::to_device(void* device, const void* host, std::size_t bytes) {
  const std::size_t share = (bytes / lanes_.size() + least_piece - 1) / least_piece * least_piece;
  const std::size_t piece = std::clamp(share, least_piece, slot_bytes);
  Job job{.host = const_cast<std::byte*>(static_cast<const std::byte*>(host)),
          .device = static_cast<std::byte*>(device),
          .bytes = bytes,
          .block = piece,
          .piece = piece,
          .to_host = false};
  run(job);
}

void Transfer::to_host(void* host, const void* device, std::size_t bytes) {
  Job job{.host = static_cast<std::byte*>(host),
          .device = const_cast<std::byte*>(static_cast<const std::byte*>(device)),
          .bytes = bytes,
          .block = bytes >= lanes_.size() * huge_page ? huge_page : slot_bytes,
          .piece = slot_bytes,
          .to_host = true};
  run(job);
}

}  // namespace cadt::cuda
