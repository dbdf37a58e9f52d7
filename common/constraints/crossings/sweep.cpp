// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/crossings/sweep.hpp"

#include "common/constraints/crossings/sweep_status.hpp"
#include "common/constraints/stop_check.hpp"

#include <algorithm>
#include <queue>

namespace cadt::constraints {
namespace {

using exact::Line;
using exact::Place;
using exact::Point;

// Lines run from the lexicographically lower end to the higher one: what is left of them is above. The sweep line leans
// by less than any angle, so that points of the same x come from the lowest to the highest, and that it meets a
// vertical segment in one point. Segments that overlap are one wall, with the line of that which reaches farthest, so
// no two walls are on the same line where the sweep line is.
class Sweep {
 public:
  Sweep(const Arrangement& arrangement, const std::vector<std::int32_t>& starts, std::atomic<std::size_t>& vertices,
        const StopCheck& check_stop)
      : in_(arrangement),
        starts_(starts),
        vertices_(vertices),
        check_stop_(check_stop),
        exact_(arrangement.lines),
        queue_(Later{exact_}) {
    node_of_.assign(in_.segments.size(), SweepStatus::none);
    wall_of_.assign(in_.segments.size(), none);
    reach_.assign(in_.segments.size(), none);
  }

  SlabFindings run(std::int32_t first, std::int32_t last) {
    if (first > 0) start_after(first - 1);
    for (std::int32_t r = first; r < last; ++r) {
      const Place p = exact::explicit_place(point(r));
      int order = -1;
      while (!queue_.empty() && (order = exact_.compare(queue_.top(), p)) <= 0) {
        const Place crossing = queue_.top();
        do queue_.pop();
        while (!queue_.empty() && exact_.compare(queue_.top(), crossing) == 0);
        if (order < 0) pass_crossing(crossing);
        check_stop_();
      }
      pass_point(r);
      check_stop_();
    }
    return std::move(out_);
  }

 private:
  struct Later {
    exact::ImplicitPoints exact;
    bool operator()(const Place& a, const Place& b) const { return exact.compare(a, b) > 0; }
  };

  static constexpr std::int32_t none = SweepStatus::none;

  [[nodiscard]] const Point& point(std::int32_t rank) const { return in_.points[static_cast<std::size_t>(rank)]; }
  [[nodiscard]] const Line& segment(std::int32_t s) const { return in_.lines[static_cast<std::size_t>(s)]; }
  [[nodiscard]] std::int32_t wall_of(std::int32_t s) const { return wall_of_[static_cast<std::size_t>(s)]; }
  [[nodiscard]] std::int32_t reach(std::int32_t wall) const { return reach_[static_cast<std::size_t>(wall)]; }
  [[nodiscard]] const Line& line(std::int32_t wall) const { return segment(reach(wall)); }

  /// 1: the point is above the wall, 0: on its line, -1: below.
  [[nodiscard]] int side(std::int32_t wall, const Point& p) const {
    const Line& s = line(wall);
    return verifier::equal(s.b, p) ? 0 : verifier::orientation(s.a, s.b, p);
  }
  [[nodiscard]] int side(std::int32_t wall, const Place& p) const {
    if (wall == wall_of(p.first) || wall == wall_of(p.second)) return 0;
    const Line& s = line(wall);
    return exact_.orientation(exact::explicit_place(s.a), exact::explicit_place(s.b), p);
  }

  void begin_wall(std::int32_t s) {
    wall_of_[static_cast<std::size_t>(s)] = s;
    reach_[static_cast<std::size_t>(s)] = s;
  }
  void join_wall(std::int32_t s, std::int32_t wall) {
    wall_of_[static_cast<std::size_t>(s)] = wall;
    if (in_.segments[static_cast<std::size_t>(s)][1] > in_.segments[static_cast<std::size_t>(reach(wall))][1])
      reach_[static_cast<std::size_t>(wall)] = s;
    out_.parts.push_back({s, wall});
  }

  /// Where a wall comes to cross the one above it. If their higher ends are on the wrong sides they do, at a place that
  /// is neither's end.
  void expect_crossing(std::int32_t below, std::int32_t above) {
    if (below == none || above == none) return;
    const std::int32_t s = status_.segment(below), t = status_.segment(above);
    if (side(s, line(t).b) < 0 && side(t, line(s).b) > 0) queue_.push(exact_.crossing(reach(s), reach(t)));
  }

  /// Replaces the walls of adjacent nodes, which follow `below`, by others.
  void replace(const std::vector<std::int32_t>& nodes, std::int32_t below, const std::vector<std::int32_t>& walls) {
    std::int32_t node = below;
    for (std::size_t i = 0; i < walls.size(); ++i) {
      node = i < nodes.size() ? nodes[i] : status_.insert_above(node, walls[i]);
      status_.set_segment(node, walls[i]);
      node_of_[static_cast<std::size_t>(walls[i])] = node;
    }
    for (std::size_t i = walls.size(); i < nodes.size(); ++i) status_.erase(nodes[i]);
    if (walls.empty()) {
      if (below != none) expect_crossing(below, status_.next(below));
      return;
    }
    expect_crossing(below, node_of_[static_cast<std::size_t>(walls.front())]);
    expect_crossing(node, status_.next(node));
  }

  void pass_point(std::int32_t r) {
    const Point& p = point(r);
    nodes_.clear();
    walls_.clear();
    const std::int32_t found = status_.find_first([&](std::int32_t wall) { return side(wall, p) <= 0; });
    for (std::int32_t n = found; n != none && side(status_.segment(n), p) == 0; n = status_.next(n)) {
      const std::int32_t wall = status_.segment(n);
      nodes_.push_back(n);
      out_.contacts.push_back({wall, r});
      if (in_.segments[static_cast<std::size_t>(reach(wall))][1] != r) walls_.push_back(wall);
    }
    const std::int32_t start = starts_[static_cast<std::size_t>(r)], end = starts_[static_cast<std::size_t>(r) + 1];
    if (start == end && nodes_.size() == walls_.size() && nodes_.size() <= 1) return;  // nothing changes
    const std::int32_t below = found == none ? status_.highest() : status_.previous(found);
    for (std::int32_t s = start; s < end; ++s) begin_wall(s), walls_.push_back(s);
    std::sort(walls_.begin(), walls_.end(), [this](std::int32_t s, std::int32_t t) {
      const int side_of_t = side(s, line(t).b);
      return side_of_t != 0 ? side_of_t > 0 : s < t;
    });
    // Those on the same line become one: the lowest, which has been there if any has.
    std::size_t kept = 0;
    for (const std::int32_t s : walls_) {
      if (kept > 0 && side(walls_[kept - 1], line(s).b) == 0)
        join_wall(s, walls_[kept - 1]);
      else
        walls_[kept++] = s;
    }
    walls_.resize(kept);
    for (const std::int32_t wall : walls_)
      if (wall >= start) out_.contacts.push_back({wall, r});
    replace(nodes_, below, walls_);
  }

  /// \pre no point is there
  void pass_crossing(const Place& p) {
    if (const std::size_t count = vertices_.fetch_add(1, std::memory_order_relaxed) + 1; count > max_points())
      throw LimitError("points and crossings of segments are more than 32-bit indices allow", count, max_points());
    std::int32_t lowest = node_of_[static_cast<std::size_t>(wall_of(p.first))];
    for (std::int32_t n; (n = status_.previous(lowest)) != none && side(status_.segment(n), p) == 0;) lowest = n;
    nodes_.clear();
    walls_.clear();
    const auto vertex = -1 - static_cast<std::int32_t>(out_.crossings.size());
    for (std::int32_t n = lowest; n != none && side(status_.segment(n), p) == 0; n = status_.next(n)) {
      nodes_.push_back(n);
      walls_.push_back(status_.segment(n));
      out_.contacts.push_back({walls_.back(), vertex});
    }
    out_.crossings.push_back(p);
    const std::int32_t below = status_.previous(lowest);
    std::reverse(walls_.begin(), walls_.end());
    replace(nodes_, below, walls_);
  }

  /// Where a wall meets the vertical line of a point, and the side of the point.
  struct Height {
    std::int32_t wall;
    int side;
    exact::Rounded y;
  };
  [[nodiscard]] Height height(std::int32_t wall, const Point& p) const {
    const int of_point = side(wall, p);
    if (of_point == 0) return {wall, 0, {p.y, 0}};
    exact::Arena arena;
    const auto [dividend, divisor] = height_quotient(wall, p, arena);
    return {wall, of_point, exact::round_quotient(dividend, divisor, arena)};
  }
  [[nodiscard]] std::pair<exact::Number, exact::Number> height_quotient(std::int32_t wall, const Point& p,
                                                                        exact::Arena& arena) const {
    const exact::Arithmetic of(arena);
    const Line& s = line(wall);
    const exact::Number left = of.number(s.a.x), low = of.number(s.a.y);
    const exact::Number width = of.subtract(of.number(s.b.x), left);
    const exact::Number rise = of.multiply(of.subtract(of.number(s.b.y), low), of.subtract(of.number(p.x), left));
    return {of.add(of.multiply(low, width), rise), width};
  }
  /// The order of two walls just behind a point: negative if s is below t, 0 if they are on a line.
  [[nodiscard]] int compare_at(const Height& s, const Height& t, const Point& p) const {
    if (s.side != t.side) return t.side - s.side;
    if (s.side == 0) return -side(s.wall, line(t.wall).b);
    if (s.y.value != t.y.value) return s.y.value < t.y.value ? -1 : 1;
    if (s.y.rest != t.y.rest) return s.y.rest - t.y.rest;
    if (s.y.rest != 0) {
      exact::Arena arena;
      const exact::Arithmetic of(arena);
      const auto [y, width] = height_quotient(s.wall, p, arena);
      const auto [other, other_width] = height_quotient(t.wall, p, arena);
      if (const int order = exact::compare(of.multiply(y, other_width), of.multiply(other, width)); order != 0)
        return order;
    }
    // They meet on the vertical line: below the point, where the sweep line has been, or above it.
    return -side(s.wall, s.side > 0 ? line(t.wall).b : line(t.wall).a);
  }

  /// The status just behind a point.
  void start_after(std::int32_t r) {
    const Point& p = point(r);
    std::vector<Height> order;
    for (std::int32_t s = 0; s < starts_[static_cast<std::size_t>(r) + 1]; ++s) {
      if (in_.segments[static_cast<std::size_t>(s)][1] <= r) continue;
      begin_wall(s);
      order.push_back(height(s, p));
    }
    std::sort(order.begin(), order.end(), [&](const Height& s, const Height& t) {
      const int c = compare_at(s, t, p);
      return c != 0 ? c < 0 : s.wall < t.wall;
    });
    const Height* last = nullptr;
    for (const Height& s : order) {
      if (last != nullptr && compare_at(*last, s, p) == 0) {
        join_wall(s.wall, last->wall);
        continue;
      }
      node_of_[static_cast<std::size_t>(s.wall)] = status_.insert_above(status_.highest(), s.wall);
      last = &s;
    }
    for (std::int32_t n = status_.highest(); n != none; n = status_.previous(n))
      expect_crossing(status_.previous(n), n);
  }

  const Arrangement& in_;
  const std::vector<std::int32_t>& starts_;
  std::atomic<std::size_t>& vertices_;
  const StopCheck& check_stop_;
  exact::ImplicitPoints exact_;
  SweepStatus status_;
  std::vector<std::int32_t> node_of_;  // of walls in the status
  std::vector<std::int32_t> wall_of_;  // of segments that have begun
  std::vector<std::int32_t> reach_;    // of each wall the segment that ends last
  std::priority_queue<Place, std::vector<Place>, Later> queue_;
  SlabFindings out_;
  std::vector<std::int32_t> nodes_, walls_;  // at one vertex
};

}  // namespace

SlabFindings sweep_slab(const Arrangement& arrangement, const std::vector<std::int32_t>& starts, std::int32_t first,
                        std::int32_t last, std::atomic<std::size_t>& vertices, const StopCheck& check_stop) {
  return Sweep(arrangement, starts, vertices, check_stop).run(first, last);
}

}  // namespace cadt::constraints
