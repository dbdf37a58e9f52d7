// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/command.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>

namespace cadt::viewer {

static_assert(shift == GLFW_MOD_SHIFT && control == GLFW_MOD_CONTROL);

const std::vector<Binding>& bindings() {
  constexpr std::string_view look = "Look", draw = "Draw", ask = "Ask", files = "Files and pictures",
                             grows = "The mesh as it grows", edits = "Edit points", window = "Window";
  static const std::vector<Binding> all{
      {Command::pan_left, "pan_left", "", {{GLFW_KEY_LEFT}}, "arrows", look, "move (also: drag, or two fingers)"},
      {Command::pan_right, "pan_right", "", {{GLFW_KEY_RIGHT}}, "", look, ""},
      {Command::pan_up, "pan_up", "", {{GLFW_KEY_UP}}, "", look, ""},
      {Command::pan_down, "pan_down", "", {{GLFW_KEY_DOWN}}, "", look, ""},
      {Command::zoom_in, "zoom_in", "+=", {}, "+  -", look, "zoom (also: wheel, to the cursor)"},
      {Command::zoom_out, "zoom_out", "-", {}, "", look, ""},
      {Command::fit, "fit", "fF", {{GLFW_KEY_HOME}}, "F  Home", look, "everything in view"},
      {Command::points, "points", "1", {}, "1  2  3", draw, "points, wireframe, filled"},
      {Command::wireframe, "wireframe", "2", {}, "", draw, ""},
      {Command::filled, "filled", "3", {}, "", draw, ""},
      {Command::next_colour, "next_colour", "cC", {}, "C", draw, "next colour"},
      {Command::hull, "hull", "hH", {}, "H", draw, "convex hull"},
      {Command::voronoi, "voronoi", "vV", {}, "V", draw, "Voronoi cells"},
      {Command::dark, "dark", "dD", {}, "D", draw, "dark or light"},
      {Command::inspect, "inspect", "iI", {}, "I", ask, "circumcircle and neighbours under the cursor"},
      {Command::pick,
       "pick",
       "",
       {{GLFW_KEY_TAB}},
       "Tab  click",
       ask,
       "select the triangle in the middle, then its neighbours"},
      {Command::search,
       "search",
       "/",
       {{GLFW_KEY_F, control}},
       "/  Ctrl+F",
       ask,
       "go to a triangle or a point by its index"},
      {Command::previous_file,
       "previous_file",
       "",
       {{GLFW_KEY_PAGE_UP}},
       "PgUp  PgDn",
       files,
       "previous and next file"},
      {Command::next_file, "next_file", "", {{GLFW_KEY_PAGE_DOWN}}, "", files, ""},
      {Command::rebuild, "rebuild", "rR", {{GLFW_KEY_F5}}, "R  F5", files, "read and triangulate again"},
      {Command::screenshot, "screenshot", "s", {}, "S", files, "save a picture of the mesh"},
      {Command::screenshot_of_window,
       "screenshot_of_window",
       "S",
       {},
       "Shift+S",
       files,
       "save a picture of the window"},
      {Command::grow, "grow", "gG", {}, "G", grows, "record how the mesh grows"},
      {Command::play, "play", " ", {}, "Space", grows, "play, pause"},
      {Command::back, "back", ",", {}, ",  .", grows, "step back, step"},
      {Command::step, "step", ".", {}, "", grows, ""},
      {Command::slower, "slower", "<", {}, "<  >", grows, "slower, faster"},
      {Command::faster, "faster", ">", {}, "", grows, ""},
      {Command::edit, "edit", "eE", {}, "E", edits, "edit points, and back"},
      {Command::next_tool, "next_tool", "tT", {}, "T", edits, "next tool: drag, paint, erase"},
      {Command::move_points, "move_points", "mM", {}, "M", edits, "all points move, or stop"},
      {Command::panel, "panel", "pP", {}, "P", window, "panel"},
      {Command::focus_panel,
       "focus_panel",
       "",
       {{GLFW_KEY_F6}},
       "F6",
       window,
       "keys for the panel (arrows, Enter, Space), and back"},
      {Command::full_screen, "full_screen", "", {{GLFW_KEY_F11}}, "F11", window, "full screen"},
      {Command::help, "help", "?", {{GLFW_KEY_F1}}, "?  F1", window, "this help"},
      {Command::cancel, "cancel", "", {{GLFW_KEY_ESCAPE}}, "Esc", window, "close, cancel, deselect"},
      {Command::quit, "quit", "qQ", {{GLFW_KEY_Q, control}, {GLFW_KEY_W, control}}, "Q", window, "quit"},
  };
  return all;
}

std::optional<Command> command_of(char32_t character) {
  if (character >= 128) return std::nullopt;
  for (const Binding& b : bindings())
    if (b.characters.find(static_cast<char>(character)) != std::string_view::npos) return b.command;
  return std::nullopt;
}

std::optional<Command> command_of(Key key) {
  for (const Binding& b : bindings())
    if (std::find(b.keys.begin(), b.keys.end(), key) != b.keys.end()) return b.command;
  return std::nullopt;
}

}  // namespace cadt::viewer
