// SPDX-License-Identifier: Apache-2.0
#include "viewer/still/still.hpp"

#include "viewer/gl/context.hpp"
#include "viewer/gl/errors.hpp"
#include "viewer/still/scene_values.hpp"

namespace cadt::viewer {

Image draw_still(const io::PointSet& points, const Triangulation& mesh, const StillOptions& options) {
  constexpr int most_height = 4000;
  const gl::HeadlessContext context;
  Renderer renderer;
  const MeshBuffers buffers = MeshBuffers::copy(points.xy, mesh.triangles());
  const int height = options.height != 0 ? options.height : Camera::height_for(buffers.box, options.width, most_height);
  Camera camera(buffers.box, options.width, height);
  if (options.view) {
    camera.look_at(options.view->x, options.view->y);
    camera.zoom(options.view->magnification, 0.5 * camera.width(), 0.5 * camera.height());
  }
  Style style = options.style;
  style.colour = options.colour.value_or(points.height.empty() ? ColourBy::area : ColourBy::height);
  renderer.update(buffers);
  prepare_colour(renderer, buffers, points, mesh, style.colour);
  const Stroke hull = hull_stroke(points, mesh, style.dark);
  renderer.draw(buffers, camera, style, std::span<const Stroke>(&hull, style.hull ? 1 : 0));
  Image image = renderer.read();
  if (const int errors = gl::errors_seen(); errors != 0) {
    throw DisplayError("the OpenGL driver '" + context.driver().renderer + "' reported " + std::to_string(errors) +
                       " errors; CADT_GL_DEBUG=1 prints them. Please report them with the driver's version");
  }
  return image;
}

}  // namespace cadt::viewer
