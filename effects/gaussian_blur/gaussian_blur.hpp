// SPDX-License-Identifier: MIT
#pragma once
// Gaussian blur: every pixel becomes the mean of its surroundings, weighted by a bell curve; one line of the picture
// after the other, so the cost grows with the radius and not with its square, and a wide blur is one of a smaller
// picture. It is not a depth of field: it knows no depth.

#include <array>
#include <cstddef>
#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class GaussianBlurResolution : std::uint32_t {
    Automatic,  ///< as small a picture as the blur leaves no detail for
    Full,       ///< every weight at every pixel
};

struct GaussianBlur {
    /// Half-width of the blur; 0 leaves the picture as it is. [0, 64] px
    std::int32_t radius = 4;
    /// Standard deviation of the bell curve; 0 takes a third of the radius. [0, 64] px
    float sigma = 0.0f;
    /// Size at which a wide blur works: automatic takes a smaller picture where no detail is lost, full never does.
    GaussianBlurResolution resolution = GaussianBlurResolution::Automatic;
    /// Pixels that radius and sigma are measured in: those of the picture, or of a picture of 1080 lines.
    Reach reach = Reach::Pixels;
};

/// The same blur in pixels of a picture of this height.
[[nodiscard]] GaussianBlur gaussian_blur_in_pixels(const GaussianBlur& blur, std::uint32_t height);

// What follows is about blurs in pixels.

/// One direction of the blur as a shader sums it up: the texel itself, then pairs of texels to both sides. Pair i holds
/// texels 2i + 1 and 2i + 2, weighed by weights[i] (1 - fractions[i]) and weights[i] fractions[i]: one bilinear tap at
/// 2i + 1 + fractions[i] reads both.
struct GaussianBlurTaps {
    static constexpr std::size_t capacity = 32;
    float centre_weight = 1.0f;
    std::size_t count = 0;
    std::array<float, capacity> fractions{};
    std::array<float, capacity> weights{};  ///< of one side
};
/// `scale`: how many of the picture's pixels a texel of the blurred picture stands for, along this direction. Above 1,
/// the curve's variance is what making the picture small and large again leaves of the whole.
[[nodiscard]] GaussianBlurTaps gaussian_blur_taps(const GaussianBlur& blur, double scale = 1.0);
/// How often the picture is halved before it is blurred. A plan keeps what it was compiled with.
[[nodiscard]] std::uint32_t gaussian_blur_level(const GaussianBlur& blur);
/// Reads of an image for every pixel of the result, where bilinear taps are used; those of smaller pictures count by
/// their share of the pixels.
[[nodiscard]] double gaussian_blur_fetches(const GaussianBlur& blur);

[[nodiscard]] const EffectInfo& effect_info(const GaussianBlur&);

}  // namespace darkroom
