// SPDX-License-Identifier: MIT
#pragma once
// Where widgets were drawn, by name ("bloom.intensity", "stack/bloom", "bar/undo"): for what points at them or moves
// the mouse there, tests and tutorials. Nobody asks: nothing is noted.

#include <imgui.h>

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace darkroom::panels {

struct WidgetPlace {
    ImVec2 least, most;  ///< corners, in the units of ImGui's mouse
    [[nodiscard]] ImVec2 center() const { return {(least.x + most.x) / 2, (least.y + most.y) / 2}; }
};
using WidgetPlaces = std::map<std::string, WidgetPlace, std::less<>>;

}  // namespace darkroom::panels
