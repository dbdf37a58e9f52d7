// SPDX-License-Identifier: Apache-2.0
// A picture without a window.
#pragma once

#include <cadt/io/points_file.hpp>
#include <cadt/triangulation.hpp>

#include "viewer/draw/renderer.hpp"

#include <optional>

namespace cadt::viewer {

/// What a picture shows: a place in its middle, and how many times larger than the whole mesh.
struct View {
  double x = 0, y = 0, magnification = 1;
};

struct StillOptions {
  int width = 1600;
  int height = 0;                  ///< 0: as the box of the points needs, at most 4000
  std::optional<ColourBy> colour;  ///< not set: the height if the points have one, else the area
  std::optional<View> view;        ///< not set: the whole mesh
  Style style;                     ///< its colour is not used
};

/// Draws on a context of its own, on a GPU if there is one for OpenGL without a window, else on the CPU. O(triangles +
/// pixels). \throws DisplayError, OutOfMemory
[[nodiscard]] Image draw_still(const io::PointSet& points, const Triangulation& mesh, const StillOptions& options = {});

}  // namespace cadt::viewer
