// SPDX-License-Identifier: Apache-2.0
// What lies over the mesh for a while: progress, messages, search, help.
#include "viewer/window/cards.hpp"

#include "viewer/window/app.hpp"
#include "viewer/window/look.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cadt::viewer {
namespace {

constexpr ImGuiWindowFlags card_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                                        ImGuiWindowFlags_NoNav;

void title(const std::string& text) {
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
}

void draw_progress(App& app, Work& work) {
  const Work::State state = work.state();
  if (state.seconds < 0.2) return;
  begin_card(app, "##progress", 0.5f, app.growing ? 0.8f : 1.0f, 380);
  title(state.stopping ? "Stopping ..." : "Working");
  const std::string text = state.phase + (state.fraction >= 0 ? fmt::format(", {:.0f} %", 100 * state.fraction) : "") +
                           fmt::format(", {:.0f} s", state.seconds);
  ImGui::TextUnformatted(text.c_str());
  const float button = 90 * static_cast<float>(app.view.scale);
  // A bar that runs where the length of the work is not known.
  if (state.fraction >= 0)
    ImGui::ProgressBar(static_cast<float>(state.fraction), {-button - ImGui::GetStyle().ItemSpacing.x, 0}, "");
  else
    ImGui::ProgressBar(static_cast<float>(state.seconds - std::floor(state.seconds)),
                       {-button - ImGui::GetStyle().ItemSpacing.x, 0}, "");
  ImGui::SameLine();
  if (ImGui::Button("Cancel", {button, 0})) work.cancel();
  end_card();
}

void draw_message(App& app) {
  begin_card(app, "##message", 0.5f, 0.4f, 500);
  if (app.message->error)
    ImGui::PushStyleColor(ImGuiCol_Text, app.view.dark ? ImVec4(1.0f, 0.62f, 0.5f, 1) : ImVec4(0.68f, 0.16f, 0.08f, 1));
  title(app.message->title);
  if (app.message->error) ImGui::PopStyleColor();
  ImGui::PushTextWrapPos(0);
  ImGui::Spacing();
  ImGui::TextUnformatted(app.message->text.c_str());
  if (!app.message->advice.empty()) {
    ImGui::Spacing();
    ImGui::TextUnformatted(app.message->advice.c_str());
  }
  ImGui::PopTextWrapPos();
  ImGui::Spacing();
  const bool close = ImGui::Button("Close (Esc)");
  end_card();
  if (close) app.message.reset();
}

void draw_search(App& app) {
  begin_card(app, "##search", 0.5f, 0.06f, 380);
  title("Go to");
  ImGui::TextDisabled("12 or t 12: a triangle.  p 12: a point.  Enter goes there.");
  // Keys come from the window (input.cpp): those that are pressed before a field would be ready are not lost.
  const ImVec2 at = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight());
  const ImGuiStyle& style = ImGui::GetStyle();
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg),
                                            style.FrameRounding);
  ImGui::GetWindowDrawList()->AddText({at.x + style.FramePadding.x, at.y + style.FramePadding.y},
                                      ImGui::GetColorU32(ImGuiCol_Text), (app.search_text + "|").c_str());
  ImGui::Dummy(size);
  end_card();
}

void draw_help(App& app) {
  const float scale = static_cast<float>(app.view.scale), keys = 88 * scale, gap = 30 * scale;
  begin_card(app, "##help", 0.5f, 0.5f, 0);
  title("Keys and mouse");
  std::string_view group;
  int groups = 0;
  const int in_first = static_cast<float>(app.view.camera.width()) > 800 * scale ? 3 : 100;
  ImGui::BeginGroup();
  for (const Binding& b : bindings()) {
    if (b.shown.empty()) continue;
    if (b.group != group) {
      if (++groups == in_first + 1) {  // the second column
        ImGui::EndGroup();
        ImGui::SameLine(0, gap);
        ImGui::BeginGroup();
      }
      group = b.group;
      ImGui::Spacing();
      ImGui::TextDisabled("%s", std::string(group).c_str());
    }
    ImGui::TextUnformatted(b.shown.data(), b.shown.data() + b.shown.size());
    ImGui::SameLine(keys);
    ImGui::TextUnformatted(b.what.data(), b.what.data() + b.what.size());
  }
  ImGui::EndGroup();
  ImGui::Spacing();
  ImGui::TextDisabled("? or Esc closes this");
  end_card();
}

void draw_toast(App& app) {
  begin_card(app, "##toast", 0.0f, app.growing ? 0.8f : 1.0f, 0, false);
  ImGui::TextUnformatted(app.toast.c_str());
  end_card();
}

/// Where there is nothing to see, why.
void draw_hint(App& app) {
  if (app.loaded == nullptr || app.message) return;
  std::string text;
  if (app.scene->mesh.point_count == 0)
    text = "There are no points.";
  else if (app.scene->mesh.triangle_count == 0)
    text = app.scene->mesh.point_count < 3 ? "Fewer than three points have no triangle."
                                           : "There is no triangle: all points lie on one line, or are equal.";
  if (text.empty()) return;
  begin_card(app, "##hint", 0.5f, 0.0f, 0, false);
  ImGui::TextUnformatted(text.c_str());
  end_card();
}

}  // namespace

void begin_card(App& app, const char* name, float x, float y, float width, bool inputs) {
  const float scale = static_cast<float>(app.view.scale), gap = 16 * scale;
  const float w = static_cast<float>(app.view.camera.width()), h = static_cast<float>(app.view.camera.height());
  ImGui::SetNextWindowPos({gap + x * (w - 2 * gap), gap + y * (h - 2 * gap)}, ImGuiCond_Always, {x, y});
  const float wide = std::min(width * scale, w - 2 * gap);
  ImGui::SetNextWindowSizeConstraints({width > 0 ? wide : 0, 0}, {width > 0 ? wide : w - 2 * gap, h - 2 * gap});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 9 * scale);
  ImGui::Begin(name, nullptr, card_flags | (inputs ? ImGuiWindowFlags_None : ImGuiWindowFlags_NoInputs));
  if (!inputs) return;
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  app.cards.push_back({at.x, at.y, at.x + size.x, at.y + size.y});
}

void end_card() {
  ImGui::End();
  ImGui::PopStyleVar();
}

void draw_cards(App& app) {
  app.cards.clear();
  if (app.scene == nullptr) {
    begin_card(app, "##opening", 0.5f, 0.5f, 0);
    ImGui::TextUnformatted("Opening the display ...");
    end_card();
    return;
  }
  draw_hint(app);
  if (app.growing) draw_timeline(app);
  if (app.toast_shown()) draw_toast(app);
  if (app.loading.running())
    draw_progress(app, app.loading);
  else if (app.asking.running())
    draw_progress(app, app.asking);
  if (app.message) draw_message(app);
  if (app.search_shown) draw_search(app);
  if (app.help_shown) draw_help(app);
}

}  // namespace cadt::viewer
