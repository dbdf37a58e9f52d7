// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/app.hpp"

#include "viewer/gl/errors.hpp"
#include "viewer/still/scene_values.hpp"
#include "viewer/window/input.hpp"

#include <cadt/devices.hpp>

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace cadt::viewer {
namespace {

using Clock = std::chrono::steady_clock;

/// What there is for points alone.
bool needs_delaunay_mesh(Command command) {
  return command == Command::voronoi || command == Command::grow || command == Command::edit ||
         command == Command::next_tool || command == Command::move_points;
}

/// Waits for events: at most so long while something moves by itself.
constexpr double busy_wait = 0.1;

bool has_gpu(const Options& options) {
  const auto devices = list_devices();
  return std::any_of(devices.begin(), devices.end(), [&](const DeviceInfo& d) {
    return d.usable && d.gpu && (options.backend == Backend::automatic || options.backend == d.backend);
  });
}

}  // namespace

App::App(ViewOptions given) : options(std::move(given)), loading(&Window::wake), asking(&Window::wake) {
  options.compute.order = Order::fast;  // along the curve
  view.drawing = options.drawing;
  view.dark = options.dark;
  colour_chosen_ = options.colour.has_value();
  if (options.colour) view.colour = *options.colour;
}

App::~App() = default;

void App::say(const std::string& text) {
  if (!options.log) return;
  std::fputs((text + "\n").c_str(), stdout);
  std::fflush(stdout);
}

void App::run() {
  for (bool again = true; again;) {
    again = false;
    try {
      session();
    } catch (const ContextLost&) {
      again = true;
    }
    loading.abandon();
    asking.abandon();
    asked_.reset();  // what they would have brought is of the mesh that goes
    coming_.reset();
    recorded_.reset();
    if (growing) view.colour = before_growing_;
    editing.reset();
    growing.reset();
    const bool errors = scene != nullptr && !again && gl::errors_seen() != 0;
    scene.reset();
    window.reset();
    if (errors) throw InternalError("OpenGL reported errors");
    if (again)
      message = Message{"The display's driver was reset", "The window was opened again, and the mesh is made anew.",
                        "If this happens often, update the driver or show fewer points."};
  }
}

void App::session() {
  window = std::make_unique<Window>("cadt", options.width, options.height);
  window->listen(events_for(*this));
  look_ = {-1, -1, -1, -1};
  loaded.reset();
  hovered.reset();
  mark({});
  values_of_.reset();
  diagram_.reset();
  drawn_.clear();
  frame();  // the window appears at once; compiling comes after that
  scene = std::make_unique<Scene>();
  say("window " + window->driver().renderer);
  restart_asked_ = true;
  int frames = 2;  // ImGui needs a second one for what follows from the first
  while (!window->should_close()) {
    const bool busy =
        loading.running() || asking.running() || !settled_ || points_stale_ || Clock::now() < toast_until_;
    if (window->wait(!window->visible() ? -1 : frames > 0 || animated() ? 0 : busy ? busy_wait : -1)) frames = 3;
    if (window->lost() || (loaded != nullptr && std::exchange(options.lose_context, false)))
      throw ContextLost("the driver was reset");
    guarded([&] {
      std::exception_ptr error;
      // The end of a task is no event: what it brings (a card that fits its text) takes ImGui two frames, too.
      if (loading.finished(error)) {
        frames = 3;
        finish_loading(error);
      }
      if (asking.finished(error)) {
        frames = 3;
        finish_asking(error);
      }
      if (restart_asked_ && !loading.running()) start_loading();
      advance();
      ask_next();
    });
    if (!window->visible()) continue;
    frame();
    if (frames > 0) --frames;
  }
  window->hide();
}

bool App::open_mesher() {
  interop_reason.clear();
  scene->mesher.reset();
  try {
    const bool forced = options.interop == Interop::cuda || options.interop == Interop::opencl;
    if (options.sources[current].constrain) {
      if (forced) throw DisplayError("a mesh with segments comes through the host: leave --interop out");
      interop_reason = "the mesh has segments";
    } else if (options.interop == Interop::copy) {
      interop_reason = "--interop copy";
    } else if (!forced && (options.compute.backend == Backend::host || !has_gpu(options.compute))) {
      interop_reason = "no GPU computes";
    } else {
      scene->mesher = std::make_unique<Mesher>(options.compute, options.interop);
      interop_reason = scene->mesher->reason();
      // Then a thread makes the mesh, and the window goes on.
      if (scene->mesher->interop() == Interop::copy) scene->mesher.reset();
    }
    return true;
  } catch (...) {
    report(explain(std::current_exception()));
    return false;
  }
}

std::string App::way_text() const {
  return std::string(
      to_string(scene != nullptr && scene->mesher != nullptr ? scene->mesher->interop() : Interop::copy));
}

void App::show_source(std::size_t which) {
  if (which >= options.sources.size()) return;
  current = which;
  restart();
}

void App::add_source(Source source) {
  options.sources.push_back(std::move(source));
  show_source(options.sources.size() - 1);
}

void App::choose_colour(ColourBy colour) {
  view.colour = colour;
  colour_chosen_ = true;
  before_editing_.reset();
}

void App::restart() {
  message.reset();
  restart_asked_ = true;
  loading.cancel();
  Window::wake();
}

void App::start_loading() {
  restart_asked_ = false;
  stop_editing();  // before the mesher goes
  if (!open_mesher()) return;
  asking.cancel();
  asked_.reset();  // nobody waits for it: no "Cancelled", and what is drawn stays chosen
  const Source& source = options.sources[current];
  window->set_title("cadt: " + source.name());
  const std::size_t available = options.free_memory ? options.free_memory() : 0;
  const auto result = std::make_shared<std::shared_ptr<Loaded>>();
  Triangulators* const triangulators = scene->mesher == nullptr ? &triangulators_ : nullptr;
  coming_ = result;
  loading.start([result, source, compute = options.compute, triangulators, available](Work::Desk& desk) {
    *result = load(source, compute, triangulators, available, desk);
  });
}

void App::finish_loading(const std::exception_ptr& error) {
  const auto coming = std::exchange(coming_, nullptr);
  const auto recorded = std::exchange(recorded_, nullptr);
  if (restart_asked_) return;  // by something newer
  if (error) std::rethrow_exception(error);
  if (coming != nullptr) {
    shown = current;
    show(*coming);
  }
  if (recorded != nullptr) finish_recording(*recorded);
}

void App::guarded(const std::function<void()>& action) noexcept {
  try {
    action();
  } catch (...) {
    report(explain(std::current_exception()));
  }
}

bool App::animated() const {
  return (growing && growing->playback.playing()) || (editing != nullptr && editing->moving);
}

void App::advance() {
  const auto now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last_frame_).count();
  last_frame_ = now;
  if (growing) advance_growing(seconds);
  if (editing != nullptr) advance_editing(seconds);
  // After a pause what was edited comes to the host, if something there needs it.
  if (editing != nullptr && points_stale_ && !editing->moving && !editing->held &&
      now - edited_ > std::chrono::milliseconds(300))
    take_points_back();
}

void App::report(const Message& what) {
  message = what;
  say("message " + what.title + ": " + what.text);
}

void App::show_toast(std::string text) {
  say(text);
  toast = std::move(text);
  toast_until_ = Clock::now() + std::chrono::seconds(4);
}

void App::show(const std::shared_ptr<Loaded>& next) {
  Scene& s = *scene;
  const auto begin = Clock::now();
  editing.reset();
  if (growing) view.colour = before_growing_;
  growing.reset();
  if (before_editing_) view.colour = *std::exchange(before_editing_, std::nullopt);
  points_stale_ = false;
  s.mesh = {};                                           // first: both may not fit
  s.mesh = MeshBuffers::with_room(next->points.size());  // also for points that are edited
  s.mesh.write_points(next->points.xy);
  if (next->mesh) {
    s.mesh.write_triangles(next->triangles());
    if (next->inside) s.mesh.write_edges(next->inside->edges);
    triangulate_milliseconds = next->mesh_milliseconds;
  } else {
    s.mesh.bytes_through_host = 0;  // the points of a file come from there; what counts is the mesh
    s.mesher->options() = options.compute;
    const auto start = Clock::now();
    s.mesher->triangulate(s.mesh, &next->statistics);
    triangulate_milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    next->device = s.mesher->device();
  }
  const bool same = loaded != nullptr && loaded->source == next->source;
  loaded = next;
  hovered.reset();
  diagram_.reset();
  voronoi_note.clear();
  if (same && view.box() == s.mesh.box)
    view.renew(s.mesh.box, s.mesh.point_count);
  else
    view.show(s.mesh.box, s.mesh.point_count, !loaded->heights.empty());
  offer_colours();
  if (loaded->inside) view.voronoi = false;
  if (std::find(view.colours.begin(), view.colours.end(), view.colour) == view.colours.end())
    view.colour = ColourBy::area;
  if (!same && !colour_chosen_) {
    view.colour = loaded->inside            ? usual_colour(loaded->scene())
                  : loaded->heights.empty() ? ColourBy::area
                                            : ColourBy::height;
  }
  s.renderer.update(s.mesh);
  mark({});
  values_of_.reset();
  ++version_;
  update_strokes();
  const std::string name = loaded->source.name();
  window->set_title(fmt::format("cadt: {}, {} points", name, number_text(s.mesh.point_count)));
  say(fmt::format("loaded {} {} points {} triangles {} constrained edges by {} in {:.0f} ms", name, s.mesh.point_count,
                  s.mesh.triangle_count, s.mesh.edge_count, way_text(),
                  std::chrono::duration<double, std::milli>(Clock::now() - begin).count()));
}

void App::ask(Command command) {
  if (loaded != nullptr && loaded->inside && needs_delaunay_mesh(command)) {
    report({"This mesh has segments", "Voronoi cells, growth and editing are there for points without segments.",
            "Show the points alone for that.", false});
    return;
  }
  if (view.apply(command)) {
    if (command == Command::next_colour) {
      colour_chosen_ = true;
      before_editing_.reset();
    }
    if (command == Command::hull || command == Command::voronoi) update_strokes();
    if (const auto [x, y] = window->cursor(); over_mesh(x, y)) hover(x, y);
    return;
  }
  switch (command) {
    case Command::cancel:
      if (search_shown || help_shown)
        search_shown = help_shown = false;
      else if (message)
        message.reset();
      else if (loading.running())
        loading.cancel();
      else if (asking.running())
        asking.cancel();
      else if (panel_focused)
        panel_focused = false;
      else if (!selection.empty())
        mark({});
      else if (growing)
        stop_growing();
      else if (editing != nullptr)
        stop_editing();
      return;
    case Command::quit:
      window->close();
      return;
    case Command::help:
      help_shown = !help_shown;
      return;
    case Command::search:
      search_shown = true;
      search_text.clear();
      return;
    case Command::pick:
      pick_next();
      return;
    case Command::panel:
      panel_shown = !panel_shown;
      if (!panel_shown) panel_focused = false;  // else arrows would go to what is not there
      return;
    case Command::focus_panel:
      panel_shown = true;
      panel_focused = !panel_focused;
      return;
    case Command::full_screen:
      window->toggle_full_screen();
      return;
    case Command::previous_file:
      if (current > 0) show_source(current - 1);
      return;
    case Command::next_file:
      show_source(current + 1);
      return;
    case Command::rebuild:
      restart();
      return;
    case Command::screenshot:
    case Command::screenshot_of_window:
      screenshot_ = command;
      return;
    case Command::grow:
    case Command::play:
    case Command::step:
    case Command::back:
    case Command::faster:
    case Command::slower:
      grow_command(command);
      return;
    case Command::edit:
    case Command::next_tool:
    case Command::move_points:
      edit_command(command);
      return;
    default:
      return;
  }
}

}  // namespace cadt::viewer
