// SPDX-License-Identifier: Apache-2.0
// A search by relacy (protocol_model.ipp) among the orders of steps of three threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace model {

/// Of all threads of all runs of splits and flips; locks alone have ten times as many runs.
struct Totals {
  std::uint64_t flips = 0, splits = 0, lost = 0, invalid = 0;
};

struct Found {
  bool claims_passed = false;  ///< lock, validation, stores and unlock of one triangle
  bool mesh_passed = false;    ///< splits and flips in a mesh; not looked at if the locks failed
  std::string text;            ///< what relacy says
  std::size_t illegal = 0;     ///< edges that the mesh begins with
  Totals totals;
};

[[nodiscard]] Found search_cpu(unsigned long runs);  ///< the memory orders of CPUs
[[nodiscard]] Found search_gpu(unsigned long runs);  ///< those of GPUs

}  // namespace model
