// SPDX-License-Identifier: Apache-2.0
// The viewer: its state, what commands do to it, and its loop. What draws cards and the panel (panel.hpp, cards.hpp)
// reads the state and asks for commands.
#pragma once

#include "viewer/draw/renderer.hpp"
#include "viewer/gl/errors.hpp"
#include "viewer/growth/playback.hpp"
#include "viewer/growth/recording.hpp"
#include "viewer/live/live_points.hpp"
#include "viewer/mesh/mesher.hpp"
#include "viewer/window/facts.hpp"
#include "viewer/window/message.hpp"
#include "viewer/window/source.hpp"
#include "viewer/window/view.hpp"
#include "viewer/window/window.hpp"
#include "viewer/window/work.hpp"

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cadt::viewer {

/// What the command line says.
struct ViewOptions {
  std::vector<Source> sources;
  Options compute;
  Interop interop = Interop::automatic;
  Drawing drawing = Drawing::filled;
  std::optional<ColourBy> colour;  ///< empty: by height where there are heights, else by area
  bool dark = false;
  int width = 1280, height = 800;
  double scale = 0;                          ///< of text and lines; 0: the system's
  bool log = false;                          ///< says on standard output what has happened, for tests
  bool lose_context = false;                 ///< once, for tests: as if the driver had been reset
  std::function<std::size_t()> free_memory;  ///< bytes of the host; 0: not known
};

/// The driver was reset, and all that lived in OpenGL is gone.
class ContextLost : public DisplayError {
 public:
  using DisplayError::DisplayError;
};

/// What lives in OpenGL, and goes with its context.
struct Scene {
  Renderer renderer;
  MeshBuffers mesh;
  std::unique_ptr<Mesher> mesher;  ///< where the device writes OpenGL's buffers; else null, and `Work` makes the mesh
};

/// The mesh as it grows: one snapshot of a recording after the other is in OpenGL's buffers.
struct Growing {
  std::shared_ptr<const Recording> recording;
  Playback playback;
  double speed = 8;  ///< snapshots a second
  std::optional<std::size_t> shown;
  std::vector<std::optional<std::uint64_t>>
      illegal_edges;  ///< of each snapshot; found when it is looked at for a while
};

/// What the mouse does to points.
enum class Tool { drag, paint, erase };

/// Points that are edited or move; the mesh is made anew for each picture.
struct Editing {
  std::unique_ptr<Mesher> own;  ///< where the scene has none
  Mesher* mesher = nullptr;
  std::unique_ptr<LivePoints> points;
  Tool tool = Tool::drag;
  Motion motion = Motion::flow;
  bool moving = false;
  float brush = 30;  ///< radius, pixels
  int amount = 40;   ///< points of a dab of paint
  std::optional<std::size_t> held;
  bool changed = false;  ///< the triangles are of other points
  double mesh_milliseconds = 0, frame_milliseconds = 0;
  std::chrono::steady_clock::time_point last;
};

class App {
 public:
  explicit App(ViewOptions options);
  ~App();
  /// Until the window is closed. \throws DisplayError if it cannot be opened
  void run();

  // ---- what panel and cards read ----
  ViewOptions options;      ///< `compute` is what the next triangulation does
  std::size_t current = 0;  ///< of options.sources
  std::size_t shown = 0;    ///< of them, the one in the picture: another while `current` is loaded, or cannot be
  ViewState view;
  Selection selection;
  std::optional<TriangleFacts> hovered, selected;
  std::optional<Place> selected_place;  ///< of selection.point
  std::shared_ptr<Loaded> loaded;       ///< null until the first is there
  Work loading, asking;
  std::optional<Message> message;
  std::string toast, voronoi_note, interop_reason, search_text;
  bool panel_shown = true, panel_focused = false, help_shown = false, search_shown = false;
  std::array<double, 2> height_ends{0, 1};  ///< of which the renderer's values are shares
  std::optional<Growing> growing;
  std::unique_ptr<Editing> editing;
  double picture_milliseconds = 0, triangulate_milliseconds = 0;
  std::unique_ptr<Window> window;
  std::unique_ptr<Scene> scene;
  int panel_width = 0;                      ///< pixels, right of the mesh
  std::vector<std::array<float, 4>> cards;  ///< over the mesh, that take the mouse: left, top, right, bottom

  // ---- what they ask for ----
  void ask(Command command);
  /// "12", "t 12", "p 12": goes there and marks it.
  void search(const std::string& text);
  void show_source(std::size_t which);
  /// Another source, behind those that there are.
  void add_source(Source source);
  void choose_colour(ColourBy colour);
  void restart();
  [[nodiscard]] std::string way_text() const;
  [[nodiscard]] bool toast_shown() const { return std::chrono::steady_clock::now() < toast_until_; }

  /// A snapshot of the recording; pauses.
  void show_snapshot(std::size_t which);
  void choose_tool(Tool tool);
  /// Whether something moves by itself.
  [[nodiscard]] bool animated() const;

  // ---- what the input calls ----
  /// Runs it; what it throws becomes a message.
  void guarded(const std::function<void()>& action) noexcept;
  /// Tools: press, move, release. False: there is nothing to edit here.
  bool press(double x, double y);
  void drag_to(double x, double y);
  void release();
  void select_at(double x, double y);
  void hover(double x, double y);
  [[nodiscard]] bool over_mesh(double x, double y) const;

 private:
  void session();
  bool open_mesher();
  void start_loading();
  void finish_loading(const std::exception_ptr& error);
  void show(const std::shared_ptr<Loaded>& next);
  void ask_next();
  void finish_asking(const std::exception_ptr& error);
  void offer_colours();
  void update_colour();
  void update_strokes();
  /// `complete`: with all samples at once.
  void draw_mesh(bool complete);
  void frame();
  void mark(const Selection& what);
  [[nodiscard]] TriangleFacts facts(std::size_t triangle) const;
  void pick_next();
  void say(const std::string& text);
  void report(const Message& what);
  void show_toast(std::string text);
  void advance();
  void grow_command(Command command);
  void edit_command(Command command);
  void start_growing();
  void finish_recording(const std::shared_ptr<const Recording>& recording);
  void stop_growing();
  void advance_growing(double seconds);
  void upload_snapshot();
  [[nodiscard]] std::vector<float> growth_values() const;
  void start_editing();
  void stop_editing();
  void advance_editing(double seconds);
  void points_changed();
  void take_points_back();
  void save_screenshot(int width, int height);
  [[nodiscard]] std::vector<double> signature(int samples) const;

  struct Asked;  ///< what the thread of `asking` brings
  std::shared_ptr<Asked> asked_;
  std::shared_ptr<std::shared_ptr<Loaded>> coming_;  ///< what the thread of `loading` brings
  std::shared_ptr<std::shared_ptr<const Recording>> recorded_;
  ColourBy before_growing_ = ColourBy::area;
  std::optional<ColourBy> ramp_of_growth_;
  std::optional<ColourBy> before_editing_;  ///< where editing has no such colour
  Triangulators triangulators_;
  std::shared_ptr<const VoronoiDiagram> diagram_;
  std::optional<ColourBy> values_of_;  ///< whose values and ends the renderer has
  std::array<Stroke, 2> strokes_;      ///< hull, Voronoi cells
  int version_ = 0;                    ///< counts changes of mesh, values and strokes
  std::vector<double> drawn_;
  bool points_stale_ = false;  ///< loaded->points are not those that are drawn
  std::chrono::steady_clock::time_point last_frame_, edited_, changed_, toast_until_;
  bool colour_chosen_ = false, hover_later_ = false, settled_ = true, restart_asked_ = false;
  std::optional<Command> screenshot_;
  std::array<float, 4> look_{-1, -1, -1, -1};
  std::optional<std::size_t> tab_from_;  ///< the triangle whose neighbours Tab shows
  int tab_ = 0;
};

}  // namespace cadt::viewer
