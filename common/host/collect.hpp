// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/host/build_mesh.hpp"
#include "common/host/run.hpp"
#include "common/host/triangulation_data.hpp"

namespace cadt {

/// Numbers the triangles in the order asked for and fills triangles, neighbours and hull of `data`.
/// \pre data.points is set; `labels` maps vertices to input indices
void collect_mesh(Run& run, const DeviceMesh& mesh, const Allocation& labels, Triangulation::Data& data);

}  // namespace cadt
