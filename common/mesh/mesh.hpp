// SPDX-License-Identifier: Apache-2.0
// The mesh on the device, from the stage that made it to the result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "common/driver/context.hpp"
#include "common/driver/triangulation_data.hpp"

namespace cadt {

/// Three words a triangle. If the array may become one of a result on the host, and the device can write there, it lies
/// there from the beginning.
struct MeshArray {
  Words host;  ///< what `device` aliases, if that is memory of the host
  Allocation device;

  void release() noexcept {
    device.release();
    host.reset();
  }
  [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(device); }
  operator Arg() const noexcept { return device; }  // NOLINT: passed to kernels as it is
};

/// What becomes of a mesh.
enum class MeshUse {
  whole,        ///< its arrays may become those of the result, so they lie where that goes
  constrained,  ///< the same, but segments become edges first: it keeps points, ghosts and half-edges
  part          ///< a part of another mesh
};

/// \throws OutOfMemory
[[nodiscard]] inline MeshArray make_mesh_array(Context& ctx, std::size_t triangles, MeshUse use) {
  const std::size_t bytes = 3 * triangles * device_text::word;
  MeshArray array;
  if (use != MeshUse::part && ctx.result_on_host) {
    array.host = make_words(3 * triangles);
    array.device = ctx.memory.export_to(array.host.get(), bytes);
    if (array.device) return array;
    array.host.reset();
  }
  array.device = ctx.memory.allocate(bytes);
  return array;
}

/// A mesh in arrays (common/mesh/mesh_view.dev.h), which may be longer than needed. After certification only
/// renumbering changes it.
struct Mesh {
  Allocation points;                  ///< of the vertices; null if nobody needs them any more
  double scale = 1, scale_again = 1;  ///< they are the input's times both factors
  Allocation input_ids;               ///< of the vertices; null if these are input ids
  MeshArray vertices, across;         ///< of `all` triangles
  Allocation edge_flags;              ///< of `all` triangles; null if no edge is constrained
  std::size_t triangles = 0;          ///< the first so many have no ghost vertex
  std::size_t all = 0;                ///< with ghost triangles
  bool finished = false;              ///< vertices are input ids, triangles stand across; else positions and half-edges
  bool flat = false;                  ///< no triangles: all vertices are collinear, or there are fewer than three
  bool certified = false;             ///< a pass has examined all edges already

  [[nodiscard]] static Mesh without_triangles(Allocation input_ids) {
    Mesh mesh;
    mesh.input_ids = std::move(input_ids);
    mesh.flat = mesh.certified = true;
    return mesh;
  }
};

/// CADT_MESH_VIEW_PARAMETERS: a mesh within a run, or the arrays of a finished one.
struct DeviceMeshView {
  const Allocation &points, &vertices, &across, &edge_flags;
  std::uint32_t triangles, all;
  std::uint32_t edge_bits;  ///< 2: half-edges across; 0: triangles

  [[nodiscard]] auto arguments() const {
    return std::tie(points, vertices, across, edge_flags, triangles, all, edge_bits);
  }
};

/// `points`: of the vertices; null if the kernel reads none.
[[nodiscard]] inline DeviceMeshView view_of(const Mesh& mesh, const Allocation& points) {
  return {points,
          mesh.vertices.device,
          mesh.across.device,
          mesh.edge_flags,
          static_cast<std::uint32_t>(mesh.triangles),
          static_cast<std::uint32_t>(mesh.all),
          mesh.finished ? 0U : 2U};
}

}  // namespace cadt
