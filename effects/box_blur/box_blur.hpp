// SPDX-License-Identifier: MIT
#pragma once
// Box blur: every pixel becomes the plain mean of the square around it. One iteration is the cheapest blur there is and
// looks like a square; three come near a bell curve. For a round blur of a given width take gaussian_blur.

#include <darkroom/effect.hpp>

namespace darkroom {

struct BoxBlur {
    std::int32_t radius = 4;
    std::int32_t iterations = 1;
};
inline constexpr auto box_blur_rows =
    describe(field<&BoxBlur::radius>("Half-width of the square; 0 leaves the picture as it is.", {0, 64}, unit::pixels)
                 .as_loop_count(),
             field<&BoxBlur::iterations>(
                 "How many times the picture is blurred: 2 make a pyramid, 3 nearly a bell curve.", {1, 4})
                 .at_compile());

[[nodiscard]] const EffectInfo& effect_info(const BoxBlur&);

}  // namespace darkroom
