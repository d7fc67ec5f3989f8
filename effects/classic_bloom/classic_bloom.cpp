// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <darkroom/effects/classic_bloom.hpp>

#include "classic_bloom/classic_bloom_reference.hpp"

namespace darkroom {

namespace {

constexpr std::uint32_t vectors = (classic_bloom_capacity + 3) / 4;

const ClassicBloom& bloom_of(const void* parameters) { return *static_cast<const ClassicBloom*>(parameters); }

void weight_constants(const void* parameters, const PassContext&, std::span<PassVector> out) {
    const auto weights = classic_bloom_weights(bloom_of(parameters).radius);
    for (std::size_t i = 0; i < out.size() * 4; ++i)
        out[i / 4][i % 4] = i < weights.size() ? static_cast<float>(weights[i]) : 0.0f;
}

void build(PassBuilder& builder) {
    const bool is_layer = bloom_of(builder.parameters()).source_kind == ClassicBloomSource::Layer;
    KernelPassDesc extract{.name = "extract",
                           .shader = is_layer ? "classic_bloom_layer.glsl" : "classic_bloom_bright.glsl",
                           .inputs = {{.name = "classic_bloom_source", .image = builder.source()}},
                           .output = builder.create({.name = "extracted", .denominator = 4})};
    if (is_layer) extract.inputs.push_back({.name = "classic_bloom_picture", .image = builder.picture()});
    const PassImage wide = builder.add({.name = "horizontal",
                                        .shader = "classic_bloom_horizontal.glsl",
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
        .doc = "What is cut out of the picture glows, by one separable blur.",
        .parameters = classic_bloom_rows.table(),
        .files = embedded_files("classic_bloom"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .build = build,
        .reference = classic_bloom_reference,
        .is_identity = [](const void* parameters) { return bloom_of(parameters).intensity == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
