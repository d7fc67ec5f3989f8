// SPDX-License-Identifier: MIT
#pragma once
// FilmGrain: the grain of film, in code values, as the last thing that happens to a picture before dither. It keeps the
// mean of every tone, is as coarse and as strong at every size of the picture, and stands still unless it is told to
// move. It is not what hides the steps of 8 bits: that is dither.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class FilmGrainModel : std::uint32_t {
    Film,  ///< discs that cover each other: Newson et al., "Realistic Film Grain Rendering", 2017
    Av1,   ///< a filtered Gaussian noise in blocks of 32x32: AV1 specification, section 7.18.3
};

struct FilmGrain {
    /// Standard deviation of the grain on mid-grey, in a picture of 1080 lines, in units of the encoded range. [0,
    /// 0.25]
    float amount = 0.03f;
    /// Size of a grain, in a picture of 1080 lines. [0.5, 16] px
    float size = 1.5f;
    /// Share of coloured grain: at 0 all channels have the same grain, at 1 each has its own. [0, 1]
    float color = 0.3f;
    /// Factor of the grain at a quarter of the encoded range. [0, 4]
    float shadows = 1.0f;
    /// Factor of the grain at half of the encoded range. [0, 4]
    float midtones = 1.0f;
    /// Factor of the grain at three quarters of the encoded range. [0, 4]
    float highlights = 1.0f;
    /// Model of the grain: film draws overlapping discs, av1 filters Gaussian noise.
    FilmGrainModel model = FilmGrainModel::Film;
    /// Changes the grain in each frame.
    Toggle animated = false;
};

[[nodiscard]] const EffectInfo& effect_info(const FilmGrain&);

}  // namespace darkroom
