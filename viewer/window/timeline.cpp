// SPDX-License-Identifier: Apache-2.0
// The card of the growing mesh.
#include "viewer/window/app.hpp"
#include "viewer/window/cards.hpp"
#include "viewer/window/look.hpp"

#include <fmt/format.h>
#include <imgui.h>

namespace cadt::viewer {
namespace {

void counter(const char* name, const std::string& value) {
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", name);
  ImGui::TextUnformatted(value.c_str());
}

}  // namespace

void draw_timeline(App& app) {
  Growing& g = *app.growing;
  const Recording& r = *g.recording;
  const float scale = static_cast<float>(app.view.scale);
  const std::size_t frame = *g.shown;
  const GrowthCounters& c = r.counters(frame);
  begin_card(app, "##timeline", 0.5f, 1.0f, 700);
  ImGui::PushFont(title_font());
  ImGui::Text("%s of %s points, level %u", number_text(c.points).c_str(),
              number_text(app.scene->mesh.point_count).c_str(), c.level);
  ImGui::PopFont();
  ImGui::SameLine();
  ImGui::TextDisabled("%s", c.complete ? "complete" : "");
  if (ImGui::BeginTable("##counters", 7, ImGuiTableFlags_SizingStretchSame)) {
    counter("triangles", number_text(c.triangles));
    counter("flips", number_text(c.flips));
    counter("lost locks", number_text(c.lost_locks));
    counter("deferred", number_text(c.deferred_points));
    counter("waiting points", number_text(c.waiting_points));
    counter("waiting edges", number_text(c.waiting_edges));
    counter("illegal edges", g.illegal_edges[frame] ? number_text(*g.illegal_edges[frame]) : c.complete ? "0" : "...");
    ImGui::EndTable();
  }
  int shown = static_cast<int>(frame);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderInt("##snapshot", &shown, 0, static_cast<int>(r.size()) - 1,
                       fmt::format("snapshot {} of {}", frame + 1, r.size()).c_str()))
    app.guarded([&] { app.show_snapshot(static_cast<std::size_t>(shown)); });
  const auto button = [&](const char* text, Command command) {
    if (ImGui::Button(text, {72 * scale, 0})) app.guarded([&] { app.ask(command); });
    ImGui::SameLine();
  };
  button("Back ,", Command::back);
  button(g.playback.playing() ? "Pause" : "Play", Command::play);
  button("Step .", Command::step);
  if (ImGui::Button("Play back", {84 * scale, 0})) g.playback.play(-g.speed);
  ImGui::SameLine();
  button("Slower <", Command::slower);
  button("Faster >", Command::faster);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s a second", fmt::format("{:g}", g.speed).c_str());
  ImGui::SameLine();
  const float end = 60 * scale;
  ImGui::SetCursorPosX(ImGui::GetWindowWidth() - end - ImGui::GetStyle().WindowPadding.x);
  const bool close = ImGui::Button("End", {end, 0});
  end_card();
  if (close) app.guarded([&] { app.ask(Command::grow); });
}

}  // namespace cadt::viewer
