// SPDX-License-Identifier: MIT
#pragma once
// Volumetric light: shafts of directional light in even haze, marched through each light's own shadow cascades. One
// scattering only, and the haze neither hides the scene nor casts a shadow: for that see fog.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class VolumetricDecay : std::uint32_t {
    PerMetre,  ///< of the way from the light's place in the air to the eye
    PerStep,   ///< of each thirty-second of the march, however long that is
};

struct Volumetric {
    /// Light that the haze scatters toward the camera, in hundredths a metre. [0, 1000]
    float density = 1.0f;
    /// Number of steps of the march. Brightness does not depend on it, smoothness does. [1, 256]
    std::int32_t samples = 32;
    /// Length of the march; the sky is marched as far. [0.01, 1000000] m
    float max_distance = 100.0f;
    /// Share of the light that is left after each metre, or after each thirty-second of the march. [0.01, 1]
    float decay = 0.994f;
    /// Length that `decay` counts for: a metre, or a thirty-second of the march.
    VolumetricDecay decay_form = VolumetricDecay::PerMetre;
};

[[nodiscard]] const EffectInfo& effect_info(const Volumetric&);

}  // namespace darkroom
