// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "measure.hpp"
#include "upload.hpp"

namespace darkroom::bench {

namespace {

constexpr VkFormat scene_format = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat target_format = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkImageUsageFlags every_use = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                        VK_IMAGE_USAGE_TRANSFER_DST_BIT;

/// Light as a room has it: smooth gradients, edges, and small lamps that bloom.
std::vector<std::uint16_t> make_scene(VkExtent2D extent) {
    std::vector<std::uint16_t> out(std::size_t{extent.width} * extent.height * 4);
    std::size_t at = 0;
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(extent.width);
            const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(extent.height);
            const bool is_tile = ((x / 48 + y / 48) & 1) != 0;
            const float wall = (is_tile ? 0.6f : 0.15f) * (0.2f + 1.8f * u) * (1.2f - v);
            const float dx = std::fmod(u * 6, 1.0f) - 0.5f, dy = std::fmod(v * 4, 1.0f) - 0.5f;
            const float lamp = 40.0f * std::max(0.0f, 1.0f - (dx * dx + dy * dy) * 150.0f);
            for (const float tint : {1.0f, 0.8f - 0.3f * v, 0.5f + 0.4f * u})
                out[at++] = half_bits((wall + lamp) * tint);
            out[at++] = half_bits(1.0f);
        }
    return out;
}

VkBufferImageCopy whole(VkExtent2D extent) {
    return {.imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1},
            .imageExtent = {extent.width, extent.height, 1}};
}

ImageRef ref_of(const gpu::Image& image, VkExtent2D extent) {
    return {.image = image.handle,
            .view = image.mip_views[0],
            .format = image.info.format,
            .extent = extent,
            .layout = VK_IMAGE_LAYOUT_GENERAL,
            .final_layout = VK_IMAGE_LAYOUT_GENERAL};
}

}  // namespace

Result<std::unique_ptr<Bed>> Bed::create(Device& device, VkExtent2D extent) {
    gpu::Context& context = device.context();
    const VkExtent3D size{extent.width, extent.height, 1};
    const std::vector<std::uint16_t> pixels = make_scene(extent);
    DARKROOM_TRY_VALUE(auto scene,
                       upload(context, {.name = "scene", .format = scene_format, .extent = size, .usage = every_use},
                              std::as_bytes(std::span(pixels)), VK_IMAGE_LAYOUT_GENERAL));
    DARKROOM_TRY_VALUE(
        auto target,
        gpu::Image::create(context, {.name = "target", .format = target_format, .extent = size, .usage = every_use}));
    DARKROOM_TRY(gpu::submit_and_wait(context, "preparing the target", [&](VkCommandBuffer commands) {
        gpu::transition(context, commands, target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    }));
    return std::unique_ptr<Bed>(new Bed{device, context, extent, std::move(scene), std::move(target), {}});
}

Result<> Bed::make_world() {
    if (world != nullptr) return {};
    DARKROOM_TRY_VALUE(auto made, World::create(context, extent));
    world = std::make_unique<World>(std::move(made));
    return {};
}

Frame Bed::frame(WorldUse use) const {
    Frame out{.color = ref_of(scene, extent), .target = ref_of(target, extent)};
    if (use == WorldUse::None) return out;
    const auto read_only = [&](const gpu::Image& image) {
        ImageRef ref = ref_of(image, extent);
        ref.layout = ref.final_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        return ref;
    };
    if (use == WorldUse::Interface) {
        out.ui = read_only(world->ui);
        return out;
    }
    out.depth = read_only(use == WorldUse::Planar ? world->distance : world->depth);
    if (use != WorldUse::WithoutNormals) {
        out.normals = read_only(world->normals);
        out.velocity = read_only(world->velocity);
    }
    out.camera = world->camera;
    if (use == WorldUse::Planar) out.camera.depth = DepthKind::Planar;
    out.lights = {&world->light, 1};
    return out;
}

CompileDesc Bed::compile_desc(WorldUse use) const {
    CompileDesc out{.max_extent = extent,
                    .color = {scene_format, every_use},
                    .target = {target_format, every_use},
                    .target_domain = Domain::Encoded};
    if (use == WorldUse::None) return out;
    const Frame frame = this->frame(use);
    constexpr VkImageUsageFlags layer_use = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
    if (use == WorldUse::Interface) {
        out.ui = {frame.ui.format, layer_use};
        return out;
    }
    out.depth = {frame.depth.format, layer_use};
    out.is_depth_planar = use == WorldUse::Planar;
    out.normals = {frame.normals.format, layer_use};
    out.velocity = {frame.velocity.format, layer_use};
    out.is_velocity_plain = true;
    out.has_shadows = true;
    return out;
}

Result<std::vector<std::byte>> Bed::read_target() const {
    const std::size_t bytes = std::size_t{extent.width} * extent.height * 4;
    DARKROOM_TRY_VALUE(auto staging, gpu::Buffer::create(context, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                         gpu::Memory::Kind::Readback, "target"));
    auto done = gpu::submit_and_wait(context, "reading the target", [&](VkCommandBuffer commands) {
        const VkBufferImageCopy copy = whole(extent);
        gpu::transition(context, commands, target, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        context.vk.CmdCopyImageToBuffer(commands, target.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.handle,
                                        1, &copy);
        gpu::transition(context, commands, target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
    });
    if (!done) return failure(std::move(done));
    return std::vector<std::byte>(staging.memory.mapped, staging.memory.mapped + bytes);
}

}  // namespace darkroom::bench
