// SPDX-License-Identifier: MIT
#pragma once
// Kawase's blur, and the one that grew out of it: very wide blurs by a few bilinear taps a pass. The width goes in
// steps, and the shape is only nearly round; for a blur of a given width take gaussian_blur.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class KawaseBlurMode : std::uint32_t {
    Dual,    ///< down through halved pictures and up again
    Kawase,  ///< at full size, each pass reaching farther than the one before
};

struct KawaseBlur {
    /// Filter: dual halves the picture and brings it back, kawase works at full size.
    KawaseBlurMode mode = KawaseBlurMode::Dual;
    /// Number of halvings for dual, of passes for kawase. [1, 8]
    std::int32_t iterations = 3;
    /// Distance between taps, relative to the published one; at 0 kawase has no width. [0, 2]
    float offset = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const KawaseBlur&);

}  // namespace darkroom
