// SPDX-License-Identifier: Apache-2.0
// What is seen of a mesh, and what commands do to it. No window, no OpenGL.
#pragma once

#include "viewer/draw/camera.hpp"
#include "viewer/draw/style.hpp"
#include "viewer/window/command.hpp"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace cadt::viewer {

/// How triangles are drawn: keys 1, 2, 3.
enum class Drawing { points, wireframe, filled };
[[nodiscard]] std::string_view to_string(Drawing drawing) noexcept;
/// "points", "wireframe", "filled".
[[nodiscard]] std::optional<Drawing> drawing_from_string(std::string_view name) noexcept;

class ViewState {
 public:
  Camera camera;
  Drawing drawing = Drawing::filled;
  ColourBy colour = ColourBy::area;
  bool hull = true, voronoi = false, inspect = true, dark = false;
  double scale = 1;  ///< of text and lines: pixels for a 96th of an inch

  /// Colours there are values for; the others are passed over.
  std::vector<ColourBy> colours = usual_colours();
  [[nodiscard]] static std::vector<ColourBy> usual_colours();
  [[nodiscard]] static std::vector<ColourBy> colours_with_heights();

  /// Does what the command asks of the view. False: it is none of the view's.
  bool apply(Command command);
  /// A step of the wheel to zoom in (positive) or out, at a pixel.
  void wheel(double steps, double x, double y);
  /// A new mesh: everything in view.
  void show(const Extent& box, std::size_t points, bool has_heights);
  /// Other points; what is seen stays.
  void renew(const Extent& box, std::size_t points);
  /// Another size of the picture; what is seen stays.
  void resize(int width, int height);
  /// A place to the middle, so large that `size` (a length of the plane) takes about a third of the picture; 0: only
  /// closer than now.
  void go_to(double x, double y, double size);
  [[nodiscard]] Style style() const;
  [[nodiscard]] const Extent& box() const noexcept { return box_; }

 private:
  Extent box_{{0, 0}, {1, 1}};
  std::size_t points_ = 0;
};

/// What is marked: by hand, or found by its index.
struct Selection {
  std::optional<std::size_t> triangle, point;
  [[nodiscard]] bool empty() const noexcept { return !triangle && !point; }
};

/// What a search says: "12", "t 12", "triangle 12" or "p 12", "point 12".
struct Search {
  bool point = false;
  std::size_t index = 0;
};
/// A number alone means a point or a triangle, as `points` says. Empty: not understood.
[[nodiscard]] std::optional<Search> parse_search(std::string_view text, bool points);

}  // namespace cadt::viewer
