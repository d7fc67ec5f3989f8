// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "gpu/shader/glsl_compiler.hpp"

namespace darkroom::gpu {

std::string glsl_compiler_version() { return {}; }

Result<std::vector<std::uint32_t>> compile_glsl(const ShaderSource& source) {
    return user_error(fmt::format("{}: this library was built without a compiler of GLSL", source.name));
}

}  // namespace darkroom::gpu
