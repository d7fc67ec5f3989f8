// SPDX-License-Identifier: MIT
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/box_blur.hpp>
#include <string>

#include "box_blur/box_blur_reference.hpp"

namespace darkroom {

namespace {

constexpr auto box_blur_rows =
    describe(field<&BoxBlur::radius>("Half-width of the square; 0 leaves the picture as it is.", {0, 64}, unit::pixels)
                 .as_size_of<&BoxBlur::reach>()
                 .as_loop_count(),
             field<&BoxBlur::iterations>("Number of passes: 2 give a pyramid filter, 3 nearly a bell curve.", {1, 4})
                 .at_compile(),
             field<&BoxBlur::reach>(
                 "Pixels that the radius is measured in: those of the picture, or of a picture of 1080 lines."));

const BoxBlur& blur_of(const void* parameters) { return *static_cast<const BoxBlur*>(parameters); }

/// The direction; then of a radius in parts of the height its whole pixels and what is left.
template <bool is_horizontal>
void line_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const BoxBlur& blur = blur_of(parameters);
    const double radius = pixels_of(blur.reach, blur.radius, context.frame_extent.height);
    out[0] = {is_horizontal ? 1.0f : 0.0f, is_horizontal ? 0.0f : 1.0f, static_cast<float>(std::floor(radius)),
              static_cast<float>(radius - std::floor(radius))};
}

void build(PassBuilder& builder) {
    PassImage image = builder.picture();
    for (std::int32_t i = 1; i <= blur_of(builder.parameters()).iterations; ++i)
        for (const bool is_horizontal : {true, false}) {
            const std::string name = (is_horizontal ? "horizontal " : "vertical ") + std::to_string(i);
            image = builder.add({.name = name,
                                 .shader = "box_blur_line.glsl",
                                 .inputs = {{.name = "box_blur_input", .image = image}},
                                 .output = builder.create({.name = name}),
                                 .custom_vectors = 1,
                                 .constants = is_horizontal ? line_constants<true> : line_constants<false>});
        }
    builder.result(image);
}

}  // namespace

const EffectInfo& effect_info(const BoxBlur&) {
    static const EffectInfo info{
        .name = "box_blur",
        .doc = "Blurs the picture by the mean of a square.",
        .parameters = box_blur_rows.table(),
        .files = embedded_files("box_blur"),
        .touch = Touch::Neighbourhood,
        .accepts = Domains::all(),
        .flat = {.documented = 77, .scene_linear = 85},
        .build = build,
        .reference = box_blur_reference,
        .is_identity = [](const void* parameters) { return blur_of(parameters).radius == 0; },
    };
    return info;
}

}  // namespace darkroom
