// SPDX-License-Identifier: Apache-2.0
#include "tests/system/constrained/adversaries.hpp"

#include "tests/support/same_math.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cadt::test {
namespace {

/// Teeth of a comb, their tips in a row, and a segment that passes close below the tips, or through them.
Drawing comb(int n, bool through_tips) {
  Drawing d;
  const double y = through_tips ? 1 : 0.99;
  const std::int32_t left = d.add(-1, y), right = d.add(n, y);
  for (int i = 0; i < n; ++i) {
    const std::int32_t tip = d.add(i, 1), root = d.add(i + 0.4, 6);
    d.join(tip, root);
    if (i != 0) d.join(root, tip - 3);
    d.add(i + 0.5, 0.7);
  }
  d.join(left, right);
  return d;
}

/// Segments from one point to all others, around it or in a row on one side.
Drawing hub(int n) {
  Drawing d;
  d.xy = hub_points(n);
  for (std::int32_t i = 1; i <= n; ++i) d.join(0, i);
  return d;
}
Drawing hub_beside(int n) {
  Drawing d;
  Random random(1);
  d.add(0, 0);
  for (int i = 0; i < n; ++i) d.join(0, d.add(1 + random.uniform(), 4.0 * i / n - 2));
  return d;
}

/// One segment through n points, and as many around it.
Drawing through_points(int n) {
  Drawing d;
  Random random(2);
  for (int i = 0; i <= n; ++i) d.add(3.0 * i, i);
  for (int i = 0; i < n; ++i) d.add(3.0 * n * random.uniform(), n * random.uniform());
  d.join(0, n);
  return d;
}

/// n segments along a line of 100 points that are no neighbours, in both directions.
Drawing overlaps(int n) {
  Drawing d;
  Random random(3);
  for (int i = 0; i < 100; ++i) d.add(100.0 * i, 200.0 * i);
  for (int i = 0; i < 20000; ++i) d.add(10000 * random.uniform(), 20000 * random.uniform());
  for (int i = 0; i < n; ++i)
    d.join(static_cast<std::int32_t>(random.below(100)), static_cast<std::int32_t>(random.below(100)));
  return d;
}

/// n times the same segment: across all points, or between two points that are neighbours of all others.
Drawing repeated(int n) {
  Drawing d;
  d.xy = uniform_points(2000, 4);
  const std::int32_t left = d.add(-0.1, 0.5), right = d.add(1.1, 0.51);
  for (int i = 0; i < n; ++i) i % 2 == 0 ? d.join(left, right) : d.join(right, left);
  return d;
}
Drawing repeated_between_hubs(int n) {
  Drawing d;
  const std::int32_t left = d.add(0, 0), right = d.add(1, 0);
  for (int i = 1; i <= n / 2; ++i) d.add(0.5, i), d.add(0.5, -i);
  for (int i = 0; i < n; ++i) d.join(left, right);
  return d;
}

/// Side by side from left to right across one long edge; as many beside them are edges already.
Drawing across_one_edge(int n) {
  Drawing d;
  Random random(5);
  d.add(-1e6, 0);
  d.add(1e6, 0);
  for (int i = 0; i < n; ++i) {
    const double x = i - n / 2.0, y = 1.5e6 + x * x * 1e-9;
    const std::int32_t above = d.add(x, y + 1e-3 * random.uniform());
    d.join(above, d.add(x + 0.3 * random.uniform(), -y - 1e-3 * random.uniform()));
    if (i != 0) d.join(above - 2, above);
  }
  return d;
}

/// One above the other, much longer than they are apart, with points between.
Drawing rungs(int n) {
  Drawing d;
  Random random(6);
  n /= 10;
  for (int i = 0; i < n; ++i) {
    const std::int32_t left = d.add(0, i);
    d.join(left, d.add(1000.0 * n, i));
    for (int j = 0; j < 8; ++j) d.add(1000 * n * random.uniform(), i + 0.2 + 0.5 * random.uniform());
  }
  return d;
}

Drawing long_segments(int n) {
  Drawing d;
  Random random(7);
  const int count = std::min(1000, n / 10);
  d.xy = uniform_points(static_cast<std::size_t>(n), 7);
  for (int i = 0; i < count; ++i) {
    const double y = (i + 0.5) / count;
    const std::int32_t left = d.add(-0.001, y);
    d.join(left, d.add(1.001, y + 0.4 / count * random.uniform()));
  }
  return d;
}

/// Walls of a square spiral, with points between.
Drawing spiral(int n) {
  Drawing d;
  Random random(8);
  n /= 10;
  double x = 0, y = 0, dx = 1, dy = 0;
  std::int32_t before = d.add(0, 0);
  for (int i = 0; i < n; ++i) {
    const double length = i / 2 + 1;
    const std::int32_t corner = d.add(x += dx * length, y += dy * length);
    d.join(before, corner);
    before = corner;
    std::swap(dx, dy);
    dx = -dx;
  }
  for (int i = 0; i < 9 * n; ++i) d.add(n / 2.0 * (random.uniform() - 0.5), n / 2.0 * (random.uniform() - 0.5));
  return d;
}

/// Rings, one in the other, that do not meet, or that touch one another at a point.
Drawing nested_rings(int n) {
  Drawing d;
  for (int ring = 1; ring <= n / 8; ++ring) {
    const std::int32_t first = static_cast<std::int32_t>(d.points());
    for (int i = 0; i < 8; ++i) {
      const double turn = 0.25 * 3.14159265358979 * i;
      d.add(ring * same_cos(turn), ring * same_sin(turn));
      d.join(first + i, first + (i + 1) % 8);
    }
  }
  return d;
}
Drawing touching_rings(int n) {
  Drawing d;
  const std::int32_t touch = d.add(0, 0);
  for (int ring = 1; ring <= n / 3; ++ring) {
    const double r = ring, height = r + r * r / n;
    const std::int32_t a = d.add(r, -height), b = d.add(2 * r, 0), c = d.add(r, height);
    d.join({touch, a, b, c, touch});
  }
  return d;
}

/// The chord of an arc of points, which is a little bent or much, with a mirrored one below. `teeth`: how far every
/// second point is beside the arc.
Drawing arc(int n, double bend, double teeth) {
  Drawing d;
  const std::int32_t left = d.add(0, 0), right = d.add(n, 0);
  for (int i = 1; i < n; ++i) {
    d.add(i, bend * i * (n - i) / n + 1e-3 + (i % 2 == 0 ? teeth : 0));
    d.add(i - 0.5, -bend * (i - 0.5) * (n - i + 0.5) / n - 1e-3);
  }
  d.join(left, right);
  return d;
}
/// A part of a parabola beside its vertex, whose triangulation is a fan.
Drawing parabola_beside(int n) {
  Drawing d;
  for (int i = 0; i <= n; ++i) {
    const double x = 1 + static_cast<double>(i) / n;
    d.add(x, x * x);
  }
  for (int i = 0; i < n; ++i) {
    const double x = 1 + (i + 0.5) / n;
    d.add(x, 6 * x - 4 - x * x);
  }
  d.join(0, n);
  return d;
}

/// Many short segments with both ends loose in the cavity of a long one: spikes that come close to it.
Drawing loose_ends(int n) {
  Drawing d;
  Random random(9);
  const std::int32_t left = d.add(-1, 0), right = d.add(n, 0);
  for (int i = 0; i < n; ++i) {
    const double side = i % 2 == 0 ? 1 : -1, low = 0.02 + 0.5 * random.uniform();
    d.join(d.add(i, side * low), d.add(i + 0.3 * random.uniform(), side * (low + 3)));
  }
  d.join(left, right);
  return d;
}

/// Points along a segment, as near as doubles are.
Drawing along_a_rounded_line(int n) {
  Drawing d;
  Random random(11);
  const std::int32_t left = d.add(0.1, 0.3), right = d.add(7.7, 2.9);
  for (int i = 0; i < n; ++i) {
    const double part = random.uniform();
    d.add(0.1 + part * 7.6, 0.3 + part * 2.6);
  }
  d.join(left, right);
  return d;
}

/// Two columns of points and a rung at their top: below it the chain goes down, across and up again.
Drawing columns(int n, bool all_rungs) {
  Drawing d;
  Random random(10);
  for (int i = 0; i < n; ++i) {
    const double low = 0.5 * (i + 0.5) / n, wide = 0.1 * random.uniform() / n;
    d.add(-1, low + wide);
    d.add(2, low + 0.1 * random.uniform() / n);
  }
  d.add(0.5, 1);
  for (int i = all_rungs ? 0 : n - 1; i < n; ++i) d.join(2 * i, 2 * i + 1);
  return d;
}

/// Slanted teeth stand above a segment, with points below them: its side goes back again and again.
Drawing slanted_teeth(int n) {
  Drawing d;
  const std::int32_t left = d.add(-10, 0.95), right = d.add(n + 5, 0.95);
  for (int i = 0; i < n; ++i) {
    const std::int32_t root = d.add(i, 1), tip = d.add(i - 2.0, 3);
    d.join(root, tip);
    d.add(i - 0.3, 1.8);
    d.add(i + 0.5, 0.9);
  }
  d.join(left, right);
  return d;
}

/// Points along the outline of a rectangle, or of a turned ellipse, and one segment across. Its sides turn corners, and
/// ascend neither in x nor in y all along.
Drawing outline_across(int n, bool ellipse) {
  Drawing d;
  for (int i = 0; i < n; ++i) {
    const double part = 4.0 * i / n, along = part - std::floor(part);
    const double corners[5][2] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}, {0, 0}};
    const auto& from = corners[static_cast<int>(part)];
    const auto& to = corners[static_cast<int>(part) + 1];
    const double angle = 2 * std::numbers::pi * i / n, x = 3 * std::cos(angle), y = std::sin(angle);
    if (ellipse)
      d.add(0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y);
    else
      d.add(from[0] + along * (to[0] - from[0]), from[1] + along * (to[1] - from[1]));
  }
  d.join(0, n / 2);
  return d;
}

}  // namespace

const std::vector<Adversary>& adversaries() {
  static const std::vector<Adversary> all = {{"comb", [](int n) { return comb(n / 3, false); }},
                                             {"comb_through_tips", [](int n) { return comb(n / 3, true); }},
                                             {"hub", hub},
                                             {"hub_beside", hub_beside},
                                             {"through_points", [](int n) { return through_points(n / 2); }},
                                             {"overlaps", overlaps},
                                             {"repeated", repeated},
                                             {"repeated_between_hubs", repeated_between_hubs},
                                             {"across_one_edge", [](int n) { return across_one_edge(n / 2); }},
                                             {"rungs", rungs},
                                             {"long_segments", long_segments},
                                             {"spiral", spiral},
                                             {"nested_rings", nested_rings},
                                             {"touching_rings", touching_rings},
                                             {"slight_arc", [](int n) { return arc(n / 2, 1e-4, 0); }},
                                             {"arc", [](int n) { return arc(n / 2, 0.1, 0); }},
                                             {"jagged_arc", [](int n) { return arc(n / 2, 1e-4, 0.1); }},
                                             {"rectangle", [](int n) { return outline_across(3 * n, false); }},
                                             {"turned_ellipse", [](int n) { return outline_across(3 * n, true); }},
                                             {"parabola", [](int n) { return parabola_beside(n / 2); }},
                                             {"loose_ends", [](int n) { return loose_ends(n / 2); }},
                                             {"slanted_teeth", [](int n) { return slanted_teeth(n / 4); }},
                                             {"along_a_rounded_line", along_a_rounded_line},
                                             {"columns", [](int n) { return columns(n / 2, false); }},
                                             {"rungs_of_columns", [](int n) { return columns(n / 2, true); }}};
  return all;
}

Drawing ulps_around_segment(std::uint64_t seed) {
  Drawing d;
  Random random(seed);
  const double ends[4] = {0.1 * random.uniform(), 0.3, 7.7, 0.3 + 3 * random.uniform()};
  const std::int32_t left = d.add(ends[0], ends[1]), right = d.add(ends[2], ends[3]);
  for (int i = 0; i < 60; ++i) {
    const double part = random.uniform();
    double x = ends[0] + part * (ends[2] - ends[0]), y = ends[1] + part * (ends[3] - ends[1]);
    const double to = random.below(2) == 0 ? -1e9 : 1e9;
    for (std::size_t k = random.below(3); k > 0; --k) x = std::nextafter(x, to), y = std::nextafter(y, -to);
    d.add(x, y);
  }
  d.join(left, right);
  return d;
}

Drawing extreme_points(std::uint64_t seed, bool subnormal, bool largest) {
  const double least = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
  std::vector<double> values;
  if (subnormal) values = {0, least, -least, 2 * least, 3 * least, -3 * least, 0x1p-1022};
  if (largest) values.insert(values.end(), {most, -most, most / 2, -most / 3, 0x1p1023, 0x1.8p1022, most / 7});
  Drawing d;
  Random random(seed);
  for (int i = 0; i < 40; ++i) {
    const double x = values[random.below(values.size())];
    d.add(x, values[random.below(values.size())]);
  }
  return d;
}

}  // namespace cadt::test
