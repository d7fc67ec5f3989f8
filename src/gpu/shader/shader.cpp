// SPDX-License-Identifier: MIT
#include "gpu/shader/shader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <shaderc/shaderc.hpp>
#include <string_view>
#include <system_error>

#include "core/files.hpp"
#include "core/hash.hpp"
#include "core/thread/parallel.hpp"
#include "gpu/shaderc_version.hpp"

namespace darkroom::gpu {

namespace {

using Words = std::vector<std::uint32_t>;

// Raised whenever the options below change, so that no entry made with others is found.
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

std::filesystem::path entry_path(const std::filesystem::path& folder, const ShaderSource& source) {
    const std::string key = fmt::format("{}|{}|{}|{}", options_version, shaderc_version, static_cast<int>(source.stage),
                                        hex(source.identity()));
    return folder / (hex(sha256(key)) + ".spv");
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
    // Its time is when it was last used, by which the cache is thinned out.
    std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now(), error);
    return words;
}

/// A cache that cannot be written is slow, not wrong: failures are dropped.
std::uintmax_t write_entry(const std::filesystem::path& path, const Words& words) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error) return 0;
    const std::span<const std::byte> content = std::as_bytes(std::span(words));
    const Hash hash = content_hash(content);
    std::vector<std::byte> bytes(sizeof hash + content.size());
    std::memcpy(bytes.data(), &hash, sizeof hash);
    std::memcpy(bytes.data() + sizeof hash, content.data(), content.size());
    return write_file(path, bytes) ? bytes.size() : 0;
}

struct CachedFile {
    std::filesystem::path path;
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type used{};
};

/// Temporary files that a killed process left behind count as well. What vanishes meanwhile was another process's
/// doing.
std::vector<CachedFile> cached_files(const std::filesystem::path& folder) {
    std::vector<CachedFile> files;
    std::error_code error;
    std::filesystem::directory_iterator entry(folder, error);
    for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        if (entry->path().extension() != ".spv") continue;
        std::error_code of_file;
        CachedFile file{.path = entry->path(), .bytes = entry->file_size(of_file)};
        if (!of_file) file.used = entry->last_write_time(of_file);
        if (!of_file) files.push_back(std::move(file));
    }
    return files;
}

/// Removes what was used longest ago if there are more bytes than `most`, and returns how many remain.
std::uintmax_t thin_out(const std::filesystem::path& folder, std::uintmax_t most) {
    std::vector<CachedFile> files = cached_files(folder);
    std::uintmax_t total = 0;
    for (const CachedFile& file : files) total += file.bytes;
    if (total <= most) return total;
    // Further than to the bound, so that the folder is not looked through again for every entry that comes.
    const std::uintmax_t wanted = most - most / 4;
    std::ranges::sort(files, {}, &CachedFile::used);
    for (const CachedFile& file : files) {
        if (total <= wanted) break;
        std::error_code error;
        std::filesystem::remove(file.path, error);
        total -= file.bytes;
    }
    return total;
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
        return Words(result.begin(), result.end());
    } catch (const std::exception& exception) {
        return machine_error(fmt::format("{}: the shader compiler failed: {}", source.name, exception.what()));
    }
}

}  // namespace

ShaderCompiler::ShaderCompiler(std::filesystem::path cache_folder, std::uintmax_t most_bytes)
    : folder_(std::move(cache_folder)), most_bytes_(most_bytes) {}

void ShaderCompiler::add_entry(const std::filesystem::path& path, const Words& words) {
    const std::uintmax_t bytes = write_entry(path, words);
    const std::lock_guard lock(size_mutex_);
    if (known_bytes_) *known_bytes_ += bytes;
    if (!known_bytes_ || *known_bytes_ > most_bytes_) known_bytes_ = thin_out(folder_, most_bytes_);
}

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
    if (words && !path.empty()) add_entry(path, *words);
    return words;
}

std::vector<Result<Words>> ShaderCompiler::compile_all(std::span<const ShaderSource> sources) {
    std::vector<Result<Words>> results(sources.size());
    parallel_for(sources.size(), 0, [&](std::size_t index) { results[index] = compile(sources[index]); });
    return results;
}

}  // namespace darkroom::gpu
