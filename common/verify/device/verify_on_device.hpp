// SPDX-License-Identifier: Apache-2.0
// The driver of the verifier on the device (common/verify/device/verify.dev.h).
#pragma once

#include <cadt/verify.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/driver/context.hpp"

namespace cadt {
namespace verifier {
struct Mesh;
}

/// A mesh in device memory, and what goes with it on the host. The memory must stay alive until the verifier returns.
struct VerifyInput {
  const Allocation& points;               ///< cadt_point each: the coordinates of the input, unscaled
  const Allocation& triangles;            ///< 3 x number_of_triangles words
  const Allocation& neighbors;            ///< the same number
  std::size_t number_of_points = 0;       ///< below 2^31
  std::size_t number_of_triangles = 0;    ///< more than 0, at most 2^32 / 3
  std::span<const std::int32_t> hull;     ///< compared if it is not empty
  std::span<const Duplicate> duplicates;  ///< compared if `has_duplicates`
  bool has_duplicates = false;
  const Allocation* edge_flags = nullptr;  ///< number_of_triangles words; null: no edge is constrained
};

/// The checks of `verify`, with the same names and outcomes. A kernel that did not run, or not over all elements, fails
/// "counts". \throws InputError for a coordinate that is not finite, and what launches throw
[[nodiscard]] VerifyReport verify_on_device(Context& run, const VerifyInput& input, const VerifyOptions& options);

/// The same with what the host has of the mesh (points, triangles, neighbours, or nothing), which then need not be
/// fetched.
[[nodiscard]] VerifyReport verify_on_device(Context& run, const VerifyInput& input, const VerifyOptions& options,
                                            verifier::Mesh known);

/// The same for a mesh of the host on a device that is open: uploads, then verifies.
[[nodiscard]] VerifyReport verify_on_device(Device& device, PointsView points, const MeshView& mesh,
                                            const Options& run_options, const VerifyOptions& options);

}  // namespace cadt
