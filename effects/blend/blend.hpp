// SPDX-License-Identifier: MIT
#pragma once
// Blend: puts a second picture, which the stack entry names, over the picture. It knows no transparency of the second
// picture: for a share that varies, give the entry a mask.

#include <darkroom/blend_mode.hpp>
#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Blend {
    /// Formula that lays the second picture over the picture.
    BlendMode mode = BlendMode::Mix;
    /// Share of the blended picture; 0 leaves the picture as it is. [0, 1]
    float amount = 0.5f;
};

[[nodiscard]] const EffectInfo& effect_info(const Blend&);

}  // namespace darkroom
