// SPDX-License-Identifier: MIT
#pragma once
// Bloom: light above a threshold spreads around its source, by a pyramid of halved pictures that are filtered down,
// then up again and added. It is a glow of a fixed shape: no diffraction spikes, no lens flares, no dirt.

#include <vulkan/vulkan.h>

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class BloomMode : std::uint32_t {
    Additive,          ///< the glow is added to the picture
    EnergyConserving,  ///< the picture is mixed with its blurred self; no threshold
};

struct Bloom {
    float intensity = 0.04f;
    float threshold = 1.0f;
    float soft_threshold = 0.5f;
    Toggle firefly_filter = true;
    BloomMode mode = BloomMode::Additive;
    float scatter = 0.7f;
    std::int32_t levels = 5;
};

/// Levels that a picture of `extent` has: floor(log2(shorter side)) - 3 within [0, 5], so that the last one is at least
/// 8x8. Level i is 2^(i+1) times smaller than the picture.
[[nodiscard]] std::uint32_t bloom_level_count(VkExtent2D extent);

[[nodiscard]] const EffectInfo& effect_info(const Bloom&);

}  // namespace darkroom
