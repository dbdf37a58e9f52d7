// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/look.hpp"

#include <imgui.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

namespace cadt::viewer {
namespace {

constexpr float text_size = 15;

ImFont* bold = nullptr;

struct Face {
  const char *plain, *bold;
};
constexpr std::array faces{
    Face{"/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf", "/usr/share/fonts/truetype/noto/NotoSans-Bold.ttf"},
    Face{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"},
    Face{"/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans-Bold.ttf"},
    Face{"/usr/share/fonts/TTF/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans-Bold.ttf"},
    Face{"/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
         "/usr/share/fonts/truetype/liberation/LiberationSans-Bold.ttf"},
    Face{"/System/Library/Fonts/Supplemental/Arial.ttf", "/System/Library/Fonts/Supplemental/Arial Bold.ttf"},
    Face{"C:/Windows/Fonts/segoeui.ttf", "C:/Windows/Fonts/segoeuib.ttf"},
};

ImVec4 colour(std::uint32_t rgb, float alpha = 1) {
  const auto part = [&](int shift) { return static_cast<float>((rgb >> shift) & 255u) / 255.0f; };
  return {part(16), part(8), part(0), alpha};
}

}  // namespace

void load_fonts(double scale) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  bold = nullptr;
  // What file names, numbers and formulas have: Latin, Greek, Cyrillic, punctuation, arrows.
  static const ImWchar ranges[] = {0x20, 0x17f, 0x370, 0x3ff, 0x400, 0x4ff, 0x2000, 0x206f, 0x2190, 0x21ff, 0};
  const float pixels = std::round(text_size * static_cast<float>(scale));
  const auto there = [](const char* path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored);
  };
  for (const Face& face : faces) {
    if (!there(face.plain) || atlas.AddFontFromFileTTF(face.plain, pixels, nullptr, ranges) == nullptr) continue;
    if (there(face.bold)) bold = atlas.AddFontFromFileTTF(face.bold, std::round(1.05f * pixels), nullptr, ranges);
    break;
  }
  if (atlas.Fonts.empty()) {
    ImFontConfig config;
    config.SizePixels = 13 * std::max(1.0f, std::round(static_cast<float>(scale)));
    atlas.AddFontDefault(&config);
  }
}

ImFont* title_font() { return bold != nullptr ? bold : ImGui::GetIO().Fonts->Fonts[0]; }

void set_colours(bool dark, double scale) {
  ImGuiStyle style;
  dark ? ImGui::StyleColorsDark(&style) : ImGui::StyleColorsLight(&style);
  const std::uint32_t paper = dark ? 0x1d2128 : 0xffffff, ink = dark ? 0xe4e9ee : 0x1f2a37,
                      quiet = dark ? 0x939daa : 0x67717e, field = dark ? 0x2a303a : 0xeef1f3,
                      over = dark ? 0x363e4a : 0xe2e8ec, accent = dark ? 0x5aa7c7 : 0x2b7596,
                      rule = dark ? 0x333a45 : 0xdde2e6;
  const auto set = [&](ImGuiCol which, std::uint32_t rgb, float alpha = 1) {
    style.Colors[which] = colour(rgb, alpha);
  };
  set(ImGuiCol_WindowBg, paper, 0.97f);
  set(ImGuiCol_PopupBg, paper, 0.99f);
  set(ImGuiCol_Text, ink);
  set(ImGuiCol_TextDisabled, quiet);
  set(ImGuiCol_Border, rule);
  set(ImGuiCol_Separator, rule);
  set(ImGuiCol_FrameBg, field);
  set(ImGuiCol_FrameBgHovered, over);
  set(ImGuiCol_FrameBgActive, over);
  set(ImGuiCol_Button, field);
  set(ImGuiCol_ButtonHovered, over);
  set(ImGuiCol_ButtonActive, accent, 0.5f);
  set(ImGuiCol_Header, accent, 0.16f);
  set(ImGuiCol_HeaderHovered, accent, 0.24f);
  set(ImGuiCol_HeaderActive, accent, 0.34f);
  set(ImGuiCol_CheckMark, accent);
  set(ImGuiCol_SliderGrab, accent);
  set(ImGuiCol_SliderGrabActive, accent);
  set(ImGuiCol_PlotHistogram, accent);
  set(ImGuiCol_NavHighlight, accent);
  set(ImGuiCol_TextSelectedBg, accent, 0.35f);
  set(ImGuiCol_ScrollbarBg, paper, 0);
  set(ImGuiCol_ScrollbarGrab, dark ? 0x434c59 : 0xc9d1d8);
  set(ImGuiCol_TableRowBgAlt, field, 0.5f);
  style.WindowRounding = 0;
  style.ChildRounding = style.PopupRounding = 8;
  style.FrameRounding = style.GrabRounding = 5;
  style.WindowBorderSize = 1;
  style.FrameBorderSize = 0;
  style.PopupBorderSize = 1;
  style.WindowPadding = {14, 12};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};
  style.ScrollbarSize = 11;
  style.ScrollbarRounding = 6;
  style.CellPadding = {2, 1.5f};
  style.ScaleAllSizes(static_cast<float>(scale));
  style.WindowBorderSize = 1;
  ImGui::GetStyle() = style;
}

}  // namespace cadt::viewer
