// SPDX-License-Identifier: Apache-2.0
// The machine of the measurements.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cadt::bench {

/// Another program that takes part, for the record.
struct PeerInfo {
  std::string name, version;
  bool usable = false;
  std::string reason;  ///< why it is not usable
};

[[nodiscard]] std::string cpu_name();
/// As many as the process may use, not as the machine has.
[[nodiscard]] unsigned cores();
/// Bytes that the system says can be taken without swapping; the largest number if it does not say.
[[nodiscard]] std::uint64_t memory_available();
/// The first usable GPU, else the processor.
[[nodiscard]] std::string default_machine_name();
/// machine.json
[[nodiscard]] std::string machine_json(const std::string& name, const std::vector<PeerInfo>& peers);

}  // namespace cadt::bench
