// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/view.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace cadt::viewer {
namespace {

constexpr std::array<std::string_view, 3> drawings{"points", "wireframe", "filled"};
constexpr double step_of_wheel = 1.2, step_of_key = 1.5;

}  // namespace

std::string_view to_string(Drawing drawing) noexcept { return drawings[static_cast<std::size_t>(drawing)]; }

std::optional<Drawing> drawing_from_string(std::string_view name) noexcept {
  for (std::size_t i = 0; i < drawings.size(); ++i)
    if (drawings[i] == name) return static_cast<Drawing>(i);
  return std::nullopt;
}

bool ViewState::apply(Command command) {
  const double across = 0.1 * std::min(camera.width(), camera.height());
  const double x = 0.5 * camera.width(), y = 0.5 * camera.height();
  switch (command) {
    case Command::pan_left:
      camera.pan(across, 0);
      return true;
    case Command::pan_right:
      camera.pan(-across, 0);
      return true;
    case Command::pan_up:
      camera.pan(0, across);
      return true;
    case Command::pan_down:
      camera.pan(0, -across);
      return true;
    case Command::zoom_in:
      camera.zoom(step_of_key, x, y);
      return true;
    case Command::zoom_out:
      camera.zoom(1 / step_of_key, x, y);
      return true;
    case Command::fit:
      camera = Camera(box_, camera.width(), camera.height());
      return true;
    case Command::points:
      drawing = Drawing::points;
      return true;
    case Command::wireframe:
      drawing = Drawing::wireframe;
      return true;
    case Command::filled:
      drawing = Drawing::filled;
      return true;
    case Command::next_colour: {
      const auto at = std::find(colours.begin(), colours.end(), colour);
      colour = at == colours.end() || at + 1 == colours.end() ? colours.front() : at[1];
      return true;
    }
    case Command::hull:
      hull = !hull;
      return true;
    case Command::voronoi:
      voronoi = !voronoi;
      return true;
    case Command::inspect:
      inspect = !inspect;
      return true;
    case Command::dark:
      dark = !dark;
      return true;
    default:
      return false;
  }
}

void ViewState::wheel(double steps, double x, double y) { camera.zoom(std::pow(step_of_wheel, steps), x, y); }

std::vector<ColourBy> ViewState::usual_colours() {
  return {ColourBy::nothing, ColourBy::angle, ColourBy::area, ColourBy::order, ColourBy::degree};
}

std::vector<ColourBy> ViewState::colours_with_heights() {
  std::vector<ColourBy> all = usual_colours();
  all.push_back(ColourBy::height);
  return all;
}

void ViewState::show(const Extent& box, std::size_t points, bool has_heights) {
  box_ = box;
  points_ = points;
  camera = Camera(box, camera.width(), camera.height());
  colours = has_heights ? colours_with_heights() : usual_colours();
  if (std::find(colours.begin(), colours.end(), colour) == colours.end()) colour = ColourBy::area;
}

void ViewState::renew(const Extent& box, std::size_t points) {
  points_ = points;
  if (box == box_) return;
  box_ = box;
  const double x = 0.5 * camera.width(), y = 0.5 * camera.height(), before = camera.scale();
  const auto middle = camera.place(x, y);
  camera = Camera(box, camera.width(), camera.height());
  camera.look_at(middle[0], middle[1]);
  if (const double larger = before / camera.scale(); larger > 0 && std::isfinite(larger)) camera.zoom(larger, x, y);
}

void ViewState::resize(int width, int height) { camera.resize(width, height); }

void ViewState::go_to(double x, double y, double size) {
  camera.look_at(x, y);
  const double wanted = std::min(camera.width(), camera.height()) / 3.0;
  const double now = std::fabs(size * camera.scale());
  if (!(now > 0) || !std::isfinite(now)) {
    if (camera.magnification() < 8)
      camera.zoom(8 / camera.magnification(), 0.5 * camera.width(), 0.5 * camera.height());
    return;
  }
  camera.zoom(wanted / now, 0.5 * camera.width(), 0.5 * camera.height());
}

Style ViewState::style() const {
  Style style;
  style.colour = colour;
  style.fill = drawing != Drawing::wireframe;
  style.points_alone = drawing == Drawing::points;
  style.line_width = static_cast<float>(scale);
  // Vertices are drawn where they are far apart: smaller triangles would be covered by them.
  const double area =
      std::fabs((box_.high[0] - box_.low[0]) * camera.scale() * (box_.high[1] - box_.low[1]) * camera.scale());
  const double apart = std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, points_)));
  const bool vertices = !(apart < 22 * scale);
  style.point_radius = static_cast<float>(drawing == Drawing::points ? 1.6 * scale : vertices ? 2.4 * scale : 0);
  style.edge_width = static_cast<float>(2.0 * scale);
  style.hull = hull;
  style.dark = dark;
  return style;
}

std::optional<Search> parse_search(std::string_view text, bool points) {
  const auto skip = [&](auto&& wanted) {
    while (!text.empty() && wanted(text.front())) text.remove_prefix(1);
  };
  const auto space = [](char c) { return c == ' ' || c == '\t' || c == ','; };
  const auto letter = [](char c) { return (c | 32) >= 'a' && (c | 32) <= 'z'; };
  skip(space);
  Search search{points, 0};
  if (!text.empty() && letter(text.front())) {
    std::string_view word = text;
    skip(letter);
    word = word.substr(0, word.size() - text.size());
    const auto is = [&](std::string_view whole) {
      return word.size() <= whole.size() &&
             std::equal(word.begin(), word.end(), whole.begin(), [](char a, char b) { return (a | 32) == b; });
    };
    if (is("triangle"))
      search.point = false;
    else if (is("point") || is("vertex"))
      search.point = true;
    else
      return std::nullopt;
    skip(space);
  }
  while (!text.empty() && space(text.back())) text.remove_suffix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), search.index);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return search;
}

}  // namespace cadt::viewer
