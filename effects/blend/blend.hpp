// SPDX-License-Identifier: MIT
#pragma once
// Blend: puts a second picture, which the stack entry names, over the picture. It knows no transparency of the second
// picture: for a share that varies, give the entry a mask.

#include <darkroom/blend_mode.hpp>
#include <darkroom/effect.hpp>

namespace darkroom {

struct Blend {
    BlendMode mode = BlendMode::Mix;
    float amount = 0.5f;
};
inline constexpr auto blend_rows =
    describe(field<&Blend::mode>("How the second picture goes over the picture."),
             field<&Blend::amount>("Share of the blended picture; at 0 the picture stays as it is.", {0, 1}));

[[nodiscard]] const EffectInfo& effect_info(const Blend&);

}  // namespace darkroom
