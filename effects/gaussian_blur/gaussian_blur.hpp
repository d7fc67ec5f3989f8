// SPDX-License-Identifier: MIT
#pragma once
// Gaussian blur: every pixel becomes the mean of its surroundings, weighted by a bell curve; one line of the picture
// after the other, so the cost grows with the radius and not with its square. It is not a depth of field: it knows no
// depth.

#include <array>
#include <cstddef>
#include <darkroom/effect.hpp>

namespace darkroom {

struct GaussianBlur {
    std::int32_t radius = 4;
    float sigma = 0.0f;
};
inline constexpr auto gaussian_blur_rows = describe(
    field<&GaussianBlur::radius>("Half-width of the blur; 0 leaves the picture as it is.", {0, 64}, unit::pixels),
    field<&GaussianBlur::sigma>("Standard deviation of the bell curve; 0 takes a third of the radius.", {0, 64},
                                unit::pixels));

/// The curve as a shader samples it: the pixel itself, then bilinear taps to both sides, each standing for two pixels.
struct GaussianBlurTaps {
    static constexpr std::size_t capacity = 32;
    float centre_weight = 1.0f;
    std::size_t count = 0;
    std::array<float, capacity> offsets{};  ///< in pixels
    std::array<float, capacity> weights{};  ///< of one side
};
[[nodiscard]] GaussianBlurTaps gaussian_blur_taps(const GaussianBlur& blur);

[[nodiscard]] const EffectInfo& effect_info(const GaussianBlur&);

}  // namespace darkroom
