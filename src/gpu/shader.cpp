// SPDX-License-Identifier: MIT
#include "gpu/shader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <shaderc/shaderc.hpp>
#include <string_view>
#include <system_error>

#include "core/files.hpp"
#include "core/hash.hpp"
#include "core/parallel.hpp"
#include "gpu/shaderc_version.hpp"

namespace darkroom::gpu {

namespace {

using Words = std::vector<std::uint32_t>;

// Raised whenever the options below change, so that no entry made with others is found.
constexpr std::string_view options_version = "darkroom 1: vulkan 1.3, spir-v 1.5, performance";

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

std::filesystem::path entry_path(const std::filesystem::path& folder, const ShaderSource& source) {
    const std::string key =
        fmt::format("{}|{}|{}|{}", options_version, shaderc_version, static_cast<int>(source.stage), source.text);
    return folder / (content_hash(key).hex() + ".spv");
}

/// An entry is the hash of its words, then the words.
std::optional<Words> read_entry(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return {};
    const Result<std::vector<std::byte>> bytes = read_file(path);
    if (!bytes || bytes->size() <= sizeof(Hash) || bytes->size() % sizeof(std::uint32_t) != 0) return {};
    Hash expected;
    std::memcpy(&expected, bytes->data(), sizeof expected);
    const std::span<const std::byte> content = std::span(*bytes).subspan(sizeof expected);
    if (content_hash(content) != expected) return {};
    Words words(content.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), content.data(), content.size());
    return words;
}

/// A cache that cannot be written is slow, not wrong: failures are dropped.
void write_entry(const std::filesystem::path& path, const Words& words) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error) return;
    const std::span<const std::byte> content = std::as_bytes(std::span(words));
    const Hash hash = content_hash(content);
    std::vector<std::byte> bytes(sizeof hash + content.size());
    std::memcpy(bytes.data(), &hash, sizeof hash);
    std::memcpy(bytes.data() + sizeof hash, content.data(), content.size());
    static_cast<void>(write_file(path, bytes));
}

/// The first line that reports an error, without the word "error:". The compiler writes "file:line: error: message".
std::string first_error(const std::string& messages, const std::string& name) {
    constexpr std::string_view mark = "error: ";
    std::size_t begin = 0;
    while (begin < messages.size()) {
        const std::size_t end = std::min(messages.find('\n', begin), messages.size());
        std::string line = messages.substr(begin, end - begin);
        if (const std::size_t at = line.find(mark); at != std::string::npos) return line.erase(at, mark.size());
        begin = end + 1;
    }
    return fmt::format("{}: the shader compiler failed without a message", name);
}

Result<Words> run_compiler(const ShaderSource& source) {
    try {
        shaderc::Compiler compiler;
        shaderc::CompileOptions options;
        options.SetTargetEnvironment(shaderc_target_env_vulkan, shaderc_env_version_vulkan_1_3);
        // SPIR-V 1.6 states workgroup sizes in a way that asks the host for the feature maintenance4.
        options.SetTargetSpirv(shaderc_spirv_version_1_5);
        options.SetOptimizationLevel(shaderc_optimization_level_performance);
        const shaderc::SpvCompilationResult result =
            compiler.CompileGlslToSpv(source.text, kind_of(source.stage), source.name.c_str(), options);
        if (result.GetCompilationStatus() != shaderc_compilation_status_success) {
            return user_error(first_error(result.GetErrorMessage(), source.name));
        }
        return Words(result.begin(), result.end());
    } catch (const std::exception& exception) {
        return machine_error(fmt::format("{}: the shader compiler failed: {}", source.name, exception.what()));
    }
}

}  // namespace

ShaderCompiler::ShaderCompiler(std::filesystem::path cache_folder) : folder_(std::move(cache_folder)) {}

Result<Words> ShaderCompiler::compile(const ShaderSource& source) {
    const std::filesystem::path path = folder_.empty() ? std::filesystem::path() : entry_path(folder_, source);
    if (!path.empty()) {
        if (std::optional<Words> words = read_entry(path)) {
            ++from_cache;
            return std::move(*words);
        }
    }
    ++compiled;
    Result<Words> words = run_compiler(source);
    if (words && !path.empty()) write_entry(path, *words);
    return words;
}

std::vector<Result<Words>> ShaderCompiler::compile_all(std::span<const ShaderSource> sources) {
    std::vector<Result<Words>> results(sources.size());
    parallel_for(sources.size(), 0, [&](std::size_t index) { results[index] = compile(sources[index]); });
    return results;
}

}  // namespace darkroom::gpu
