// SPDX-License-Identifier: Apache-2.0
// Leaves and joins of a tree of tiles (cadt.tiles).
#include "device.hpp"
#include "tiles.hpp"

#include "tiles/store.hpp"

namespace cadt_python {

namespace {

using cadt::NodeSums;
using Node = std::shared_ptr<TileNode>;
using Box = std::array<double, 4>;
using LinkArray = nb::ndarray<std::uint64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

cadt::TileBox box_of(const Box& b) { return {b[0], b[1], b[2], b[3]}; }

Node leaf(const Shared& shared, const Coordinates& xy, const Words& ids, const Box& box, std::uint32_t node,
          const cadt::Options& options, const nb::object& progress) {
  return shared->run(options, progress, [&](cadt::Triangulator& own) {
    const auto x = span_of(xy);
    const auto i = span_of(ids);
    cadt::tiles::LeafPoints points{{x.begin(), x.end()}, {i.begin(), i.end()}};
    return std::make_shared<TileNode>(
        TileNode{cadt::tiles::compute_leaf(own, std::move(points), box_of(box), node, {})});
  });
}

Node join(const Shared& shared, const nb::sequence& opens, const Box& box, std::uint32_t node,
          const cadt::Options& options, const nb::object& progress) {
  std::vector<cadt::Open> children;
  for (const nb::handle open : opens) children.push_back(nb::cast<const cadt::Open&>(open));
  return shared->run(options, progress, [&](cadt::Triangulator& own) {
    return std::make_shared<TileNode>(TileNode{cadt::tiles::compute_join(own, children, box_of(box), node, {})});
  });
}

/// Rows of words: a copy, since the structs have gaps.
template <class Item, class Row>
NumpyArray<std::uint64_t> rows_of(const std::vector<Item>& items, std::size_t columns, const Row& row) {
  std::vector<std::uint64_t> words;
  words.reserve(columns * items.size());
  for (const Item& item : items) {
    const auto numbers = row(item);
    words.insert(words.end(), numbers.begin(), numbers.end());
  }
  return array_of(std::move(words), columns);
}

std::vector<cadt::Link> links_of(const WordRows& rows) {
  std::vector<cadt::Link> links(rows.shape(0));
  const std::uint64_t* word = rows.data();
  for (cadt::Link& link : links) {
    link = {word[0], static_cast<std::uint32_t>(word[1]), word[2]};
    word += 3;
  }
  return links;
}

using SumsState = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, int,
                             std::uint64_t, std::uint64_t>;

void bind_sums(nb::module_& m) {
  nb::class_<NodeSums>(m, "NodeSums", "What nodes say of the whole mesh, to be added up in any order.")
      .def(nb::init<>())
      .def_ro("points", &NodeSums::points, "Points of leaves.")
      .def_ro("distinct", &NodeSums::distinct, "Those that equal no earlier one: vertices.")
      .def_ro("triangles", &NodeSums::triangles, "Final triangles.")
      .def_ro("hull_edges", &NodeSums::hull_edges, "Edges of the hull of all points; known at the root alone.")
      .def_ro("certified_edges", &NodeSums::certified_edges, "Edges whose circles were examined, each once.")
      .def_ro("dimension", &NodeSums::dimension, "Dimension of all points so far: -1 (none) to 2.")
      .def_prop_ro(
          "hash", [](const NodeSums& s) { return s.hash.to_string(); },
          "Sum of the hashes of triangles and duplicates.")
      .def("__add__",
           [](NodeSums a, const NodeSums& b) {
             a += b;
             return a;
           })
      .def(
          "__eq__", [](const NodeSums& a, const NodeSums& b) { return a == b; }, nb::is_operator(),
          nb::sig("def __eq__(self, arg: object, /) -> bool"))
      .def("__repr__",
           [](const NodeSums& s) {
             return "<cadt.tiles.Sums: " + std::to_string(s.points) + " points, " + std::to_string(s.triangles) +
                    " triangles, " + std::to_string(s.certified_edges) + " certified edges>";
           })
      .def("__getstate__",
           [](const NodeSums& s) -> SumsState {
             return {s.points,          s.distinct,  s.triangles, s.hull_edges,
                     s.certified_edges, s.dimension, s.hash.high, s.hash.low};
           })
      .def("__setstate__", [](NodeSums& self, const SumsState& s) {
        const auto& [points, distinct, triangles, hull, certified, dimension, high, low] = s;
        new (&self) NodeSums{points, distinct, triangles, hull, certified, dimension, {high, low}};
      });
  m.def("require_complete", &cadt::require_complete);
  m.def("mesh_hash", [](const NodeSums& whole) { return cadt::hash_of(whole).to_string(); });
}

void bind_open(nb::module_& m) {
  m.def("open_of_words", [](const Words& words) { return cadt::tiles::unpack_open(span_of(words)); });
  nb::class_<cadt::Open>(m, "Open",
                         "What a node passes to its parent: open vertices, and the sides of final triangles between "
                         "them. Can be pickled: about 24 bytes a vertex and 40 bytes a side.")
      .def_prop_ro(
          "xy", [](const cadt::Open& o) { return array_of(std::vector(o.xy), 2); }, nb::rv_policy::automatic,
          "(n, 2) float64, a copy: the open vertices.")
      .def_prop_ro(
          "ids", [](const cadt::Open& o) { return array_of(std::vector(o.ids)); }, nb::rv_policy::automatic,
          "(n,) uint64, a copy: their input indices, ascending.")
      .def_prop_ro(
          "number_of_sides", [](const cadt::Open& o) { return o.sides.size(); },
          "Edges between open vertices with a final triangle on one side alone.")
      .def("__len__", [](const cadt::Open& o) { return o.ids.size(); })
      .def("__getstate__", [](const cadt::Open& o) { return array_of(cadt::tiles::pack(o)); })
      .def("__setstate__", [](cadt::Open& self, const Words& words) {
        new (&self) cadt::Open(cadt::tiles::unpack_open(span_of(words)));
      });
}

}  // namespace

void bind_tile_nodes(nb::module_& m) {
  bind_sums(m);
  bind_open(m);
  const auto view = [](const Node& n, const auto& values, std::size_t columns) {
    return array_of(std::span(values), columns, n);
  };
  nb::class_<TileNode>(m, "TileNode")
      .def_prop_ro("node", [](const TileNode& n) { return n.data.node; })
      .def_prop_ro("sums", [](const TileNode& n) { return n.data.sums; })
      .def_prop_ro("statistics", [](const TileNode& n) { return to_dict(n.data.statistics); })
      .def_prop_ro("open", [](const TileNode& n) { return cadt::Open(n.data.open); })
      .def_prop_ro(
          "messages",
          [](const TileNode& n) {
            return rows_of(n.data.messages, 3, [](const cadt::Link& l) {
              return std::array<std::uint64_t, 3>{l.triangle, l.row, l.across};
            });
          },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "duplicates",
          [](const TileNode& n) {
            return rows_of(n.data.duplicates, 2, [](const cadt::DuplicateId& d) {
              return std::array<std::uint64_t, 2>{d.point, d.representative};
            });
          },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "links", [](const TileNode& n) { return array_of(std::vector(n.data.links)); }, nb::rv_policy::automatic);
  m.def(
      "apply_links",
      [](std::uint32_t node, const WordRows& messages, const LinkArray& links) {
        cadt::tiles::apply_messages(node, links_of(messages), {links.data(), links.size()});
      },
      nb::arg("node"), nb::arg("messages"), nb::arg("links"));
  m.def("node_points", [=](const Node& n) { return view(n, n->data.xy, 2); });
  m.def("node_ids", [=](const Node& n) { return view(n, n->data.ids, 0); });
  m.def("node_triangles", [=](const Node& n) { return view(n, n->data.triangles, 3); });
  m.def("node_neighbors", [=](const Node& n) { return view(n, n->data.neighbors, 3); });
  m.def("finish_leaf", &leaf, nb::arg("triangulator"), nb::arg("xy"), nb::arg("ids"), nb::arg("box"), nb::arg("node"),
        nb::arg("options"), nb::arg("progress") = nb::none());
  m.def("finish_join", &join, nb::arg("triangulator"), nb::arg("opens"), nb::arg("box"), nb::arg("node"),
        nb::arg("options"), nb::arg("progress") = nb::none());
  m.attr("outside_hull") = cadt::outside_hull;
  m.attr("pending_triangle") = cadt::pending_triangle;
  m.attr("local_bits") = cadt::local_bits;
}

}  // namespace cadt_python
