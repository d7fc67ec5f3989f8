// SPDX-License-Identifier: MIT
#pragma once
// Small pictures for buttons, drawn of lines, so that they are there whatever the font has.

#include <cstdint>

namespace darkroom::panels {

enum class Icon : std::uint8_t { Shown, Hidden, Duplicate, Remove, Undo, Redo, Save, SaveAs, Reset, Up };

/// A square button as high as a frame, without a background until the mouse is over it. `tooltip` may be null.
bool icon_button(const char* id, Icon icon, const char* tooltip, bool is_dim = false);

/// Has the mouse stayed over the last item for a moment? What it explains must not cover what one works at.
bool is_rested_on();
/// Shows `text` beside the mouse while it rests on the last item, wrapped at a readable width. Also over disabled
/// items.
void tooltip(const char* text);

}  // namespace darkroom::panels
