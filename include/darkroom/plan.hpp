// SPDX-License-Identifier: MIT
#pragma once
// What the planner made of a stack: readable by people (`darkroom plan`), by programs (JSON) and by tests.

#include <vulkan/vulkan.h>
#include <cstdint>
#include <string>
#include <vector>

namespace darkroom {

/// An image that passes of a frame read or write. Constant ones are not named.
struct PlanImage {
    enum class Kind : std::uint8_t {
        Host,       ///< lent by the host
        Transient,  ///< of this frame alone; shares memory with others
        History,    ///< outlives the frame: there are two, which change places
    };
    static constexpr std::uint32_t never = ~0u;
    std::string name;  ///< no two have the same: what a Watch names
    Kind kind = Kind::Transient;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};  ///< of mip level 0
    std::uint32_t mip_levels = 1;
    std::uint64_t bytes = 0;                              ///< of one of the two, where it is a history
    std::uint64_t offset = 0;                             ///< in the transient memory; of other kinds 0
    std::uint32_t first_pass = never, last_pass = never;  ///< of Plan::passes, those that use it
    // Of the host's: how a recording uses it, whichever effects are on. A host that places its own barriers brings it
    // into `layout` for these, says so (ImageRef::last_stages NONE), and finds it in `final_layout`, used by them.
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED, final_layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

/// One mip level of an image, as a pass uses it.
struct PlanUse {
    std::uint32_t image = 0;  ///< of Plan::images
    std::uint32_t mip_level = 0;
    bool is_previous = false;  ///< of a history: what the last frame wrote
};

/// One dispatch or draw of a frame.
struct PlanPass {
    std::string name;
    std::string stage;                 ///< "compute" or "raster"
    std::vector<std::string> entries;  ///< that it holds, in order
    std::string boundary;              ///< why a new pass starts here: one sentence
    /// Passes of one round run side by side: barriers stand only between rounds, which are counted from 0.
    std::uint32_t round = 0;
    VkExtent2D extent{};
    std::uint64_t invocations = 0;  ///< its threads: one a pixel, but in passes that make tiles
    std::uint64_t bytes_read = 0;   ///< each input texel counted once
    std::uint64_t bytes_written = 0;
    std::vector<PlanUse> reads;
    PlanUse writes;                      ///< its image is PlanImage::never where a pass writes buffers alone
    std::vector<PlanUse> more_writes{};  ///< of a pass with several outputs
};

/// What the numbers of the picture mean behind an entry, with the present values.
struct PlanState {
    std::string entry, state;
};

struct Plan {
    VkExtent2D extent{};
    std::vector<PlanPass> passes;
    std::vector<PlanImage> images;  ///< those of passes that do not run with the present values, too
    /// "ssao: needs depth, which the frame does not have"; of Composer::current_plan(), what its frame alone left out,
    /// too
    std::vector<std::string> left_out;
    std::vector<std::string> misplaced;  ///< entries that expect a picture in another colour domain, one sentence each
    std::vector<std::string> remarks;    ///< other oddities, likewise
    std::vector<PlanState> states;       ///< behind each entry that is not left out, in order
    /// Of the frame, what any pass may read: "color", "depth" and so on, as needs name them.
    std::vector<std::string> frame_images;
    std::uint64_t transient_bytes = 0;  ///< after aliasing
    std::uint64_t transient_bytes_unaliased = 0;

    [[nodiscard]] std::uint32_t rounds() const;  ///< their number
    [[nodiscard]] std::uint64_t bytes_read() const;
    [[nodiscard]] std::uint64_t bytes_written() const;
    [[nodiscard]] std::string text() const;
    [[nodiscard]] std::string json() const;
};

}  // namespace darkroom
