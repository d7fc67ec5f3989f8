// SPDX-License-Identifier: MIT
#pragma once
// What stands between the library and the compiler of GLSL: engine/glsl has it in two forms, by shaderc and without
// any, of which one is linked (DARKROOM_COMPILER).

#include <cstdint>
#include <darkroom/result.hpp>
#include <string>
#include <vector>

#include "gpu/shader/shader.hpp"

namespace darkroom::gpu {

/// Its version and options: what was made by another is not what it makes. Empty: there is no compiler.
[[nodiscard]] std::string glsl_compiler_version();
/// Error text: "file:line: message" of the first error.
[[nodiscard]] Result<std::vector<std::uint32_t>> compile_glsl(const ShaderSource& source);

}  // namespace darkroom::gpu
