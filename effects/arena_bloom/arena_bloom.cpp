// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/arena_bloom.hpp>
#include <string>

#include "arena_bloom/arena_bloom_reference.hpp"

namespace darkroom {

namespace {

constexpr auto arena_bloom_rows = describe(
    field<&ArenaBloom::intensity>("Amount of the glow added to the picture.", {0, 4}).as_amount(),
    field<&ArenaBloom::source_kind>(
        "Light that glows: masked limits colour to a display's range and lets alpha mask it, plain takes it as it is."),
    field<&ArenaBloom::reach>("Unit of the glow's width: pixels, as in the game, or parts of the picture's height."));

/// Of each level, for a glow in parts of the height.
void weight_constants(const void* /*parameters*/, const PassContext& context, std::span<PassVector> out) {
    const auto weights = arena_bloom_weights(context.frame_extent.height);
    for (std::size_t i = 0; i < out.size() * 4; ++i)
        out[i / 4][i % 4] = i < weights.size() ? static_cast<float>(weights[i]) : 0.0f;
}

void build(PassBuilder& builder) {
    const auto create = [&](std::string name, std::uint32_t denominator) {
        return builder.create({.name = std::move(name), .denominator = denominator});
    };
    PassImage image = builder.add({.name = "bright part",
                                   .shader = "arena_bloom.glsl#bright",
                                   .inputs = {{.name = "arena_bloom_source", .image = builder.source()}},
                                   .output = create("bright part", 4)});
    const std::uint32_t levels = builder.from_max_extent(arena_bloom_level_count);
    // The 3x3 filter (1 2 1 / 2 4 2 / 1 2 1) / 16 of bilinear taps one texel apart is the tent that halves.
    KernelPassDesc combine{.name = "combine",
                           .shader = "arena_bloom.glsl#combine",
                           .output = create("combine", 4),
                           .custom_vectors = 2,
                           .constants = weight_constants};
    for (std::uint32_t level = 0; level < arena_bloom_max_levels; ++level) {
        const std::string number = std::to_string(level);
        // Of those that are not there the weight is 0.
        if (level < levels)
            image = builder.add({.name = "halve " + number,
                                 .shader = "shared/halve.glsl",
                                 .inputs = {{.name = "halve_input", .image = image}},
                                 .output = create("level " + number, 8u << level)});
        combine.inputs.push_back({.name = "arena_bloom_level_" + number, .image = image});
    }
    const PassImage glow = builder.add({.name = "double",
                                        .shader = "shared/double.glsl",
                                        .inputs = {{.name = "double_input", .image = builder.add(combine)}},
                                        .output = create("glow", 2)});
    builder.side("arena_bloom_glow", glow, {0, 0, 0, 0});
}

}  // namespace

const EffectInfo& effect_info(const ArenaBloom&) {
    static const EffectInfo info{
        .name = "arena_bloom",
        .doc = "Adds the glow of bright parts, as in a fighting game.",
        .parameters = arena_bloom_rows.table(),
        .files = embedded_files("arena_bloom"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 54, .scene_linear = 64},
        .build = build,
        .reference = arena_bloom_reference,
        .is_identity =
            [](const void* parameters) { return static_cast<const ArenaBloom*>(parameters)->intensity == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
