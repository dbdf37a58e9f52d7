// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cadt::viewer {

class App;

/// The mesh, and what is marked on it.
void draw_picture(App& app);
/// What lies over it for a while: progress, messages, search, help.
void draw_cards(App& app);

}  // namespace cadt::viewer
