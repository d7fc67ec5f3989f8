// SPDX-License-Identifier: MIT
#pragma once
// Halation in double precision: c' = c + intensity tint (G(L) - L), or without the last L, where L is the light above
// the threshold and G a sum of two Gaussians, of the radius and of three times it.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/halation.hpp>
#include <darkroom/reference.hpp>

#include "shared/small_light.hpp"

namespace darkroom {

/// bright_part(), but for pictures of few lines, of which glows of few texels would be squares: as many texels as at
/// 1080 lines at most.
inline std::uint32_t halation_part(VkExtent2D extent) {
    std::uint32_t part = bright_part(extent);
    while (part > 1 && extent.height < part * 135) part /= 2;
    return part;
}

/// Standard deviation in texels of the small picture of this height.
inline double halation_near_texels(const Halation& halation, std::uint32_t small_height) {
    return double{halation.radius} * small_height / 1080;
}
/// Variances of the two blurs, each in its own texels: what is left when the other steps have added theirs, 1/12 a mean
/// over a texel, 1/6 the bilinear way back to pixels. A texel of the far one is four of the near one.
inline double halation_near_variance(double texels) { return std::max(texels * texels - 1.0 / 12 - 1.0 / 6, 0.02); }
inline double halation_far_variance(double texels) {
    const double near_variance = halation_near_variance(texels) + 1.0 / 12;
    return std::max((9 * texels * texels - near_variance) / 16 - 1.0 / 12 - 1.0 / 6, 0.02);
}

inline ReferenceImage halation_reference(const void* parameters, const ReferenceInput& input) {
    const Halation& halation = *static_cast<const Halation*>(parameters);
    ReferenceImage out = *input.picture;
    const std::uint32_t part = halation_part({out.width, out.height});
    const ReferenceImage bright = bright_reference(*input.picture, double{halation.threshold}, part);
    const double texels = halation_near_texels(halation, bright.height);
    const ReferenceImage near = blur_light_reference(bright, halation_near_variance(texels));
    const ReferenceImage far = blur_light_reference(
        quarter_light_reference(near, out.width / (4 * part), out.height / (4 * part)), halation_far_variance(texels));
    const double spread = double{halation.spread};
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            Rgba& color = out.at(x, y);
            const double u = (x + 0.5) / out.width, v = (y + 0.5) / out.height;
            const Rgba clean = clean_reference(color);
            const double brightness = std::max({clean.r, clean.g, clean.b});
            const double kept = std::max(brightness - double{halation.threshold}, 0.0) / std::max(brightness, 1e-6);
            const auto add = [&](double Rgba::*channel, float tint) {
                const double glow = sample_reference(near, u, v).*channel * (1 - spread) +
                                    sample_reference(far, u, v).*channel * spread;
                const double own = halation.conserves_energy ? std::max(clean.*channel, 0.0) * kept : 0;
                color.*channel += double{halation.intensity} * double{tint} * (glow - own);
            };
            add(&Rgba::r, halation.tint.r);
            add(&Rgba::g, halation.tint.g);
            add(&Rgba::b, halation.tint.b);
        }
    return out;
}

}  // namespace darkroom
