// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cadt::viewer {

class App;

/// The panel at the right: what is shown, how it came about, what is under the cursor.
void draw_panel(App& app);

}  // namespace cadt::viewer
