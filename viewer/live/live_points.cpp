// SPDX-License-Identifier: Apache-2.0
#include "viewer/live/live_points.hpp"

#include "viewer/live/shaders.hpp"

#include <cadt/errors.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace cadt::viewer {
namespace {

constexpr std::size_t items = 256;        // a group
constexpr double share_of_spacing = 0.7;  // the diameter of particles
enum Where { where_they_are, in_box, in_disc };
enum Slot : GLuint { points, velocities, pushes, triangles, places = 2, new_points = 3, new_velocities = 4, best = 2 };
enum Uniform : GLint {
  u_count,
  u_low,
  u_limit,
  u_scale,
  u_seed,
  u_motion,
  u_dt,
  u_time,
  u_diameter,
  u_first = 5,
  u_where = 6,
  u_centre = 7,
  u_radius = 8,
  u_round = 5
};

constexpr std::size_t bytes_of_point = 2 * sizeof(double), bytes_of_velocity = 2 * sizeof(float),
                      bytes_of_push = 2 * sizeof(std::int32_t);

gl::Program program(const char* name, const std::string& text) { return {name, shaders::live + text}; }

/// A buffer of another size with the same contents.
void resize(gl::Buffer& buffer, std::size_t bytes, std::size_t used) {
  gl::Buffer larger(bytes);
  gl::wait_for_writes();
  if (used != 0) glCopyNamedBufferSubData(buffer.id(), larger.id(), 0, 0, static_cast<GLsizeiptr>(used));
  buffer = std::move(larger);
}

}  // namespace

const std::vector<std::string>& names_of_motions() {
  static const std::vector<std::string> names{"flow", "bounce", "orbit", "particles"};
  return names;
}
std::string_view to_string(Motion motion) noexcept { return names_of_motions()[static_cast<std::size_t>(motion)]; }

LivePoints::LivePoints(MeshBuffers& mesh)
    : mesh_(mesh),
      spawn_(program("spawn", shaders::spawn)),
      move_(program("move", shaders::move)),
      push_(program("push", shaders::push)),
      keep_(program("keep", shaders::keep)),
      compact_(program("compact", shaders::compact)),
      nearest_(program("nearest", shaders::nearest)),
      velocities_(std::max<std::size_t>(1, mesh.point_count) * bytes_of_velocity),
      best_(2 * sizeof(std::uint32_t)) {
  const Extent& box = mesh.box;
  const double width = box.high[0] - box.low[0], height = box.high[1] - box.low[1], longer = std::max(width, height);
  if (box.empty() || !std::isfinite(longer) || !(longer > 0))
    throw InputError("points can move and be edited in a box that has a size and is no wider than the largest double",
                     0);
  frame_ = {{box.low[0], box.low[1]}, {width / longer, height / longer}, longer};
  spawn(0, mesh.point_count, where_they_are, 0, 0, 0);
}

LivePoints::LivePoints(MeshBuffers& mesh, std::size_t n, std::uint32_t seed) : LivePoints(mesh) {
  seed_ = seed;
  make_room(n);
  mesh_.point_count = n;
  spawn(0, n, in_box, 0, 0, 0);
}

void LivePoints::use(const gl::Program& program, std::size_t count) const {
  program.use();
  glUniform1ui(u_count, static_cast<GLuint>(count));
  glUniform2d(u_low, frame_.low[0], frame_.low[1]);
  glUniform2d(u_limit, frame_.limit[0], frame_.limit[1]);
  glUniform1d(u_scale, frame_.scale);
  glUniform1ui(u_seed, seed_);
  mesh_.points.bind(points);
  velocities_.bind(velocities);
}

void LivePoints::spawn(std::size_t first, std::size_t n, int where, double x, double y, double radius) {
  ++seed_;
  use(spawn_, n);
  glUniform1ui(u_first, static_cast<GLuint>(first));
  glUniform1i(u_where, where);
  glUniform2d(u_centre, x, y);
  glUniform1d(u_radius, radius);
  gl::dispatch_for(n, items);
  gl::wait_for_writes();
}

void LivePoints::step(double dt, Motion motion) {
  const std::size_t n = mesh_.point_count;
  ++seed_;
  time_ += dt;
  const double area = frame_.limit[0] * frame_.limit[1];
  const auto diameter =
      static_cast<float>(share_of_spacing * std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, n))));
  if (motion == Motion::particles) {
    if (pushes_.bytes() < n * bytes_of_push) pushes_ = gl::Buffer(n * bytes_of_push);
    fill_(pushes_, 2 * n, 0);
    use(push_, mesh_.triangle_count);
    glUniform1f(u_diameter, diameter);
    pushes_.bind(pushes);
    mesh_.triangles.bind(triangles);
    gl::dispatch_for(mesh_.triangle_count, items);
    gl::wait_for_writes();
  }
  use(move_, n);
  glUniform1i(u_motion, static_cast<GLint>(motion));
  glUniform1f(u_dt, static_cast<GLfloat>(dt));
  glUniform1f(u_time, static_cast<GLfloat>(std::fmod(time_, 16.0)));
  glUniform1f(u_diameter, diameter);
  if (motion == Motion::particles) pushes_.bind(pushes);
  gl::dispatch_for(n, items);
  gl::wait_for_writes();
}

std::optional<std::size_t> LivePoints::nearest(double x, double y) {
  if (mesh_.point_count == 0) return std::nullopt;
  best_.fill(0xffffffffu, best_.bytes());
  for (const GLint round : {0, 1}) {
    use(nearest_, mesh_.point_count);
    glUniform1i(u_round, round);
    glUniform2d(u_centre, x, y);
    best_.bind(best);
    gl::dispatch_for(mesh_.point_count, items);
    gl::wait_for_writes();
  }
  return best_.read_values<std::uint32_t>(1, sizeof(std::uint32_t))[0];
}

void LivePoints::drag(std::size_t point, double x, double y) {
  const std::array<double, 2> place{x, y};
  gl::wait_for_writes();
  mesh_.points.write_values(std::span<const double>(place), point * bytes_of_point);
}

void LivePoints::make_room(std::size_t wanted) {
  const std::size_t n = mesh_.point_count;
  const auto room = [&](gl::Buffer& buffer, std::size_t each, std::size_t used) {
    // Half as much again, so that a brush does not copy all points each time.
    if (buffer.bytes() < wanted * each) resize(buffer, std::max(wanted, n + n / 2) * each, used);
  };
  room(mesh_.points, bytes_of_point, n * bytes_of_point);
  room(mesh_.triangles, 6 * sizeof(std::int32_t), 3 * mesh_.triangle_count * sizeof(std::int32_t));
  room(velocities_, bytes_of_velocity, n * bytes_of_velocity);
}

void LivePoints::paint(double x, double y, double radius, std::size_t n) {
  const std::size_t first = mesh_.point_count;
  make_room(first + n);
  mesh_.point_count = first + n;
  spawn(first, n, in_disc, x, y, radius);
}

std::size_t LivePoints::erase(double x, double y, double radius) {
  const std::size_t n = mesh_.point_count;
  if (n == 0) return 0;
  if (places_.bytes() < (n + 1) * sizeof(std::uint32_t)) places_ = gl::Buffer((n + 1) * sizeof(std::uint32_t));
  use(keep_, n);
  glUniform2d(u_centre, x, y);
  glUniform1d(u_radius, radius);
  places_.bind(places);
  gl::dispatch_for(n, items);
  gl::wait_for_writes();
  scan_.exclusive(places_, n);
  const std::size_t left = places_.read_values<std::uint32_t>(1, n * sizeof(std::uint32_t))[0];
  if (left == n) return 0;
  const gl::Buffer kept_points(left * bytes_of_point), kept_velocities(left * bytes_of_velocity);
  use(compact_, n);
  places_.bind(places);
  kept_points.bind(new_points);
  kept_velocities.bind(new_velocities);
  gl::dispatch_for(n, items);
  gl::wait_for_writes();
  // Back into the same buffers, which other devices may know.
  const auto copy_back = [&](const gl::Buffer& from, const gl::Buffer& to, std::size_t each) {
    if (left != 0) glCopyNamedBufferSubData(from.id(), to.id(), 0, 0, static_cast<GLsizeiptr>(left * each));
  };
  copy_back(kept_points, mesh_.points, bytes_of_point);
  copy_back(kept_velocities, velocities_, bytes_of_velocity);
  mesh_.point_count = left;
  mesh_.triangle_count = 0;  // they were of other points
  return n - left;
}

}  // namespace cadt::viewer
