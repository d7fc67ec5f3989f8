// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/box_blur.hpp>
#include <string>

#include "box_blur/box_blur_reference.hpp"

namespace darkroom {

namespace {

constexpr auto box_blur_rows =
    describe(field<&BoxBlur::radius>("Half-width of the square; 0 leaves the picture as it is.", {0, 64}, unit::pixels)
                 .as_loop_count(),
             field<&BoxBlur::iterations>(
                 "How many times the picture is blurred: 2 make a pyramid, 3 nearly a bell curve.", {1, 4})
                 .at_compile());

const BoxBlur& blur_of(const void* parameters) { return *static_cast<const BoxBlur*>(parameters); }

void horizontal_constants(const void*, const PassContext&, std::span<PassVector> out) { out[0] = {1, 0, 0, 0}; }
void vertical_constants(const void*, const PassContext&, std::span<PassVector> out) { out[0] = {0, 1, 0, 0}; }

void build(PassBuilder& builder) {
    PassImage image = builder.picture();
    for (std::int32_t i = 1; i <= blur_of(builder.parameters()).iterations; ++i)
        for (const bool is_horizontal : {true, false}) {
            const std::string name = (is_horizontal ? "horizontal " : "vertical ") + std::to_string(i);
            image = builder.add({.name = name,
                                 .shader = "box_blur_line.glsl",
                                 .inputs = {{.name = "box_blur_input", .image = image, .is_loaded = true}},
                                 .output = builder.create({.name = name}),
                                 .custom_vectors = 1,
                                 .constants = is_horizontal ? horizontal_constants : vertical_constants});
        }
    builder.result(image);
}

}  // namespace

const EffectInfo& effect_info(const BoxBlur&) {
    static const EffectInfo info{
        .name = "box_blur",
        .doc = "Blurs the picture by plain means of squares.",
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
