// SPDX-License-Identifier: MIT
#pragma once
// How a step of a fused kernel gets the picture in a frame: as it is, or as code values of sRGB, which is decided by
// the state of the picture and what its effect works with; and how one that mixes pixels gets their light. The chain of references decides by the same. And what the
// target's kernel does last: the difference of the picture's state and the target's.

#include <darkroom/composer.hpp>
#include <darkroom/effect.hpp>

#include "plan/text/glsl.hpp"

namespace darkroom::plan {

/// Members work_, work_scale_, work_limit_ and work_ootf_ of a step's block: what effects/shared/color_state.glsl
/// turns the picture's numbers into light by, and back.
struct Work {
    std::uint32_t word = 0;  ///< 0: as it is; else 1, the transfer from bit 1, the primaries from bit 4
    float scale = 1;         ///< from the picture's linear 1.0 to that of the step
    float limit = 65504;     ///< of the picture's linear numbers
    float ootf = 1;          ///< of HLG: the exponent of its OOTF
};
inline constexpr std::uint32_t work_bits = 6;  ///< of Work::word

/// May the picture be anything but what the effect works with? `may_be_encoded`, `is_always_encoded`: what the
/// entries before it may make.
[[nodiscard]] bool may_need_work(const EffectInfo& info, bool may_be_encoded, bool is_always_encoded);
[[nodiscard]] Work work_of(const EffectInfo& info, const ColorState& before, const void* parameters);

/// Members finish_ and so on of the target's kernel.
struct Conversion {
    Finish kind = Finish::None;      ///< Convert, or one that is cheaper
    std::uint32_t from = 0, to = 0;  ///< as Work::word
    float scale = 1;                 ///< from the picture's linear 1.0 to that of the target
    float limit = 65504;             ///< of the target's linear numbers
    float ootf = 1, target_ootf = 1;

    /// Finish::OfFrame's member.
    [[nodiscard]] std::uint32_t word() const { return static_cast<std::uint32_t>(kind) | from << 2u | to << 8u; }
};
inline constexpr std::uint32_t conversion_bits = 14;  ///< of Conversion::word()
[[nodiscard]] Conversion conversion_of(const ColorState& from, const ColorState& to);

/// What the target's kernel does to a picture in this state: it is encoded exactly once, by a kernel or by the format.
[[nodiscard]] Conversion finish_of(const ColorState& picture, const CompileDesc& desc);
[[nodiscard]] Domain target_domain(const CompileDesc& desc);
/// What a frame's colour is: light, whose white is the target's.
[[nodiscard]] ColorState scene_state(const CompileDesc& desc);
/// Does an effect get the colours of a picture that `is_associated` divided by alpha, or turn them into light so?
[[nodiscard]] bool maps_without_alpha(const EffectInfo& info, bool is_wrapped, bool is_associated);
/// What the target's kernel does for alpha. A target that is not told keeps it as the frames have it.
[[nodiscard]] FinishAlpha finish_alpha(const CompileDesc& desc, Finish finish);
/// Errors: a target that cannot hold what it says.
[[nodiscard]] Result<> check_target_color(const CompileDesc& desc);

/// "code values, Rec. 2020, PQ, white 203 cd/m2, up to 1000 cd/m2"
[[nodiscard]] std::string text_of(const ColorState& state);

}  // namespace darkroom::plan
