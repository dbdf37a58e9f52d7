// SPDX-License-Identifier: Apache-2.0
// The viewer while points are edited or move: the mesh is made anew for each picture.
#include "viewer/window/app.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cadt::viewer {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// A mean that follows.
void follow(double& mean, double value) { mean = mean == 0 ? value : 0.85 * mean + 0.15 * value; }

}  // namespace

void App::start_editing() {
  if (loaded == nullptr || loading.running() || editing != nullptr) return;
  if (growing) stop_growing();
  asking.abandon();
  asked_.reset();
  auto next = std::make_unique<Editing>();
  if (scene->mesher == nullptr) next->own = std::make_unique<Mesher>(options.compute, Interop::copy);
  next->mesher = next->own != nullptr ? next->own.get() : scene->mesher.get();
  next->mesher->options().tuning = options.compute.tuning;
  try {
    next->points = std::make_unique<LivePoints>(scene->mesh);
  } catch (const InputError&) {
    report({"These points cannot be edited",
            "Points move and are edited in a box that has a size and is no wider than the largest double.", "", false});
    return;
  }
  next->last = Clock::now();
  editing = std::move(next);
  view.colours = {ColourBy::nothing, ColourBy::angle, ColourBy::area, ColourBy::order};
  if (std::find(view.colours.begin(), view.colours.end(), view.colour) == view.colours.end()) {
    before_editing_ = view.colour;
    view.colour = ColourBy::area;
  }
  say("editing");
}

void App::stop_editing() {
  if (editing == nullptr) return;
  editing->moving = false;
  if (editing->changed) advance_editing(0);
  editing.reset();
  take_points_back();
  offer_colours();
  if (before_editing_ && std::find(view.colours.begin(), view.colours.end(), *before_editing_) != view.colours.end())
    view.colour = *std::exchange(before_editing_, std::nullopt);
  say(fmt::format("edited: {} points {} triangles", scene->mesh.point_count, scene->mesh.triangle_count));
}

/// What is drawn comes to the host, for hull, neighbours, Voronoi cells and growth.
void App::take_points_back() {
  if (!points_stale_) return;
  const auto now = std::make_shared<Loaded>(*loaded);
  now->points.height.clear();
  now->points.xy = scene->mesh.points.read_values<double>(2 * scene->mesh.point_count);
  // The box grows alone: there is room for others where some were erased.
  const Extent box = box_of(now->points.xy);
  for (std::size_t k = 0; k < 2 && scene->mesh.point_count != 0; ++k) {
    scene->mesh.box.low[k] = std::min(scene->mesh.box.low[k], box.low[k]);
    scene->mesh.box.high[k] = std::max(scene->mesh.box.high[k], box.high[k]);
  }
  view.renew(scene->mesh.box, scene->mesh.point_count);
  now->heights.clear();
  now->mesh.reset();
  loaded = now;
  points_stale_ = false;
  values_of_.reset();
}

void App::points_changed() {
  editing->changed = true;
  points_stale_ = true;
  edited_ = Clock::now();
}

void App::advance_editing(double seconds) {
  Editing& e = *editing;
  if (e.moving) {
    e.points->step(std::min(seconds, 0.05), e.motion);
    points_changed();
    follow(e.frame_milliseconds, 1000 * seconds);
  }
  if (!e.changed) return;
  const auto begin = Clock::now();
  e.changed = false;
  e.mesher->triangulate(scene->mesh);
  follow(e.mesh_milliseconds, milliseconds_since(begin));
  scene->renderer.update(scene->mesh);
  hovered.reset();
  mark({});
  diagram_.reset();
  for (Stroke& stroke : strokes_) stroke.segments.clear();
  ++version_;
}

void App::choose_tool(Tool tool) {
  if (editing != nullptr) editing->tool = tool;
}

bool App::press(double x, double y) {
  if (editing == nullptr) return false;
  Editing& e = *editing;
  if (e.tool == Tool::drag) {
    const Place at = view.camera.place(x, y);
    e.held = e.points->nearest(at[0], at[1]);
    if (!e.held) return false;
    const auto xy = scene->mesh.points.read_values<double>(2, 2 * *e.held * sizeof(double));
    const Place pixel = view.camera.pixel(xy[0], xy[1]);
    if (std::hypot(pixel[0] - x, pixel[1] - y) > 24 * view.scale) {
      e.held.reset();
      return false;
    }
    say(fmt::format("holds point {}", *e.held));
    return true;
  }
  drag_to(x, y);
  return true;
}

void App::drag_to(double x, double y) {
  if (editing == nullptr) return;
  Editing& e = *editing;
  const Place at = view.camera.place(x, y);
  const double radius = e.brush * view.scale / std::fabs(view.camera.scale());
  // Seen from afar, a place beside a box of the largest doubles may be beyond them.
  const double reach = e.tool == Tool::drag ? 0 : radius;
  if (!std::isfinite(std::fabs(at[0]) + reach) || !std::isfinite(std::fabs(at[1]) + reach)) return;
  switch (e.tool) {
    case Tool::drag:
      if (e.held) e.points->drag(*e.held, at[0], at[1]);
      break;
    case Tool::paint:
      e.points->paint(at[0], at[1], radius, static_cast<std::size_t>(e.amount));
      break;
    case Tool::erase:
      if (e.points->erase(at[0], at[1], radius) == 0) return;
      break;
  }
  points_changed();
}

void App::release() {
  if (editing == nullptr) return;
  editing->held.reset();
  if (editing->changed) advance_editing(0);
  say(fmt::format("edited: {} points {} triangles", scene->mesh.point_count, scene->mesh.triangle_count));
}

void App::edit_command(Command command) {
  switch (command) {
    case Command::edit:
      editing != nullptr ? stop_editing() : start_editing();
      break;
    case Command::next_tool:
      if (editing == nullptr) start_editing();
      if (editing != nullptr) editing->tool = static_cast<Tool>((static_cast<int>(editing->tool) + 1) % 3);
      break;
    case Command::move_points:
      if (editing == nullptr) start_editing();
      if (editing != nullptr) editing->moving = !editing->moving;
      break;
    default:
      break;
  }
}

}  // namespace cadt::viewer
