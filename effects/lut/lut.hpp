// SPDX-License-Identifier: MIT
#pragma once
// Lut: looks every colour up in a table (.cube and its like), as grading programs and cameras' makers hand them out. A
// table knows nothing of what its numbers mean: `space` says what it expects. For arithmetic that can be written down
// (exposure, contrast) a table is the worse choice: it is cut off at its ends and approximate between its entries.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

/// What a table is given; see lut.md for curves and primaries.
enum class LutSpace : std::uint32_t { Display, SceneLinear, Acescct, Logc3, Slog3 };
/// What a table gives.
enum class LutResult : std::uint32_t { Same, Display };
enum class LutInterpolation : std::uint32_t { Tetrahedral, Trilinear };

struct Lut {
    Resource lut;
    Resource fade_to;
    float fade = 0.0f;
    float strength = 1.0f;
    LutSpace space = LutSpace::Display;
    LutResult result = LutResult::Same;
    LutInterpolation interpolation = LutInterpolation::Tetrahedral;
};

[[nodiscard]] const EffectInfo& effect_info(const Lut&);

}  // namespace darkroom
