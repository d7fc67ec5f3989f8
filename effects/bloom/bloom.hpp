// SPDX-License-Identifier: MIT
#pragma once
// Bloom: light above a threshold spreads around its source, by a pyramid of halved pictures that are filtered down,
// then up again and added. It is a glow of a fixed shape: no diffraction spikes, no lens flares, no dirt.

#include <vulkan/vulkan.h>

#include <array>
#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class BloomMode : std::uint32_t {
    Additive,          ///< the glow is added to the picture
    EnergyConserving,  ///< the picture is mixed with its blurred self; no threshold
};

struct Bloom {
    /// Amount of the glow added; with energy_conserving, share of the glow in the mix, where 1 and more leave the glow
    /// alone. [0, 16]
    float intensity = 0.04f;
    /// Light above this value glows; energy_conserving ignores it. [0, 65504]
    float threshold = 1.0f;
    /// Width of the soft knee, as a share of the threshold; 0 is a hard edge. [0, 1]
    float soft_threshold = 0.5f;
    /// Weights the first level by inverse luminance, so that single bright pixels do not flicker; energy_conserving
    /// ignores it and keeps their light.
    Toggle firefly_filter = true;
    /// Way to join the glow: additive adds it, energy_conserving mixes the picture with it.
    BloomMode mode = BloomMode::Additive;
    /// Weight of each wider level relative to the narrower one, with energy_conserving. [0, 1]
    float scatter = 0.7f;
    /// Number of pyramid levels at a height of 1080, each twice as wide; with reach = pixels, the largest number at any
    /// height. [1, 5]
    std::int32_t levels = 5;
    /// Unit of the glow's width: parts of the picture's height, or pixels.
    Reach reach = Reach::Height;
};

/// Levels that a picture of `extent` has by pixels: floor(log2(shorter side)) - 3 within [0, 5], so that the last one
/// is at least 8x8. Level i is 2^(i+1) times smaller than the picture.
[[nodiscard]] std::uint32_t bloom_level_count(VkExtent2D extent);

/// What each level counts in the sum of a picture of `extent`, finest first.
struct BloomWeights {
    static constexpr std::uint32_t capacity = 10;
    std::uint32_t count = 0;
    std::array<double, capacity> weights{};
    [[nodiscard]] double total() const;
};
[[nodiscard]] BloomWeights bloom_weights(const Bloom& bloom, VkExtent2D extent);

[[nodiscard]] const EffectInfo& effect_info(const Bloom&);

}  // namespace darkroom
