// SPDX-License-Identifier: Apache-2.0
// The tree of tiles, how points come to its leaves, and the directory of a mesh (cadt.tiles).
#include "tiles.hpp"

#include "tiles/hash.hpp"
#include "tiles/machine.hpp"
#include "tiles/store.hpp"

#include <cstring>
#include <stdexcept>

namespace cadt_python {

namespace {

using cadt::tiles::TileTree;
using cadt::tiles::TreeBuilder;
using cadt::tiles::TreePass;
using Boxes = nb::ndarray<const double, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;
using Children = nb::ndarray<const std::int64_t, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Hash = std::pair<std::uint64_t, std::uint64_t>;

NumpyArray<double> boxes_of(const TileTree& tree) {
  std::vector<double> boxes;
  for (const auto& n : tree.nodes()) boxes.insert(boxes.end(), {n.box.min_x, n.box.min_y, n.box.max_x, n.box.max_y});
  return array_of(std::move(boxes), 4);
}

NumpyArray<std::int64_t> children_of(const TileTree& tree) {
  std::vector<std::int64_t> children;
  for (const auto& n : tree.nodes()) {
    if (n.is_leaf())
      children.insert(children.end(), {-1, -1});
    else
      children.insert(children.end(), {n.left, n.right});
  }
  return array_of(std::move(children), 2);
}

NumpyArray<std::uint64_t> counts_of(const TileTree& tree) {
  std::vector<std::uint64_t> counts;
  for (const auto& n : tree.nodes()) counts.push_back(n.points);
  return array_of(std::move(counts));
}

TileTree tree_of(const Boxes& boxes, const Children& children, const Words& counts) {
  const std::size_t n = boxes.shape(0);
  if (children.shape(0) != n || counts.shape(0) != n)
    throw nb::value_error("arrays of a tree have a row for each node");
  std::vector<cadt::tiles::TreeNode> nodes(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double* box = boxes.data() + 4 * i;
    const std::int64_t* child = children.data() + 2 * i;
    nodes[i].box = {box[0], box[1], box[2], box[3]};
    nodes[i].points = counts.data()[i];
    if (child[0] < 0) continue;
    if (child[0] >= static_cast<std::int64_t>(i) || child[1] < 0 || child[1] >= static_cast<std::int64_t>(i))
      throw nb::value_error("a child of a tree of tiles comes before its parent");
    nodes[i].left = static_cast<std::uint32_t>(child[0]), nodes[i].right = static_cast<std::uint32_t>(child[1]);
    nodes[nodes[i].left].parent = nodes[nodes[i].right].parent = static_cast<std::uint32_t>(i);
  }
  return TileTree(std::move(nodes));
}

TreePass pass_of(const Words& counts, const Coordinates& bounds, const Coordinates& sample) {
  if (bounds.size() != 4 * counts.size()) throw nb::value_error("a pass has four bounds for each count");
  const auto c = span_of(counts);
  const auto b = span_of(bounds), s = span_of(sample);
  return {{c.begin(), c.end()}, {b.begin(), b.end()}, {s.begin(), s.end()}};
}

nb::tuple arrays_of(const TreePass& pass) {
  return nb::make_tuple(array_of(std::vector(pass.counts)), array_of(std::vector(pass.bounds), 2),
                        array_of(std::vector(pass.sample), 2));
}

/// A builder that can be pickled: it is a function of its passes.
class Builder {
 public:
  Builder(std::uint64_t points, std::uint64_t tile_points)
      : points_(points), tile_points_(tile_points), builder_(points, tile_points) {}

  [[nodiscard]] bool done() const noexcept { return builder_.done(); }
  [[nodiscard]] TreePass new_pass() const { return builder_.new_pass(); }
  void look_at(TreePass& pass, std::uint64_t first, std::span<const double> xy) const {
    builder_.look_at(pass, first, xy);
  }
  void finish(const TreePass& pass) {
    if (pass.counts.size() != builder_.new_pass().counts.size())
      throw std::invalid_argument("the pass is not one of this builder");
    builder_.finish_pass(TreePass(pass));
    passes_.push_back(pass);
  }
  [[nodiscard]] TileTree take() {
    if (!done()) throw std::invalid_argument("the tree needs another pass");
    return builder_.take();
  }

  [[nodiscard]] nb::tuple state() const {
    nb::list passes;
    for (const TreePass& pass : passes_) passes.append(arrays_of(pass));
    return nb::make_tuple(points_, tile_points_, passes);
  }
  static void restore(Builder* self, const nb::tuple& state) {
    new (self) Builder(nb::cast<std::uint64_t>(state[0]), nb::cast<std::uint64_t>(state[1]));
    for (const nb::handle pass : nb::cast<nb::list>(state[2]))
      self->finish(pass_of(nb::cast<Words>(pass[0]), nb::cast<Coordinates>(pass[1]), nb::cast<Coordinates>(pass[2])));
  }

 private:
  std::uint64_t points_, tile_points_;
  TreeBuilder builder_;
  std::vector<TreePass> passes_;
};

/// Points by leaf, in their order within each leaf.
nb::tuple distribute(const TileTree& tree, std::uint64_t first_id, const Coordinates& points) {
  std::vector<std::uint64_t> counts, ids;
  std::vector<double> xy;
  without_gil([&] {
    const std::span<const double> from = span_of(points);
    const std::size_t n = from.size() / 2;
    std::vector<std::uint32_t> leaf(n);
    counts.resize(tree.size()), ids.resize(n), xy.resize(2 * n);
    for (std::size_t i = 0; i < n; ++i) {
      leaf[i] = tree.leaf_of(from[2 * i], from[2 * i + 1]);
      ++counts[leaf[i]];
    }
    std::vector<std::uint64_t> next(tree.size());
    for (std::size_t i = 1; i < next.size(); ++i) next[i] = next[i - 1] + counts[i - 1];
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint64_t to = next[leaf[i]]++;
      xy[2 * to] = from[2 * i], xy[2 * to + 1] = from[2 * i + 1];
      ids[to] = first_id + i;
    }
  });
  return nb::make_tuple(array_of(std::move(counts)), array_of(std::move(xy), 2), array_of(std::move(ids)));
}

/// Sum of the hashes of whole blocks of points from `first` on.
Hash blocks_hash(std::uint64_t first, const Coordinates& points) {
  constexpr std::size_t block = cadt::tiles::block_points;
  if (points.shape(0) != 0 && first % block != 0) throw nb::value_error("blocks begin at multiples of block_points");
  cadt::Hash128 hash;
  without_gil([&] { cadt::tiles::add_blocks_hash(hash, first, span_of(points)); });
  return {hash.high, hash.low};
}

}  // namespace

void bind_tile_tree(nb::module_& m) {
  nb::class_<TileTree>(m, "TileTree")
      .def_prop_ro("boxes", &boxes_of, nb::rv_policy::automatic)
      .def_prop_ro("children", &children_of, nb::rv_policy::automatic)
      .def_prop_ro("counts", &counts_of, nb::rv_policy::automatic)
      .def("__len__", &TileTree::size)
      .def(
          "__eq__", [](const TileTree& a, const TileTree& b) { return a == b; }, nb::is_operator(),
          nb::sig("def __eq__(self, arg: object, /) -> bool"))
      .def("leaf_of",
           [](const TileTree& tree, const Coordinates& points) {
             std::vector<std::int64_t> leaves(points.shape(0));
             without_gil([&] {
               const double* p = points.data();
               for (std::int64_t& leaf : leaves) leaf = tree.leaf_of(p[0], p[1]), p += 2;
             });
             return array_of(std::move(leaves));
           })
      .def("__getstate__", [](const TileTree& t) { return nb::make_tuple(boxes_of(t), children_of(t), counts_of(t)); })
      .def("__setstate__", [](TileTree& self, const std::tuple<Boxes, Children, Words>& state) {
        new (&self) TileTree(std::apply(tree_of, state));
      });

  nb::class_<TreePass>(m, "TreePass")
      .def(
          "__iadd__",
          [](TreePass& a, const TreePass& b) -> TreePass& {
            if (a.counts.size() != b.counts.size()) throw nb::value_error("the passes are not of the same builder");
            return a += b;
          },
          nb::rv_policy::none)
      .def("arrays", &arrays_of)
      .def_static("of_arrays", &pass_of)
      .def("__getstate__", &arrays_of)
      .def("__setstate__", [](TreePass& self, const std::tuple<Words, Coordinates, Coordinates>& state) {
        new (&self) TreePass(std::apply(pass_of, state));
      });
  nb::class_<Builder>(m, "TreeBuilder")
      .def(nb::init<std::uint64_t, std::uint64_t>(), nb::arg("points"), nb::arg("tile_points"))
      .def_prop_ro("done", &Builder::done)
      .def("new_pass", &Builder::new_pass)
      .def("look_at", [](const Builder& b, TreePass& pass, std::uint64_t first,
                         const Coordinates& xy) { without_gil([&] { b.look_at(pass, first, span_of(xy)); }); })
      .def("finish_pass", &Builder::finish)
      .def("take", &Builder::take)
      .def("__getstate__", &Builder::state)
      .def("__setstate__", [](Builder& self, const nb::tuple& state) { Builder::restore(&self, state); });

  m.def("distribute", &distribute, nb::arg("tree"), nb::arg("first_id"), nb::arg("xy"));
  m.def("blocks_hash", &blocks_hash, nb::arg("first"), nb::arg("xy"));
  m.def("available_memory", &cadt::tiles::available_memory);
  m.attr("block_points") = cadt::tiles::block_points;
  m.attr("default_tile_points") = cadt::tiles::default_tile_points;
  m.attr("least_tile_points") = cadt::tiles::least_tile_points;
}

void bind_tile_store(nb::module_& m) {
  using cadt::tiles::Store;
  nb::class_<Store>(m, "TileStore")
      .def(
          "__init__",
          [](Store* self, const std::string& path, const TileTree& tree, std::uint64_t tile_points, const Hash& content,
             bool create) {
            const cadt::tiles::Plan plan{
                .tile_points = tile_points, .first_id = 0, .content = {content.first, content.second}, .tree = tree};
            without_gil([&] {
              new (self) Store(path, plan, create ? Store::Start::create : Store::Start::join);
              return 0;
            });
          },
          nb::arg("path"), nb::arg("tree"), nb::arg("tile_points"), nb::arg("content"), nb::arg("create"))
      .def("write", [](const Store& s, const TileNode& node) { without_gil([&] { s.write(node.data); }); })
      .def("finish", [](Store& s) { return without_gil([&] { return s.finish().whole; }); });
}

}  // namespace cadt_python
