// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 1
#include "bench/sequential_insertion.ipp"

namespace cadt::bench {
SequentialMesh insert_wide(std::span<const double> xy, std::span<std::uint32_t> labels) {
  return Insertion(xy, labels).run();
}
}  // namespace cadt::bench
