// SPDX-License-Identifier: Apache-2.0
// Fonts and colours of the panel.
#pragma once

struct ImFont;

namespace cadt::viewer {

/// A font of the system in this size, or ImGui's own where none is known.
void load_fonts(double scale);
void set_colours(bool dark, double scale);
/// For titles: bold where the system has it.
[[nodiscard]] ImFont* title_font();

}  // namespace cadt::viewer
