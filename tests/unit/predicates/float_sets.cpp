// SPDX-License-Identifier: Apache-2.0
// The sets of cases for the build for floats.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "tests/unit/predicates/cases.hpp"

namespace cadt::test {
namespace {

constexpr float largest = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();

double uniform(Random& r) { return std::ldexp(static_cast<double>(r() >> 11), -53); }
int whole(Random& r, int low, int high) { return low + static_cast<int>(r() % static_cast<unsigned>(high - low + 1)); }
double sign(Random& r) { return r() & 1 ? 1.0 : -1.0; }

double rounded(double v) { return static_cast<double>(static_cast<float>(v)); }
Four rounded(Four p) {
  for (PlanePoint& q : p) q = {rounded(q.x), rounded(q.y)};
  return p;
}
Four scaled(Four p, int ex, int ey) {
  for (PlanePoint& q : p) q = {std::ldexp(q.x, ex), std::ldexp(q.y, ey)};
  return rounded(p);
}
/// One coordinate of one point, a unit of a float off or two.
void nudge(Random& r, Four& p) {
  PlanePoint& q = p[r() % 4];
  double& v = r() & 1 ? q.x : q.y;
  for (int i = whole(r, 1, 2); i > 0; --i)
    v = static_cast<double>(std::nextafter(static_cast<float>(v), r() & 1 ? HUGE_VALF : -HUGE_VALF));
}

// Points of one line, exactly or all but: whole numbers (m, n) times powers of two apart, and times small odd ones.
Four line(Random& r, int most_apart) {
  const double m = whole(r, 1, (1 << 20) - 1), n = sign(r) * whole(r, 1, (1 << 20) - 1);
  Four p;
  for (PlanePoint& q : p) {
    const double t = sign(r) * std::ldexp(whole(r, 1, 7), -whole(r, 0, most_apart));
    q = {m * t, n * t};
  }
  if (r() & 1) nudge(r, p);
  return p;
}

// Four of the points (+-a, +-b), (+-b, +-a), on a circle: ties that no axis mirrors.
Four octet(Random& r, int most_apart) {
  const double a = rounded(1 + uniform(r)), b = rounded(std::ldexp(1 + uniform(r), -whole(r, 0, most_apart)));
  Four p;
  for (PlanePoint& q : p) {
    q = {sign(r) * a, sign(r) * b};
    if (r() & 1) std::swap(q.x, q.y);
  }
  if (r() & 1) nudge(r, p);
  return p;
}

// Degenerate points of every magnitude, x and y apart: subnormal ones, those that overflow when they are subtracted.
Four float_scales(Random& r) {
  const Four p = r() & 1 ? line(r, 8) : octet(r, 12);
  const int ex = whole(r, -150, 106), ey = r() % 4 == 0 ? whole(r, -150, 106) : ex;
  return scaled(p, ex, ey);
}

// Any floats, and those at which the format ends.
Four float_bits(Random& r) {
  static const std::vector<float> ends = {0.0F,        -0.0F,    least,     -least,       3 * least, 0x1p-126F,
                                          -0x1p-126F,  1.0F,     -1.0F,     1 + 0x1p-23F, largest,   -largest,
                                          largest / 2, 0x1p127F, 0x1p-125F, 0x1p-64F,     0x1p63F,   -0x1p-40F};
  Four p;
  for (PlanePoint& q : p) {
    const auto coordinate = [&] {
      if (r() & 1) return static_cast<double>(ends[r() % ends.size()]);
      return rounded(sign(r) * std::ldexp(1 + uniform(r), whole(r, -149, 126)));
    };
    q = {coordinate(), coordinate()};
  }
  return p;
}

// A tiny cluster with points far away: what is lost of the tiny differences decides.
Four float_far_and_tiny(Random& r) {
  const int tiny = -whole(r, 20, 149), far = whole(r, -60, 126);
  const auto small = [&] { return rounded(std::ldexp(whole(r, -3, 3), tiny)); };
  const double large = rounded(std::ldexp(r() & 1 ? 1.0 : 1 + uniform(r), far));
  Four p{{{-large, small()}, {large, small()}, {small(), small()}, {small(), r() & 1 ? small() : large}}};
  if (r() & 1)
    for (PlanePoint& q : p) std::swap(q.x, q.y);
  std::swap(p[2], p[r() % 4]);
  return p;
}

// Differences around 2^-40, below which the filter is not asked, with and without subnormal coordinates beside them.
Four float_small(Random& r) {
  Four p;
  const int size = -whole(r, 36, 44), other = r() & 1 ? size : -whole(r, 60, 149);
  for (PlanePoint& q : p)
    q = {std::ldexp(uniform(r) - 0.5, size), std::ldexp(uniform(r) - 0.5, r() & 1 ? size : other)};
  if (r() & 1) p[2] = {(p[0].x + p[1].x) / 2, (p[0].y + p[1].y) / 2};
  return rounded(p);
}

struct Generator {
  const char* name;
  int cases;
  std::function<Four(Random&)> make;
};

const std::vector<Generator>& generators() {
  static const std::vector<Generator> all = {
      {"float_lines", 20000, [](Random& r) { return line(r, r() & 1 ? 100 : 4); }},
      {"float_octets", 20000, [](Random& r) { return octet(r, r() & 1 ? 100 : 8); }},
      {"float_scales", 20000, float_scales},
      {"float_bits", 20000, float_bits},
      {"float_far_and_tiny", 20000, float_far_and_tiny},
      {"float_small", 20000, float_small},
  };
  return all;
}

constexpr const char* shared[] = {"cocircular",  "rectangles", "lattices", "near_line",
                                  "near_circle", "near_arms",  "polygons"};
constexpr std::size_t most_of_shared = 30000;

}  // namespace

std::vector<std::string> float_sets() {
  std::vector<std::string> names;
  for (const char* name : shared) names.push_back(std::string("float_") + name);
  for (const Generator& g : generators()) names.emplace_back(g.name);
  return names;
}

SignSet float_set(const std::string& name) {
  SignSet set{name, {}, {}, {}};
  Random random(1);
  for (const char* of_doubles : shared) {
    if (name != std::string("float_") + of_doubles) continue;
    std::vector<Four> all = generated_points(of_doubles);
    all.resize(std::min(all.size(), most_of_shared));
    for (const Four& points : all) {
      Four p = rounded(points);
      if (random() & 1) nudge(random, p);
      add_float_case(set, p);
    }
    return set;
  }
  for (const Generator& g : generators()) {
    if (name != g.name) continue;
    for (int i = 0; i < g.cases; ++i) add_float_case(set, g.make(random));
    return set;
  }
  throw std::invalid_argument("no set " + name);
}

}  // namespace cadt::test
