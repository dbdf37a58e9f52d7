// SPDX-License-Identifier: Apache-2.0
// A picture without a window.
#pragma once

#include <cadt/io/region_file.hpp>

#include "viewer/draw/renderer.hpp"

#include <optional>

namespace cadt::viewer {

/// What a picture shows: a place in its middle, and how many times larger than the whole mesh.
struct View {
  double x = 0, y = 0, magnification = 1;
};

/// The camera, which shows the whole mesh, turns to that; its magnification is the nearest that it reaches there.
void aim(Camera& camera, const View& view);

struct StillOptions {
  int width = 1600;
  int height = 0;                  ///< 0: as the box of the points needs, at most `most_height`
  int most_height = 4000;          ///< where it would be more, the mesh does not fill the width
  std::optional<ColourBy> colour;  ///< not set: regions if there are several, heights if there are any, else the area
  std::optional<View> view;        ///< not set: the whole mesh
  Style style;                     ///< its colour is not used
};

/// Draws on a context of its own, on a GPU if there is one for OpenGL without a window, else on the CPU. O(triangles +
/// pixels). \throws DisplayError, OutOfMemory
[[nodiscard]] Image draw_still(const io::RegionMesh& mesh, const StillOptions& options = {});
[[nodiscard]] inline Image draw_still(const io::PointSet& points, const Triangulation& mesh,
                                      const StillOptions& options = {}) {
  return draw_still({.xy = points.xy,
                     .height = points.height,
                     .triangles = mesh.triangles(),
                     .region = {},
                     .segments = {},
                     .hull = mesh.hull()},
                    options);
}

}  // namespace cadt::viewer
