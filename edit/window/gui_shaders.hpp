// SPDX-License-Identifier: MIT
#pragma once
// The GLSL of GuiPass, whole: the files of shaders/ with what they share before them.

#include <string>

namespace darkroom::window {

[[nodiscard]] std::string gui_vertex_shader();
/// A texture times a colour.
[[nodiscard]] std::string gui_fragment_shader();
/// A Pane.
[[nodiscard]] std::string pane_fragment_shader();

}  // namespace darkroom::window
