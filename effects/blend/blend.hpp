// SPDX-License-Identifier: MIT
#pragma once
// Blend: puts a second picture, which the stack entry names, over the picture. It knows no transparency of the second
// picture: for a share that varies, give the entry a mask.

#include <darkroom/blend_mode.hpp>
#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Blend {
    BlendMode mode = BlendMode::Mix;
    float amount = 0.5f;
};

[[nodiscard]] const EffectInfo& effect_info(const Blend&);

}  // namespace darkroom
