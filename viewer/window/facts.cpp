// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cadt::viewer {
namespace {

Place minus(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1]}; }
double cross(const Place& a, const Place& b) { return a[0] * b[1] - a[1] * b[0]; }
double dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1]; }

double angle_between(const Place& a, const Place& b) {
  return std::atan2(std::fabs(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

/// The corners times 2 to the -exponent, so that no side is longer than about 4: products neither vanish nor overflow.
struct Scaled {
  std::array<Place, 3> corners;
  int exponent = 0;

  explicit Scaled(const std::array<Place, 3>& given) : corners(given) {
    double largest = 0;  // halves: the difference of two doubles may be more than the largest one
    for (std::size_t k = 0; k < 2; ++k) {
      const auto [low, high] = std::minmax({given[0][k], given[1][k], given[2][k]});
      largest = std::max(largest, 0.5 * high - 0.5 * low);
    }
    std::frexp(largest, &exponent);
    for (Place& corner : corners) corner = {std::ldexp(corner[0], -exponent), std::ldexp(corner[1], -exponent)};
  }
};

}  // namespace

std::optional<Circle> circumcircle(const std::array<Place, 3>& corners) {
  const Scaled scaled(corners);
  const Place u = minus(scaled.corners[1], scaled.corners[0]), v = minus(scaled.corners[2], scaled.corners[0]);
  const double twice = 2 * cross(u, v), uu = dot(u, u), vv = dot(v, v);
  const Place offset{(v[1] * uu - u[1] * vv) / twice, (u[0] * vv - v[0] * uu) / twice};
  const auto back = [&](double value) { return std::ldexp(value, scaled.exponent); };
  const Circle circle{{corners[0][0] + back(offset[0]), corners[0][1] + back(offset[1])},
                      back(std::hypot(offset[0], offset[1]))};
  if (!std::isfinite(circle.centre[0]) || !std::isfinite(circle.centre[1]) || !std::isfinite(circle.radius))
    return std::nullopt;
  return circle;
}

TriangleFacts facts_of(std::size_t index, const std::array<std::int32_t, 3>& points,
                       const std::array<Place, 3>& corners) {
  TriangleFacts facts;
  facts.index = index;
  facts.points = points;
  facts.corners = corners;
  facts.circle = circumcircle(corners);
  const Scaled scaled(corners);
  const auto& [a, b, c] = scaled.corners;
  const Place ab = minus(b, a), bc = minus(c, b), ca = minus(a, c);
  facts.area = std::ldexp(0.5 * std::fabs(cross(ab, ca)), 2 * scaled.exponent);
  facts.smallest_angle = std::min(
      {angle_between(ab, {-ca[0], -ca[1]}), angle_between(bc, {-ab[0], -ab[1]}), angle_between(ca, {-bc[0], -bc[1]})});
  return facts;
}

std::string text_of(const Place& place) { return fmt::format("{}\n{}", place[0], place[1]); }

std::vector<std::pair<std::string, std::string>> lines_of(const TriangleFacts& facts) {
  std::vector<std::pair<std::string, std::string>> lines;
  lines.emplace_back("triangle", fmt::format("{}", facts.index));
  for (std::size_t k = 0; k < 3; ++k)
    lines.emplace_back(fmt::format("point {}", facts.points[k]), text_of(facts.corners[k]));
  std::string neighbours = "known of the finished mesh";
  if (facts.neighbours) {
    neighbours.clear();
    for (const std::int32_t t : *facts.neighbours) {
      if (!neighbours.empty()) neighbours += ", ";
      neighbours += t < 0 ? "none" : std::to_string(t);
    }
  }
  lines.emplace_back("neighbours", neighbours);
  if (facts.region) lines.emplace_back("region", fmt::format("{}", *facts.region));
  lines.emplace_back("circumcentre",
                     facts.circle ? fmt::format("{:.12g}\n{:.12g}", facts.circle->centre[0], facts.circle->centre[1])
                                  : "beyond the largest double");
  if (facts.circle) lines.emplace_back("circumradius", fmt::format("{:.6g}", facts.circle->radius));
  lines.emplace_back("smallest angle", fmt::format("{:.2f} degrees", facts.smallest_angle));
  lines.emplace_back("area", fmt::format("{:.6g}", facts.area));
  return lines;
}

std::vector<std::array<float, 2>> visible_arc(const Circle& circle, const Camera& camera) {
  const Axis x = camera.axis(0), y = camera.axis(1);
  // Pixels of a unit along both axes; they differ in views of boxes that are longer than the camera allows.
  const double sx = std::fabs(x.first * x.second * camera.before()),
               sy = std::fabs(y.first * y.second * camera.before());
  const double rx = circle.radius * sx, ry = circle.radius * sy;
  const Place middle = camera.pixel(circle.centre[0], circle.centre[1]);
  const Place view{0.5 * camera.width(), 0.5 * camera.height()};
  if (!(std::min(rx, ry) > 0.5) || !std::isfinite(rx + ry + middle[0] + middle[1])) return {};
  const double reach = std::hypot(camera.width(), camera.height());
  const double towards = std::atan2((view[1] - middle[1]) / ry, (view[0] - middle[0]) / rx);
  const double open = std::min(std::numbers::pi, 2 * reach / std::min(rx, ry));
  const int pieces = 180;
  std::vector<std::array<float, 2>> arc;
  bool seen = false;
  for (int i = 0; i <= pieces; ++i) {
    const double angle = towards + open * (2.0 * i / pieces - 1);
    const double px = middle[0] + rx * std::cos(angle), py = middle[1] + ry * std::sin(angle);
    seen = seen || (px > -reach && py > -reach && px < camera.width() + reach && py < camera.height() + reach);
    arc.push_back({static_cast<float>(px), static_cast<float>(py)});
  }
  if (!seen) arc.clear();
  return arc;
}

}  // namespace cadt::viewer
