// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/mesh.hpp"

namespace cadt {

MeshArray make_mesh_array(Context& ctx, std::size_t triangles, MeshUse use) {
  const std::size_t bytes = 3 * triangles * device_text::word;
  MeshArray array;
  if (use == MeshUse::whole && ctx.result_on_host) {
    array.host = make_words(3 * triangles);
    array.device = ctx.memory.export_to(array.host.get(), bytes);
    if (array.device) return array;
    array.host.reset();
  }
  array.device = ctx.memory.allocate(bytes);
  return array;
}

}  // namespace cadt
