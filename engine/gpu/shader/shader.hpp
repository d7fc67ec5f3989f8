// SPDX-License-Identifier: MIT
#pragma once
// SPIR-V of a text, by the first of three that has it: kernels that were baked, a content-addressed disk cache, the
// compiler of GLSL. The identity of a text is its SHA-256, since strangers may write texts; the cache's key adds stage,
// options and the compiler's version. A damaged entry is recompiled, never trusted (the file carries a hash of its
// words). Several processes may share a folder: entries appear whole, and one that another process removed is compiled
// again.

#include <atomic>
#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/digest/sha256.hpp"
#include "gpu/shader/baked_shaders.hpp"
#include "gpu/shader/shader_stage.hpp"

namespace darkroom::gpu {

struct ShaderSource {
    std::string name;  ///< for messages: "effects/bloom/bloom_downsample.glsl (compute)"
    std::string text;
    ShaderStage stage = ShaderStage::Compute;
    std::optional<Digest> digest{};  ///< of the text, from who has worked it out already

    [[nodiscard]] Digest identity() const { return digest ? *digest : sha256(text); }
};

class ShaderCompiler {
  public:
    /// Some thousands of kernels.
    static constexpr std::uintmax_t max_bytes_by_default = std::uintmax_t{128} << 20U;
    /// An empty folder: no disk cache. When its entries exceed `max_bytes`, those that were not used for longest are
    /// removed, down to three quarters of it.
    explicit ShaderCompiler(std::filesystem::path cache_folder, std::uintmax_t max_bytes = max_bytes_by_default);
    /// What is asked first. Before the first compile().
    void set_baked(BakedShaders baked) { baked_ = std::move(baked); }
    /// Of a text that nobody has, where there is no compiler.
    [[nodiscard]] bool is_missing(const Error& error) const {
        return !has_compiler && error.fault == darkroom::Fault::User;
    }
    /// Error text: "file:line: message" of the first error, by the #line directives of the source; or that the text was
    /// not baked.
    [[nodiscard]] Result<std::vector<std::uint32_t>> compile(const ShaderSource& source);
    /// Compiles many on a few threads; results in order.
    [[nodiscard]] std::vector<Result<std::vector<std::uint32_t>>> compile_all(std::span<const ShaderSource> sources);

    std::atomic<std::uint64_t> compiled{0};  ///< calls that reached the compiler
    std::atomic<std::uint64_t> from_cache{0};
    std::atomic<std::uint64_t> from_baked{0};
    bool has_compiler;  ///< is one linked? Tests go without.

  private:
    void add_entry(const std::filesystem::path& path, const std::vector<std::uint32_t>& words);

    BakedShaders baked_;
    std::filesystem::path folder_;
    std::uintmax_t max_bytes_;
    std::mutex size_mutex_;                      ///< guards the next member
    std::optional<std::uintmax_t> known_bytes_;  ///< when this process last looked, and what it added since
};

}  // namespace darkroom::gpu
