// SPDX-License-Identifier: MIT
#pragma once
// Temporal anti-aliasing and upscaling: gathers the frames of a jittered camera into one picture of the output's size,
// following what moves. It needs depth; without a velocity image it knows the camera's motion alone. The host moves its
// projection by Composer::jitter and tells of it in Camera::jitter.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Taa {
    /// Sharpening of the gathered picture: 0 is none, 1 the most that its contrast allows. [0, 1]
    float sharpness = 0.0f;
    /// Number of frames that a still surface is gathered over: 0 is 8 frames, 1 is 128. [0, 1]
    float stability = 0.75f;
};

[[nodiscard]] const EffectInfo& effect_info(const Taa&);

}  // namespace darkroom
