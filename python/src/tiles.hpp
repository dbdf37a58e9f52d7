// SPDX-License-Identifier: Apache-2.0
// What the bindings of cadt.tiles share: nodes of a tree of tiles, and what goes from node to node.
#pragma once

#include "common.hpp"

#include <nanobind/stl/array.h>

#include "tiles/node.hpp"

namespace cadt_python {

using Words = nb::ndarray<const std::uint64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using WordRows = nb::ndarray<const std::uint64_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

template <class Array>
[[nodiscard]] auto span_of(const Array& array) {
  return std::span(array.data(), array.size());
}

/// A node in the memory of the host. Arrays that Python has of it keep it.
struct TileNode {
  cadt::tiles::NodeData data;
};

void bind_tile_nodes(nb::module_& m);
void bind_tile_tree(nb::module_& m);
void bind_tile_store(nb::module_& m);

}  // namespace cadt_python
