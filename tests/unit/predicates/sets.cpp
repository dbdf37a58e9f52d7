// SPDX-License-Identifier: Apache-2.0
// The sets of cases. Each is there for faults that others do not see (docs/reliability.md has the table).
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/unit/predicates/cases.hpp"

namespace cadt::test {
namespace {

double uniform(Random& r) { return std::ldexp(static_cast<double>(r() >> 11), -53); }
int whole(Random& r, int low, int high) { return low + static_cast<int>(r() % static_cast<unsigned>(high - low + 1)); }
double sign(Random& r) { return r() & 1 ? 1.0 : -1.0; }
/// 53 random bits, the highest one set, in [1, 2).
double mantissa(Random& r) { return 1 + std::ldexp(static_cast<double>(r() >> 12), -52); }

double moved(double v, int units) {
  for (int i = 0; i < std::abs(units); ++i) v = std::nextafter(v, units > 0 ? HUGE_VAL : -HUGE_VAL);
  return v;
}
/// One coordinate of one point, a few units in the last place off.
void nudge(Random& r, Four& p, int most) {
  PlanePoint& q = p[r() % 4];
  double& v = r() & 1 ? q.x : q.y;
  v = moved(v, whole(r, -most, most));
}
void times(Four& p, int exponent) {
  for (PlanePoint& q : p) q = {std::ldexp(q.x, exponent), std::ldexp(q.y, exponent)};
}

// All integer points of the circle of radius 325, of which there are 36, 40,000 times as large, each coordinate off by
// 1 or not. Every fourth case is a true tie.
Four cocircular(Random& r) {
  static const std::vector<PlanePoint> circle = [] {
    std::vector<PlanePoint> points;
    for (int x = -325; x <= 325; ++x)
      for (int y = -325; y <= 325; ++y)
        if (x * x + y * y == 325 * 325) points.push_back({x * 40000.0, y * 40000.0});
    return points;
  }();
  const bool exact = r() % 4 == 0;
  Four p;
  for (PlanePoint& q : p) {
    q = circle[r() % circle.size()];
    if (!exact) q.x += whole(r, -1, 1), q.y += whole(r, -1, 1);
  }
  return p;
}

// Corners of a rectangle with coordinates of 53 random bits are on a circle; every other one has a corner one unit off.
Four rectangle(Random& r) {
  const double x0 = uniform(r), x1 = uniform(r), y0 = std::ldexp(uniform(r), -whole(r, 0, 6)),
               y1 = std::ldexp(uniform(r), -whole(r, 0, 6));
  Four p{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
  std::swap(p[3], p[r() % 4]);
  if (r() & 1) nudge(r, p, 1);
  return p;
}

// Four of the eight points (+-a, +-b), (+-b, +-a), which lie on a circle and hardly ever on two lines that an axis
// mirrors. With b of another exponent the integers are as long as wanted.
Four octet(Random& r, int most_apart) {
  const double a = mantissa(r), b = std::ldexp(mantissa(r), -whole(r, 0, most_apart));
  Four p;
  for (PlanePoint& q : p) {
    q = {sign(r) * a, sign(r) * b};
    if (r() & 1) std::swap(q.x, q.y);
  }
  if (r() & 1) nudge(r, p, 1);
  return p;
}

// The same with integers of up to 62 bits as differences: the most that 256 bits are asked for, of either sign.
Four longest_integers(Random& r) {
  static const std::array<double, 8> ends = {
      (0x1p53 - 1) * 0x1p8, 0x1p60, 0x1p60 + 0x1p8, 0x1.921fb54442d18p59, 0x1p31, 3.0, 1.0, 0.0};
  const auto end = [&] { return ends[r() % ends.size()] * sign(r); };
  const double x0 = end(), y0 = end(), x1 = end(), y1 = end();
  Four p{{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
  if (r() % 4 == 0) p[1] = {-x0, -y0}, p[2] = {-y0, x0}, p[3] = {y0, -x0};
  if (r() & 1) nudge(r, p, 1);
  times(p, -62);
  return p;
}

// Integers of 54 to 61 bits beside small ones, on a circle around the origin but for what rounding and a shift of one
// of them by a random part leave: determinants of every size from 0 to that of their terms.
Four long_integers_of_every_size(Random& r) {
  const double a = std::ldexp(mantissa(r), 59 - whole(r, 0, 6)), b = std::ldexp(mantissa(r), 59 - whole(r, 0, 6));
  Four p;
  for (PlanePoint& q : p) {
    q = {sign(r) * a, sign(r) * b};
    if (r() & 1) std::swap(q.x, q.y);
  }
  const double odd = std::floor(uniform(r) * 16) * 2 + 1;
  PlanePoint& far = p[r() % 4];
  const double length = std::hypot(a, b), turn = std::asin(std::min(1.0, odd / length));
  far = {sign(r) * length * std::cos(turn), sign(r) * odd};
  far.x += sign(r) * std::ldexp(mantissa(r), whole(r, 0, 58));
  far.x = std::clamp(far.x, -0x1p60, 0x1p60);
  if (r() & 1) std::swap(far.x, far.y);
  times(p, -61);
  return p;
}

// (X, 1), (-X, 1) and (1, 0) around the origin, X of 61 bits: the terms of the determinant go up to 2^183, their sum is
// 2 X, so the lowest word alone tells the sign.
Four tiny_determinant(Random& r) {
  const double x = std::ldexp(mantissa(r), 60), k = sign(r), j = sign(r);
  Four p{{{x, k}, {-x, k}, {j, 0}, {0, 0}}};
  if (r() & 1)
    for (PlanePoint& q : p) std::swap(q.x, q.y);
  std::swap(p[r() % 4], p[r() % 4]);
  times(p, -62);
  return p;
}

// Rounded corners of small regular polygons, near the origin or far from it: differences are exact where coordinates
// have too many bits, and the determinant is far below the sizes of its terms.
Four polygon(Random& r) {
  const double radius = std::ldexp(1 + uniform(r), -12), x = std::ldexp(uniform(r), -8 * whole(r, 0, 2)),
               y = uniform(r);
  Four p;
  for (PlanePoint& q : p) {
    const double angle = std::numbers::pi / 6 * whole(r, 0, 11);
    q = {x + radius * std::cos(angle), y + radius * std::sin(angle)};
  }
  return p;
}

// Points of one line, exactly or all but: (m, n) times powers of two apart, and times small odd numbers.
Four line(Random& r) {
  const int bits = whole(r, 20, 50);
  const double m = std::floor(mantissa(r) * std::ldexp(1.0, bits)),
               n = std::floor(mantissa(r) * std::ldexp(1.0, bits)) * sign(r);
  const int apart = r() & 1 ? 100 : 4;
  Four p;
  for (PlanePoint& q : p) {
    const double t = sign(r) * std::ldexp(whole(r, 1, 7), -whole(r, 0, apart));
    q = {m * t, n * t};
  }
  if (r() & 1) nudge(r, p, 1);
  return p;
}

// Three points all but on a line, with full mantissas: determinants of the size of their rounding errors, on either
// side of the filter's bound and of a half of it.
Four near_line(Random& r) {
  Four p;
  p[0] = {uniform(r) * 16, uniform(r) * 16}, p[1] = {uniform(r) * 16, uniform(r) * 16};
  const double t = uniform(r);
  p[2] = {p[0].x + t * (p[1].x - p[0].x), p[0].y + t * (p[1].y - p[0].y)};
  p[3] = {uniform(r), uniform(r)};
  p[2].x = moved(p[2].x, whole(r, -3, 3));
  std::swap(p[2], p[r() % 3]);
  return p;
}

// Four points all but on a circle, seen under all angles, near to one another or not.
Four near_circle(Random& r) {
  const double x = uniform(r) - 0.5, y = uniform(r) - 0.5, radius = 1 + uniform(r);
  const double first = uniform(r) * 7, width = std::ldexp(6.283185307179586, -whole(r, 0, 5));
  Four p;
  for (PlanePoint& q : p) {
    const double angle = first + width * uniform(r);
    q = {x + radius * std::cos(angle), y + radius * std::sin(angle)};
  }
  PlanePoint& q = p[r() % 4];
  q.x = moved(q.x, whole(r, -8, 8));
  return p;
}

// What makes the bound of the cheap incircle filter as small as it can be: two points of a triangle near to one another
// on a diagonal through p, the third one as far away and across it.
Four near_arms(Random& r) {
  const double length = mantissa(r), x = r() % 4 == 0 ? 0.0 : uniform(r), y = r() % 4 == 0 ? 0.0 : uniform(r);
  const double apart = std::ldexp(mantissa(r), -whole(r, 18, 46));
  Four p{{{x + length + apart, y + length - apart}, {x + length, y + length}, {x - length, y + length}, {x, y}}};
  if (r() & 1) p[2].y -= 2 * length, p[2].x += 2 * length;
  nudge(r, p, 12);
  return p;
}

// Lattices of a few points: ties and points in a row.
Four lattice(Random& r) {
  const int size = whole(r, 1, 7);
  Four p;
  for (PlanePoint& q : p) q = {whole(r, 0, size) / 16.0, whole(r, 0, size) / 16.0};
  return p;
}

// Any bits of a window of 240 binades.
Four window(Random& r) {
  Four p;
  for (PlanePoint& q : p) {
    const auto coordinate = [&] {
      return sign(r) * std::ldexp(std::trunc(std::ldexp(mantissa(r), 240 - whole(r, 1, 240))), -240);
    };
    q = {coordinate(), coordinate()};
  }
  return p;
}

// Long integers with determinants far below the sizes of their terms: the octet, with exponents up to 80 apart.
Four far_octet(Random& r) {
  Four p = octet(r, 80);
  return p;
}

// Any finite doubles, and those at which the format ends.
Four any_bits(Random& r) {
  constexpr double largest = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  static const std::vector<double> ends = {
      0,           -0.0,  least,   -least,   3 * least,   0x1p-1022, -0x1p-1022, 1e-300,   1,       -1,
      1 + 0x1p-52, 1e300, largest, -largest, largest / 2, 0x1p1023,  -0x1p-1000, 0x1p-511, 0x1p511, -0x1p-300};
  Four p;
  for (PlanePoint& q : p) {
    const auto coordinate = [&] {
      if (r() & 1) return ends[r() % ends.size()];
      for (;;) {
        const double v = std::ldexp(mantissa(r), whole(r, -1074, 1023)) * sign(r);
        if (std::isfinite(v)) return v;
      }
    };
    q = {coordinate(), coordinate()};
  }
  return p;
}

// Nearly degenerate points of every magnitude: subnormal ones, those whose products under- or overflow, x and y apart.
Four every_scale(Random& r) {
  Four p = r() % 3 == 0 ? line(r) : (r() & 1 ? octet(r, 20) : cocircular(r));
  const int ex = whole(r, -1100, 960), ey = r() % 4 == 0 ? whole(r, -1100, 960) : ex;
  for (PlanePoint& q : p) q = {std::ldexp(q.x, ex), std::ldexp(q.y, ey)};
  if (r() % 8 == 0)
    p[r() % 4] = {sign(r) * std::numeric_limits<double>::max(), std::ldexp(uniform(r), whole(r, -1074, 0))};
  return p;
}

// A tiny cluster with points far away: products of the tiny differences are lost beside the others. The far ones are on
// a line with the cluster, or opposite to each other, so that the lost ones decide.
Four far_and_tiny(Random& r) {
  const int tiny = -whole(r, 100, 1070), far = whole(r, -100, 900);
  const auto small = [&] { return std::ldexp(whole(r, -3, 3), tiny); };
  const double large = std::ldexp(r() & 1 ? 1.0 : mantissa(r), far);
  Four p{{{-large, small()}, {large, small()}, {small(), small()}, {small(), r() & 1 ? small() : large}}};
  if (r() & 1)
    for (PlanePoint& q : p) std::swap(q.x, q.y);
  std::swap(p[2], p[r() % 4]);
  return p;
}

struct Generator {
  const char* name;
  int cases;
  std::function<Four(Random&)> make;
};

const std::vector<Generator>& generators() {
  static const std::vector<Generator> all = {
      {"cocircular", 200000, cocircular},
      {"rectangles", 200000, rectangle},
      {"octets", 40000, [](Random& r) { return octet(r, 8); }},
      {"far_octets", 20000, far_octet},
      {"lattices", 20000, lattice},
      {"lines", 40000, line},
      {"near_line", 40000, near_line},
      {"near_circle", 40000, near_circle},
      {"near_arms", 40000, near_arms},
      {"polygons", 20000, polygon},
      {"longest_integers", 40000, longest_integers},
      {"long_integers", 40000, long_integers_of_every_size},
      {"window", 10000, window},
      {"any_bits", 10000, any_bits},
      {"every_scale", 20000, every_scale},
      {"far_and_tiny", 20000, far_and_tiny},
      {"tiny_determinants", 5000, tiny_determinant},
  };
  return all;
}

}  // namespace

std::vector<std::string> generated_sets() {
  std::vector<std::string> names;
  for (const Generator& g : generators()) names.emplace_back(g.name);
  return names;
}

std::vector<std::string> file_sets() {
  return {"predicates_pscico_orient2d.txt", "predicates_pscico_incircle.txt", "gen_threshold_orient2d.txt",
          "gen_threshold_incircle.txt"};
}

std::vector<Four> generated_points(const std::string& name) {
  Random::result_type seed = 0;
  for (const Generator& g : generators()) {
    ++seed;
    if (name != g.name) continue;
    std::vector<Four> points;
    Random random(seed);
    for (int i = 0; i < g.cases; ++i) points.push_back(g.make(random));
    return points;
  }
  throw std::invalid_argument("no set " + name);
}

SignSet generated_set(const std::string& name) {
  SignSet set{name, {}, {}, {}};
  for (const Four& points : generated_points(name)) add_case(set, points);
  return set;
}

SignSet file_set(const std::filesystem::path& folder, const std::string& name) {
  const bool circle = name.find("incircle") != std::string::npos;
  const std::size_t points = circle ? 4 : 3;
  std::ifstream file(folder / name);
  SignSet set{name, {}, {}, {}};
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::vector<double> v;
    for (std::string word; words >> word;) v.push_back(std::strtod(word.c_str(), nullptr));
    if (v.size() != 2 * points + 2) continue;
    Four p{};
    for (std::size_t i = 0; i < points; ++i) p[i] = {v[1 + 2 * i], v[2 + 2 * i]};
    // An orientation case gets a fourth point that is none of the three.
    if (!circle) p[3] = {p[0].x + p[1].x + 1, p[2].y - p[0].y};
    add_case(set, p);
  }
  return set;
}

}  // namespace cadt::test
