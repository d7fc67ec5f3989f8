// SPDX-License-Identifier: MIT
#pragma once
// Box blur: every pixel becomes the plain mean of the square around it. One iteration is the cheapest blur there is and
// looks like a square; three come near a bell curve. For a round blur of a given width take gaussian_blur.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct BoxBlur {
    /// Half-width of the square; 0 leaves the picture as it is. [0, 64] px
    std::int32_t radius = 4;
    /// Number of passes: 2 give a pyramid filter, 3 nearly a bell curve. [1, 4]
    std::int32_t iterations = 1;
    /// Pixels that the radius is measured in: those of the picture, or of a picture of 1080 lines.
    Reach reach = Reach::Pixels;
};

[[nodiscard]] const EffectInfo& effect_info(const BoxBlur&);

}  // namespace darkroom
