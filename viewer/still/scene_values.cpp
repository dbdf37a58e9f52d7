// SPDX-License-Identifier: Apache-2.0
#include "viewer/still/scene_values.hpp"

#include "io/picture/measure.hpp"
#include "io/picture/scene.hpp"
#include "io/picture/sheets.hpp"
#include "io/picture/viewport.hpp"
#include "viewer/draw/palette.hpp"

#include <vector>

namespace cadt::viewer {
namespace {

/// Relative heights, of the upper sheet if there are two, and the triangles that are no ground.
void prepare_heights(Renderer& renderer, const io::PointSet& points, const Triangulation& mesh) {
  using namespace io::picture;
  const Scene scene{points.xy, points.height, mesh.triangles(), mesh.hull()};
  std::vector<float> heights = relative_heights(scene);
  show_upper_sheet(scene, heights);
  if (heights.empty()) heights.assign(points.size(), 0.0f);
  renderer.set_values(heights);
  constexpr int width = 1600;
  const Viewport view(points.xy, width, 4000);
  const std::vector<Point2f> position = view.map_all(points.xy);
  const GroundOpacity ground(scene, position, edge_lengths(scene, position).median);
  const Camera same(box_of(points.xy), view.width(), view.height());
  renderer.set_outside(ground.outer(), static_cast<double>(ground.begin()) / same.scale());
}

std::vector<float> degrees_of(const io::PointSet& points, const Triangulation& mesh) {
  std::vector<float> degree(points.size(), 0.0f);
  for (const std::int32_t v : mesh.triangles()) degree[static_cast<std::size_t>(v)] += 1.0f;
  return degree;
}

}  // namespace

void prepare_colour(Renderer& renderer, const MeshBuffers& buffers, const io::PointSet& points,
                    const Triangulation& mesh, ColourBy colour) {
  renderer.set_values({});
  renderer.set_outside({}, 0);
  if (colour == ColourBy::height) prepare_heights(renderer, points, mesh);
  if (colour == ColourBy::degree) renderer.set_values(degrees_of(points, mesh));
  renderer.fit_ramp(buffers, colour);
}

Stroke hull_stroke(const io::PointSet& points, const Triangulation& mesh, bool dark) {
  Stroke stroke{{}, palette(dark).hull, 1.5f};
  const auto loop = mesh.hull();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto a = static_cast<std::size_t>(loop[i]), b = static_cast<std::size_t>(loop[(i + 1) % loop.size()]);
    stroke.segments.push_back({points.xy[2 * a], points.xy[2 * a + 1], points.xy[2 * b], points.xy[2 * b + 1]});
  }
  return stroke;
}

}  // namespace cadt::viewer
