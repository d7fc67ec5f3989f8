// SPDX-License-Identifier: MIT
#pragma once
// Lut: looks every colour up in a table (.cube and its like), as grading programs and cameras' makers hand them out. A
// table knows nothing of what its numbers mean: `space` says what it expects. For arithmetic that can be written down
// (exposure, contrast) a table is the worse choice: it is cut off at its ends and approximate between its entries.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

/// What a table is given; see lut.md for curves and primaries.
enum class LutSpace : std::uint32_t {
    Display,
    SceneLinear,
    Acescct,
    Logc3,
    Slog3,
    Logc4,
    Vlog,
    DavinciIntermediate,
    Linear
};
/// What a table gives.
enum class LutResult : std::uint32_t { Same, Display };
enum class LutInterpolation : std::uint32_t { Tetrahedral, Trilinear };

struct Lut {
    /// Table that colours are looked up in.
    Resource lut;
    /// Second table for the same space, which `fade` fades to.
    Resource fade_to;
    /// Share of the second table in the result. [0, 1]
    float fade = 0.0f;
    /// Share of the result that goes over the picture. [0, 1]
    float strength = 1.0f;
    /// Colours that the tables expect: sRGB code values, or scene-linear light, as it is (`linear`), in stops or
    /// through a curve of a camera.
    LutSpace space = LutSpace::Display;
    /// Colours that the tables give: the same kind that they expect, or sRGB code values for a display.
    LutResult result = LutResult::Same;
    /// Interpolation between the entries of a 3D table.
    LutInterpolation interpolation = LutInterpolation::Tetrahedral;
};

[[nodiscard]] const EffectInfo& effect_info(const Lut&);

}  // namespace darkroom
