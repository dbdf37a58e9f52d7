// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/grid/snap_rounding.hpp"

#include "common/constraints/crossings/arrangement.hpp"
#include "common/constraints/grid/pixel_grid.hpp"
#include "common/constraints/stop_check.hpp"
#include "common/platform/parallel.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace cadt::constraints {
namespace {

/// The factor of a double that is odd.
std::uint64_t odd_part(double v) {
  int exponent = 0;
  const auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(v, &exponent), 53));
  return mantissa >> std::countr_zero(mantissa);
}

/// The shortest that reads back as the same number.
std::string text(double v) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), v).ptr};
}

[[noreturn]] void refuse(const std::string& message) { throw OptionError("grid", message, "ConstraintOptions::"); }

// Why edges of chains do not run through other centres. Let a segment s pass the pixels of centres a and b one after
// the other, in places a + p and b + q with p, q in the pixel P around 0. In between it is at s(t) = e(t) + d(t), where
// e runs from a to b and d from p to q, all evenly; d is in P, which is convex. If a hot centre c is on the edge e, or
// the edge passes over it as s moves there, then c = s(t) - m d(t) for an m in [0, 1], so s(t) - c = m d(t) is in P, as
// 0 is: s passes the pixel of c, and c is in the chain. This needs the same P for all, so sides belong to the pixels
// right of and above them, without exception. And two segments whose edges crossed would have crossed in a hot pixel
// before.
//
// Multiples k g are rounded. If k g is a double for each k up to the largest one, K, nothing moves. Else a centre moves
// by up to K g 2^-53, while a centre beside an edge is g / (3 K) away from it, as it is no less than 1 / length in
// units of g, and the length is below 3 K. As long as 6 K^2 < 2^53, so with K < 2^25, no centre can move across an
// edge.
void check_grid(PointsView points, double grid) {
  if (!(grid > 0) || !std::isfinite(grid))
    refuse("the width of the grid is " + text(grid) + "; it must be above 0 and finite");
  double most = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = std::abs(points.x(i)), y = std::abs(points.y(i));
    if (std::isfinite(x) && std::isfinite(y)) most = std::max({most, x, y});  // others are errors of the input
  }
  const double multiples = std::ceil(most / grid) + 1;
  if (!(multiples < 0x1p52)) refuse("coordinates are 2^52 times the width of the grid or more; take a larger one");
  if (!std::isfinite(multiples * grid))
    refuse("the grid point next to the largest coordinate is no finite number; take a smaller width");
  if (multiples >= 0x1p25 && multiples * static_cast<double>(odd_part(grid)) > 0x1p53)
    refuse(
        "coordinates are 2^25 times the width or more, where multiples of a width that is no power of two are no "
        "doubles; "
        "take a power of two, such as " +
        text(std::exp2(std::ceil(std::log2(grid)))) + ", or a width above " + text(most / (0x1p25 - 2)));
}

/// A hot pixel and what makes it hot: an input point, or the pair of a crossing.
struct Hot {
  Pixel pixel;
  std::int32_t point;
  std::array<std::int32_t, 2> parents;

  friend bool operator<(const Hot& a, const Hot& b) {
    if (a.pixel != b.pixel) return a.pixel < b.pixel;
    return a.point != b.point ? a.point < b.point : a.parents < b.parents;
  }
};

constexpr std::int32_t no_point = std::numeric_limits<std::int32_t>::max();

std::vector<Hot> hot_pixels(const Arrangement& in, const PixelGrid& grid, unsigned threads) {
  const std::size_t points = in.points.size();
  std::vector<Hot> hot(points + in.crossings.size());
  const exact::ImplicitPoints exact(in.lines);
  platform::for_each_block(hot.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      hot[i].pixel = grid.pixel_of(in.place(static_cast<std::int32_t>(i)), exact);
      hot[i].point = i < points ? in.representative[i] : no_point;
      if (i >= points) hot[i].parents = in.parents[i - points];
    }
  });
  return hot;
}

}  // namespace

SnappedSegments snap_segments(PointsView points, std::span<const Segment> segments, double width, unsigned threads,
                              const StopCheck& check_stop) {
  check_grid(points, width);
  threads = platform::threads_or_all(threads);
  const Arrangement in = arrange(points, segments, threads, check_stop);
  const PixelGrid grid(width);
  std::vector<Hot> hot = hot_pixels(in, grid, threads);
  const auto put = [&](std::vector<double>& xy, std::size_t vertex, const Pixel& pixel) {
    xy[2 * vertex] = static_cast<double>(pixel.x) * width;
    xy[2 * vertex + 1] = static_cast<double>(pixel.y) * width;
  };

  SnappedSegments out;
  out.xy.resize(2 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) put(out.xy, i, hot[static_cast<std::size_t>(in.rank[i])].pixel);

  std::sort(hot.begin(), hot.end());
  hot.erase(std::unique(hot.begin(), hot.end(), [](const Hot& a, const Hot& b) { return a.pixel == b.pixel; }),
            hot.end());
  std::vector<std::size_t> added;
  for (std::size_t i = 0; i < hot.size(); ++i)
    if (hot[i].point == no_point) added.push_back(i);
  if (points.size() + added.size() > max_points())
    throw LimitError("points and crossings of segments are more than 32-bit indices allow",
                     points.size() + added.size(), max_points());
  std::sort(added.begin(), added.end(), [&](std::size_t a, std::size_t b) { return hot[a].parents < hot[b].parents; });
  out.xy.resize(2 * (points.size() + added.size()));
  for (const std::size_t i : added) {
    hot[i].point = static_cast<std::int32_t>(points.size() + out.parents.size());
    put(out.xy, static_cast<std::size_t>(hot[i].point), hot[i].pixel);
    out.parents.push_back(hot[i].parents);
  }

  std::vector<Pixel> pixels(hot.size());
  for (std::size_t i = 0; i < hot.size(); ++i) pixels[i] = hot[i].pixel;
  const PixelTree tree(grid, pixels);
  std::vector<std::vector<std::int32_t>> chains(in.segments.size());
  platform::for_each_block(chains.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t s = first; s < last; ++s) {
      check_stop();
      tree.find(in.lines[s], chains[s]);
      for (std::int32_t& i : chains[s]) i = hot[static_cast<std::size_t>(i)].point;
      if (chains[s].size() == 1) chains[s].clear();
      chains[s].shrink_to_fit();
    }
  });
  out.offsets.assign(segments.size() + 1, 0);
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const std::int32_t same = in.segment_of[s];
    if (same >= 0) {
      const auto& chain = chains[static_cast<std::size_t>(same)];
      const bool forward =
          in.segments[static_cast<std::size_t>(same)][0] == in.rank[static_cast<std::size_t>(segments[s][0])];
      if (forward)
        out.vertices.insert(out.vertices.end(), chain.begin(), chain.end());
      else
        out.vertices.insert(out.vertices.end(), chain.rbegin(), chain.rend());
    }
    out.offsets[s + 1] = static_cast<std::int64_t>(out.vertices.size());
  }
  return out;
}

}  // namespace cadt::constraints
