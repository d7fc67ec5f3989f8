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
    float intensity = 0.5f;
    Toggle follows_light = true;
    Vec2 position = {0.5f, 0.3f};
    float radius = 0.8f;
    float threshold = 1.0f;
    float ceiling = 16.0f;
    float density = 1.0f;
    float decay = 0.4f;
    std::int32_t samples = 64;
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
