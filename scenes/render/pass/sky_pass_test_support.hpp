// SPDX-License-Identifier: MIT
#pragma once
// For tests only: targets, depth and descriptor set 0 for a single pass of the scene, without a renderer, and cameras
// for it.

#include <functional>
#include <optional>

#include "gpu/test_run.hpp"
#include "render/frame_set.hpp"
#include "render/light/environment.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::render::test {

using gpu::test::must;
using scene::mat4;
using scene::vec2;
using scene::vec3;
using scene::vec4;

/// Reversed depth, y down, as Snapshot has it.
inline mat4 perspective(float vertical_degrees, float aspect, float near_distance = 0.1F, float far_distance = 1000) {
    mat4 projection = glm::perspective(glm::radians(vertical_degrees), aspect, far_distance, near_distance);
    projection[1] *= -1.0F;
    return projection;
}

inline mat4 orthographic(float height, float aspect, float near_distance = 0.1F, float far_distance = 1000) {
    const float y = height / 2, x = y * aspect;
    mat4 projection = glm::ortho(-x, x, -y, y, far_distance, near_distance);
    projection[1] *= -1.0F;
    return projection;
}

inline scene::CameraState camera(vec3 eye, vec3 target, const mat4& projection, vec3 up = vec3(0, 1, 0)) {
    scene::CameraState state;
    state.view = state.previous_view = glm::lookAt(eye, target, up);
    state.projection = state.previous_projection = projection;
    state.position = eye;
    state.kind = projection[2][3] == 0 ? scene::Projection::Orthographic : scene::Projection::Perspective;
    return state;
}

/// Where a point is in the picture, in pixels from its upper left corner.
inline vec2 project(const mat4& view_projection, vec4 point, VkExtent2D extent) {
    const vec4 clip = view_projection * point;
    return (vec2(clip) / clip.w * 0.5F + 0.5F) *
           vec2(static_cast<float>(extent.width), static_cast<float>(extent.height));
}

class Stage {
  public:
    explicit Stage(VkExtent2D size, const std::optional<Picture>& sky = std::nullopt, const TargetFormats& wanted = {})
        : extent(size), formats(wanted), environment(must(GpuEnvironment::create(context, sky))) {
        color = gpu::test::blank(context, extent, formats.color);
        normals = gpu::test::blank(context, extent, formats.normals);
        velocity = gpu::test::blank(context, extent, formats.velocity);
        depth.image = must(gpu::Image::create(
            context, {.name = "depth",
                      .format = formats.depth,
                      .extent = {extent.width, extent.height, 1},
                      .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
        block_buffer = must(gpu::Buffer::create(context, sizeof(blocks::Frame),
                                                VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                                gpu::Memory::Kind::Upload, "frame block"));
        sets = must(gpu::DescriptorSets::create(context, {&frame_layout.handle, 1}));
        write_descriptors();
        frame.modes = {static_cast<std::uint32_t>(Output::Hdr), 0, 0, 0};
        frame.environment_settings = {1, static_cast<float>(environment.levels - 1), 0, 0};
        for (std::size_t i = 0; i < 9; ++i) frame.irradiance[i] = vec4(environment.irradiance[i], 0);
    }

    [[nodiscard]] PassSetup setup() const {
        return {.frame_layout = frame_layout.handle,
                .formats = formats,
                .output = formats.has_layers ? Output::Hdr : Output::Display,
                .has_environment = environment.is_given};
    }
    [[nodiscard]] float aspect() const { return static_cast<float>(extent.width) / static_cast<float>(extent.height); }

    void look(const scene::CameraState& state) {
        frame.view = state.view;
        frame.projection = state.projection;
        frame.view_projection = state.projection * state.view;
        frame.previous_view_projection = state.previous_projection * state.previous_view;
        frame.inverse_view_projection = glm::inverse(frame.view_projection);
        frame.camera_position = vec4(state.position, state.kind == scene::Projection::Perspective ? 1 : 0);
        frame.camera_forward = -vec4(state.view[0].z, state.view[1].z, state.view[2].z, 0);
        const vec2 size(extent.width, extent.height);
        frame.target_size = vec4(size, 1.0F / size);
        frame.planes = {state.near_distance, state.far_distance, 0, 1};
    }

    /// Clears the targets to `clear_color`, normals and velocity to 7, depth to `clear_depth`, and calls
    /// draw(commands, set 0).
    void render(const std::function<void(VkCommandBuffer, VkDescriptorSet)>& draw, vec4 clear_color = vec4(0),
                float clear_depth = 0) {
        std::memcpy(block_buffer.memory.mapped, &frame, sizeof frame);
        must(gpu::submit_and_wait(context, "rendering a test", [&](VkCommandBuffer commands) {
            for (gpu::test::Picture* picture : {&color, &normals, &velocity}) {
                gpu::transition(context, commands, picture->image, picture->layout,
                                VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
                picture->layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
            }
            gpu::transition(context, commands, depth.image, depth.layout, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
            depth.layout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
            begin(commands, clear_color, clear_depth);
            draw(commands, sets.sets[0]);
            context.vk.CmdEndRendering(commands);
        }));
    }

    gpu::Context& context = gpu::test::context();
    VkExtent2D extent;
    TargetFormats formats;
    gpu::SetLayout frame_layout = must(create_frame_layout(context));
    GpuEnvironment environment;
    blocks::Frame frame{};
    gpu::test::Picture color, normals, velocity, depth;

  private:
    /// Lavapipe reads every descriptor of a set, used or not: those without a meaning here get any resource.
    void write_descriptors() const {
        const VkDescriptorBufferInfo buffer{.buffer = block_buffer.handle, .range = VK_WHOLE_SIZE};
        const std::array images{&environment.split_sum, &environment.prefiltered, &environment.skybox,
                                &environment.split_sum};
        for (std::uint32_t binding = 0; binding < frame_bindings; ++binding) {
            const VkDescriptorImageInfo picture{environment.sampler, images[binding < 8 ? 0 : binding - 8]->view,
                                                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
            std::array<VkDescriptorImageInfo, shadow_images> pictures{};
            pictures.fill(picture);
            VkDescriptorType type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
            if (binding < 8) type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            if (binding < 3) type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
            const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                             .dstSet = sets.sets[0],
                                             .dstBinding = binding,
                                             .descriptorCount = binding == 8 ? shadow_images : 1,
                                             .descriptorType = type,
                                             .pImageInfo = pictures.data(),
                                             .pBufferInfo = &buffer};
            context.vk.UpdateDescriptorSets(context.device, 1, &write, 0, nullptr);
        }
    }

    void begin(VkCommandBuffer commands, vec4 clear_color, float clear_depth) const {
        const auto attachment = [](VkImageView view, VkImageLayout layout, VkClearValue clear) {
            return VkRenderingAttachmentInfo{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = view,
                                             .imageLayout = layout,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                             .clearValue = clear};
        };
        const VkClearValue first{.color = {.float32 = {clear_color.r, clear_color.g, clear_color.b, clear_color.a}}};
        const VkClearValue others{.color = {.float32 = {7, 7, 7, 7}}};
        constexpr VkImageLayout layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        const std::array colors{attachment(color.image.view, layout, first),
                                attachment(normals.image.view, layout, others),
                                attachment(velocity.image.view, layout, others)};
        const VkRenderingAttachmentInfo depth_attachment = attachment(
            depth.image.view, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, {.depthStencil = {.depth = clear_depth}});
        const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                   .renderArea = {{0, 0}, extent},
                                   .layerCount = 1,
                                   .colorAttachmentCount = formats.has_layers ? 3U : 1U,
                                   .pColorAttachments = colors.data(),
                                   .pDepthAttachment = &depth_attachment};
        const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
        context.vk.CmdBeginRendering(commands, &info);
        context.vk.CmdSetViewport(commands, 0, 1, &viewport);
        context.vk.CmdSetScissor(commands, 0, 1, &info.renderArea);
    }

    gpu::Buffer block_buffer;
    gpu::DescriptorSets sets;
};

}  // namespace darkroom::render::test
