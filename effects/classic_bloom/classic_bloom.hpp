// SPDX-License-Identifier: MIT
#pragma once
// Classic bloom: what shall glow is cut out into a small picture, blurred along its lines into a larger one and along
// the columns at full size, and added. One round glow of one width; for one with a long tail see bloom.

#include <darkroom/effect.hpp>

namespace darkroom {

enum class ClassicBloomSource : std::uint32_t {
    Hdr,       ///< what light has above the threshold
    HighPass,  ///< light above the threshold as it is; all else is black
    Layer,     ///< the picture, where the grey picture that `source` names is bright
};

struct ClassicBloom {
    float intensity = 0.5f;
    ClassicBloomSource source_kind = ClassicBloomSource::Hdr;
    float threshold = 1.0f;
    std::int32_t radius = 16;
};
inline constexpr auto classic_bloom_rows = describe(
    field<&ClassicBloom::intensity>("How much of the glow is added.", {0, 16}).as_amount(),
    field<&ClassicBloom::source_kind>("What glows; the layer is named by the entry's source, for example alpha.")
        .at_compile(),
    field<&ClassicBloom::threshold>("Light above this glows; not used with a layer.", {0, 65504}),
    field<&ClassicBloom::radius>("Half-width of the glow, which is not below 7.", {1, 64}, unit::pixels)
        .as_loop_count());

[[nodiscard]] const EffectInfo& effect_info(const ClassicBloom&);

}  // namespace darkroom
