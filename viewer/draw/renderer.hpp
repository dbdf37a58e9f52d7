// SPDX-License-Identifier: Apache-2.0
// Draws a mesh by compute programs alone, from the library's arrays. The same picture on every driver but for the
// rounding of colours.
//
//     blocks of 4,096 consecutive triangles -> those that are seen -> which triangle each sample belongs to -> picture
//
// No time goes into triangles outside of the picture. A triangle that is smaller than a pixel adds its colour, weighted
// by its area, to the pixel, so a far view is the mean of what lies there.
#pragma once

#include "viewer/draw/camera.hpp"
#include "viewer/draw/mesh_buffers.hpp"
#include "viewer/draw/style.hpp"
#include "viewer/gl/fill.hpp"
#include "viewer/gl/objects.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cadt::viewer {

/// With ColourBy::region the values are numbers of colours, below this.
inline constexpr int colours_of_ramp = 512;

/// Rows of pixels from the top, four bytes each: red, green, blue, 255.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Lines over the mesh, in coordinates of the plane.
struct Stroke {
  std::vector<std::array<double, 4>> segments;  ///< x0 y0 x1 y1
  std::uint32_t colour = 0;                     ///< 0xRRGGBB
  float width = 1;                              ///< pixels
};

/// One for each context, current on the thread of all calls. Not thread-safe.
class Renderer {
 public:
  /// Compiles the programs. \throws DisplayError
  Renderer();

  /// To be called after the contents of a mesh have changed: finds the boxes of its blocks. O(triangles).
  /// \throws LimitError for more than 357 million triangles
  void update(const MeshBuffers& mesh);
  /// Values that the colour depends on: one a point (height, degree, level) or one a triangle (conflicts, flips,
  /// region). With too few for the mesh all triangles have one colour.
  void set_values(std::span<const float> values);
  /// Points of triangles that fill bays of the outline, where nothing was measured; the larger such a triangle, the
  /// fainter it is drawn when the colour is that of the height. `begin` is the length from which on, in the unit of
  /// the points along x. Empty: none.
  void set_outside(std::span<const std::uint8_t> outside, double begin);
  /// The values of the ramp's ends for `colour`, from a sample of the triangles. Call after update() and set_values().
  void fit_ramp(const MeshBuffers& mesh, ColourBy colour);

  /// In place of those that fit_ramp() found.
  void set_ramp_ends(std::array<float, 2> ends) noexcept { ends_ = ends; }

  /// The picture, in texture(). Constrained edges lie over the triangles and do not fade. \pre update(mesh)
  void draw(const MeshBuffers& mesh, const Camera& camera, const Style& style, std::span<const Stroke> strokes = {});
  [[nodiscard]] const gl::Texture& texture() const noexcept { return picture_; }
  /// Waits for the device.
  [[nodiscard]] Image read() const;
  /// The triangle at a pixel of the last picture.
  [[nodiscard]] std::optional<std::size_t> triangle_at(int x, int y) const;
  /// Ends of the ramp: of the values, or for ColourBy::area log2 of areas, of which a unit of the plane has
  /// area_of_unit().
  [[nodiscard]] std::array<float, 2> ramp_ends() const noexcept { return ends_; }
  [[nodiscard]] double area_of_unit() const noexcept;

 private:
  void make_room(const Camera& camera, int side);
  void bind(const MeshBuffers& mesh) const;
  void draw_triangles(const MeshBuffers& mesh);
  enum class Lines { strokes, edges };
  void draw_lines(Lines lines, std::size_t count, std::uint32_t colour, float width);
  void draw_strokes(std::span<const Stroke> strokes);
  void choose_ramp(ColourBy colour);
  /// Whether there are as many values as the colour reads.
  [[nodiscard]] bool has_values(const MeshBuffers& mesh, ColourBy colour) const noexcept;

  gl::Program bounds_, cull_, blocks_, large_, resolve_, strokes_, discs_, sample_;
  gl::Fill clear_;
  gl::Buffer frame_, values_, outside_, boxes_, seen_, commands_, owners_, sums_, large_list_, overlay_, segments_;
  gl::Texture picture_;
  gl::Name<gl::delete_texture> ramp_;
  std::optional<ColourBy> ramp_of_;
  std::array<float, 2> ends_{0, 1};
  float relief_ = 0;  ///< samples of the reference view for a unit of height
  Camera reference_;
  std::size_t value_count_ = 0;
  double fade_begin_ = 0;  ///< 0: nothing is faded
  int side_ = 0;
};

}  // namespace cadt::viewer
