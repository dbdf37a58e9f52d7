// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "bench/sequential.hpp"

namespace cadt::bench {

/// Inserts the points in their order; `input_ids` are their input ids. Of equal points the lowest id is the vertex.
/// \pre narrow: coordinates are multiples of 2^-240 below 1
[[nodiscard]] SequentialMesh insert_narrow(std::span<const double> xy, std::span<std::uint32_t> input_ids);
[[nodiscard]] SequentialMesh insert_wide(std::span<const double> xy, std::span<std::uint32_t> input_ids);

}  // namespace cadt::bench
