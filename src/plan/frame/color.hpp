// SPDX-License-Identifier: MIT
#pragma once
// How a step of a fused kernel gets the picture in a frame: as it is, or as code values of sRGB, which is decided by
// the state of the picture and what its effect works with. The chain of references decides by the same.

#include <darkroom/effect.hpp>

namespace darkroom::plan {

/// Members work_, work_scale_, work_limit_ and work_ootf_ of a step's block: what effects/shared/color_state.glsl
/// turns the picture's numbers into light by, and back.
struct Work {
    std::uint32_t word = 0;  ///< 0: as it is; else 1, the transfer from bit 1, the primaries from bit 4
    float scale = 1;         ///< from the picture's linear 1.0 to that of the step
    float limit = 65504;     ///< of the picture's linear numbers
    float ootf = 1;          ///< of HLG: the exponent of its OOTF
};
inline constexpr std::uint32_t work_words = 4;
inline constexpr std::uint32_t work_bits = 6;  ///< of Work::word

/// May the picture be anything but what the effect works with? `may_be_encoded`, `is_always_encoded`: what the
/// entries before it may make.
[[nodiscard]] bool may_need_work(const EffectInfo& info, bool may_be_encoded, bool is_always_encoded);
[[nodiscard]] Work work_of(const EffectInfo& info, const ColorState& before, const void* parameters);

/// "code values, Rec. 2020, PQ, white 203 cd/m2, up to 1000 cd/m2"
[[nodiscard]] std::string text_of(const ColorState& state);

}  // namespace darkroom::plan
