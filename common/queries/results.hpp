// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/driver/context.hpp"

namespace cadt {

/// What `write` leaves in device memory for `count` elements, as a vector; on the host it is written there at once.
template <class T, class Write>
[[nodiscard]] std::vector<T> to_vector(Context& ctx, std::size_t count, const Write& write) {
  std::vector<T> result(count);
  if (count == 0) return result;
  const std::size_t bytes = count * sizeof(T);
  Allocation memory = ctx.memory.export_to(result.data(), bytes);
  const bool copied = !memory;
  if (copied) memory = ctx.memory.allocate(bytes);
  write(memory);
  if (copied) ctx.device.read(*memory, 0, result.data(), bytes);
  ctx.device.finish();
  return result;
}

}  // namespace cadt
