// SPDX-License-Identifier: Apache-2.0
// What the measurements were made on.
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
/// As the process may use them, not as the machine has them.
[[nodiscard]] unsigned cores();
/// Bytes that the system says can be taken without swapping; the largest number if it does not say.
[[nodiscard]] std::uint64_t memory_available();
/// The first usable graphics card, else the processor.
[[nodiscard]] std::string default_machine_name();
/// machine.json
[[nodiscard]] std::string machine_json(const std::string& name, const std::vector<PeerInfo>& peers);

}  // namespace cadt::bench
