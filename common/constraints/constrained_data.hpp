// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/constrained.hpp>

#include <cstdint>
#include <mutex>
#include <vector>

namespace cadt {

/// Constrained edges and what they are part of, in CSR.
struct ConstrainedEdges {
  std::vector<Segment> edges;
  std::vector<std::int64_t> offsets;
  std::vector<std::int32_t> sources;
};

/// What a ConstrainedTriangulation holds.
struct ConstrainedTriangulation::Data {
  Triangulation mesh;
  std::vector<std::uint32_t> edge_flags;
  std::vector<std::int64_t> chain_offsets = {0};
  std::vector<std::int32_t> chain_vertices, degenerate;
  std::vector<std::uint8_t> inside;
  std::vector<std::int32_t> region, region_value;
  std::vector<double> region_attribute;
  std::size_t number_inside = 0;
  std::vector<double> added, moved;
  std::vector<std::array<std::int32_t, 2>> parents;
  bool rounded_valid = true;

  [[nodiscard]] const ConstrainedEdges& edges() const;

 private:
  mutable std::once_flag made_;
  mutable ConstrainedEdges edges_;
};

}  // namespace cadt
