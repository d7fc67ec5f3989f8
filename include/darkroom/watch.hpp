// SPDX-License-Identifier: MIT
#pragma once
// Looking into a plan while it runs: a host names pictures inside it when it compiles, and gives a frame images of its
// own (Frame::watched) that they are copied to. The passes that copy are the plan's, so lifetimes and barriers follow,
// and a frame that gives none runs none. What is watched must be an image: an entry that would share a kernel with the
// next one ends it.

#include <cstddef>
#include <darkroom/frame.hpp>
#include <darkroom/handle.hpp>
#include <string>

namespace darkroom {

inline constexpr std::size_t max_watches = 1024;  ///< of a plan

/// One picture of a plan: what an entry makes of its input, or an image by its name.
struct Watch {
    std::uint32_t id = 0;         ///< what frames and answers call it; no two of a plan have the same
    Handle entry;                 ///< its output, as whatever reads it gets it; or scene_color
    std::string image;            ///< where no entry is given: PlanImage::name
    std::uint32_t mip_level = 0;  ///< of the image
    ImageUse target{VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};  ///< of every frame's target
    friend bool operator==(const Watch&, const Watch&) = default;
};

/// What the last record made of a watch.
enum class WatchState : std::uint8_t {
    NotInPlan,   ///< the plan has no such watch, or for it no such entry, image or mip level; the target is not written
    NotGiven,    ///< the frame had no target for it
    NotWritten,  ///< no pass makes the image in this frame: the target is not written
    InputShown,  ///< the entry is off or left out: its input is shown
    Shown,
};

}  // namespace darkroom
