// SPDX-License-Identifier: Apache-2.0
// The contestants: the sequential baseline, other programs, and each back end of cadt.
#pragma once

#include "bench/peers.hpp"

#include <cadt/cadt.hpp>

#include <optional>
#include <string>
#include <vector>

namespace cadt::bench {

struct Contestant {
  std::string who;                 ///< sequential, cgal, scipy, cupy, host, opencl, cuda
  std::optional<Backend> backend;  ///< of cadt
  std::string index;               ///< as Options::device takes it
  std::string device;              ///< as its driver names it
  bool gpu = false;
  unsigned threads = 0;      ///< of the processor; 0: none of its own
  std::optional<Peer> peer;  ///< a program of its own
  std::string missing;       ///< why it cannot take part
  [[nodiscard]] bool present() const { return missing.empty(); }
};

/// Filters; an empty one accepts all.
struct Choice {
  std::vector<std::string> who, backends;
  std::string device;  ///< number or part of its name; does not apply to the host
};

/// The names that `who` may have, in the order of the tables.
[[nodiscard]] const std::vector<std::string>& all_who();

/// One contestant of each kind, those of cadt on the library's default device. Missing ones have the reason.
[[nodiscard]] std::vector<Contestant> find_contestants(const Choice& choice, const std::vector<Peer>& peers);
/// cadt on every usable device of every back end and platform.
[[nodiscard]] std::vector<Contestant> every_device(const Choice& choice);

}  // namespace cadt::bench
