// SPDX-License-Identifier: MIT
#pragma once
// How the panels look: neutral dark greys, so that nothing beside a picture tints the eye that judges it, and one
// accent for what is selected, changed or wrong. Any window of a host's own that uses ImGui's style fits in.

#include <imgui.h>

namespace darkroom::panels {

/// 18 % grey, sRGB-encoded: what a picture should be surrounded by.
inline const ImVec4 surround_color{0.461f, 0.461f, 0.461f, 1.0f};
inline const ImVec4 accent_color{0.878f, 0.592f, 0.251f, 1.0f};
inline const ImVec4 error_color{0.886f, 0.357f, 0.298f, 1.0f};

/// Sets style, colours and font of the present ImGui context; before the font atlas is built, and outside of a frame.
/// `scale`: pixels of the display to one of 96 dpi, in (0, 8]. The font is DejaVu Sans at 15 pixels times `scale`,
/// where it is installed, else ImGui's own.
void apply_theme(float scale);

}  // namespace darkroom::panels
