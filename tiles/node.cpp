// SPDX-License-Identifier: Apache-2.0
#include "tiles/node.hpp"

#include <cadt/errors.hpp>

#include "tiles/stopwatch.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace cadt::tiles {
namespace {

/// From a node on the device to one on the host.
NodeData take_down(FinishedNode&& finished, LeafPoints&& points, const TileBox& box, std::uint32_t node, bool leaf,
                   const ComputeOptions& options, Stopwatch& watch) {
  NodeData data;
  data.node = node;
  const Hash128 hash = finished.part.hash();
  finished.sums.hash.high += hash.high;
  finished.sums.hash.low += hash.low;
  data.times.compute = watch.lap();
  if (options.consumer) {
    options.consumer(
        {.node = node, .box = box, .leaf = leaf, .xy = points.xy, .ids = points.ids, .finished = finished});
    data.times.consume = watch.lap();
  }
  if (options.arrays) {
    data.triangles.resize(3 * finished.part.number_of_triangles());
    data.neighbors.resize(3 * finished.part.number_of_triangles());
    finished.part.download(data.triangles, data.neighbors);
    data.xy = std::move(points.xy);
    data.ids = std::move(points.ids);
    data.times.download = watch.lap();
  }
  data.links = std::move(finished.links);
  data.messages = std::move(finished.messages);
  data.duplicates = std::move(finished.duplicates);
  data.open = std::move(finished.open);
  data.open_vertices = data.open.ids.size();
  data.sums = finished.sums;
  data.statistics = std::move(finished.statistics);
  return data;
}

/// A leaf whose points are made on the device, and on the host if somebody wants them there.
NodeData compute_cells(Triangulator& triangulator, LeafPoints&& points, const TileBox& box, std::uint32_t node,
                       const ComputeOptions& options) {
  Stopwatch watch;
  const auto count = static_cast<std::size_t>(points.count);
  const std::shared_ptr<void> xy = triangulator.allocate(2 * count * sizeof(double));
  points.cells->generate(triangulator, points.first, count, {xy.get(), 2 * count});
  FinishedNode finished =
      finish_leaf(triangulator, DevicePoints{.x = xy.get(), .size = count}, {.first = points.first_id}, box, node);
  if (options.arrays || options.consumer) {
    points.xy.resize(2 * count);
    points.cells->generate(points.first, count, points.xy.data());
    points.ids.resize(count);
    std::iota(points.ids.begin(), points.ids.end(), points.first_id);
  }
  return take_down(std::move(finished), std::move(points), box, node, true, options, watch);
}

/// The open vertices of all children by their ids: the points of a join.
LeafPoints merge_points(std::span<const Open> children) {
  struct Vertex {
    std::uint64_t id;
    double x, y;
  };
  std::vector<Vertex> all;
  for (const Open& child : children)
    for (std::size_t i = 0; i < child.ids.size(); ++i)
      all.push_back({child.ids[i], child.xy[2 * i], child.xy[2 * i + 1]});
  std::sort(all.begin(), all.end(), [](const Vertex& a, const Vertex& b) { return a.id < b.id; });
  LeafPoints points;
  points.xy.reserve(2 * all.size());
  points.ids.reserve(all.size());
  for (const Vertex& v : all) {
    points.xy.insert(points.xy.end(), {v.x, v.y});
    points.ids.push_back(v.id);
  }
  return points;
}

/// Words in order; running out of them is an error.
class Reader {
 public:
  explicit Reader(std::span<const std::uint64_t> words) : words_(words) {}
  std::uint64_t next() {
    if (words_.empty()) fail();
    const std::uint64_t word = words_.front();
    words_ = words_.subspan(1);
    return word;
  }
  /// A number of items that take `each` words.
  std::size_t count(std::size_t each) {
    const std::uint64_t n = next();
    if (n > words_.size() / each) fail();
    return static_cast<std::size_t>(n);
  }
  void end() const {
    if (!words_.empty()) fail();
  }
  [[noreturn]] static void fail() { throw Error("the words are not those of a node's message: they are damaged"); }

 private:
  std::span<const std::uint64_t> words_;
};

}  // namespace

NodeData compute_leaf(Triangulator& triangulator, LeafPoints&& points, const TileBox& box, std::uint32_t node,
                      const ComputeOptions& options) {
  if (points.cells != nullptr) return compute_cells(triangulator, std::move(points), box, node, options);
  Stopwatch watch;
  FinishedNode finished;
  try {
    finished = finish_leaf(triangulator, PointsView(std::span<const double>(points.xy)), points.ids, box, node);
  } catch (const InputError& e) {
    throw InputError(e.what(), e.index() < points.ids.size() ? points.ids[e.index()] : e.index());
  }
  return take_down(std::move(finished), std::move(points), box, node, true, options, watch);
}

NodeData compute_join(Triangulator& triangulator, std::span<const Open> children, const TileBox& box,
                      std::uint32_t node, const ComputeOptions& options) {
  Stopwatch watch;
  FinishedNode finished = finish_join(triangulator, children, box, node);
  LeafPoints points;
  if (options.arrays || options.consumer) points = merge_points(children);
  return take_down(std::move(finished), std::move(points), box, node, false, options, watch);
}

std::vector<std::uint64_t> pack(const Open& open) {
  std::vector<std::uint64_t> words{open.ids.size(), open.sides.size()};
  words.reserve(2 + 3 * open.ids.size() + 5 * open.sides.size());
  for (const double v : open.xy) words.push_back(std::bit_cast<std::uint64_t>(v));
  words.insert(words.end(), open.ids.begin(), open.ids.end());
  for (const OpenSide& side : open.sides) {
    words.insert(words.end(), {side.from | std::uint64_t{side.to} << 32, std::bit_cast<std::uint64_t>(side.apex_x),
                               std::bit_cast<std::uint64_t>(side.apex_y), side.triangle, side.row});
  }
  return words;
}

Open unpack_open(std::span<const std::uint64_t> words) {
  Reader reader(words);
  if (words.size() < 2) Reader::fail();
  const std::uint64_t vertices = reader.next(), sides = reader.next();
  const std::uint64_t left = words.size() - 2;
  if (vertices > left / 3 || sides > left / 5 || 3 * vertices + 5 * sides != left) Reader::fail();
  Open open;
  open.xy.resize(2 * vertices);
  open.ids.resize(vertices);
  open.sides.resize(sides);
  for (double& v : open.xy) v = std::bit_cast<double>(reader.next());
  for (std::uint64_t& id : open.ids) id = reader.next();
  for (OpenSide& side : open.sides) {
    const std::uint64_t ends = reader.next();
    side.from = static_cast<std::uint32_t>(ends);
    side.to = static_cast<std::uint32_t>(ends >> 32);
    side.apex_x = std::bit_cast<double>(reader.next());
    side.apex_y = std::bit_cast<double>(reader.next());
    side.triangle = reader.next();
    side.row = static_cast<std::uint32_t>(reader.next());
    if (side.from >= vertices || side.to >= vertices) Reader::fail();
  }
  return open;
}

std::vector<std::uint64_t> pack(std::span<const Link> messages) {
  std::vector<std::uint64_t> words{messages.size()};
  words.reserve(1 + 3 * messages.size());
  for (const Link& link : messages) words.insert(words.end(), {link.triangle, link.row, link.across});
  return words;
}

std::vector<Link> unpack_messages(std::span<const std::uint64_t> words) {
  Reader reader(words);
  std::vector<Link> messages(reader.count(3));
  for (Link& link : messages) {
    link.triangle = reader.next();
    link.row = static_cast<std::uint32_t>(reader.next());
    link.across = reader.next();
  }
  reader.end();
  return messages;
}

}  // namespace cadt::tiles
