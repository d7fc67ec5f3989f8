// SPDX-License-Identifier: MIT
#include "gpu/shader/shader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <system_error>

#include "core/files.hpp"
#include "core/hash.hpp"
#include "core/own_file.hpp"
#include "core/system/folders.hpp"
#include "core/thread/parallel.hpp"
#include "gpu/device/device_facts.hpp"
#include "gpu/shader/glsl_compiler.hpp"

namespace darkroom::gpu {

namespace {

using Words = std::vector<std::uint32_t>;

std::filesystem::path entry_path(const std::filesystem::path& folder, const Digest& text, ShaderStage stage) {
    constexpr int format = 2;  // of entries
    const std::string key =
        fmt::format("{}|{}|{}|{}", format, glsl_compiler_version(), static_cast<int>(stage), hex(text));
    return folder / (hex(sha256(key)) + ".spv");
}

/// Of an entry's words under its name, so that one in the place of another is none.
Hash hash_of(const std::filesystem::path& path, std::span<const std::byte> words) {
    const std::string name = path.stem().string();
    std::vector<std::byte> all(name.size() + words.size());
    std::memcpy(all.data(), name.data(), name.size());
    std::memcpy(all.data() + name.size(), words.data(), words.size());
    return content_hash(all);
}

constexpr std::uintmax_t max_entry_bytes = std::uintmax_t{16} << 20;

/// An entry is the hash of its words under its name, then the words.
std::optional<Words> read_entry(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return {};
    // What it says is run, so nobody else may have written it.
    if (!is_of_this_user_alone(path) || !is_of_this_user_alone(path.parent_path())) return {};
    const Result<std::vector<std::byte>> bytes = read_file(path, {.max_size = max_entry_bytes});
    if (!bytes || bytes->size() <= sizeof(Hash) || bytes->size() % sizeof(std::uint32_t) != 0) return {};
    Hash expected;
    std::memcpy(&expected, bytes->data(), sizeof expected);
    const std::span<const std::byte> content = std::span(*bytes).subspan(sizeof expected);
    if (hash_of(path, content) != expected) return {};
    Words words(content.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), content.data(), content.size());
    // Its time is when it was last used, by which the cache is thinned out.
    std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now(), error);
    return words;
}

/// A cache that cannot be written is slow, not wrong: failures are dropped.
std::uintmax_t write_entry(const std::filesystem::path& path, const Words& words) {
    make_cache_folder(path.parent_path());
    const std::span<const std::byte> content = std::as_bytes(std::span(words));
    const Hash hash = hash_of(path, content);
    std::vector<std::byte> bytes(sizeof hash + content.size());
    std::memcpy(bytes.data(), &hash, sizeof hash);
    std::memcpy(bytes.data() + sizeof hash, content.data(), content.size());
    return write_own_file(path, bytes) ? bytes.size() : 0;
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

Failure missing(const ShaderSource& source, const BakedShaders& baked) {
    const std::string what = baked.size() == 0
                                 ? std::string("the device was given no baked kernels")
                                 : fmt::format("it is not among the {} kernels that were baked for profile {}",
                                               baked.size(), profile_name(baked.profile()));
    return failure({Fault::User, fmt::format("{}: {}, and this library has no compiler of GLSL", source.name, what),
                    ErrorCode::Unsupported});
}

}  // namespace

ShaderCompiler::ShaderCompiler(std::filesystem::path cache_folder, std::uintmax_t max_bytes)
    : has_compiler(!glsl_compiler_version().empty()), folder_(std::move(cache_folder)), max_bytes_(max_bytes) {}

void ShaderCompiler::add_entry(const std::filesystem::path& path, const Words& words) {
    const std::uintmax_t bytes = write_entry(path, words);
    const std::lock_guard lock(size_mutex_);
    if (known_bytes_) *known_bytes_ += bytes;
    if (!known_bytes_ || *known_bytes_ > max_bytes_) known_bytes_ = thin_out(folder_, max_bytes_);
}

Result<Words> ShaderCompiler::compile(const ShaderSource& source) {
    const Digest text = source.identity();
    if (std::optional<Words> words = baked_.find(text, source.stage)) {
        ++from_baked;
        return std::move(*words);
    }
    if (!has_compiler) return missing(source, baked_);
    const std::filesystem::path path = folder_.empty() ? folder_ : entry_path(folder_, text, source.stage);
    if (!path.empty()) {
        if (std::optional<Words> words = read_entry(path)) {
            ++from_cache;
            return std::move(*words);
        }
    }
    ++compiled;
    Result<Words> words = compile_glsl(source);
    if (words && !path.empty()) add_entry(path, *words);
    return words;
}

std::vector<Result<Words>> ShaderCompiler::compile_all(std::span<const ShaderSource> sources) {
    std::vector<Result<Words>> results(sources.size());
    parallel_for(sources.size(), 0, [&](std::size_t index) { results[index] = compile(sources[index]); });
    return results;
}

}  // namespace darkroom::gpu
