// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <shaderc/shaderc.hpp>
#include <string_view>

#include "core/text/param_text.hpp"
#include "gpu/shader/glsl_compiler.hpp"
#include "gpu/shaderc_version.hpp"

namespace darkroom::gpu {

namespace {

// Raised whenever the options below change.
constexpr std::string_view options_version = "darkroom 3: vulkan 1.2, spir-v 1.5, performance, clamped NaN";

shaderc_shader_kind kind_of(ShaderStage stage) {
    switch (stage) {
        case ShaderStage::Vertex:
            return shaderc_glsl_vertex_shader;
        case ShaderStage::Fragment:
            return shaderc_glsl_fragment_shader;
        case ShaderStage::Compute:
            return shaderc_glsl_compute_shader;
    }
    return shaderc_glsl_compute_shader;
}

/// The first line that reports an error, without the word "error:". The compiler writes "file:line: error: message".
std::string first_error(const std::string& messages, const std::string& name) {
    constexpr std::string_view mark = "error: ";
    std::size_t begin = 0;
    while (begin < messages.size()) {
        const std::size_t end = std::min(messages.find('\n', begin), messages.size());
        const std::string line = messages.substr(begin, end - begin);
        // The message quotes the text, whatever its bytes are.
        if (const std::size_t at = line.find(mark); at != std::string::npos)
            return line.substr(0, at) + printable(line.substr(at + mark.size()));
        begin = end + 1;
    }
    return fmt::format("{}: the shader compiler failed without a message", name);
}

}  // namespace

std::string glsl_compiler_version() { return fmt::format("{}|{}", options_version, shaderc_version); }

Result<std::vector<std::uint32_t>> compile_glsl(const ShaderSource& source) {
    try {
        shaderc::Compiler compiler;
        shaderc::CompileOptions options;
        // What a 1.2 device loads. SPIR-V 1.6 would also state workgroup sizes in a way that asks the host for the
        // feature maintenance4.
        options.SetTargetEnvironment(shaderc_target_env_vulkan, shaderc_env_version_vulkan_1_2);
        options.SetTargetSpirv(shaderc_spirv_version_1_5);
        options.SetOptimizationLevel(shaderc_optimization_level_performance);
        // min, max and clamp take the operand that is a number: clamp(NaN, low, high) is low.
        options.SetNanClamp(true);
        const shaderc::SpvCompilationResult result =
            compiler.CompileGlslToSpv(source.text, kind_of(source.stage), source.name.c_str(), options);
        if (result.GetCompilationStatus() != shaderc_compilation_status_success) {
            return user_error(first_error(result.GetErrorMessage(), source.name));
        }
        return std::vector<std::uint32_t>(result.begin(), result.end());
    } catch (const std::exception& exception) {
        return machine_error(fmt::format("{}: the shader compiler failed: {}", source.name, exception.what()));
    }
}

}  // namespace darkroom::gpu
