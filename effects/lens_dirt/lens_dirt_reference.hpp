// SPDX-License-Identifier: MIT
#pragma once
// Lens dirt in double precision: c' = c + intensity D G(L), where D is the dirt, L the light above the threshold and G
// a Gaussian.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <darkroom/effects/lens_dirt.hpp>
#include <darkroom/reference.hpp>
#include <darkroom/resource.hpp>
#include <vector>

#include "shared/small_light.hpp"

namespace darkroom {

/// A piece of dust: place and radius in heights of a picture of 16:9.
struct LensDirtDisc {
    double x = 0, y = 0, radius = 0, brightness = 0;
};
inline constexpr std::uint32_t lens_dirt_width = 512, lens_dirt_height = 288;

/// The dust that there is without a picture.
[[nodiscard]] const std::vector<LensDirtDisc>& lens_dirt_discs();
/// Of a disc at a distance from its middle: brighter toward its rim, as what is out of focus, with a soft edge, which
/// takes a texel and a half at least, so that small discs are round.
inline double lens_dirt_profile(const LensDirtDisc& disc, double distance) {
    const double t = distance / disc.radius, edge = std::max(0.15, 1.5 / (disc.radius * lens_dirt_height));
    return disc.brightness * (0.6 + 0.4 * std::pow(std::min(t, 1.0), 4)) * std::clamp((1 - t) / edge, 0.0, 1.0);
}

/// RGBA of 8 bits, row-major: of a picture, or of the discs, the brightest of which counts.
struct LensDirtTable {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};
[[nodiscard]] LensDirtTable lens_dirt_table(const ResourceImage* picture);

/// Variance of the blur, in texels of the picture that is blurred, of this height: without the mean over a texel, and
/// the way back to pixels.
inline double lens_dirt_variance(const LensDirt& dirt, std::uint32_t small_height) {
    const double texels = double{dirt.radius} * small_height / 1080;
    return std::max(texels * texels - 1.0 / 12 - 1.0 / 6, 0.02);
}

inline ReferenceImage lens_dirt_reference(const void* parameters, const ReferenceInput& input) {
    const LensDirt& dirt = *static_cast<const LensDirt*>(parameters);
    ReferenceImage out = *input.picture;
    const std::uint32_t part = 4 * bright_part({out.width, out.height});
    const ReferenceImage small = quarter_light_reference(bright_reference(*input.source, double{dirt.threshold}),
                                                         out.width / part, out.height / part);
    const ReferenceImage light = blur_light_reference(small, lens_dirt_variance(dirt, small.height));
    const LensDirtTable table = lens_dirt_table(find_resource<ResourceImage>(input.resources, dirt.dirt));
    ReferenceImage on_lens(table.width, table.height);
    for (std::size_t i = 0; i < on_lens.pixels.size(); ++i)
        on_lens.pixels[i] = {table.rgba[4 * i] / 255.0, table.rgba[4 * i + 1] / 255.0, table.rgba[4 * i + 2] / 255.0};
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double u = (x + 0.5) / out.width, v = (y + 0.5) / out.height;
            const Rgba around = sample_reference(light, u, v), there = sample_reference(on_lens, u, v);
            out.at(x, y) = weighed_sum_reference(
                out.at(x, y), {around.r * there.r, around.g * there.g, around.b * there.b, 1}, double{dirt.intensity});
        }
    return out;
}

}  // namespace darkroom
