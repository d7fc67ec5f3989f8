// SPDX-License-Identifier: MIT
#pragma once
// LensFlare: light that is reflected between the lenses of a camera: ghosts of what is bright, on a line through the
// picture's middle, and a halo around it. Made of the picture itself, so a light that is outside of it, or hidden, has
// none.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct LensFlare {
    /// How much of the flare is added. [0, 16]
    float intensity = 0.05f;
    /// Light above this flares. [0, 65504]
    float threshold = 1.0f;
    /// Ghosts of each light, on both sides of the middle by turns. [0, 16]
    std::int32_t ghosts = 6;
    /// How much smaller, and nearer to the middle, each ghost is than the one before. [0, 2]
    float spacing = 0.35f;
    /// Strength of the halo, to that of a ghost. [0, 4]
    float halo = 0.5f;
    /// Radius of the halo of a light in the middle, in heights of the picture. [0, 1]
    float halo_radius = 0.4f;
    /// How much larger ghosts are in red, and smaller in blue. [0, 0.2]
    float dispersion = 0.02f;
    /// Blades of the aperture: an even number has as many rays, an odd one twice as many. [3, 16]
    std::int32_t blades = 6;
    /// How much of the flare lies in the rays of the aperture. [0, 1]
    float starburst = 0.5f;
    /// Colour that the flare is multiplied by. [0, 4]
    Rgb tint{1, 1, 1};
};

[[nodiscard]] const EffectInfo& effect_info(const LensFlare&);

}  // namespace darkroom
