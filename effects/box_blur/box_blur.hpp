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
    /// How many times the picture is blurred: 2 make a pyramid, 3 nearly a bell curve. [1, 4]
    std::int32_t iterations = 1;
    /// Which pixels the radius is measured in.
    Reach reach = Reach::Pixels;
};

[[nodiscard]] const EffectInfo& effect_info(const BoxBlur&);

}  // namespace darkroom
