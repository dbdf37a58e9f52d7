// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/crossings/crossings.hpp"

#include "common/constraints/stop_check.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>
#include <span>

namespace cadt {
namespace constraints {

namespace {

/// The segments of a wall that run through a place of its chain: all in `segments`, which ascend by their lower ends,
/// that begin before and end behind it. `ends`: the last end of each half, of each quarter, ... as a heap.
class Stabbed {
 public:
  Stabbed(const Arrangement& in, std::size_t wall)
      : in_(in),
        segments_(in.wall_segments.data() + in.wall_offsets[wall],
                  in.wall_segments.data() + in.wall_offsets[wall + 1]) {
    leaves_ = std::bit_ceil(segments_.size());
    ends_.assign(2 * leaves_, -1);
    for (std::size_t i = 0; i < segments_.size(); ++i)
      ends_[leaves_ + i] = in.segment_last[static_cast<std::size_t>(segments_[i])];
    for (std::size_t i = leaves_ - 1; i > 0; --i) ends_[i] = std::max(ends_[2 * i], ends_[2 * i + 1]);
  }

  /// Input segments, appended. O(their number log n).
  void append(std::int64_t position, std::vector<std::int32_t>& sources) const {
    visit(1, 0, leaves_, position, sources);
  }

 private:
  void visit(std::size_t node, std::size_t first, std::size_t count, std::int64_t position,
             std::vector<std::int32_t>& sources) const {
    if (ends_[node] <= position || first >= segments_.size()) return;
    const auto s = static_cast<std::size_t>(segments_[first]);
    if (in_.segment_first[s] >= position) return;
    if (count == 1) {
      sources.insert(sources.end(), in_.sources.begin() + in_.source_offsets[s],
                     in_.sources.begin() + in_.source_offsets[s + 1]);
      return;
    }
    visit(2 * node, first, count / 2, position, sources);
    visit(2 * node + 1, first + count / 2, count / 2, position, sources);
  }

  const Arrangement& in_;
  std::span<const std::int32_t> segments_;
  std::size_t leaves_;
  std::vector<std::int64_t> ends_;
};

}  // namespace

std::vector<std::array<std::int32_t, 2>> crossing_pairs(const Arrangement& in, const StopCheck& check_stop) {
  // Wall by wall: the input segments through each of its crossings, those of member m from begins[m] to ends[m] - 1
  const std::size_t walls = in.wall_offsets.size() - 1;
  std::vector<std::size_t> begins(in.members.size()), ends(in.members.size()), ends_of_wall(walls);
  std::vector<std::size_t> by_wall(in.members.size());
  for (const Arrangement::Member& m : in.members) ++ends_of_wall[static_cast<std::size_t>(m.wall)];
  std::exclusive_scan(ends_of_wall.begin(), ends_of_wall.end(), ends_of_wall.begin(), std::size_t{0});
  for (std::size_t m = 0; m < in.members.size(); ++m)
    by_wall[ends_of_wall[static_cast<std::size_t>(in.members[m].wall)]++] = m;
  std::vector<std::int32_t> through;
  for (std::size_t wall = 0, first = 0; wall < walls; first = ends_of_wall[wall++]) {
    check_stop();
    if (ends_of_wall[wall] == first) continue;
    const Stabbed stabbed(in, wall);
    for (std::size_t i = first; i < ends_of_wall[wall]; ++i) {
      begins[by_wall[i]] = through.size();
      stabbed.append(in.members[by_wall[i]].position, through);
      ends[by_wall[i]] = through.size();
    }
  }
  std::vector<std::array<std::int32_t, 2>> pairs;
  for (std::size_t c = 0; c < in.crossings.size(); ++c) {
    check_stop();
    const auto first = static_cast<std::size_t>(in.member_offsets[c]);
    const auto last = static_cast<std::size_t>(in.member_offsets[c + 1]);
    for (std::size_t i = first; i < last; check_stop(), ++i)
      for (std::size_t j = i + 1; j < last; ++j)
        for (std::size_t s = begins[i]; s < ends[i]; ++s)
          for (std::size_t t = begins[j]; t < ends[j]; ++t)
            pairs.push_back({std::min(through[s], through[t]), std::max(through[s], through[t])});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace constraints

std::vector<std::array<std::int32_t, 2>> find_crossings(PointsView points, std::span<const Segment> segments,
                                                        const Options& options) {
  const constraints::StopCheck check_stop(options, 0);
  return constraints::crossing_pairs(constraints::arrange(points, segments, options.threads, check_stop), check_stop);
}

}  // namespace cadt
