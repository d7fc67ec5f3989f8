// SPDX-License-Identifier: MIT
#pragma once
// Temporal anti-aliasing and upscaling: gathers the frames of a jittered camera into one picture of the output's size,
// following what moves. It needs depth; without a velocity image it knows the camera's motion alone. The host moves its
// projection by Composer::jitter and tells of it in Camera::jitter.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Taa {
    /// How much the gathered picture is sharpened: 0 is not at all, 1 all that its contrast allows. [0, 1]
    float sharpness = 0.0f;
    /// How long what stands still is gathered: 0 for 8 frames, 1 for 128. [0, 1]
    float stability = 0.75f;
};

[[nodiscard]] const EffectInfo& effect_info(const Taa&);

}  // namespace darkroom
