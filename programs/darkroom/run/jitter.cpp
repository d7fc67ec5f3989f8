// SPDX-License-Identifier: MIT
#include "jitter.hpp"

#include <algorithm>
#include <cmath>
#include <darkroom/composer.hpp>
#include <darkroom/effect.hpp>

namespace app {

bool gathers_frames(const darkroom::Look& look) {
    return look.is_enabled && std::ranges::any_of(look.entries, [](const darkroom::LookEntry& entry) {
               // Not an upscaler of single frames.
               return entry.state.enabled.on != 0 && entry.effect->output_scale.is_of_output &&
                      entry.effect->touch == darkroom::Touch::History;
           });
}

darkroom::render::FrameJitter jitter_of(std::uint64_t frame, float scale) {
    return {.now = darkroom::Composer::jitter(frame, scale),
            .before = darkroom::Composer::jitter(frame > 0 ? frame - 1 : 0, scale)};
}

VkExtent2D scaled(VkExtent2D extent, double render_scale) {
    const auto side = [&](std::uint32_t of_picture) {
        return std::max(1U, static_cast<std::uint32_t>(std::lround(of_picture * render_scale)));
    };
    return {side(extent.width), side(extent.height)};
}

}  // namespace app
