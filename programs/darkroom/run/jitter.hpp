// SPDX-License-Identifier: MIT
#pragma once
// Frames of a scene for looks that gather them: how large they are drawn, and from where within the pixel.

#include <cstdint>
#include <darkroom/look.hpp>

#include "render/frame_set.hpp"

namespace app {

/// Has the look an entry that is on and makes the output of several frames?
[[nodiscard]] bool gathers_frames(const darkroom::Look& look);
/// Of a frame of a sequence. `scale`: lines of the picture to those of the frame.
[[nodiscard]] darkroom::render::FrameJitter jitter_of(std::uint64_t frame, float scale);
/// Of frames whose picture has this extent, at least 1x1.
[[nodiscard]] VkExtent2D scaled(VkExtent2D extent, double render_scale);

}  // namespace app
