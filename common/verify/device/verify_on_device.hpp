// SPDX-License-Identifier: Apache-2.0
// The driver of the verifier on the device (common/verify/device/verify.dev.h).
#pragma once

#include <cadt/verify.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/driver/context.hpp"
#include "common/mesh/mesh.hpp"
#include "common/verify/host/mesh.hpp"

namespace cadt {

/// A mesh in device memory, and what goes with it on the host. The memory must stay alive until the verifier returns.
struct VerifyInput {
  DeviceMeshView mesh;  ///< of 1 to 2^32 / 3 triangles, finished; its points are those of the input, unscaled
  std::size_t number_of_points = 0;       ///< below 2^31
  std::span<const std::int32_t> hull;     ///< compared if it is not empty
  std::span<const Duplicate> duplicates;  ///< compared if `has_duplicates`
  bool has_duplicates = false;
};

/// The checks of `verify`, with the same names and outcomes. A kernel that did not run, or not over all elements, fails
/// "counts". `known`: what the host has of the mesh (points, triangles, neighbours, or nothing), which then need not be
/// fetched. \throws InputError for a coordinate that is not finite, and what launches throw
[[nodiscard]] VerifyReport verify_on_device(Context& run, const VerifyInput& input, const VerifyOptions& options,
                                            verifier::Mesh known = {});

/// The same for a mesh of the host on a device that is open: uploads, then verifies.
[[nodiscard]] VerifyReport verify_on_device(Device& device, PointsView points, const MeshView& mesh,
                                            const Options& run_options, const VerifyOptions& options);

}  // namespace cadt
