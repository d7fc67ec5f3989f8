// SPDX-License-Identifier: MIT
#pragma once
// GLSL to SPIR-V, with a content-addressed disk cache: the key hashes source, stage, options and the compiler's
// version. A damaged entry is recompiled, never trusted (the file carries a hash of its words).

#include <atomic>
#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace darkroom::gpu {

enum class ShaderStage : std::uint8_t { Vertex, Fragment, Compute };

struct ShaderSource {
    std::string name;  ///< for messages: "effects/bloom/bloom_downsample.glsl (compute)"
    std::string text;
    ShaderStage stage = ShaderStage::Compute;
};

class ShaderCompiler {
  public:
    /// An empty folder: no disk cache.
    explicit ShaderCompiler(std::filesystem::path cache_folder);
    /// Error text: "file:line: message" of the first error, by the #line directives of the source.
    [[nodiscard]] Result<std::vector<std::uint32_t>> compile(const ShaderSource& source);
    /// Compiles many on a few threads; results in order.
    [[nodiscard]] std::vector<Result<std::vector<std::uint32_t>>> compile_all(std::span<const ShaderSource> sources);

    std::atomic<std::uint64_t> compiled{0};  ///< calls that reached the compiler
    std::atomic<std::uint64_t> from_cache{0};

  private:
    std::filesystem::path folder_;
};

}  // namespace darkroom::gpu
