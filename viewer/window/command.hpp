// SPDX-License-Identifier: Apache-2.0
// What a user can ask for, with the keys for it: one table for the keyboard, the help and the tests.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace cadt::viewer {

enum class Command {
  // where one looks
  pan_left,
  pan_right,
  pan_up,
  pan_down,
  zoom_in,
  zoom_out,
  fit,
  // what is drawn
  points,
  wireframe,
  filled,
  next_colour,
  hull,
  voronoi,
  inspect,
  dark,
  // what is asked
  pick,
  search,
  // files and pictures
  previous_file,
  next_file,
  rebuild,
  screenshot,
  screenshot_of_window,
  // the mesh as it grows
  grow,
  play,
  step,
  back,
  faster,
  slower,
  // points that are edited
  edit,
  next_tool,
  move_points,
  // the window
  panel,
  focus_panel,
  full_screen,
  help,
  cancel,
  quit
};

/// Modifiers as GLFW numbers them.
enum Modifier : int { no_modifier = 0, shift = 1, control = 2 };

/// A key that types nothing, or one with Ctrl.
struct Key {
  int code = 0;  ///< as GLFW numbers keys
  int modifiers = no_modifier;
  friend bool operator==(const Key&, const Key&) = default;
};

struct Binding {
  Command command;
  std::string_view name;        ///< of the command, e.g. "zoom_in"
  std::string_view characters;  ///< that ask for it, whatever keys they are on
  std::vector<Key> keys;
  std::string_view shown;  ///< the keys in words: "+"; empty: not in the help
  std::string_view group;  ///< title in the help
  std::string_view what;   ///< e.g. "zoom in"
};

[[nodiscard]] const std::vector<Binding>& bindings();
[[nodiscard]] std::optional<Command> command_of(char32_t character);
[[nodiscard]] std::optional<Command> command_of(Key key);

}  // namespace cadt::viewer
