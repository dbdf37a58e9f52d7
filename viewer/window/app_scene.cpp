// SPDX-License-Identifier: Apache-2.0
// The viewer's picture: when it is drawn anew, what lies over it, and what has to be computed for that.
#include "io/picture/measure.hpp"
#include "viewer/draw/image_file.hpp"
#include "viewer/draw/palette.hpp"
#include "viewer/still/scene_values.hpp"
#include "viewer/window/app.hpp"
#include "viewer/window/cards.hpp"
#include "viewer/window/overlays.hpp"
#include "viewer/window/panel.hpp"
#include "viewer/window/screenshot.hpp"

#include <cadt/verify.hpp>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cadt::viewer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_voronoi_lines = 150'000;     // more cannot be told apart
constexpr std::size_t most_hull_by_itself = 4'000'000;  // triangles of a mesh on the device that are fetched for it
constexpr double slow_picture = 25;                     // ms; above, one sample a pixel is drawn while things move
constexpr std::uint32_t voronoi_colour = 0x3a7d5d, voronoi_colour_dark = 0x7fc7a2;

bool needs_mesh_of_host(const App& app) {
  return app.view.voronoi || app.view.colour == ColourBy::degree || app.selection.triangle ||
         (app.view.hull && app.scene->mesh.triangle_count <= most_hull_by_itself);
}

}  // namespace

struct App::Asked {
  std::shared_ptr<Loaded> of;
  std::optional<Triangulation> mesh;
  std::shared_ptr<const VoronoiDiagram> diagram;
  std::shared_ptr<const Recording> recording;  ///< whose snapshot `frame` has so many illegal edges
  std::size_t frame = 0;
  std::uint64_t illegal_edges = 0;
};

void App::ask_next() {
  if (asking.running() || loading.running() || loaded == nullptr || scene == nullptr || points_stale_) return;
  if (editing != nullptr && editing->moving) return;
  if (scene->mesh.triangle_count == 0) return;
  const auto asked = std::make_shared<Asked>();
  asked->of = loaded;
  if (growing) {
    const std::size_t frame = *growing->shown;
    if (growing->playback.playing() || growing->illegal_edges[frame]) return;
    asked->recording = growing->recording;
    asked->frame = frame;
    asking.start([asked](Work::Desk& desk) {
      desk.report("illegal edges", -1);
      asked->illegal_edges = asked->recording->illegal_edges(asked->frame);
    });
  } else if (!loaded->mesh) {
    if (!needs_mesh_of_host(*this)) return;
    // The device made the mesh: neighbours and hull are the host's to find.
    auto triangles = scene->mesh.triangles.read_values<std::int32_t>(3 * scene->mesh.triangle_count);
    asking.start([asked, triangles = std::move(triangles)](Work::Desk& desk) {
      desk.report("neighbours", -1);
      asked->mesh = Triangulation::adopt(asked->of->points.view(), triangles, {}, Trust::geometry);
    });
  } else if (view.voronoi && diagram_ == nullptr) {
    asking.start([asked](Work::Desk& desk) {
      desk.report("Voronoi cells", -1);
      Options host;
      host.backend = Backend::host;
      host.stop = desk.stop();
      MeshQueries queries(asked->of->points.view(), *asked->of->mesh, host);
      asked->diagram = std::make_shared<const VoronoiDiagram>(queries.voronoi());
    });
  } else {
    return;
  }
  asked_ = asked;
}

void App::finish_asking(const std::exception_ptr& error) {
  const auto asked = std::exchange(asked_, nullptr);
  if (asked == nullptr || asked->of != loaded) return;
  if (asked->recording != nullptr) {
    if (error) std::rethrow_exception(error);
    if (growing && growing->recording == asked->recording) growing->illegal_edges[asked->frame] = asked->illegal_edges;
    return;
  }
  if (error) {
    view.voronoi = false;  // else it would be asked again for ever
    view.hull = false;
    if (view.colour == ColourBy::degree) view.colour = ColourBy::area;
    mark({});
    report(explain(error));
    return;
  }
  if (asked->mesh) loaded->mesh = std::move(*asked->mesh);
  if (asked->diagram) diagram_ = asked->diagram;
  mark(selection);
  values_of_.reset();
  update_strokes();
  say("ready");
}

/// Those that there are values for.
void App::offer_colours() {
  view.colours = loaded->heights.empty() ? ViewState::usual_colours() : ViewState::colours_with_heights();
  if (loaded->inside) view.colours.push_back(ColourBy::region);
}

void App::update_colour() {
  if (values_of_ == view.colour) return;
  Renderer& r = scene->renderer;
  if (growing && ramp_of_growth_ != view.colour) {
    // The ends are those of the complete mesh, so that colours mean the same in each snapshot.
    const double position = growing->playback.position();
    growing->playback.seek(growing->playback.last());
    upload_snapshot();
    r.set_values(growth_values());
    r.fit_ramp(scene->mesh, view.colour);
    // Most points come at the last levels: quantiles would leave out the first ones.
    if (view.colour == ColourBy::level)
      r.set_ramp_ends({1, static_cast<float>(growing->recording->counters(growing->recording->size() - 1).level)});
    ramp_of_growth_ = view.colour;
    growing->playback.seek(position);
    upload_snapshot();
  }
  if (growing) {
    r.set_values(growth_values());
  } else if (loaded->mesh && !points_stale_) {
    prepare_colour(r, scene->mesh, loaded->scene(), view.colour);
    const auto ends = io::picture::height_ends(loaded->scene());
    height_ends = ends ? std::array{ends->low, ends->high} : std::array{0.0, 1.0};
  } else {
    height_ends = {0, 1};
    r.set_outside({}, 0);
    r.set_values(view.colour == ColourBy::height ? loaded->heights : std::vector<float>());
    if (scene->mesh.triangle_count != 0) r.fit_ramp(scene->mesh, view.colour);
  }
  values_of_ = view.colour;
  ++version_;
}

void App::update_strokes() {
  for (Stroke& stroke : strokes_) stroke.segments.clear();
  ++version_;
  if (loaded == nullptr || !loaded->mesh || points_stale_) return;
  if (view.hull) strokes_[0] = hull_stroke(loaded->scene(), view.dark);
}

std::vector<double> App::signature(int samples) const {
  const Axis x = view.camera.axis(0), y = view.camera.axis(1);
  return {x.origin,
          x.first,
          x.second,
          y.origin,
          y.second,
          static_cast<double>(view.camera.width()),
          static_cast<double>(view.camera.height()),
          static_cast<double>(view.colour),
          static_cast<double>(view.drawing),
          view.dark ? 1.0 : 0.0,
          view.hull ? 1.0 : 0.0,
          view.voronoi ? 1.0 : 0.0,
          view.scale,
          static_cast<double>(version_),
          static_cast<double>(samples)};
}

void App::draw_mesh(bool complete) {
  if (scene->mesh.point_count == 0) {
    settled_ = true;
    return;
  }
  update_colour();
  Style style = view.style();
  const int most = style.samples;
  if (drawn_ == signature(most)) {
    settled_ = true;
    return;
  }
  const bool moved = drawn_ != signature(1);
  if (moved) changed_ = Clock::now();
  // While things move the picture is drawn with one sample a pixel if all of them take too long.
  if (!complete && picture_milliseconds > slow_picture && Clock::now() - changed_ < std::chrono::milliseconds(150))
    style.samples = 1;
  settled_ = style.samples == most;
  if (!moved && !settled_) return;
  strokes_[0].colour = palette(view.dark).hull;
  strokes_[0].width = static_cast<float>(1.6 * view.scale);
  strokes_[1].segments.clear();
  voronoi_note.clear();
  if (view.voronoi && diagram_ != nullptr && !growing && !points_stale_) {
    VoronoiLines lines = voronoi_lines(loaded->points.xy, *diagram_, view.camera, most_voronoi_lines);
    if (lines.segments.empty() && lines.in_view > 0)
      voronoi_note = fmt::format("{} edges in view: zoom in", number_text(lines.in_view));
    strokes_[1] = {std::move(lines.segments), view.dark ? voronoi_colour_dark : voronoi_colour,
                   static_cast<float>(1.2 * view.scale)};
  }
  const auto begin = Clock::now();
  scene->renderer.draw(scene->mesh, view.camera, style, strokes_);
  glFinish();
  const double taken = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  if (settled_) picture_milliseconds = taken;
  drawn_ = signature(style.samples);
}

TriangleFacts App::facts(std::size_t triangle) const {
  const MeshBuffers& mesh = scene->mesh;
  const auto corners = mesh.triangles.read_values<std::int32_t>(3, 3 * triangle * sizeof(std::int32_t));
  std::array<Place, 3> places{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto xy = mesh.points.read_values<double>(2, 2 * static_cast<std::size_t>(corners[k]) * sizeof(double));
    places[k] = {xy[0], xy[1]};
  }
  TriangleFacts facts = facts_of(triangle, {corners[0], corners[1], corners[2]}, places);
  if (loaded->mesh && !growing && !points_stale_) {
    const auto all = loaded->neighbors();
    facts.neighbours = {all[3 * triangle], all[3 * triangle + 1], all[3 * triangle + 2]};
    if (loaded->inside) facts.region = loaded->inside->region[triangle];
  }
  return facts;
}

void App::hover(double x, double y) {
  hovered.reset();
  // The picture tells which triangle it is: after a change it has to be drawn first.
  hover_later_ =
      scene != nullptr && loaded != nullptr && drawn_ != signature(1) && drawn_ != signature(Style().samples);
  if (hover_later_) return;
  if (!view.inspect || scene == nullptr || loaded == nullptr || scene->mesh.triangle_count == 0 || !over_mesh(x, y))
    return;
  const auto found = scene->renderer.triangle_at(static_cast<int>(x), static_cast<int>(y));
  if (found && *found < scene->mesh.triangle_count) hovered = facts(*found);
}

void App::mark(const Selection& what) {
  selection = what;
  selected.reset();
  selected_place.reset();
  if (what.triangle) selected = facts(*what.triangle);
  if (what.point) {
    const auto xy = scene->mesh.points.read_values<double>(2, 2 * *what.point * sizeof(double));
    selected_place = Place{xy[0], xy[1]};
  }
}

void App::select_at(double x, double y) {
  if (scene == nullptr || loaded == nullptr || scene->mesh.triangle_count == 0) return;
  draw_mesh(false);  // the wheel may have moved since the last picture
  const auto found = scene->renderer.triangle_at(static_cast<int>(x), static_cast<int>(y));
  if (!found || *found >= scene->mesh.triangle_count) {
    mark({});
    return;
  }
  Selection next{*found, std::nullopt};
  const TriangleFacts there = facts(*found);
  double nearest = 8 * view.scale;
  for (std::size_t k = 0; k < 3; ++k) {
    const Place at = view.camera.pixel(there.corners[k][0], there.corners[k][1]);
    const double distance = std::hypot(at[0] - x, at[1] - y);
    if (distance < nearest) {
      nearest = distance;
      next.point = static_cast<std::size_t>(there.points[k]);
    }
  }
  mark(next);
  say(fmt::format("picked triangle {} of points {} {} {}{}", *found, there.points[0], there.points[1], there.points[2],
                  next.point ? fmt::format(", point {}", *next.point) : ""));
}

void App::pick_next() {
  if (scene == nullptr || loaded == nullptr || scene->mesh.triangle_count == 0) return;
  const int x = view.camera.width() / 2, y = view.camera.height() / 2;
  draw_mesh(false);
  const auto middle = scene->renderer.triangle_at(x, y);
  if (!middle) return;
  if (!selected || middle != tab_from_) {
    tab_from_ = middle;
    tab_ = 0;
    select_at(x, y);
    return;
  }
  // The middle has not changed: one neighbour of its triangle after the other.
  const TriangleFacts from = facts(*tab_from_);
  if (!from.neighbours) return;
  for (int i = 0; i < 4; ++i, ++tab_) {
    const std::int32_t t =
        tab_ % 4 == 3 ? static_cast<std::int32_t>(*tab_from_) : (*from.neighbours)[static_cast<std::size_t>(tab_ % 4)];
    if (t < 0 || selection.triangle == static_cast<std::size_t>(t)) continue;
    mark({static_cast<std::size_t>(t), std::nullopt});
    say(fmt::format("picked triangle {}", t));
    return;
  }
}

void App::search(const std::string& text) {
  search_shown = false;
  if (loaded == nullptr || scene == nullptr) return;
  const auto wanted = parse_search(text, scene->mesh.triangle_count == 0);
  const std::size_t count = wanted && wanted->point ? scene->mesh.point_count : scene->mesh.triangle_count;
  if (!wanted || wanted->index >= count) {
    report({"Not found",
            wanted ? fmt::format("There is no {} {}.", wanted->point ? "point" : "triangle", wanted->index)
                   : fmt::format("'{}' is no index.", text),
            fmt::format("Write 12 or t 12 for a triangle, p 12 for a point. The last index is {}.",
                        count == 0 ? 0 : count - 1),
            false});
    return;
  }
  if (wanted->point) {
    mark({std::nullopt, wanted->index});
    view.go_to((*selected_place)[0], (*selected_place)[1], 0);
  } else {
    mark({wanted->index, std::nullopt});
    const auto& c = selected->corners;
    const double across =
        std::max({std::fabs(c[0][0] - c[1][0]), std::fabs(c[1][0] - c[2][0]), std::fabs(c[2][0] - c[0][0]),
                  std::fabs(c[0][1] - c[1][1]), std::fabs(c[1][1] - c[2][1]), std::fabs(c[2][1] - c[0][1])});
    view.go_to((c[0][0] + c[1][0] + c[2][0]) / 3, (c[0][1] + c[1][1] + c[2][1]) / 3, across);
  }
  say(fmt::format("went to {} {}", wanted->point ? "point" : "triangle", wanted->index));
}

void App::save_screenshot(int width, int height) {
  try {
    const std::string name = free_picture_name(options.sources[shown].stem());
    write_png(name, read_window(width, height));
    show_toast("saved " + name);
  } catch (...) {
    Message failed = explain(std::current_exception());
    failed.title = "The picture cannot be written";
    failed.advice = "Start cadt in a folder that you may write to.";
    report(failed);
  }
}

void App::frame() {
  const auto [width, height] = window->size();
  view.scale = options.scale > 0 ? options.scale : window->content_scale();
  const std::array<float, 4> look{view.dark ? 1.0f : 0.0f, static_cast<float>(view.scale), 0, 0};
  if (look != look_) window->set_look(view.dark, view.scale);
  look_ = look;
  panel_width = panel_shown ? std::min(width / 2, static_cast<int>(340 * view.scale)) : 0;
  view.resize(width - panel_width, height);
  if (scene != nullptr && loaded != nullptr) guarded([&] { draw_mesh(screenshot_.has_value()); });
  if (hover_later_) {
    const auto [x, y] = window->cursor();
    guarded([&] { hover(x, y); });
  }
  window->begin_frame();
  const auto shot = std::exchange(screenshot_, std::nullopt);
  draw_picture(*this);
  if (shot != Command::screenshot) {
    if (panel_shown) draw_panel(*this);
    draw_cards(*this);
  }
  const auto ground = palette(view.dark).background;
  const auto part = [&](int shift) { return static_cast<float>((ground >> shift) & 255u) / 255.0f; };
  window->end_frame({part(16), part(8), part(0)}, [&] {
    if (shot) save_screenshot(*shot == Command::screenshot ? width - panel_width : width, height);
  });
}

bool App::over_mesh(double x, double y) const {
  return x >= 0 && y >= 0 && x < view.camera.width() && y < view.camera.height();
}

}  // namespace cadt::viewer
