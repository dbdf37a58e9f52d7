// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "bench/sequential.hpp"

namespace cadt::bench {

/// Inserts the points in their order; `labels` are their indices in the result. Of equal points the lowest label
/// stands. Narrow: \pre coordinates are multiples of 2^-240 below 1
[[nodiscard]] SequentialMesh insert_narrow(std::span<const double> xy, std::span<std::uint32_t> labels);
[[nodiscard]] SequentialMesh insert_wide(std::span<const double> xy, std::span<std::uint32_t> labels);

}  // namespace cadt::bench
