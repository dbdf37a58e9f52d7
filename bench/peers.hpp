// SPDX-License-Identifier: Apache-2.0
// Other triangulators, each in a process of its own: a missing one affects no other, and neither does a crash.
//
// A peer is called in two ways:
//
//     PEER --version
//     PEER POINTS.f64 --warm-up W --runs R --limit SECONDS
//
// POINTS.f64 holds interleaved little-endian doubles. The peer prints one JSON object, and nothing else, on standard
// output: {"name", "version"}, in the second case with "triangles", "warmups" (how many it made) and "milliseconds" (an
// array, one for each timed run) or with "error". It ends with 0, or with 3 if it cannot be used here, e.g. because a
// module is missing. A time is that from points in memory, in the peer's own layout, to the triangulation in memory;
// "timing": "device" says that both are in GPU memory. Once the limit is used up no run starts, except for one timed
// run.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace cadt::bench {

struct Peer {
  std::string name;                  ///< cgal, scipy, cupy
  std::vector<std::string> command;  ///< program and first arguments
  std::string version;               ///< as it says itself; empty if it is not usable
  std::string reason;                ///< why it is not usable; empty if it is
  [[nodiscard]] bool usable() const { return reason.empty(); }
};

struct PeerResult {
  std::string name, version, error;  ///< error: empty if it has times
  bool too_slow = false;             ///< it was killed
  std::size_t triangles = 0, warmups = 0;
  std::vector<double> milliseconds;
  std::string timing;  ///< "device" if points and triangles are in device memory, else empty or "host"
};

/// All peers, those that are not usable with the reason. Programs are looked for beside the caller's, Python on the
/// path: of several the first one that has the module.
[[nodiscard]] std::vector<Peer> find_peers(const std::filesystem::path& program_folder);

/// Runs it; three times the limit and half a minute later it is killed. What goes wrong is in `error`.
[[nodiscard]] PeerResult run_peer(const Peer& peer, const std::string& points_file, int warm_up, int runs,
                                  double limit_seconds);

}  // namespace cadt::bench
