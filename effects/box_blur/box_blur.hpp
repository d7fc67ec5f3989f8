// SPDX-License-Identifier: MIT
#pragma once
// Box blur: every pixel becomes the plain mean of the square around it. One iteration is the cheapest blur there is and
// looks like a square; three come near a bell curve. For a round blur of a given width take gaussian_blur.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct BoxBlur {
    std::int32_t radius = 4;
    std::int32_t iterations = 1;
};

[[nodiscard]] const EffectInfo& effect_info(const BoxBlur&);

}  // namespace darkroom
