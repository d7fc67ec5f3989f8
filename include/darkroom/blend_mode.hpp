// SPDX-License-Identifier: MIT
#pragma once
// How one picture goes over another: the modes of stack entries and of the blend effect.
// effects/shared/blend_modes.glsl holds the formulas.

#include <cstdint>

namespace darkroom {

/// The order is that of the constants in effects/shared/blend_modes.glsl.
enum class BlendMode : std::uint32_t {
    Mix,  ///< the layer itself
    Add,
    Screen,
    Multiply,
    Lighten,
    Darken,
    Difference,
    Overlay,
    SoftLight,
};

}  // namespace darkroom
