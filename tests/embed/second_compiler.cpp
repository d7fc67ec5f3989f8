// SPDX-License-Identifier: MIT
// A host's own GLSL compiler, which works before Darkroom is used and after.

#include <cstdio>
#include <cstdlib>
#include <shaderc/shaderc.hpp>

namespace {

void compile() {
    const shaderc::Compiler compiler;
    const auto result = compiler.CompileGlslToSpv(
        "#version 450\nlayout(local_size_x = 8) in;\nlayout(set = 0, binding = 0, r32f) uniform writeonly image2D to;\n"
        "void main() { imageStore(to, ivec2(gl_GlobalInvocationID.xy), vec4(1)); }\n",
        shaderc_compute_shader, "host");
    if (result.GetCompilationStatus() != shaderc_compilation_status_success) {
        std::printf("the host's compiler: %s\n", result.GetErrorMessage().c_str());
        std::_Exit(1);
    }
    std::printf("the host's compiler: %td words\n", result.cend() - result.cbegin());
}

const struct BeforeAndAfter {
    BeforeAndAfter() { compile(); }
    ~BeforeAndAfter() { compile(); }
} before_and_after;

}  // namespace
