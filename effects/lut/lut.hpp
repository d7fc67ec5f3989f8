// SPDX-License-Identifier: MIT
#pragma once
// Lut: looks every colour up in a table (.cube and its like), as grading programs and cameras' makers hand them out. A
// table knows nothing of what its numbers mean: `space` says what it expects. For arithmetic that can be written down
// (exposure, contrast) a table is the worse choice: it is cut off at its ends and approximate between its entries.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

/// What a table is given; see lut.md for curves and primaries.
enum class LutSpace : std::uint32_t { Display, SceneLinear, Acescct, Logc3, Slog3, Logc4, Vlog, DavinciIntermediate };
/// What a table gives.
enum class LutResult : std::uint32_t { Same, Display };
enum class LutInterpolation : std::uint32_t { Tetrahedral, Trilinear };

struct Lut {
    /// The table that colours are looked up in.
    Resource lut;
    /// Another table, for the same space, to fade to.
    Resource fade_to;
    /// How far the picture has faded to the other table. [0, 1]
    float fade = 0.0f;
    /// How much of the result goes over the picture. [0, 1]
    float strength = 1.0f;
    /// What the tables are given: sRGB code values, or scene-linear light by a curve.
    LutSpace space = LutSpace::Display;
    /// What the tables give: the same as they are given, or sRGB code values for a display.
    LutResult result = LutResult::Same;
    /// How a 3D table is read between its entries.
    LutInterpolation interpolation = LutInterpolation::Tetrahedral;
};

[[nodiscard]] const EffectInfo& effect_info(const Lut&);

}  // namespace darkroom
