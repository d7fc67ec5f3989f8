// SPDX-License-Identifier: MIT
#pragma once
// A sequence as a renderer leaves it on a disk: OpenEXR, ZIP, halves with depth and normals. The street of the world
// in stone, under a sun that gets brighter, with the noise of a path tracer: neither flat nor noise alone, so that it
// packs as pictures do.

#include <darkroom/result.hpp>
#include <filesystem>

#include "bench/world.hpp"

namespace darkroom::bench {

/// One name for all frames, with %04d.
[[nodiscard]] std::filesystem::path frames_pattern(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path frame_path(const std::filesystem::path& folder, std::uint32_t index);
/// Frames 0 to `count` - 1.
[[nodiscard]] Result<> write_frames(const std::filesystem::path& folder, VkExtent2D extent, std::uint32_t count);

}  // namespace darkroom::bench
