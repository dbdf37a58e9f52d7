// SPDX-License-Identifier: Apache-2.0
// What the colours of a finished mesh depend on.
#pragma once

#include "io/picture/scene.hpp"
#include "viewer/draw/renderer.hpp"

#include <vector>

namespace cadt::viewer {

/// By regions if there are several, by height if there are heights, else by area.
[[nodiscard]] ColourBy usual_colour(const io::picture::Scene& scene);

/// The heights that ColourBy::height shows: shares of their range, 0 where all are equal.
[[nodiscard]] std::vector<float> heights_of(const io::picture::Scene& scene);

/// Sets the renderer's values and ramp for the mesh, which is in `buffers`. O(points + triangles), for regions
/// O(triangles log triangles).
void prepare_colour(Renderer& renderer, const MeshBuffers& buffers, const io::picture::Scene& scene, ColourBy colour);

/// The hull as lines, without the segments that lie on it: those are drawn as such. O((hull + segments) log hull).
[[nodiscard]] Stroke hull_stroke(const io::picture::Scene& scene, bool dark);

}  // namespace cadt::viewer
