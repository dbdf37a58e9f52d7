// SPDX-License-Identifier: Apache-2.0
#include "tiles/mpi/share.hpp"

#include <sched.h>

#include <algorithm>
#include <thread>

namespace cadt::tiles::mpi {
namespace {

constexpr std::size_t bits = 64;
constexpr std::size_t most_cores = 8192;  // that Linux counts

bool has(std::span<const std::uint64_t> cores, std::size_t core) {
  return (cores[core / bits] >> core % bits & 1) != 0;
}

}  // namespace

Words allowed_cores() {
  Words words(most_cores / bits);
  cpu_set_t* const set = reinterpret_cast<cpu_set_t*>(words.data());
  if (::sched_getaffinity(0, words.size() * sizeof words[0], set) == 0) return words;
  const std::size_t all = std::min<std::size_t>(std::thread::hardware_concurrency(), most_cores);
  for (std::size_t core = 0; core < all; ++core) words[core / bits] |= std::uint64_t{1} << core % bits;
  return words;
}

unsigned share_of_cores(Communicator& ranks) {
  const Words mine = allowed_cores();
  const Words all = ranks.local_gather(mine);
  double share = 0;
  for (std::size_t core = 0; core < bits * mine.size(); ++core) {
    if (!has(mine, core)) continue;
    std::size_t users = 0;
    for (std::size_t at = 0; at < all.size(); at += mine.size()) {
      if (has(std::span(all).subspan(at, mine.size()), core)) ++users;
    }
    share += 1 / static_cast<double>(users);
  }
  constexpr double rounding = 1e-6;  // of a sum of thirds
  return static_cast<unsigned>(std::max(1.0, share + rounding));
}

Options share_of_devices(Options options, int local_rank, std::span<const std::string> named,
                         std::span<const DeviceInfo> devices) {
  const auto turn = static_cast<std::size_t>(local_rank);
  if (!named.empty()) {
    options.device = named[turn % named.size()];
    return options;
  }
  if (!options.device.empty() || options.backend == Backend::host) return options;
  const auto candidates = [&](Backend backend, bool gpu) {
    std::vector<const DeviceInfo*> found;
    for (const DeviceInfo& device : devices) {
      if (device.backend == backend && device.usable && device.fp64 && device.gpu == gpu) found.push_back(&device);
    }
    return found;
  };
  std::vector<const DeviceInfo*> found;
  if (options.backend == Backend::automatic) {
    found = candidates(Backend::cuda, true);
    if (found.empty()) found = candidates(Backend::opencl, true);
    options.backend = found.empty() ? Backend::host : found.front()->backend;
  } else {
    found = candidates(options.backend, true);
    if (found.empty()) found = candidates(options.backend, false);
  }
  // None: the triangulator says why.
  if (!found.empty()) options.device = std::to_string(found[turn % found.size()]->index);
  return options;
}

}  // namespace cadt::tiles::mpi
