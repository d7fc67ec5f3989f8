// SPDX-License-Identifier: MIT
#pragma once
// God rays: bright sky streams away from the light over the picture, and what stands before the sky cuts dark streaks
// into it. It works on the picture alone: a light outside of it, or hidden, sends nothing. For shafts in a room see
// volumetric.

#include <darkroom/frame.hpp>
#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct GodRays {
    /// How much of the streaks is added. [0, 64]
    float intensity = 0.5f;
    /// Takes the place of the frame's first light; without a light `position` counts.
    Toggle follows_light = true;
    /// Where the light is: (0, 0) is the top left of the picture, (1, 1) the bottom right. [-4, 5]
    Vec2 position = {0.5f, 0.3f};
    /// How far around the light the sky streams, in heights of the picture. [0.01, 16]
    float radius = 0.8f;
    /// Sky above this luminance streams; without depth, all that is brighter. [0, 65504]
    float threshold = 1.0f;
    /// Luminance above the threshold counts no further than this. [0, 65504]
    float ceiling = 16.0f;
    /// How much of the way to the light a streak gathers from. [0, 1]
    float density = 1.0f;
    /// What counts of the light at the end of the way, beside 1 at its beginning. [0.001, 1]
    float decay = 0.4f;
    /// Steps on the way. Brightness does not depend on it, smoothness does. [1, 256]
    std::int32_t samples = 64;
    /// Colour that the streaks are multiplied by. [0, 64]
    Rgb tint = {1.0f, 1.0f, 1.0f};
};

/// Where the light is in the picture, and how much of it is left there: 1 inside, 0 from half a picture outside on, and
/// behind the camera.
struct GodRaysLight {
    double u = 0.5, v = 0.5, fade = 0;
};
[[nodiscard]] GodRaysLight god_rays_light(const GodRays& parameters, const Camera* camera, const Light* first_light);

[[nodiscard]] const EffectInfo& effect_info(const GodRays&);

}  // namespace darkroom
