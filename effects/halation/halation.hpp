// SPDX-License-Identifier: MIT
#pragma once
// Halation: bright light goes through the emulsion, is thrown back by the film's base and exposes it once more, around
// itself, red first. It is the film's glow, not the lens's: for that there is bloom.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Halation {
    /// How much of the light comes back. [0, 1]
    float intensity = 0.3f;
    /// Light above this comes back. [0, 65504]
    float threshold = 1.0f;
    /// Standard deviation of the near glow, of a picture of 1080 lines; the far one is three times as wide. [4, 32] px
    float radius = 10.0f;
    /// How much of the glow is the far one. [0, 1]
    float spread = 0.3f;
    /// Colour of what comes back: red goes deepest. [0, 1]
    Rgb tint{1.0f, 0.3f, 0.1f};
    /// What comes back is missing where it came from: the picture has as much light as before.
    Toggle conserves_energy = true;
};

[[nodiscard]] const EffectInfo& effect_info(const Halation&);

}  // namespace darkroom
