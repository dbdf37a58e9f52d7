// SPDX-License-Identifier: Apache-2.0
#include "viewer/still/scene_values.hpp"

#include "io/picture/measure.hpp"
#include "io/picture/sheets.hpp"
#include "io/picture/viewport.hpp"
#include "viewer/draw/palette.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <vector>

namespace cadt::viewer {

using io::picture::Scene;

namespace {

/// Relative heights, of the upper sheet if there are two, and the triangles that are no ground.
void prepare_heights(Renderer& renderer, const Scene& scene) {
  using namespace io::picture;
  std::vector<float> heights = heights_of(scene);
  show_upper_sheet(scene, heights);
  renderer.set_values(heights);
  constexpr int width = 1600;
  const Viewport view(scene.xy, width, 4000);
  const std::vector<Point2f> position = view.map_all(scene.xy);
  const GroundOpacity ground(scene, position, edge_lengths(scene, position).median);
  const Camera same(box_of(scene.xy), view.width(), view.height());
  renderer.set_outside(ground.outer(), static_cast<double>(ground.begin()) / same.scale());
}

std::vector<float> degrees_of(const Scene& scene) {
  std::vector<float> degree(scene.points(), 0.0f);
  for (const std::int32_t v : scene.triangles) degree[static_cast<std::size_t>(v)] += 1.0f;
  return degree;
}

std::vector<float> colours_of_regions(const Scene& scene) {
  std::vector<float> colour(scene.faces(), 0.0f);
  std::ranges::transform(io::picture::region_numbers(scene), colour.begin(),
                         [](std::uint32_t number) { return static_cast<float>(number % colours_of_ramp); });
  return colour;
}

Segment ascending(std::int32_t a, std::int32_t b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

std::vector<float> heights_of(const Scene& scene) {
  std::vector<float> heights = io::picture::relative_heights(scene);
  if (heights.empty()) heights.assign(scene.points(), 0.0f);
  return heights;
}

ColourBy usual_colour(const Scene& scene) {
  const bool regions = std::ranges::adjacent_find(scene.region, std::not_equal_to()) != scene.region.end();
  return regions ? ColourBy::region : scene.height.empty() ? ColourBy::area : ColourBy::height;
}

void prepare_colour(Renderer& renderer, const MeshBuffers& buffers, const Scene& scene, ColourBy colour) {
  renderer.set_values({});
  renderer.set_outside({}, 0);
  if (colour == ColourBy::height) prepare_heights(renderer, scene);
  if (colour == ColourBy::degree) renderer.set_values(degrees_of(scene));
  if (colour == ColourBy::region) renderer.set_values(colours_of_regions(scene));
  renderer.fit_ramp(buffers, colour);
}

Stroke hull_stroke(const Scene& scene, bool dark) {
  Stroke stroke{{}, palette(dark).hull, 1.5f};
  std::set<Segment> edges;
  for (std::size_t i = 0; i < scene.hull.size(); ++i)
    edges.insert(ascending(scene.hull[i], scene.hull[(i + 1) % scene.hull.size()]));
  for (const Segment& segment : scene.segments) edges.erase(ascending(segment[0], segment[1]));
  for (const Segment& edge : edges) {
    const auto a = static_cast<std::size_t>(edge[0]), b = static_cast<std::size_t>(edge[1]);
    stroke.segments.push_back({scene.xy[2 * a], scene.xy[2 * a + 1], scene.xy[2 * b], scene.xy[2 * b + 1]});
  }
  return stroke;
}

}  // namespace cadt::viewer
