// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/classic_bloom.hpp>

#include "classic_bloom/classic_bloom_reference.hpp"

namespace darkroom {

namespace {

constexpr auto classic_bloom_rows =
    describe(field<&ClassicBloom::intensity>("Amount of the glow added to the picture.", {0, 16}).as_amount(),
             field<&ClassicBloom::source_kind>("Source of the glow: light above the threshold, or the layer that the "
                                               "entry's `source` names, for example alpha.")
                 .at_compile(),
             field<&ClassicBloom::threshold>("Light above this value glows; the source layer ignores it.", {0, 65504}),
             field<&ClassicBloom::radius>("Half-width of the glow.", {7, 64}, unit::pixels)
                 .as_size_of<&ClassicBloom::reach>()
                 .as_loop_count(),
             field<&ClassicBloom::reach>(
                 "Pixels that the radius is measured in: those of the picture, or of a picture of 1080 lines."));

/// The weights; the last number of all is that of taps to one side.
constexpr std::uint32_t vectors = classic_bloom_capacity / 4 + 1;

const ClassicBloom& bloom_of(const void* parameters) { return *static_cast<const ClassicBloom*>(parameters); }

void weight_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const double radius = classic_bloom_radius(bloom_of(parameters), context.frame_extent.height);
    const auto weights = classic_bloom_weights(radius);
    for (std::size_t i = 0; i < out.size() * 4; ++i)
        out[i / 4][i % 4] = i < weights.size() ? static_cast<float>(weights[i]) : 0.0f;
    out.back()[3] = static_cast<float>(classic_bloom_taps(radius));
}

void build(PassBuilder& builder) {
    const bool is_layer = bloom_of(builder.parameters()).source_kind == ClassicBloomSource::Layer;
    KernelPassDesc extract{.name = "extract",
                           .shader = is_layer ? "classic_bloom.glsl#layer" : "classic_bloom.glsl#bright",
                           .inputs = {{.name = "classic_bloom_source", .image = builder.source()}},
                           .output = builder.create({.name = "extracted", .denominator = 4})};
    if (is_layer) extract.inputs.push_back({.name = "classic_bloom_picture", .image = builder.picture()});
    const PassImage wide = builder.add({.name = "horizontal",
                                        .shader = "classic_bloom.glsl#horizontal",
                                        .inputs = {{.name = "classic_bloom_small", .image = builder.add(extract)}},
                                        .output = builder.create({.name = "wide", .denominator = 2}),
                                        .custom_vectors = vectors,
                                        .constants = weight_constants});
    builder.side("classic_bloom_wide", wide, {0, 0, 0, 0});
    builder.end_constants(vectors, weight_constants);
}

}  // namespace

const EffectInfo& effect_info(const ClassicBloom&) {
    static const EffectInfo info{
        .name = "classic_bloom",
        .doc = "Adds the glow of light that is cut out of the picture, by one separable blur.",
        .parameters = classic_bloom_rows.table(),
        .files = embedded_files("classic_bloom"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .flat = {.documented = 52, .scene_linear = 63},
        .build = build,
        .reference = classic_bloom_reference,
        .is_identity = [](const void* parameters) { return bloom_of(parameters).intensity == 0.0f; },
        .threshold = [](const void* parameters) -> std::optional<float> {
            const ClassicBloom& bloom = bloom_of(parameters);
            if (bloom.intensity == 0.0f || bloom.source_kind == ClassicBloomSource::Layer) return {};
            return bloom.threshold;
        },
    };
    return info;
}

}  // namespace darkroom
