// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/smaa.hpp>

#include "shared/scene_images.hpp"
#include "smaa/smaa_reference.hpp"

namespace darkroom {

namespace {

constexpr auto smaa_rows = describe(
    field<&Smaa::quality>("Length of the search for the ends of an edge."),
    field<&Smaa::detection>("Quantity that is compared to find edges."),
    field<&Smaa::threshold>("Difference of code values, or of their luma, that makes an edge.", {0.02, 0.5}),
    field<&Smaa::contrast>("Ratio to a stronger neighbouring edge at which an edge is dropped.", {1, 8}),
    field<&Smaa::corner_rounding>(
        "Share of the smoothing that corners get: 0 keeps corners as they are, 1 rounds them.", {0, 1}),
    field<&Smaa::predication>(
        "Amount by which jumps of the frame's depth lower the threshold, and its absence raises it; 0 reads no depth.",
        {0, 1})
        .at_compile());

void build(PassBuilder& builder) {
    const bool has_depth = static_cast<const Smaa*>(builder.parameters())->predication > 0.0f &&
                           builder.has_frame_image(FrameImage::Depth);
    KernelPassDesc edges{.name = "edges",
                         .shader = has_depth ? "smaa.glsl#edges_depth" : "smaa.glsl#edges",
                         .inputs = {{.name = "smaa_picture", .image = builder.picture()}},
                         .output = builder.create({.name = "edges", .format = VK_FORMAT_R8G8_UNORM})};
    if (has_depth) {
        edges.inputs.push_back({.name = "smaa_depth", .image = builder.frame_image(FrameImage::Depth)});
        edges.custom_vectors = 2;
        edges.constants = depth_vectors;
    }
    const PassImage found = builder.add(edges);
    const PassImage weights =
        builder.add({.name = "weights",
                     .shader = "smaa.glsl#weights",
                     .inputs = {{.name = "smaa_edges", .image = found}},
                     .output = builder.create({.name = "weights", .format = VK_FORMAT_R8G8B8A8_UNORM})});
    builder.side("smaa_weights", weights, {0, 0, 0, 0});
}

}  // namespace

const EffectInfo& effect_info(const Smaa&) {
    static const EffectInfo info{
        .name = "smaa",
        .doc = "Smooths the stairs of edges by the lines that they stand for.",
        .parameters = smaa_rows.table(),
        .files = embedded_files("smaa"),
        .touch = Touch::Warp,
        .accepts = Domains::only(Domain::DisplayLinear) | Domains::only(Domain::Encoded),
        .flat = {.documented = 94, .scene_linear = 94},
        .works = {.in = WorkingSpace::Light},
        .build = build,
        .reference = smaa_reference,
    };
    return info;
}

}  // namespace darkroom
