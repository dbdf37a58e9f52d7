// SPDX-License-Identifier: Apache-2.0
// The mesh in the window, and what is marked on it.
#include "viewer/draw/palette.hpp"
#include "viewer/window/app.hpp"
#include "viewer/window/cards.hpp"
#include "viewer/window/look.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace cadt::viewer {
namespace {

struct Ink {
  ImU32 strong, weak, halo, text;
};

Ink ink_for(bool dark) {
  return dark ? Ink{IM_COL32(255, 196, 92, 255), IM_COL32(255, 196, 92, 120), IM_COL32(12, 14, 18, 190),
                    IM_COL32(255, 240, 214, 255)}
              : Ink{IM_COL32(176, 52, 20, 255), IM_COL32(176, 52, 20, 110), IM_COL32(255, 255, 252, 205),
                    IM_COL32(40, 24, 16, 255)};
}

ImVec2 at(const Camera& camera, const Place& place) {
  const Place p = camera.pixel(place[0], place[1]);
  const auto limited = [](double v) { return static_cast<float>(std::clamp(v, -1e6, 1e6)); };
  return {limited(p[0]), limited(p[1])};
}

class Marks {
 public:
  Marks(ImDrawList& list, const App& app)
      : list_(list), app_(app), ink_(ink_for(app.view.dark)), scale_(static_cast<float>(app.view.scale)) {}

  /// Size of a triangle on the screen.
  [[nodiscard]] float size_of(const TriangleFacts& t) const {
    const ImVec2 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    return std::max({a.x, b.x, c.x, a.y, b.y, c.y}) == 1e6f
               ? 1e6f
               : std::max(std::max({a.x, b.x, c.x}) - std::min({a.x, b.x, c.x}),
                          std::max({a.y, b.y, c.y}) - std::min({a.y, b.y, c.y}));
  }

  void triangle(const TriangleFacts& t, bool strong) {
    const ImVec2 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    if (strong) list_.AddTriangleFilled(a, b, c, ink_.weak);
    list_.AddTriangle(a, b, c, ink_.strong, (strong ? 2.5f : 1.6f) * scale_);
    if (size_of(t) < 5 * scale_)
      list_.AddCircle({(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3}, 9 * scale_, ink_.strong, 0, 2 * scale_);
    if (t.circle && size_of(t) > 12 * scale_) circle(*t.circle, strong);
  }

  void neighbours(const TriangleFacts& t, bool labels) {
    if (!t.neighbours) return;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t n = (*t.neighbours)[k];
      if (n < 0) continue;
      const auto all = app_.loaded->triangles();
      std::array<ImVec2, 3> p;
      for (std::size_t j = 0; j < 3; ++j) {
        const auto v = static_cast<std::size_t>(all[3 * static_cast<std::size_t>(n) + j]);
        p[j] = at(app_.view.camera, {app_.loaded->points.xy[2 * v], app_.loaded->points.xy[2 * v + 1]});
      }
      list_.AddTriangle(p[0], p[1], p[2], ink_.weak, 1.6f * scale_);
      const float wide = std::max({p[0].x, p[1].x, p[2].x}) - std::min({p[0].x, p[1].x, p[2].x});
      if (labels && wide > 46 * scale_)
        label({(p[0].x + p[1].x + p[2].x) / 3, (p[0].y + p[1].y + p[2].y) / 3}, fmt::format("{}", n), true);
    }
  }

  void names(const TriangleFacts& t) {
    if (size_of(t) < 56 * scale_) return;
    ImVec2 middle{0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      middle.x += corner(t, k).x / 3;
      middle.y += corner(t, k).y / 3;
    }
    label(middle, fmt::format("{}", t.index), true);
    for (std::size_t k = 0; k < 3; ++k) {
      const ImVec2 p = corner(t, k);
      const float dx = p.x - middle.x, dy = p.y - middle.y, length = std::max(1.0f, std::hypot(dx, dy));
      list_.AddCircleFilled(p, 3.5f * scale_, ink_.strong);
      label({p.x + dx / length * 18 * scale_, p.y + dy / length * 14 * scale_}, fmt::format("p {}", t.points[k]), true);
    }
  }

  void point(const Place& place, std::size_t index) {
    const ImVec2 p = at(app_.view.camera, place);
    list_.AddCircle(p, 8 * scale_, ink_.halo, 0, 5 * scale_);
    list_.AddCircle(p, 8 * scale_, ink_.strong, 0, 2.5f * scale_);
    label({p.x + 14 * scale_, p.y - 14 * scale_}, fmt::format("p {}", index), false);
  }

 private:
  [[nodiscard]] ImVec2 corner(const TriangleFacts& t, std::size_t k) const {
    return at(app_.view.camera, t.corners[k]);
  }

  void circle(const Circle& c, bool strong) {
    const auto arc = visible_arc(c, app_.view.camera);
    std::vector<ImVec2> line;
    line.reserve(arc.size());
    for (const auto& p : arc) line.push_back({p[0], p[1]});
    list_.AddPolyline(line.data(), static_cast<int>(line.size()), strong ? ink_.strong : ink_.weak, 0, 1.6f * scale_);
  }

  void label(ImVec2 p, const std::string& text, bool centred) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    if (centred) p = {p.x - 0.5f * size.x, p.y - 0.5f * size.y};
    p = {std::floor(p.x), std::floor(p.y)};
    const float pad = 3 * scale_;
    list_.AddRectFilled({p.x - pad, p.y - 1}, {p.x + size.x + pad, p.y + size.y + 1}, ink_.halo, 4 * scale_);
    list_.AddText(p, ink_.text, text.c_str());
  }

  ImDrawList& list_;
  const App& app_;
  Ink ink_;
  float scale_;
};

}  // namespace

void draw_picture(App& app) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 size(static_cast<float>(app.view.camera.width()), static_cast<float>(app.view.camera.height()));
  if (app.scene == nullptr || app.loaded == nullptr) return;
  list.PushClipRect({0, 0}, size);
  if (app.scene->mesh.point_count != 0) {
    list.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(app.scene->renderer.texture().id())),
                  {0, 0}, size);
    Marks marks(list, app);
    if (app.hovered && app.view.inspect && (!app.selected || app.hovered->index != app.selected->index)) {
      marks.neighbours(*app.hovered, false);
      marks.triangle(*app.hovered, false);
    }
    if (app.selected) {
      marks.neighbours(*app.selected, true);
      marks.triangle(*app.selected, true);
      marks.names(*app.selected);
    }
    const ImVec2 mouse = ImGui::GetMousePos();
    if (app.editing != nullptr && app.editing->tool != Tool::drag && app.over_mesh(mouse.x, mouse.y))
      list.AddCircle(mouse, app.editing->brush * static_cast<float>(app.view.scale), ink_for(app.view.dark).strong, 0,
                     1.6f);
    if (app.selected_place) marks.point(*app.selected_place, *app.selection.point);
  }
  list.PopClipRect();
}

}  // namespace cadt::viewer
