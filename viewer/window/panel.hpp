// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace cadt::viewer {

class App;

/// The panel at the right: what is shown, how it came about, what is under the cursor.
void draw_panel(App& app);

/// Its part for the growing mesh and for points that are edited.
void draw_tools(App& app);
/// A title that opens and closes what is below.
[[nodiscard]] bool section(const char* name, bool open);
/// Two columns, until ImGui::EndTable(); false: nothing to fill.
[[nodiscard]] bool begin_rows(const char* name, float scale);
void row(const std::string& name, const std::string& value);
/// A name, with what follows beside it.
void begin_field(const App& app, const char* name);

}  // namespace cadt::viewer
