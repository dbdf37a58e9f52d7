// SPDX-License-Identifier: Apache-2.0
// The part of the panel for what changes the mesh.
#include "viewer/window/app.hpp"
#include "viewer/window/panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

namespace cadt::viewer {
namespace {

void draw_editing(App& app) {
  Editing& e = *app.editing;
  for (const auto& [tool, name] :
       {std::pair{Tool::drag, "Drag"}, std::pair{Tool::paint, "Paint"}, std::pair{Tool::erase, "Erase"}}) {
    if (tool != Tool::drag) ImGui::SameLine();
    if (ImGui::RadioButton(name, e.tool == tool)) app.choose_tool(tool);
  }
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", e.tool == Tool::drag ? "Drag a point. The right button moves the view."
                                                 : "Press and move. The right button moves the view.");
  ImGui::PopTextWrapPos();
  if (e.tool != Tool::drag) {
    begin_field(app, "brush");
    ImGui::SliderFloat("##brush", &e.brush, 5, 200, "%.0f pixels");
  }
  if (e.tool == Tool::paint) {
    begin_field(app, "points a dab");
    ImGui::SliderInt("##amount", &e.amount, 1, 1000, "%d", ImGuiSliderFlags_Logarithmic);
  }
  begin_field(app, "motion");
  if (ImGui::BeginCombo("##motion", std::string(to_string(e.motion)).c_str())) {
    for (std::size_t i = 0; i < names_of_motions().size(); ++i)
      if (ImGui::Selectable(names_of_motions()[i].c_str(), static_cast<Motion>(i) == e.motion))
        e.motion = static_cast<Motion>(i);
    ImGui::EndCombo();
  }
  if (ImGui::Button(e.moving ? "Stop the points (M)" : "Let all points move (M)"))
    app.guarded([&] { app.ask(Command::move_points); });
  if (begin_rows("##live", static_cast<float>(app.view.scale))) {
    row("mesh", fmt::format("{:.1f} ms", e.mesh_milliseconds));
    row("picture", fmt::format("{:.1f} ms", app.picture_milliseconds));
    if (e.moving && e.frame_milliseconds > 0)
      row("frame", fmt::format("{:.1f} ms, {:.0f} a second", e.frame_milliseconds, 1000 / e.frame_milliseconds));
    ImGui::EndTable();
  }
}

}  // namespace

void draw_tools(App& app) {
  if (app.loaded == nullptr || !section("Grow and edit", true)) return;
  const float wide = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  if (ImGui::Button(app.growing ? "End of growth (G)" : "Watch it grow (G)", {wide, 0}))
    app.guarded([&] { app.ask(Command::grow); });
  ImGui::SameLine();
  if (ImGui::Button(app.editing != nullptr ? "End of editing (E)" : "Edit points (E)", {wide, 0}))
    app.guarded([&] { app.ask(Command::edit); });
  if (app.editing != nullptr) draw_editing(app);
}

}  // namespace cadt::viewer
