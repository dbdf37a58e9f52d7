// SPDX-License-Identifier: Apache-2.0
#include "tests/system/queries/brute_force.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>

#include "common/verify/host/exact_integer.hpp"
#include "common/verify/host/exact_sign.hpp"

namespace cadt::test {
namespace {

using verifier::Point;

Point point_of(const Points& xy, std::size_t i) { return {xy[2 * i], xy[2 * i + 1]}; }
Point point_of(const Asked& set, std::int32_t v) { return point_of(set.xy, static_cast<std::size_t>(v)); }

/// A double times 2^1080, as an integer.
using Long = verifier::Integer<40>;
Long integer(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(value), &exponent);  // exact, subnormals too
  const auto bits = static_cast<std::uint64_t>(std::ldexp(mantissa, 53));
  const int shift = exponent - 53 + 1130;
  return Long(std::signbit(value), bits, static_cast<unsigned>(shift));
}
verifier::Integer<80> square(const Long& a) { return verifier::product(a, a); }

void add(Points& to, double x, double y) {
  if (std::isfinite(x) && std::isfinite(y)) to.insert(to.end(), {x, y});
}

Points queries_for(const Points& xy, const Triangulation& mesh) {
  Points queries;
  Random random(mesh.number_of_triangles() + 17);
  const std::size_t n = xy.size() / 2, triangles = mesh.number_of_triangles();
  double low[2] = {0, 0}, high[2] = {0, 0};
  for (std::size_t i = 0; i < xy.size(); ++i) {
    low[i % 2] = i < 2 ? xy[i] : std::min(low[i % 2], xy[i]);
    high[i % 2] = i < 2 ? xy[i] : std::max(high[i % 2], xy[i]);
  }
  for (std::size_t k = 0; k < 24 && n != 0; ++k) {
    const std::size_t i = random.below(n);
    add(queries, xy[2 * i], xy[2 * i + 1]);
    add(queries, std::nextafter(xy[2 * i], low[0]), xy[2 * i + 1]);
    add(queries, xy[2 * i], std::nextafter(xy[2 * i + 1], high[1]));
  }
  for (std::size_t k = 0; k < 24 && triangles != 0; ++k) {
    const std::int32_t* t = &mesh.triangles()[3 * random.below(triangles)];
    const Point a = point_of(xy, static_cast<std::size_t>(t[0])), b = point_of(xy, static_cast<std::size_t>(t[1])),
                c = point_of(xy, static_cast<std::size_t>(t[2]));
    add(queries, 0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y);
    add(queries, a.x / 3 + b.x / 3 + c.x / 3, a.y / 3 + b.y / 3 + c.y / 3);
    add(queries, 0.75 * a.x + 0.25 * c.x, 0.75 * a.y + 0.25 * c.y);
    add(queries, a.x + b.x - c.x, a.y + b.y - c.y);  // across the edge
    // the centre of a lattice's square, as near to four vertices
    add(queries, 0.5 * (std::min({a.x, b.x, c.x}) + std::max({a.x, b.x, c.x})),
        0.5 * (std::min({a.y, b.y, c.y}) + std::max({a.y, b.y, c.y})));
  }
  const auto hull = mesh.hull();
  for (std::size_t k = 0; k < 16 && !hull.empty(); ++k) {
    const std::size_t i = random.below(hull.size());
    const Point a = point_of(xy, static_cast<std::size_t>(hull[i])),
                b = point_of(xy, static_cast<std::size_t>(hull[(i + 1) % hull.size()]));
    const double x = 0.5 * a.x + 0.5 * b.x, y = 0.5 * a.y + 0.5 * b.y;
    add(queries, std::nextafter(x, -INFINITY), y);
    add(queries, std::nextafter(x, INFINITY), std::nextafter(y, INFINITY));
    const double inwards = std::pow(10, -static_cast<double>(k));
    const Point c = point_of(xy, random.below(n));
    add(queries, x + inwards * (c.x - x), y + inwards * (c.y - y));
  }
  const double width = 0.5 * high[0] - 0.5 * low[0], height = 0.5 * high[1] - 0.5 * low[1];
  for (int k = 0; k < 40; ++k)
    add(queries, low[0] - 0.2 * width + random.uniform() * 2.4 * width,
        low[1] - 0.2 * height + random.uniform() * 2.4 * height);
  add(queries, -1e300, 1e300);
  add(queries, high[0] + 100 * width, low[1]);
  add(queries, 0, 0);
  return queries;
}

}  // namespace

Asked::Asked(std::string n, Points p) : name(std::move(n)), xy(std::move(p)) {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  mesh = triangulate(std::span<const double>(xy), options);
  queries = queries_for(xy, mesh);
}

void for_each_set(std::size_t most, const std::function<void(const Asked&)>& test) {
  static const std::deque<Asked> sets = [] {
    std::deque<Asked> all;
    for (const FamilyGroup& group : family_groups()) {
      std::size_t taken = 0;
      for (const Family& family : group.families()) {
        Points xy = family.make();
        if (xy.size() > 4000 || xy.size() < 2 || ++taken > 12) continue;
        all.emplace_back(std::string(group.name) + "/" + family.name, std::move(xy));
      }
    }
    all.emplace_back("uniform", uniform_points(1500));
    all.emplace_back("lattice", grid_points(31, 29));
    return all;
  }();
  for (const Asked& set : sets)
    if (set.xy.size() / 2 <= most) test(set);
}

std::int32_t containing(const Asked& set, double x, double y) {
  const auto t = set.mesh.triangles();
  const Point p{x, y};
  for (std::size_t i = 0; i < t.size(); i += 3) {
    const Point a = point_of(set, t[i]), b = point_of(set, t[i + 1]), c = point_of(set, t[i + 2]);
    if (verifier::orientation(a, b, p) >= 0 && verifier::orientation(b, c, p) >= 0 &&
        verifier::orientation(c, a, p) >= 0)
      return static_cast<std::int32_t>(i / 3);
  }
  return -1;
}

int compare_distances(const Asked& set, double x, double y, std::int32_t a, std::int32_t b) {
  const Point p = point_of(set, a), q = point_of(set, b);
  const double ax = p.x - x, ay = p.y - y, bx = q.x - x, by = q.y - y, da = ax * ax + ay * ay, db = bx * bx + by * by;
  if (da > 1e-200 && db > 1e-200 && da < 1e200 && db < 1e200 && std::abs(da - db) > 1e-14 * (da + db))
    return da < db ? -1 : 1;
  using verifier::sum;
  const auto distance = [&](const Point& v) {
    return sum(square(sum(integer(v.x), integer(x), true)), square(sum(integer(v.y), integer(y), true)));
  };
  return sum(distance(p), distance(q), true).sign();
}

std::vector<std::int32_t> nearest(const Asked& set, double x, double y, std::size_t count) {
  std::vector<std::int32_t> vertices;
  const std::vector<std::int32_t> of = set.mesh.vertex_triangle();
  std::vector<char> duplicate(set.xy.size() / 2, 0);
  for (const Duplicate& d : set.mesh.duplicates()) duplicate[static_cast<std::size_t>(d.point)] = 1;
  if (set.mesh.number_of_triangles() == 0) return vertices;
  for (std::size_t v = 0; v < of.size(); ++v)
    if (!duplicate[v]) vertices.push_back(static_cast<std::int32_t>(v));
  count = std::min(count, vertices.size());
  std::partial_sort(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(count), vertices.end(),
                    [&](std::int32_t a, std::int32_t b) {
                      const int order = compare_distances(set, x, y, a, b);
                      return order < 0 || (order == 0 && a < b);
                    });
  vertices.resize(count);
  return vertices;
}

Points near_queries(const Asked& set) {
  Points near;
  for (std::size_t i = 0; i < set.queries.size(); i += 2)
    if (set.queries[i] != -1e300) near.insert(near.end(), {set.queries[i], set.queries[i + 1]});
  return near;
}

bool narrow(const Asked& set) {
  int low = 4096, high = -4096;
  const Points queries = near_queries(set);
  for (const Points* all : {&set.xy, &queries})
    for (const double value : *all) {
      if (value == 0) continue;
      int exponent = 0;
      double mantissa = std::frexp(std::abs(value), &exponent);
      high = std::max(high, exponent);
      while (mantissa != std::floor(mantissa)) mantissa *= 2, --exponent;
      low = std::min(low, exponent);
    }
  return high - low <= 240;
}

}  // namespace cadt::test
