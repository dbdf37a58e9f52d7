// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/source.hpp"

#include "viewer/window/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

namespace cadt::viewer {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

bool same_device(const Options& a, const Options& b) {
  return a.backend == b.backend && a.device == b.device && a.threads == b.threads &&
         a.tuning.work_group_size == b.tuning.work_group_size;
}

}  // namespace

Inside inside_of(const ConstrainedTriangulation& mesh) {
  const auto kept = mesh.inside();
  std::vector<std::int32_t> number(kept.size(), -1);
  std::int32_t next = 0;
  for (std::size_t t = 0; t < kept.size(); ++t)
    if (kept[t] != 0) number[t] = next++;
  Inside inside;
  inside.triangles = mesh.triangles_inside();
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (kept[t] == 0) continue;
    for (const std::int32_t other : mesh.mesh().neighbors().subspan(3 * t, 3))
      inside.neighbors.push_back(other < 0 ? -1 : number[static_cast<std::size_t>(other)]);
    inside.region.push_back(mesh.region()[t]);
  }
  inside.edges.assign(mesh.constrained_edges().begin(), mesh.constrained_edges().end());
  return inside;
}

std::span<const std::int32_t> Loaded::triangles() const { return inside ? inside->triangles : mesh->triangles(); }
std::span<const std::int32_t> Loaded::neighbors() const { return inside ? inside->neighbors : mesh->neighbors(); }

io::picture::Scene Loaded::scene() const {
  io::picture::Scene scene = io::picture::scene_of(points, *mesh);
  if (!inside) return scene;
  if (inside->triangles.size() != scene.triangles.size()) scene.hull = {};
  scene.triangles = inside->triangles;
  scene.region = inside->region;
  scene.segments = inside->edges;
  return scene;
}

std::string Source::name() const {
  return is_file() ? (path == "-" ? "standard input" : std::filesystem::path(path).filename().string()) : distribution;
}

std::string Source::stem() const {
  if (!is_file()) return fmt::format("{}-{}", distribution, generate.n);
  const std::string stem = std::filesystem::path(path).stem().string();
  return path == "-" || stem.empty() ? "cadt" : stem;
}

Triangulator& Triangulators::open(const Options& options) {
  if (!open_ || !same_device(options, of_)) {
    open_.reset();
    open_.emplace(options);
    of_ = options;
  }
  open_->options() = options;
  return *open_;
}

std::size_t bytes_of_points(std::size_t points) noexcept {
  return points * (2 * sizeof(double)) +                            // PointSet
         points * (2 * sizeof(double) + 6 * sizeof(std::int32_t));  // MeshBuffers
}

void check_room(std::size_t points, std::size_t bytes_of_mesh, std::size_t available) {
  if (points > max_points()) throw LimitError("one triangulation cannot hold them", points, max_points());
  const std::size_t needed = bytes_of_points(points) + bytes_of_mesh;
  if (available != 0 && needed > available) {
    throw OutOfMemory(number_text(points) + " points do not fit: " + human_bytes(bytes_of_points(points)) +
                          " for points and drawing, " + human_bytes(bytes_of_mesh) + " to triangulate them",
                      needed, available);
  }
}

std::shared_ptr<Loaded> load(const Source& source, const Options& given, Triangulators* triangulators,
                             std::size_t available, Work::Desk& desk) {
  const auto result = std::make_shared<Loaded>();
  result->source = source;
  Options options = given;
  options.stop = desk.stop();
  options.progress = [&desk](const Progress& p) { desk.report(p.phase, p.fraction); };
  if (source.constrain) {
    desk.report("reading " + source.name(), -1);
    options.order = Order::canonical;  // regions are numbered in it, and so have the same colours each time
    const auto begin = Clock::now();
    Constrained constrained = source.constrain(options);
    result->mesh_milliseconds = milliseconds_since(begin);
    result->points = std::move(constrained.points);
    result->heights.assign(result->points.height.begin(), result->points.height.end());
    result->mesh = constrained.mesh.mesh();
    result->inside = inside_of(constrained.mesh);
    result->statistics = result->mesh->statistics();
    return result;
  }
  Triangulator* triangulator = nullptr;
  if (triangulators != nullptr) {
    desk.report("opening the device", -1);
    triangulator = &triangulators->open(options);
    result->device = triangulator->device();
  }
  const auto needed = [&](std::size_t n) { return triangulator == nullptr ? 0 : triangulator->memory_needed(n); };
  desk.check();
  const auto begin = Clock::now();
  if (source.is_file()) {
    desk.report("reading " + source.name(), -1);
    result->points = io::read_points(source.path, source.read);
    check_room(result->points.size(), needed(result->points.size()), available);
  } else {
    check_room(source.generate.n, source.generate.n > max_points() ? 0 : needed(source.generate.n), available);
    desk.report("making points", -1);
    result->points = io::generate(source.distribution, source.generate);
  }
  result->heights.assign(result->points.height.begin(), result->points.height.end());
  result->read_milliseconds = milliseconds_since(begin);
  desk.check();
  if (triangulator == nullptr) return result;
  const auto start = Clock::now();
  result->mesh = triangulator->triangulate(result->points.view());
  result->mesh_milliseconds = milliseconds_since(start);
  result->statistics = result->mesh->statistics();
  // The callbacks are of this call.
  triangulator->options().progress = nullptr;
  triangulator->options().stop = {};
  return result;
}

}  // namespace cadt::viewer
