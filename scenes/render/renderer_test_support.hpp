// SPDX-License-Identifier: MIT
#pragma once
// For tests only: snapshots made by hand, and a renderer whose images come back as floats.

#include <darkroom/frame.hpp>

#include "gpu/test_run.hpp"
#include "render/renderer.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::render::test {

using gpu::test::must;
using gpu::test::Pixels;
using scene::mat4;
using scene::no_index;
using scene::vec2;
using scene::vec3;
using scene::vec4;

inline constexpr float near_plane = 0.1F, far_plane = 100;

/// Looks along -z from the origin; the picture's height is seen under 90 degrees.
inline scene::CameraState front_camera(VkExtent2D extent, float height_m = 0) {
    const float aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
    scene::CameraState camera;
    camera.near_distance = near_plane;
    camera.far_distance = far_plane;
    camera.field_of_view = 90;
    if (height_m == 0) {
        camera.projection = glm::perspective(glm::radians(90.0F), aspect, far_plane, near_plane);
    } else {
        camera.kind = scene::Projection::Orthographic;
        camera.projection = glm::ortho(-height_m * aspect / 2, height_m * aspect / 2, -height_m / 2, height_m / 2,
                                       far_plane, near_plane);
    }
    camera.projection[1] *= -1.0F;
    camera.previous_projection = camera.projection;
    return camera;
}

/// Shows its colour whatever the light.
inline scene::SnapshotMaterial plain(vec4 color, scene::SurfaceBlend blend = scene::SurfaceBlend::Opaque) {
    scene::SnapshotMaterial material;
    material.surface.base_color = color;
    material.surface.is_unlit = true;
    material.surface.blend = blend;
    return material;
}

inline scene::Snapshot snapshot_of(VkExtent2D extent) {
    scene::Snapshot snapshot;
    snapshot.camera = front_camera(extent);
    return snapshot;
}

/// A box with these corners and a material of its own.
inline scene::Instance& add_box(scene::Snapshot& snapshot, vec3 low, vec3 high,
                                const scene::SnapshotMaterial& material) {
    snapshot.materials.push_back(material);
    scene::Instance& box = snapshot.instances.emplace_back();
    box.material = static_cast<std::uint32_t>(snapshot.materials.size() - 1);
    box.world = box.previous_world = glm::scale(glm::translate(mat4(1), low), high - low);
    box.bounds = {low, high};
    return box;
}

/// A wall across the view at this distance, of this half-size around the middle.
inline scene::Instance& add_wall(scene::Snapshot& snapshot, float distance, float half,
                                 const scene::SnapshotMaterial& material) {
    return add_box(snapshot, {-half, -half, -distance - 1}, {half, half, -distance}, material);
}

inline Pixels download(const ImageRef& image) {
    gpu::Context& context = gpu::test::context();
    const gpu::test::TestFormat format = gpu::test::test_format(image.format);
    const std::size_t size = std::size_t{image.extent.width} * image.extent.height * format.channels * format.bytes;
    const gpu::Buffer staging = must(gpu::Buffer::create(context, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                         gpu::Memory::Kind::Readback, "test download"));
    must(gpu::submit_and_wait(context, "downloading what was rendered", [&](VkCommandBuffer commands) {
        const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                            .srcStageMask = image.last_stages,
                                            .srcAccessMask = image.last_access,
                                            .dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                            .dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT,
                                            .oldLayout = image.layout,
                                            .newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                            .image = image.image,
                                            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        const VkDependencyInfo dependency{
            .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
        context.vk.CmdPipelineBarrier2(commands, &dependency);
        const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = {image.extent.width, image.extent.height, 1}};
        context.vk.CmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.handle, 1,
                                        &copy);
        const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                       .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                       .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                       .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                       .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
        const VkDependencyInfo last{
            .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
        context.vk.CmdPipelineBarrier2(commands, &last);
    }));
    return gpu::test::decode_pixels({staging.memory.mapped, size}, image.extent, image.format);
}

/// What a renderer made of a snapshot. The layers are empty for Output::Display.
struct Shot {
    Pixels color, depth, normals, velocity;
};

inline void draw(Renderer& renderer, const scene::Snapshot& snapshot, const FrameJitter& jitter = {}) {
    must(renderer.prepare(snapshot, jitter));
    Result<> recorded;
    must(gpu::submit_and_wait(gpu::test::context(), "rendering a test scene",
                              [&](VkCommandBuffer commands) { recorded = renderer.record(commands); }));
    must(std::move(recorded));
}

inline Shot shoot(Renderer& renderer, const scene::Snapshot& snapshot, const FrameJitter& jitter = {}) {
    draw(renderer, snapshot, jitter);
    Shot shot{.color = download(renderer.picture()), .depth = {}, .normals = {}, .velocity = {}};
    if (renderer.desc().output == Output::Display) return shot;
    const Frame frame = renderer.frame();
    shot.depth = download(frame.depth);
    shot.normals = download(frame.normals);
    shot.velocity = download(frame.velocity);
    return shot;
}

inline scene::Scene dark_scene() {
    scene::Scene scene;
    scene.environment.background = vec3(0);
    return scene;
}

/// Without a grid, which is only in the way.
inline Renderer renderer_for(RenderDesc desc, const scene::Assets& assets = {}, const scene::Scene& scene = {}) {
    desc.draw.has_grid = false;
    return must(Renderer::create(gpu::test::device(), scene, assets, desc));
}

}  // namespace darkroom::render::test
