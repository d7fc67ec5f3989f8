// SPDX-License-Identifier: MIT
// What of the host's state a command buffer still has behind a recording: push constants, vertex and index buffers. All
// dynamic state is to be set anew, whatever kernels a plan has.

#include "compose/test_stacks/host.hpp"
#include "draw/pipeline.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

class ComposeDynamicState : public test::StackTest {};

constexpr std::string_view vertex_text =
    "#version 460\n"
    "layout(location = 0) in vec2 place;\n"
    "void main() { gl_Position = vec4(place, 0.0, 1.0); }\n";
constexpr std::string_view fragment_text =
    "#version 460\n"
    "layout(push_constant) uniform Constants { vec4 color; } constants;\n"
    "layout(location = 0) out vec4 result;\n"
    "void main() { result = constants.color; }\n";

/// A host's own pipeline, which blends by a constant that is dynamic.
struct HostPipeline {
    explicit HostPipeline(gpu::Context& context)
        : pipeline(test::must(gpu::Pipeline::create(context, {.name = "the host's",
                                                              .vertex = std::string(vertex_text),
                                                              .fragment = std::string(fragment_text),
                                                              .bindings = {{0, 8, VK_VERTEX_INPUT_RATE_VERTEX}},
                                                              .attributes = {{0, 0, VK_FORMAT_R32G32_SFLOAT, 0}},
                                                              .push_constant_size = 16,
                                                              .colors = {{.format = VK_FORMAT_R32G32B32A32_SFLOAT}},
                                                              .tests_depth = false,
                                                              .writes_depth = false}))),
          vertices(test::must(gpu::Buffer::create(context, 24, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                                                  gpu::Memory::Kind::Upload, "the host's vertices"))),
          indices(test::must(gpu::Buffer::create(context, 12, VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                                                 gpu::Memory::Kind::Upload, "the host's indices"))) {
        constexpr std::array<float, 6> places{-1, -1, 3, -1, -1, 3};
        constexpr std::array<std::uint32_t, 3> order{0, 1, 2};
        std::memcpy(vertices.memory.mapped, places.data(), sizeof places);
        std::memcpy(indices.memory.mapped, order.data(), sizeof order);
    }
    gpu::Pipeline pipeline;
    gpu::Buffer vertices, indices;
};

TEST_F(ComposeDynamicState, PushConstantsAndBuffersStayAndDynamicStateIsSetAnew) {
    Host host(test::random_display(16, 16, 4));
    gpu::Context& context = host.device.context();
    const gpu::Dispatch& vk = context.vk;
    const HostPipeline own(context);
    for (const KernelStage stage : {KernelStage::Raster, KernelStage::Compute}) {
        Composer composer(host.device);
        add(composer, "bloom", {{"intensity", 0.5}});
        add(composer, "exposure", {{"exposure", 0.5}});
        CompileDesc desc = host.compile_desc();
        desc.kernels = stage;
        test::must(composer.compile(desc));
        const std::array<float, 4> color{0.25f, 0.5f, 0.75f, 1};
        const VkRect2D part{{4, 4}, {8, 8}};
        const auto set_dynamic_state = [&](VkCommandBuffer commands, const VkRect2D& scissor) {
            const VkViewport viewport{0, 0, 16, 16, 0, 1};
            vk.CmdSetViewport(commands, 0, 1, &viewport);
            vk.CmdSetScissor(commands, 0, 1, &scissor);
        };
        test::must(gpu::submit_and_wait(context, "a host's frame", [&](VkCommandBuffer commands) {
            constexpr VkDeviceSize start = 0;
            vk.CmdBindVertexBuffers(commands, 0, 1, &own.vertices.handle, &start);
            vk.CmdBindIndexBuffer(commands, own.indices.handle, 0, VK_INDEX_TYPE_UINT32);
            set_dynamic_state(commands, {{0, 0}, {1, 1}});
            test::must(composer.record(commands, host.frame()));
            const VkRenderingAttachmentInfo attachment{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                                       .imageView = host.target.image.mip_views[0],
                                                       .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
                                                       .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                                       .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
            const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                            .renderArea = {{}, {16, 16}},
                                            .layerCount = 1,
                                            .colorAttachmentCount = 1,
                                            .pColorAttachments = &attachment};
            vk.CmdBeginRendering(commands, &rendering);
            vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, own.pipeline.handle);
            // lavapipe forgets them where a pipeline without any was bound; no kernel of ours pushes some.
            vk.CmdPushConstants(commands, own.pipeline.layout,
                                VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, 16, color.data());
            set_dynamic_state(commands, part);
            vk.CmdDrawIndexed(commands, 3, 1, 0, 0, 0);
            vk.CmdEndRendering(commands);
        }));
        const ReferenceImage out = host.read_target();
        EXPECT_EQ(out.at(8, 8).r, 0.25);
        EXPECT_EQ(out.at(8, 8).g, 0.5);
        EXPECT_NE(out.at(1, 1).b, 0.75) << "outside of the scissor";
    }
}

}  // namespace
}  // namespace darkroom
