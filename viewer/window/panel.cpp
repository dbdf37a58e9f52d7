// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/panel.hpp"

#include "viewer/draw/palette.hpp"
#include "viewer/window/app.hpp"
#include "viewer/window/look.hpp"

#include <cadt/devices.hpp>

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace cadt::viewer {
namespace {

float scale_of(const App& app) { return static_cast<float>(app.view.scale); }

/// A field whose value is one of a list; true: another one was chosen.
template <class Names>
bool choice(const App& app, const char* name, std::size_t& chosen, const Names& names) {
  begin_field(app, name);
  bool changed = false;
  if (ImGui::BeginCombo((std::string("##") + name).c_str(), std::string(names[chosen]).c_str())) {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (ImGui::Selectable(std::string(names[i]).c_str(), i == chosen) && i != chosen) {
        chosen = i;
        changed = true;
      }
    ImGui::EndCombo();
  }
  return changed;
}

void draw_file(App& app) {
  const Source& source = app.options.sources[app.current];
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted(source.name().c_str());
  ImGui::PopFont();
  if (app.options.sources.size() > 1) {
    if (ImGui::ArrowButton("##previous", ImGuiDir_Left)) app.ask(Command::previous_file);
    ImGui::SameLine();
    if (ImGui::ArrowButton("##next", ImGuiDir_Right)) app.ask(Command::next_file);
    ImGui::SameLine();
    ImGui::TextDisabled("%zu of %zu", app.current + 1, app.options.sources.size());
    std::vector<std::string> names;
    for (const Source& s : app.options.sources) names.push_back(s.name());
    std::size_t which = app.current;
    if (choice(app, "show", which, names)) app.show_source(which);
  }
  if (app.loaded == nullptr || app.scene == nullptr) return;
  if (app.shown != app.current)
    ImGui::TextDisabled("the picture shows %s", app.options.sources[app.shown].name().c_str());
  const MeshBuffers& mesh = app.scene->mesh;
  ImGui::Text("%s points, %s triangles", number_text(mesh.point_count).c_str(),
              number_text(mesh.triangle_count).c_str());
  if (mesh.edge_count != 0) ImGui::Text("%s constrained edges", number_text(mesh.edge_count).c_str());
}

void draw_generated(App& app) {
  if (!section("Other points", false)) return;
  static std::size_t which = 0;
  static std::array<char, 32> n{"100000"};
  static std::string problem;
  std::vector<std::string> names;
  for (const auto& d : io::distributions()) names.emplace_back(d.name);
  bool build = choice(app, "distribution", which, names);
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", std::string(io::distributions()[which].description).c_str());
  ImGui::PopTextWrapPos();
  begin_field(app, "points");
  build = ImGui::InputText("##n", n.data(), n.size(), ImGuiInputTextFlags_EnterReturnsTrue) || build;
  build = ImGui::Button("Make and triangulate") || build;
  if (!problem.empty()) ImGui::TextWrapped("%s", problem.c_str());
  if (!build) return;
  try {
    problem.clear();
    Source source;
    source.distribution = names[which];
    source.generate.n = parse_number(n.data());
    // The one that was made last is replaced; files stay.
    if (!app.options.sources[app.current].is_file()) {
      app.options.sources[app.current] = source;
      app.restart();
    } else {
      app.add_source(source);
    }
  } catch (const std::invalid_argument& e) {
    problem = e.what();
  }
}

/// The ramp with the values of its ends.
void draw_ramp(App& app) {
  if (app.view.colour == ColourBy::nothing || app.view.colour == ColourBy::region) return;
  if (app.scene == nullptr || app.scene->mesh.triangle_count == 0) return;
  const io::picture::Ramp& ramp = ramp_for(app.view.colour);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float wide = ImGui::GetContentRegionAvail().x, high = 10 * scale_of(app);
  constexpr int parts = 48;
  for (int i = 0; i < parts; ++i) {
    const std::uint32_t c = io::picture::to_srgb(ramp((static_cast<float>(i) + 0.5f) / parts));
    ImGui::GetWindowDrawList()->AddRectFilled({at.x + wide * static_cast<float>(i) / parts, at.y},
                                              {at.x + wide * static_cast<float>(i + 1) / parts, at.y + high},
                                              IM_COL32((c >> 16) & 255, (c >> 8) & 255, c & 255, 255));
  }
  ImGui::Dummy({wide, high});
  const auto ends = app.scene->renderer.ramp_ends();
  const auto text = [&](float v) {
    if (app.view.colour == ColourBy::angle) return fmt::format("{:.0f} degrees", v);
    if (app.view.colour == ColourBy::height)
      return fmt::format("{:.4g}",
                         app.height_ends[0] + static_cast<double>(v) * (app.height_ends[1] - app.height_ends[0]));
    if (app.view.colour != ColourBy::area) return fmt::format("{:.6g}", v);
    return fmt::format("{:.3g}", std::exp2(static_cast<double>(v)) / app.scene->renderer.area_of_unit());
  };
  const std::string low = text(ends[0]), high_text = text(ends[1]);
  ImGui::TextDisabled("%s", low.c_str());
  ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + wide - ImGui::CalcTextSize(high_text.c_str()).x);
  ImGui::TextDisabled("%s", high_text.c_str());
}

std::string words_for(ColourBy by) {
  switch (by) {
    case ColourBy::nothing:
      return "one colour";
    case ColourBy::angle:
      return "smallest angle";
    case ColourBy::area:
      return "area";
    case ColourBy::order:
      return "order along the curve";
    case ColourBy::height:
      return "height";
    case ColourBy::degree:
      return "degree";
    case ColourBy::level:
      return "insertion level";
    case ColourBy::conflicts:
      return "lost locks";
    case ColourBy::flips:
      return "flips";
    case ColourBy::region:
      return "region";
  }
  return "";
}

void draw_drawing(App& app) {
  if (!section("Drawing", true)) return;
  ViewState& view = app.view;
  for (const auto& [drawing, command, name] : {std::tuple{Drawing::points, Command::points, "Points"},
                                               std::tuple{Drawing::wireframe, Command::wireframe, "Wireframe"},
                                               std::tuple{Drawing::filled, Command::filled, "Filled"}}) {
    if (drawing != Drawing::points) ImGui::SameLine();
    if (ImGui::RadioButton(name, view.drawing == drawing)) app.ask(command);
  }
  std::vector<std::string> names;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < view.colours.size(); ++i) {
    names.push_back(words_for(view.colours[i]));
    if (view.colours[i] == view.colour) chosen = i;
  }
  if (choice(app, "colour by", chosen, names)) app.choose_colour(view.colours[chosen]);
  draw_ramp(app);
  const auto box = [&](const char* name, bool value, Command command) {
    if (ImGui::Checkbox(name, &value)) app.ask(command);
  };
  const float second = 150 * scale_of(app);
  box("Hull", view.hull, Command::hull);
  ImGui::SameLine(second);
  box("Voronoi cells", view.voronoi, Command::voronoi);
  box("Circumcircle", view.inspect, Command::inspect);
  ImGui::SameLine(second);
  box("Dark", view.dark, Command::dark);
  if (view.voronoi && !app.voronoi_note.empty()) ImGui::TextDisabled("%s", app.voronoi_note.c_str());
}

/// Devices of the back end that is chosen, found once: drivers take their time.
const std::vector<DeviceInfo>& devices() {
  static const std::vector<DeviceInfo> all = list_devices();
  return all;
}

void draw_device(App& app) {
  if (!section("Triangulation", true)) return;
  Options& o = app.options.compute;
  bool changed = false;
  constexpr std::array backends{Backend::automatic, Backend::host, Backend::opencl, Backend::cuda};
  constexpr std::array<std::string_view, 4> backend_names{"automatic", "host", "OpenCL", "CUDA"};
  auto at = static_cast<std::size_t>(std::find(backends.begin(), backends.end(), o.backend) - backends.begin());
  if (choice(app, "back end", at, backend_names)) {
    o.backend = backends[at];
    o.device.clear();
    changed = true;
  }
  if (o.backend != Backend::automatic) {
    std::vector<std::string> names{"the first usable"}, numbers{""};
    std::size_t chosen = 0;
    for (const DeviceInfo& d : devices()) {
      if (d.backend != o.backend || !d.usable || d.index < 0) continue;
      names.push_back(d.name);
      numbers.push_back(std::to_string(d.index));
      if (o.device == numbers.back() || (!o.device.empty() && d.name.find(o.device) != std::string::npos))
        chosen = names.size() - 1;
    }
    if (choice(app, "device", chosen, names)) {
      o.device = numbers[chosen];
      changed = true;
    }
  }
  constexpr std::array<std::string_view, 3> strategies{"automatic", "insertion with locks", "local stars"};
  auto strategy = static_cast<std::size_t>(o.tuning.strategy);
  if (choice(app, "strategy", strategy, strategies)) {
    o.tuning.strategy = static_cast<Strategy>(strategy);
    if (o.tuning.strategy == Strategy::stars) o.tuning.stabilize = Stabilize::off;
    changed = true;
  }
  constexpr std::array<std::string_view, 3> modes{"off", "defer", "as in the paper"};
  auto mode = static_cast<std::size_t>(o.tuning.stabilize);
  if (choice(app, "stabilisation", mode, modes)) {
    o.tuning.stabilize = static_cast<Stabilize>(mode);
    if (o.tuning.stabilize != Stabilize::off && o.tuning.strategy == Strategy::stars)
      o.tuning.strategy = Strategy::automatic;
    changed = true;
  }
  if (o.tuning.stabilize != Stabilize::off) {
    int flips = static_cast<int>(o.tuning.flip_threshold);
    begin_field(app, "R (flips)");
    if (ImGui::InputInt("##R", &flips, 1, 10))
      o.tuning.flip_threshold = static_cast<unsigned>(std::clamp(flips, 0, 1000));
    changed = ImGui::IsItemDeactivatedAfterEdit() || changed;
  }
  if (o.tuning.stabilize == Stabilize::paper) {
    begin_field(app, "epsilon");
    double epsilon = o.tuning.quality_epsilon;
    if (ImGui::InputDouble("##epsilon", &epsilon, 0, 0, "%g") && epsilon >= 0) o.tuning.quality_epsilon = epsilon;
    changed = ImGui::IsItemDeactivatedAfterEdit() || changed;
  }
  if (ImGui::Button("Triangulate again (R)") || changed) app.restart();
  if (app.loaded != nullptr && begin_rows("##device", scale_of(app))) {
    row("computed by", app.loaded->device.name.empty() ? app.loaded->statistics.device : app.loaded->device.name);
    row("display", app.window->driver().renderer);
    row("mesh came by", app.way_text() + (app.interop_reason.empty() ? "" : ": " + app.interop_reason));
    row("through the host", human_bytes(app.scene->mesh.bytes_through_host));
    row("picture", fmt::format("{:.1f} ms", app.picture_milliseconds));
    ImGui::EndTable();
  }
}

void draw_statistics(App& app) {
  if (app.loaded == nullptr) return;
  const Statistics& s = app.loaded->statistics;
  if (section("Times", true) && begin_rows("##times", scale_of(app))) {
    row(app.loaded->source.is_file() ? "read" : "made", fmt::format("{:.1f} ms", app.loaded->read_milliseconds));
    for (const auto& [phase, ms] : s.milliseconds) row(phase, fmt::format("{:.2f} ms", ms));
    row("triangulated", fmt::format("{:.1f} ms", app.triangulate_milliseconds));
    ImGui::EndTable();
  }
  if (section("Work and conflicts", false) && begin_rows("##work", scale_of(app))) {
    row("splits", number_text(s.splits + s.edge_splits));
    row("flips", number_text(s.flips));
    row("lost locks", fmt::format("{} of {}", number_text(s.lock_failures), number_text(s.lock_attempts)));
    row("restarts", number_text(s.invalid_restarts));
    row("retries", number_text(s.insert_retries));
    row("deferred points", number_text(s.deferred_points));
    row("deferred edges", number_text(s.deferred_edges));
    row("illegal edges", number_text(s.illegal_edges));
    row("segments inserted", number_text(s.inserted_segments));
    row("stars, no locks", number_text(s.proven_stars + s.wrapped_stars));
    row("exact predicates", number_text(s.exact_orientations + s.exact_incircles));
    row("ties", number_text(s.ties));
    row("certified", s.certified ? "yes" : "no");
    row("peak memory", human_bytes(s.bytes_device_peak));
    row("to, from device", human_bytes(s.bytes_to_device) + ", " + human_bytes(s.bytes_from_device));
    ImGui::EndTable();
  }
}

void draw_facts(App& app) {
  const bool chosen = app.selected.has_value();
  if (!section(chosen ? "Selected###facts" : "Under the cursor###facts", true)) return;
  const auto& facts = chosen ? app.selected : app.hovered;
  if (app.selected_place && begin_rows("##point", scale_of(app))) {
    row(fmt::format("point {}", *app.selection.point), text_of(*app.selected_place));
    ImGui::EndTable();
  }
  if (facts) {
    if (begin_rows("##facts", scale_of(app))) {
      for (const auto& [name, value] : lines_of(*facts)) row(name, value);
      ImGui::EndTable();
    }
  } else if (!app.selected_place) {
    ImGui::TextDisabled("Point at a triangle; click to select it.");
  }
}

}  // namespace

bool begin_rows(const char* name, float scale) {
  if (!ImGui::BeginTable(name, 2, ImGuiTableFlags_SizingStretchProp)) return false;
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 112 * scale);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
  return true;
}

void row(const std::string& name, const std::string& value) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", name.c_str());
  ImGui::TableNextColumn();
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(value.c_str());
  ImGui::PopTextWrapPos();
}

bool section(const char* name, bool open) {
  ImGui::Spacing();
  return ImGui::CollapsingHeader(name, open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
}

void begin_field(const App& app, const char* name) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", name);
  ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + 112 * static_cast<float>(app.view.scale));
  ImGui::SetNextItemWidth(-1);
}

void draw_panel(App& app) {
  const auto [width, height] = app.window->size();
  ImGui::SetNextWindowPos({static_cast<float>(width - app.panel_width), 0});
  ImGui::SetNextWindowSize({static_cast<float>(app.panel_width), static_cast<float>(height)});
  if (app.panel_focused)
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  else
    ImGui::GetIO().ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
  ImGui::Begin("panel", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  static bool was_focused = false;
  if (app.panel_focused && !was_focused) ImGui::SetWindowFocus();
  was_focused = app.panel_focused;
  draw_file(app);
  draw_drawing(app);
  draw_facts(app);
  draw_tools(app);
  draw_device(app);
  draw_statistics(app);
  draw_generated(app);
  ImGui::Spacing();
  ImGui::TextDisabled("? shows all keys");
  ImGui::End();
}

}  // namespace cadt::viewer
