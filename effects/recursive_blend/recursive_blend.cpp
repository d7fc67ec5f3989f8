// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/recursive_blend.hpp>

#include "recursive_blend/recursive_blend_reference.hpp"

namespace darkroom {

namespace {

constexpr auto recursive_blend_rows = describe(
    field<&RecursiveBlend::weight>("Share of the past that remains after 1/60 s.", {0, 0.99}),
    field<&RecursiveBlend::precision>("Format that keeps the past: 32-bit floats, or 8 bits that leave a ghost.")
        .at_compile());

const RecursiveBlend& blend_of(const void* parameters) { return *static_cast<const RecursiveBlend*>(parameters); }

void mix_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const RecursiveBlend& blend = blend_of(parameters);
    const double kept = std::pow(double{blend.weight}, 60 * context.delta_time);
    const bool is_coarse = blend.precision == RecursiveBlendPrecision::EightBit;
    out[0] = {context.has_history ? static_cast<float>(kept) : 0.0f, is_coarse ? 255.0f : 0.0f, 0, 0};
}

void build(PassBuilder& builder) {
    const bool is_coarse = blend_of(builder.parameters()).precision == RecursiveBlendPrecision::EightBit;
    const PassBuilder::History history = builder.history(
        {.name = "trail", .format = is_coarse ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_R32G32B32A32_SFLOAT});
    builder.result(builder.add({.name = "mix",
                                .shader = "recursive_blend_mix.glsl",
                                .inputs = {{.name = "recursive_blend_picture", .image = builder.picture()},
                                           {.name = "recursive_blend_past", .image = history.previous}},
                                .output = history.current,
                                .custom_vectors = 1,
                                .constants = mix_constants}));
}

/// The frames before the first one are missing with the weight that they would have. In 8 bits light that was there
/// before them may have left a ghost, which no later frame tells of.
std::uint32_t pre_roll(const void* parameters, double delta_time) {
    constexpr double half_a_code = 0.5 / 255;
    const double of_a_frame = std::log(double{blend_of(parameters).weight}) * 60 * delta_time;
    return static_cast<std::uint32_t>(std::min(std::ceil(std::log(half_a_code) / of_a_frame), 1e9));
}

}  // namespace

const EffectInfo& effect_info(const RecursiveBlend&) {
    static const EffectInfo info{
        .name = "recursive_blend",
        .doc = "Mixes every frame with the result of the one before: trails that fade.",
        .parameters = recursive_blend_rows.table(),
        .files = embedded_files("recursive_blend"),
        .touch = Touch::History,
        .accepts = Domains::all(),
        .flat = {.documented = 43, .scene_linear = 44},
        .build = build,
        .reference = recursive_blend_reference,
        .is_identity = [](const void* parameters) { return blend_of(parameters).weight == 0.0f; },
        .pre_roll = pre_roll,
    };
    return info;
}

}  // namespace darkroom
