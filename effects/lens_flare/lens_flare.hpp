// SPDX-License-Identifier: MIT
#pragma once
// LensFlare: light that is reflected between the lenses of a camera: ghosts of what is bright, on a line through the
// picture's middle, and a halo around it. Made of the picture itself, so a light that is outside of it, or hidden, has
// none.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct LensFlare {
    /// Amount of the flare added to the picture. [0, 16]
    float intensity = 0.05f;
    /// Light above this value makes flares. [0, 65504]
    float threshold = 1.0f;
    /// Number of ghosts of each light, on both sides of the centre by turns. [0, 16]
    std::int32_t ghosts = 6;
    /// Step by which each ghost is smaller and nearer to the centre than the one before. [0, 2]
    float spacing = 0.35f;
    /// Strength of the halo relative to a ghost. [0, 4]
    float halo = 0.2f;
    /// Radius of the halo of a light in the centre, in heights of the picture. [0, 1]
    float halo_radius = 0.4f;
    /// Share by which ghosts are larger in red and smaller in blue. [0, 0.2]
    float dispersion = 0.02f;
    /// Number of the aperture's blades: an even number gives as many rays, an odd one twice as many. [3, 16]
    std::int32_t blades = 6;
    /// Share of the flare in the rays of the aperture. [0, 1]
    float starburst = 0.5f;
    /// Colour that multiplies the flare. [0, 4]
    Rgb tint{1, 1, 1};
};

[[nodiscard]] const EffectInfo& effect_info(const LensFlare&);

}  // namespace darkroom
