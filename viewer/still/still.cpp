// SPDX-License-Identifier: Apache-2.0
#include "viewer/still/still.hpp"

#include "viewer/gl/context.hpp"
#include "viewer/gl/errors.hpp"
#include "viewer/still/scene_values.hpp"

namespace cadt::viewer {

void aim(Camera& camera, const View& view) {
  camera.look_at(view.x, view.y);
  camera.zoom(view.magnification, 0.5 * camera.width(), 0.5 * camera.height());
}

Image draw_still(const io::RegionMesh& mesh, const StillOptions& options) {
  const gl::HeadlessContext context;
  Renderer renderer;
  const io::picture::Scene scene = io::picture::scene_of(mesh);
  MeshBuffers buffers = MeshBuffers::copy(scene.xy, scene.triangles);
  buffers.write_edges(scene.segments);
  const int height =
      options.height != 0 ? options.height : Camera::height_for(buffers.box, options.width, options.most_height);
  Camera camera(buffers.box, options.width, height);
  if (options.view) aim(camera, *options.view);
  Style style = options.style;
  style.colour = options.colour ? *options.colour : usual_colour(scene);
  renderer.update(buffers);
  prepare_colour(renderer, buffers, scene, style.colour);
  const Stroke hull = hull_stroke(scene, style.dark);
  renderer.draw(buffers, camera, style, std::span<const Stroke>(&hull, style.hull ? 1 : 0));
  Image image = renderer.read();
  if (const int errors = gl::errors_seen(); errors != 0) {
    throw DisplayError("the OpenGL driver '" + context.driver().renderer + "' reported " + std::to_string(errors) +
                       " errors; CADT_GL_DEBUG=1 prints them. Please report them with the driver's version");
  }
  return image;
}

}  // namespace cadt::viewer
