// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cadt::viewer {

class App;

/// The mesh, and what is marked on it.
void draw_picture(App& app);
/// The growing mesh: step, play, slow motion, back, and its counters.
void draw_timeline(App& app);
/// A card whose place of the mesh's picture (0 to 1) is the same place of it; 0: as wide as what is in it.
void begin_card(App& app, const char* name, float x, float y, float width, bool inputs = true);
void end_card();

/// What lies over it for a while: progress, messages, search, help.
void draw_cards(App& app);

}  // namespace cadt::viewer
