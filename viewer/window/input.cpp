// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/input.hpp"

#include "viewer/window/app.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace cadt::viewer {
namespace {

/// A press that moves less than this is a click.
constexpr double click_reach = 4;

struct Drag {
  bool down = false, moved = false, edits = false;
  int button = 0;
  double x = 0, y = 0;
};

/// What ImGui wants (WantCaptureMouse) it knows of the pointer's place in the last frame; an event has its own.
bool takes_mouse(const App& app, double x, double y) {
  const bool on_card = std::ranges::any_of(app.cards, [&](const std::array<float, 4>& card) {
    return x >= card[0] && y >= card[1] && x < card[2] && y < card[3];
  });
  return app.over_mesh(x, y) && !on_card &&
         !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

bool is_whole(double v) { return v == std::floor(v); }

}  // namespace

Events events_for(App& app) {
  const auto drag = std::make_shared<Drag>();
  Events events;
  events.character = [&app](char32_t c) {
    if (app.search_shown) {
      if (c >= 32 && c < 127) app.search_text += static_cast<char>(c);
      return;
    }
    if (ImGui::GetIO().WantTextInput || (app.panel_focused && c == U' ')) return;
    if (const auto command = command_of(c)) app.guarded([&] { app.ask(*command); });
  };
  events.key = [&app](int key, int modifiers, bool) {
    if (app.search_shown) {
      if (key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER)
        app.guarded([&] { app.search(app.search_text); });
      else if (key == GLFW_KEY_BACKSPACE && !app.search_text.empty())
        app.search_text.pop_back();
      else if (key == GLFW_KEY_ESCAPE)
        app.ask(Command::cancel);
      return;
    }
    const bool moves = key == GLFW_KEY_LEFT || key == GLFW_KEY_RIGHT || key == GLFW_KEY_UP || key == GLFW_KEY_DOWN ||
                       key == GLFW_KEY_HOME || key == GLFW_KEY_TAB || key == GLFW_KEY_PAGE_UP ||
                       key == GLFW_KEY_PAGE_DOWN;
    if (moves && (ImGui::GetIO().WantTextInput || app.panel_focused)) return;
    // Esc in a field of the panel ends the input, and nothing else.
    if (key == GLFW_KEY_ESCAPE && ImGui::GetIO().WantTextInput) return;
    if (const auto command = command_of(Key{key, modifiers & control})) app.guarded([&] { app.ask(*command); });
  };
  events.button = [&app, drag](int button, bool down, int, double x, double y) {
    const bool left = button == GLFW_MOUSE_BUTTON_LEFT;
    if (drag->down && button != drag->button) return;  // one drag at a time
    if (down) {
      *drag = {takes_mouse(app, x, y), false, false, button, x, y};
      if (drag->down && left) app.guarded([&] { drag->edits = app.press(x, y); });
      return;
    }
    app.guarded([&] {
      if (drag->edits)
        app.release();
      else if (drag->down && !drag->moved && left)
        app.select_at(x, y);
    });
    drag->down = drag->edits = false;
  };
  events.move = [&app, drag](double x, double y) {
    if (!drag->down) {
      if (!ImGui::GetIO().WantCaptureMouse) app.guarded([&] { app.hover(x, y); });
      return;
    }
    if (drag->edits) {
      app.guarded([&] { app.drag_to(x, y); });
      return;
    }
    if (!drag->moved && std::hypot(x - drag->x, y - drag->y) < click_reach * app.view.scale) return;
    drag->moved = true;
    app.view.camera.pan(x - drag->x, y - drag->y);
    drag->x = x;
    drag->y = y;
  };
  events.scroll = [&app](double dx, double dy, int modifiers, double x, double y) {
    if (!takes_mouse(app, x, y)) return;
    // A wheel makes whole steps; two fingers make fractions where the system tells them apart, and move sideways.
    const bool fingers = !is_whole(dy) || dx != 0;
    if ((modifiers & control) == 0 && (fingers || (modifiers & shift) != 0)) {
      const double step = fingers && !(is_whole(dx) && is_whole(dy)) ? 12 : 40;
      if ((modifiers & shift) != 0 && dx == 0) std::swap(dx, dy);
      app.view.camera.pan(dx * step * app.view.scale, dy * step * app.view.scale);
    } else {
      app.view.wheel(dy, x + 0.5, y + 0.5);  // the middle of the pixel
    }
    app.guarded([&] { app.hover(x, y); });
  };
  return events;
}

}  // namespace cadt::viewer
