// SPDX-License-Identifier: MIT
#pragma once
// The GLSL files of shaders/, which the build puts into the program. A line `#include "name.glsl"` is replaced by that
// file, once a shader; error messages then name the file that the line is in.

#include <string>
#include <string_view>

namespace darkroom::render {

/// The whole shader: version line, `#line` directives, included files. The name must be that of a file in shaders/.
[[nodiscard]] std::string shader_text(std::string_view name);

}  // namespace darkroom::render
