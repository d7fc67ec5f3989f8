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
    /// Amount of the streaks added to the picture. [0, 64]
    float intensity = 0.5f;
    /// Takes the position of the frame's first light; without a light `position` counts.
    Toggle follows_light = true;
    /// Position of the light: (0, 0) is the top left of the picture, (1, 1) the bottom right. [-4, 5]
    Vec2 position = {0.5f, 0.3f};
    /// Distance around the light in which the sky sends streaks, in heights of the picture. [0.01, 16]
    float radius = 0.8f;
    /// Sky above this luminance sends streaks; without depth, everything brighter does. [0, 65504]
    float threshold = 1.0f;
    /// Largest luminance above the threshold that counts. [0, 65504]
    float ceiling = 16.0f;
    /// Share of the way to the light that a streak gathers from. [0, 1]
    float density = 1.0f;
    /// Weight of the light at the end of the way; at the beginning it is 1. [0.001, 1]
    float decay = 0.4f;
    /// Number of steps on the way. Brightness does not depend on it, smoothness does. [1, 256]
    std::int32_t samples = 64;
    /// Colour that multiplies the streaks. [0, 64]
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
