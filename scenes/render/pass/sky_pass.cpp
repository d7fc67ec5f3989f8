// SPDX-License-Identifier: MIT
#include "render/pass/sky_pass.hpp"

#include "gpu/device/context.hpp"
#include "render/shader_text.hpp"

namespace darkroom::render {

namespace {

gpu::PipelineDesc sky_desc(const PassSetup& setup) {
    const gpu::ColorTarget opaque{.writes =
                                      setup.formats.has_alpha_layer ? color_without_alpha : gpu::ColorTarget{}.writes};
    return {.name = "sky",
            .vertex = shader_text("sky_vertex.glsl"),
            .fragment = shader_text("sky_fragment.glsl"),
            .sets = {setup.frame_layout},
            .specialization = {setup.has_environment ? 1U : 0U, static_cast<std::uint32_t>(setup.output)},
            .colors = setup.formats.colors(opaque, TargetFormats::Layers::Written),
            .depth = setup.formats.depth,
            .samples = setup.formats.samples,
            .writes_depth = false};
}

/// Set back by one pixel's worth of slope and a few of the smallest steps of depth: a floor in the plane of the grid,
/// drawn from other triangles, has the same depth but for rounding.
gpu::PipelineDesc grid_desc(const PassSetup& setup) {
    const gpu::ColorTarget blended{.is_blended = true,
                                   .source = VK_BLEND_FACTOR_SRC_ALPHA,
                                   .destination = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                                   .writes = color_without_alpha};
    return {.name = "grid",
            .vertex = shader_text("grid_vertex.glsl"),
            .fragment = shader_text("grid_fragment.glsl"),
            .sets = {setup.frame_layout},
            .colors = setup.formats.colors(blended, TargetFormats::Layers::Kept),
            .depth = setup.formats.depth,
            .samples = setup.formats.samples,
            .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
            .writes_depth = false,
            .depth_bias = -16,
            .depth_bias_slope = -1};
}

void draw(const gpu::Pipeline& pipeline, VkCommandBuffer commands, VkDescriptorSet frame_set, std::uint32_t vertices) {
    const gpu::Dispatch& vk = pipeline.context->vk;
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
    vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout, 0, 1, &frame_set, 0, nullptr);
    vk.CmdDraw(commands, vertices, 1, 0, 0);
}

}  // namespace

Result<SkyPass> SkyPass::create(gpu::Context& context, const PassSetup& setup) {
    SkyPass pass;
    DARKROOM_TRY_VALUE(gpu::Pipeline sky, gpu::Pipeline::create(context, sky_desc(setup)));
    DARKROOM_TRY_VALUE(gpu::Pipeline grid, gpu::Pipeline::create(context, grid_desc(setup)));
    pass.sky_ = std::move(sky);
    pass.grid_ = std::move(grid);
    return pass;
}

void SkyPass::record_sky(VkCommandBuffer commands, VkDescriptorSet frame_set) const {
    draw(sky_, commands, frame_set, 3);
}

void SkyPass::record_grid(VkCommandBuffer commands, VkDescriptorSet frame_set) const {
    draw(grid_, commands, frame_set, 4);
}

}  // namespace darkroom::render
