// SPDX-License-Identifier: MIT
#pragma once
// Sharpening that adapts to contrast: each pixel moves away from its four neighbours as far as the range of values
// allows, and never beyond what they and it span. It gives back what a filter took; it cannot tell detail from noise,
// so grain belongs behind it.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class SharpenMode : std::uint32_t {
    Rcas,  ///< robust contrast-adaptive sharpening: for what an upscaler leaves
    Cas,   ///< contrast-adaptive sharpening: softer, and less of what stands alone
};

struct Sharpen {
    /// Published method that sharpens.
    SharpenMode mode = SharpenMode::Rcas;
    /// Reduction of the strength, in stops: 0 is the most that the method allows, each stop halves it. [-8, 0]
    float stops = -0.5f;
};

[[nodiscard]] const EffectInfo& effect_info(const Sharpen&);

}  // namespace darkroom
