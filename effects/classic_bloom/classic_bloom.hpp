// SPDX-License-Identifier: MIT
#pragma once
// Classic bloom: what shall glow is cut out into a small picture, blurred along its lines into a larger one and along
// the columns at full size, and added. One round glow of one width; for one with a long tail see bloom.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class ClassicBloomSource : std::uint32_t {
    Hdr,       ///< what light has above the threshold
    HighPass,  ///< light above the threshold as it is; all else is black
    Layer,     ///< the picture, where the grey picture that `source` names is bright
};

struct ClassicBloom {
    /// Amount of the glow added to the picture. [0, 16]
    float intensity = 0.5f;
    /// Source of the glow: light above the threshold, or the layer that the entry's `source` names, for example alpha.
    ClassicBloomSource source_kind = ClassicBloomSource::Hdr;
    /// Light above this value glows; the source layer ignores it. [0, 65504]
    float threshold = 1.0f;
    /// Half-width of the glow. [7, 64] px
    std::int32_t radius = 16;
    /// Pixels that the radius is measured in: those of the picture, or of a picture of 1080 lines.
    Reach reach = Reach::Pixels;
};

[[nodiscard]] const EffectInfo& effect_info(const ClassicBloom&);

}  // namespace darkroom
