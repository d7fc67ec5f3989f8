// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/upscale.hpp>

#include "upscale/upscale_reference.hpp"

namespace darkroom {

namespace {

constexpr auto upscale_rows = describe(field<&Upscale::adaption>(
    "Strength with which the filter follows edges: 1 as published, 0 the same filter everywhere.", {0, 1}));

void build(PassBuilder& builder) {
    builder.result(builder.add(
        {.name = "upscale",
         .shader = "upscale_easu.glsl",
         .inputs = {{.name = "upscale_picture", .image = builder.picture()}},
         .output = builder.create({.name = "upscaled", .format = VK_FORMAT_UNDEFINED, .is_of_output = true})}));
}

}  // namespace

const EffectInfo& effect_info(const Upscale&) {
    static const EffectInfo info{
        .name = "upscale",
        .doc = "Brings a picture of fewer pixels to the output's size, along its edges.",
        .parameters = upscale_rows.table(),
        .files = embedded_files("upscale"),
        .touch = Touch::Neighbourhood,
        .accepts = Domains::only(Domain::DisplayLinear) | Domains::only(Domain::Encoded),
        .flat = {.documented = 96, .scene_linear = 96},
        .output_scale = {.is_of_output = true},
        .build = build,
        .reference = upscale_reference,
    };
    return info;
}

}  // namespace darkroom
