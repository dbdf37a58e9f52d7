// SPDX-License-Identifier: Apache-2.0
// Constrained meshes as arrays, which tests of the verifier change.
#pragma once

#include <memory>

#include "common/constraints/constrained_data.hpp"

namespace cadt::test {

inline std::unique_ptr<ConstrainedTriangulation::Data> copy_of(const ConstrainedTriangulation& mesh) {
  auto data = std::make_unique<ConstrainedTriangulation::Data>();
  data->mesh = mesh.mesh();
  data->edge_flags.assign(mesh.edge_flags().begin(), mesh.edge_flags().end());
  data->chain_offsets.assign(mesh.chain_offsets().begin(), mesh.chain_offsets().end());
  data->chain_vertices.assign(mesh.chain_vertices().begin(), mesh.chain_vertices().end());
  data->inside.assign(mesh.inside().begin(), mesh.inside().end());
  data->number_inside = mesh.number_inside();
  data->region.assign(mesh.region().begin(), mesh.region().end());
  data->region_value.assign(mesh.region_value().begin(), mesh.region_value().end());
  data->region_attribute.assign(mesh.region_attribute().begin(), mesh.region_attribute().end());
  data->added.assign(mesh.added_points().begin(), mesh.added_points().end());
  data->moved.assign(mesh.moved_points().begin(), mesh.moved_points().end());
  data->parents.assign(mesh.added_parents().begin(), mesh.added_parents().end());
  data->degenerate.assign(mesh.degenerate_segments().begin(), mesh.degenerate_segments().end());
  data->rounded_valid = mesh.rounded_valid();
  return data;
}

}  // namespace cadt::test
