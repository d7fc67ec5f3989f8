// SPDX-License-Identifier: MIT
#pragma once
// For tests only: what a SPIR-V module asks of a device, as far as the smallest one has an answer.

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace darkroom::gpu::test {

struct ShaderFacts {
    std::vector<std::uint32_t> capabilities;
    std::array<std::uint32_t, 3> workgroup{1, 1, 1};
    std::uint32_t shared_bytes = 0;
    std::uint32_t storage_images = 0, storage_buffers = 0;
    std::uint32_t written = 0;  ///< of these, those that are not NonWritable
};

/// `specialization` has the values of constants by their SpecId. A module with more than one entry point is taken as
/// one.
[[nodiscard]] ShaderFacts read_shader(std::span<const std::uint32_t> words,
                                      const std::map<std::uint32_t, std::uint32_t>& specialization = {});

}  // namespace darkroom::gpu::test
