// SPDX-License-Identifier: Apache-2.0
// From keys, mouse and touchpad to commands.
#pragma once

#include "viewer/window/window.hpp"

namespace cadt::viewer {

class App;

/// What the window calls, for this viewer.
[[nodiscard]] Events events_for(App& app);

}  // namespace cadt::viewer
