// SPDX-License-Identifier: MIT
#pragma once
// Halation: bright light goes through the emulsion, is thrown back by the film's base and exposes it once more, around
// itself, red first. It is the film's glow, not the lens's: for that there is bloom.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Halation {
    /// Share of the light that the film base throws back. [0, 1]
    float intensity = 0.3f;
    /// Light above this value is thrown back. [0, 65504]
    float threshold = 1.0f;
    /// Standard deviation of the near glow, in a picture of 1080 lines; the far one is three times as wide. [4, 32] px
    float radius = 10.0f;
    /// Share of the far glow in the whole. [0, 1]
    float spread = 0.3f;
    /// Colour of the light that comes back; red goes deepest into film. [0, 1]
    Rgb tint{1.0f, 0.3f, 0.1f};
    /// Takes the light that comes back from the place it came from, so that the picture keeps its light.
    Toggle conserves_energy = true;
};

[[nodiscard]] const EffectInfo& effect_info(const Halation&);

}  // namespace darkroom
