// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 0
#include "bench/sequential_insertion.ipp"

namespace cadt::bench {
SequentialMesh insert_narrow(std::span<const double> xy, std::span<std::uint32_t> input_ids) {
  return Insertion(xy, input_ids).run();
}
}  // namespace cadt::bench
