// SPDX-License-Identifier: Apache-2.0
#include "viewer/draw/renderer.hpp"

#include "io/picture/measure.hpp"
#include "viewer/draw/palette.hpp"
#include "viewer/draw/shaders.hpp"
#include "viewer/gl/errors.hpp"

#include <cadt/errors.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace cadt::viewer {
namespace {

using gl::dispatch_for;
using gl::wait_for_writes;
using io::picture::quantile;
using io::picture::Rgb;

constexpr std::size_t block = 4096;  // triangles; BLOCK of common.glsl
constexpr std::size_t most_large =
    4 << 20;  // triangles that get a group of their own; the others are drawn by one item
constexpr std::size_t most_bytes = std::size_t{1} << 32;  // of an array: programs have offsets of 32 bits
constexpr std::size_t most_bytes_of_picture =
    (std::size_t{1} << 31) - 1;         // a storage block of NVIDIA; Mesa ends beyond
constexpr int reference_width = 1000;   // pixels of the view in which values are sampled
static_assert(colours_of_ramp == 512);  // shade.glsl

enum Slot : GLuint { points, triangles, values, boxes, seen, commands, owners, sums, large, overlay, outside };

/// The block Frame of common.glsl.
struct Frame {
  std::array<double, 2> origin, first, second;
  std::array<std::int32_t, 2> samples;
  std::uint32_t triangle_count, point_count, block_count, large_capacity;
  std::int32_t side, colour_by, flags;
  float before, low, high, line_width, point_radius, relief, fade_begin;
  std::array<float, 4> background, fill_colour, line_colour, point_colour;
};
static_assert(offsetof(Frame, samples) == 48 && offsetof(Frame, background) == 112 && sizeof(Frame) == 176);

enum Flag { shade = 1, fill = 2, logarithm = 4, points_alone = 8, fade = 16 };
enum By { by_nothing, by_angle, by_area, by_order, by_point, by_triangle, by_mean };

By by_of(ColourBy colour) {
  switch (colour) {
    case ColourBy::nothing:
      return by_nothing;
    case ColourBy::angle:
      return by_angle;
    case ColourBy::area:
      return by_area;
    case ColourBy::order:
      return by_order;
    case ColourBy::height:
    case ColourBy::degree:
      return by_point;
    case ColourBy::level:
      return by_mean;
    case ColourBy::conflicts:
    case ColourBy::flips:
    case ColourBy::region:
      return by_triangle;
  }
  return by_nothing;
}

void place_camera(Frame& frame, const Camera& camera, int side) {
  const Axis x = camera.axis(0), y = camera.axis(1);
  frame.origin = {x.origin, y.origin};
  frame.first = {x.first, y.first};
  frame.second = {x.second * side, y.second * side};
  frame.before = static_cast<float>(camera.before());
  frame.samples = {camera.width() * side, camera.height() * side};
  frame.side = side;
}

void grow(gl::Buffer& buffer, std::size_t bytes) {
  if (buffer.bytes() < bytes || buffer.id() == 0) buffer = gl::Buffer(bytes);
}

}  // namespace

Renderer::Renderer()
    : bounds_("bounds", shaders::common + shaders::bounds),
      cull_("cull", shaders::common + shaders::cull),
      blocks_("blocks", shaders::common + shaders::shade + shaders::raster + shaders::blocks),
      large_("large", shaders::common + shaders::shade + shaders::raster + shaders::large),
      resolve_("resolve", shaders::common + shaders::shade + shaders::raster + shaders::resolve),
      strokes_("strokes", shaders::common + shaders::strokes),
      discs_("discs", shaders::common + shaders::discs),
      sample_("sample", shaders::common + shaders::shade + shaders::sample),
      frame_(sizeof(Frame)),
      values_(16),
      outside_(16),
      commands_(8 * sizeof(std::uint32_t)) {}

void Renderer::bind(const MeshBuffers& mesh) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_.id());
  mesh.points.bind(points);
  mesh.triangles.bind(triangles);
  values_.bind(values);
  boxes_.bind(boxes);
  seen_.bind(seen);
  commands_.bind(commands);
  owners_.bind(owners);
  sums_.bind(sums);
  large_list_.bind(large);
  overlay_.bind(overlay);
  outside_.bind(outside);
}

void Renderer::update(const MeshBuffers& mesh) {
  constexpr std::size_t most = most_bytes / (3 * sizeof(std::int32_t)), most_points = most_bytes / (2 * sizeof(double));
  if (mesh.triangle_count > most || mesh.point_count > most_points)
    throw LimitError("a mesh of at most " + std::to_string(most) + " triangles and " + std::to_string(most_points) +
                         " points can be drawn: take a part of the points, or every second one",
                     std::max(mesh.triangle_count, mesh.point_count), mesh.triangle_count > most ? most : most_points);
  const std::size_t count = (mesh.triangle_count + block - 1) / block;
  grow(boxes_, count * 4 * sizeof(double));
  grow(seen_, count * sizeof(std::uint32_t));
  grow(large_list_, std::min(mesh.triangle_count, most_large) * sizeof(std::uint32_t));
  Frame frame{};
  frame.triangle_count = static_cast<std::uint32_t>(mesh.triangle_count);
  frame.block_count = static_cast<std::uint32_t>(count);
  frame_.write_values(std::span<const Frame>(&frame, 1));
  bind(mesh);
  bounds_.use();
  dispatch_for(count, 1);
  wait_for_writes();
}

void Renderer::set_values(std::span<const float> all) {
  grow(values_, std::max<std::size_t>(16, all.size_bytes()));
  values_.write_values(all);
  value_count_ = all.size();
}

void Renderer::set_outside(std::span<const std::uint8_t> all, double begin) {
  std::vector<std::uint32_t> bits(all.size() / 32 + 1);
  for (std::size_t v = 0; v < all.size(); ++v)
    if (all[v] != 0) bits[v / 32] |= 1u << v % 32;
  grow(outside_, bits.size() * sizeof(std::uint32_t));
  outside_.write_values(std::span<const std::uint32_t>(bits));
  fade_begin_ = all.empty() ? 0 : begin;
}

void Renderer::choose_ramp(ColourBy colour) {
  if (ramp_of_ == colour) return;
  std::vector<std::array<float, 3>> table(colours_of_ramp);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Rgb c = colour == ColourBy::region
                      ? io::picture::region_colour(i)
                      : ramp_for(colour)(static_cast<float>(i) / static_cast<float>(colours_of_ramp - 1));
    table[i] = {c.r, c.g, c.b};
  }
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_1D, 1, &id);
  ramp_ = gl::Name<gl::delete_texture>(id);
  glTextureStorage1D(id, 1, GL_RGB32F, colours_of_ramp);
  glTextureSubImage1D(id, 0, 0, colours_of_ramp, GL_RGB, GL_FLOAT, table.data());
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  ramp_of_ = colour;
}

bool Renderer::has_values(const MeshBuffers& mesh, ColourBy colour) const noexcept {
  const By by = by_of(colour);
  return by < by_point || value_count_ >= (by == by_triangle ? mesh.triangle_count : mesh.point_count);
}

double Renderer::area_of_unit() const noexcept {
  const Axis x = reference_.axis(0), y = reference_.axis(1);
  return std::fabs(x.first * x.second * y.first * y.second) * reference_.before() * reference_.before();
}

void Renderer::fit_ramp(const MeshBuffers& mesh, ColourBy colour) {
  ends_ = {0, 1};
  relief_ = 0;
  choose_ramp(colour);
  if (colour == ColourBy::order) ends_ = {0, static_cast<float>(mesh.triangle_count)};
  if (colour == ColourBy::region) ends_ = {0, colours_of_ramp - 1};
  const bool fitted = by_of(colour) != by_nothing && colour != ColourBy::order && colour != ColourBy::region;
  if (!fitted || mesh.triangle_count == 0 || !has_values(mesh, colour)) return;
  reference_ = Camera(mesh.box, reference_width, reference_width);
  constexpr std::size_t most = 60'000;
  // Odd, so that it does not resonate with the rows of a lattice.
  const std::size_t step = std::max<std::size_t>(1, mesh.triangle_count / most) | 1;
  const std::size_t count = (mesh.triangle_count + step - 1) / step;
  Frame frame{};
  place_camera(frame, reference_, 1);
  frame.triangle_count = static_cast<std::uint32_t>(mesh.triangle_count);
  frame.colour_by = by_of(colour);
  frame_.write_values(std::span<const Frame>(&frame, 1));
  bind(mesh);
  const gl::Buffer result(3 * count * sizeof(float));
  result.bind(owners);
  sample_.use();
  glUniform1ui(0, static_cast<GLuint>(step));
  glUniform1ui(1, static_cast<GLuint>(count));
  dispatch_for(count, 64);
  wait_for_writes();
  const std::vector<float> found = result.read_values<float>(3 * count);
  std::vector<float> value, slope;
  for (std::size_t i = 0; i < count; ++i) {
    const float v = colour == ColourBy::area ? std::log2(std::max(found[3 * i], 1e-30f)) : found[3 * i];
    if (std::isfinite(v)) value.push_back(v);
    if (std::isfinite(found[3 * i + 1]) && found[3 * i + 1] > 0) slope.push_back(found[3 * i + 1]);
  }
  const bool tails = colour == ColourBy::area;
  ends_ = {quantile(value, tails ? 0.03 : 0.005), quantile(value, tails ? 0.97 : 0.995)};
  if (colour == ColourBy::angle) ends_ = {0, 60};
  if (colour == ColourBy::degree) ends_ = {3, 10};
  // At least a factor of 32 from end to end: rounding noise of a lattice must not look like structure.
  const float missing = colour == ColourBy::area ? 5.0f - (ends_[1] - ends_[0]) : 0.0f;
  if (missing > 0) ends_ = {ends_[0] - 0.5f * missing, ends_[1] + 0.5f * missing};
  // The 85 % quantile of the slopes becomes one in one: metres over degrees get light and shade, too.
  const float steep = quantile(slope, 0.85);
  relief_ = colour == ColourBy::height && steep > 0 ? 1 / steep : 0;
}

void Renderer::make_room(const Camera& camera, int side) {
  const auto pixels = static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height());
  const auto each = static_cast<std::size_t>(side * side);
  if (pixels * std::max<std::size_t>(each, 4) * sizeof(std::uint32_t) > most_bytes_of_picture)
    throw DisplayError("a picture of " + std::to_string(camera.width()) + " x " + std::to_string(camera.height()) +
                       " pixels with " + std::to_string(each) +
                       " samples each takes more than the 2 GiB that OpenGL has "
                       "for an array: take a smaller one, or fewer samples");
  grow(owners_, pixels * each * sizeof(std::uint32_t));
  grow(sums_, pixels * 4 * sizeof(std::uint32_t));
  grow(overlay_, pixels * sizeof(std::uint32_t));
  clear_(owners_, pixels * each, 0);
  clear_(sums_, pixels * 4, 0);
  clear_(overlay_, pixels, 0);
  if (picture_.width() != camera.width() || picture_.height() != camera.height())
    picture_ = gl::Texture(camera.width(), camera.height());
  side_ = side;
}

void Renderer::draw_triangles(const MeshBuffers& mesh) {
  const std::array<std::uint32_t, 8> none{0, 1, 1, 0, 1, 16, 0, 0};
  commands_.write_values(std::span<const std::uint32_t>(none));
  const std::size_t count = (mesh.triangle_count + block - 1) / block;
  cull_.use();
  dispatch_for(count, 256);
  wait_for_writes();
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, commands_.id());
  blocks_.use();
  glDispatchComputeIndirect(0);
  wait_for_writes();
  large_.use();
  glDispatchComputeIndirect(3 * sizeof(std::uint32_t));
}

void Renderer::draw_lines(Lines lines, std::size_t count, std::uint32_t colour, float width) {
  if (count == 0) return;
  strokes_.use();
  glUniform1ui(0, static_cast<GLuint>(count));
  glUniform1ui(1, colour);
  glUniform1f(2, width);
  glUniform1i(3, lines == Lines::edges ? 1 : 0);
  dispatch_for(count, 32);
  wait_for_writes();
}

void Renderer::draw_strokes(std::span<const Stroke> strokes) {
  for (const Stroke& stroke : strokes) {
    grow(segments_, stroke.segments.size() * sizeof(stroke.segments[0]));
    segments_.write_values(std::span<const std::array<double, 4>>(stroke.segments));
    segments_.bind(boxes);
    draw_lines(Lines::strokes, stroke.segments.size(), stroke.colour, stroke.width);
  }
}

void Renderer::draw(const MeshBuffers& mesh, const Camera& camera, const Style& style,
                    std::span<const Stroke> strokes) {
  const int side = std::clamp(style.samples, 1, 4);
  const bool alone = style.points_alone || mesh.triangle_count == 0;
  choose_ramp(style.colour);
  make_room(camera, side);
  const Palette& colours = palette(style.dark);
  Frame frame{};
  place_camera(frame, camera, side);
  frame.triangle_count = static_cast<std::uint32_t>(mesh.triangle_count);
  frame.point_count = static_cast<std::uint32_t>(mesh.point_count);
  frame.block_count = static_cast<std::uint32_t>((mesh.triangle_count + block - 1) / block);
  frame.large_capacity = static_cast<std::uint32_t>(std::min(mesh.triangle_count, most_large));
  frame.colour_by = has_values(mesh, style.colour) ? by_of(style.colour) : by_nothing;
  const bool heights = style.colour == ColourBy::height && frame.colour_by == by_point;
  frame.flags = (style.fill ? fill : 0) | (style.colour == ColourBy::area || alone ? logarithm : 0) |
                (alone ? points_alone : 0) | (heights && relief_ > 0 ? shade : 0) |
                (heights && fade_begin_ > 0 ? fade : 0);
  frame.fade_begin = static_cast<float>(fade_begin_ * camera.scale() * side);
  frame.low = ends_[0];
  frame.high = ends_[1];
  // The values were sampled in another view.
  const double wider = camera.axis(0).second / reference_.axis(0).second * side;
  const double higher = camera.axis(1).second / reference_.axis(1).second * side;
  if (style.colour == ColourBy::area) {
    const auto offset = static_cast<float>(std::log2(wider) + std::log2(higher));
    frame.low += offset;
    frame.high += offset;
  }
  if (alone) {
    frame.low = 0;
    frame.high = 8;
  }
  frame.relief = static_cast<float>(relief_ * wider);
  frame.line_width = style.line_width;
  frame.point_radius = style.point_radius;
  frame.background = linear(colours.background);
  frame.fill_colour = linear(colours.fill);
  frame.line_colour = linear(colours.line, style.fill ? 0.55f : 0.9f);
  frame.point_colour = linear(colours.point);
  frame_.write_values(std::span<const Frame>(&frame, 1));
  bind(mesh);
  glBindTextureUnit(0, ramp_.id());
  if (alone) {
    discs_.use();
    glUniform1f(0, std::max(0.7f, style.point_radius));
    dispatch_for(mesh.point_count, 256);
  } else {
    draw_triangles(mesh);
  }
  wait_for_writes();
  if (!style.points_alone && mesh.edge_count != 0) {
    mesh.edges.bind(seen);
    draw_lines(Lines::edges, mesh.edge_count, colours.edge, style.edge_width);
  }
  draw_strokes(strokes);
  bind(mesh);
  glBindImageTexture(0, picture_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
  resolve_.use();
  glDispatchCompute(static_cast<GLuint>((camera.width() + 15) / 16), static_cast<GLuint>((camera.height() + 15) / 16),
                    1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT);
}

Image Renderer::read() const {
  Image image{picture_.width(), picture_.height(), {}};
  image.rgba.resize(4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureImage(picture_.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(image.rgba.size()),
                    image.rgba.data());
  return image;
}

std::optional<std::size_t> Renderer::triangle_at(int x, int y) const {
  if (x < 0 || y < 0 || x >= picture_.width() || y >= picture_.height() || side_ == 0) return std::nullopt;
  const auto row = static_cast<std::size_t>(y * side_ + side_ / 2),
             column = static_cast<std::size_t>(x * side_ + side_ / 2);
  const std::size_t at = row * static_cast<std::size_t>(picture_.width() * side_) + column;
  const std::uint32_t word = owners_.read_values<std::uint32_t>(1, at * sizeof(std::uint32_t))[0] & 0x7fffffffu;
  if (word == 0) return std::nullopt;
  return word - 1;
}

}  // namespace cadt::viewer
