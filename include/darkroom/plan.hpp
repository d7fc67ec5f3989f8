// SPDX-License-Identifier: MIT
#pragma once
// What the planner made of a stack: readable by people (`darkroom plan`), by programs (JSON) and by tests.

#include <vulkan/vulkan.h>
#include <cstdint>
#include <string>
#include <vector>

namespace darkroom {

/// One dispatch or draw of a frame.
struct PlanPass {
    std::string name;
    std::string stage;                 ///< "compute" or "raster"
    std::vector<std::string> entries;  ///< that it holds, in order
    std::string boundary;              ///< why a new pass starts here: one sentence
    VkExtent2D extent{};
    std::uint64_t bytes_read = 0;  ///< each input texel counted once
    std::uint64_t bytes_written = 0;
};

struct Plan {
    VkExtent2D extent{};
    std::vector<PlanPass> passes;
    std::vector<std::string> left_out;  ///< "ssao: needs depth, which is not given"
    std::vector<std::string> remarks;   ///< colour domains and other oddities, one sentence each
    /// Of the frame, what any pass may read: color, depth, normals, velocity, ui, shadows.
    std::vector<std::string> frame_images;
    std::uint64_t transient_bytes = 0;  ///< after aliasing
    std::uint64_t transient_bytes_unaliased = 0;

    [[nodiscard]] std::uint64_t bytes_read() const;
    [[nodiscard]] std::uint64_t bytes_written() const;
    [[nodiscard]] std::string text() const;
    [[nodiscard]] std::string json() const;
};

}  // namespace darkroom
