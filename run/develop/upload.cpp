// SPDX-License-Identifier: MIT
#include "develop/upload.hpp"

#include <algorithm>
#include <cstring>

#include "core/srgb.hpp"
#include "gpu/device/context.hpp"
#include "plan/text/half.hpp"

namespace darkroom {

namespace {

bool is_all_half(std::span<const float> values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return exact_half(value).has_value(); });
}

VkBufferImageCopy whole(VkExtent2D extent) {
    return {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, .imageExtent = {extent.width, extent.height, 1}};
}

/// The light that codes stand for; alpha stays.
void fill_with_codes(const UploadLayer& layer, std::byte* out) {
    static const std::array<float, 256> light = [] {
        std::array<float, 256> all{};
        for (std::size_t code = 0; code < all.size(); ++code)
            all[code] = static_cast<float>(srgb_decode(static_cast<double>(code) / 255));
        return all;
    }();
    std::array<float, 4> texel{0, 0, 0, 1};
    for (std::size_t at = 0; at < layer.codes.size(); at += layer.given, out += sizeof texel) {
        for (std::size_t i = 0; i < 3; ++i) texel[i] = light[layer.codes[at + i]];
        if (layer.given == 4) texel[3] = static_cast<float>(layer.codes[at + 3]) / 255.0F;
        std::memcpy(out, texel.data(), sizeof texel);
    }
}

/// Three numbers a pixel become four: the last is 1.
template <class T>
void fill_with_one(std::span<const T> values, T one, std::byte* out) {
    std::array<T, 4> texel{0, 0, 0, one};
    for (std::size_t at = 0; at < values.size(); at += 3, out += sizeof texel) {
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(at), 3, texel.begin());
        std::memcpy(out, texel.data(), sizeof texel);
    }
}

/// What is given as the image has it; empty: it is not.
std::span<const std::byte> as_kept(const UploadLayer& layer) {
    if (!layer.bytes.empty()) return std::as_bytes(layer.bytes);
    if (!layer.halves.empty()) return std::as_bytes(layer.halves);
    if (!layer.is_half && layer.given == layer.kept) return std::as_bytes(layer.values);
    return {};
}

void fill(const UploadLayer& layer, std::byte* out) {
    if (!layer.codes.empty()) return fill_with_codes(layer, out);
    constexpr std::uint16_t half_one = 0x3c00;
    if (layer.kept == 4 && layer.given_halves == 3 && !layer.halves.empty())
        return fill_with_one(layer.halves, half_one, out);
    if (layer.kept == 4 && layer.given == 3 && !layer.values.empty() && !layer.is_half)
        return fill_with_one(layer.values, 1.0F, out);
    const std::span<const std::byte> as_it_is = as_kept(layer);
    if (!as_it_is.empty()) {
        std::memcpy(out, as_it_is.data(), as_it_is.size());
        return;
    }
    std::array<float, 4> texel{0, 0, 0, 1};
    for (std::size_t at = 0; at < layer.values.size(); at += layer.given, out += layer.texel()) {
        std::copy_n(layer.values.begin() + static_cast<std::ptrdiff_t>(at), layer.given, texel.begin());
        if (!layer.is_half) {
            std::memcpy(out, texel.data(), layer.texel());
            continue;
        }
        std::array<std::uint16_t, 4> halves{};
        for (std::uint32_t i = 0; i < layer.kept; ++i) halves[i] = *exact_half(texel[i]);
        std::memcpy(out, halves.data(), layer.texel());
    }
}

}  // namespace

UploadLayers layers_of(const DevelopInput& input, VkExtent2D output) {
    const auto layer = [&](const char* name, std::span<const float> values, std::span<const std::uint16_t> halves,
                           std::uint32_t given, std::uint32_t kept, VkFormat half, VkFormat whole) -> UploadLayer {
        const bool is_half = half != whole && (!halves.empty() || is_all_half(values));
        return {name, input.extent, values, halves, {}, {}, given, kept, kept, is_half ? half : whole, is_half};
    };
    constexpr VkFormat half4 = VK_FORMAT_R16G16B16A16_SFLOAT, float4 = VK_FORMAT_R32G32B32A32_SFLOAT;
    UploadLayer color = layer("color", input.color, input.color_halves, input.color_channels, 4, half4, float4);
    color.given_halves = input.color_channels;
    if (!input.color_codes.empty()) {
        color.codes = input.color_codes;
        color.format = float4;
        color.is_half = false;
    }
    // Depth stays whole: a renderer's planar distance is, too.
    return {color,
            layer("depth", input.depth, {}, 1, 1, VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32_SFLOAT),
            layer("normals", input.normals, input.normal_halves, 3, 4, half4, float4),
            layer("velocity", input.velocity, input.velocity_halves, 2, 2, VK_FORMAT_R16G16_SFLOAT,
                  VK_FORMAT_R32G32_SFLOAT),
            layer("reactive", input.reactive, {}, 1, 1, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R32_SFLOAT),
            layer("transparency", input.transparency, {}, 3, 4, half4, float4),
            {.name = "exposure",
             .extent = {1, 1},
             .values = input.exposure,
             .given = 1,
             .kept = 1,
             .format = VK_FORMAT_R32_SFLOAT},
            {.name = "ui",
             .extent = output.width != 0 ? output : input.extent,
             .bytes = input.ui,
             .given = 4,
             .kept = 4,
             .format = VK_FORMAT_R8G8B8A8_UNORM}};
}

VkImageUsageFlags shader_usage(const gpu::Context& context, VkFormat format) {
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    if (context.supports(format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    return usage;
}

ImageRef reference_to(const gpu::Image& image, VkImageLayout before, VkImageLayout after) {
    return {.image = image.handle,
            .view = image.mip_views[0],
            .format = image.info.format,
            .extent = {image.info.extent.width, image.info.extent.height},
            .layer_count = image.info.array_layers,
            .layout = before,
            .last_access = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
            .final_layout = after};
}

/// They are filled, and read back by who stores the frame.
constexpr VkImageUsageFlags copied = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

Result<FrameUpload::Layers> FrameUpload::make_layers(gpu::Context& context, const UploadLayers& layers) {
    Layers made;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const UploadLayer& layer = layers[i];
        if (!layer.is_given()) continue;
        DARKROOM_TRY_VALUE(auto image,
                           gpu::Image::create(context, {.name = layer.name,
                                                        .format = layer.format,
                                                        .extent = {layer.extent.width, layer.extent.height, 1},
                                                        .usage = shader_usage(context, layer.format) | copied}));
        DARKROOM_TRY_VALUE(
            auto buffer,
            gpu::Buffer::create(context, VkDeviceSize{layer.extent.width} * layer.extent.height * layer.texel(),
                                VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Memory::Kind::Upload, layer.name));
        made.images[i] = std::move(image);
        made.buffers[i] = std::move(buffer);
    }
    return made;
}

Result<FrameUpload::Shadow> FrameUpload::make_shadow(gpu::Context& context, const ReferenceLight& light) {
    Shadow made{.resolution = light.resolution, .count = static_cast<std::uint32_t>(light.cascades.size())};
    DARKROOM_TRY_VALUE(
        auto image,
        gpu::Image::create(context, {.name = "shadows",
                                     .format = VK_FORMAT_D32_SFLOAT,
                                     .extent = {light.resolution, light.resolution, 1},
                                     .array_layers = std::max(made.count, 2U),  // a view of one would be no array
                                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | copied}));
    const VkDeviceSize bytes = VkDeviceSize{light.resolution} * light.resolution * made.count * sizeof(float);
    DARKROOM_TRY_VALUE(auto buffer, gpu::Buffer::create(context, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                        gpu::Memory::Kind::Upload, "shadows"));
    made.image = std::move(image);
    made.buffer = std::move(buffer);
    return made;
}

Result<> FrameUpload::prepare_lights(gpu::Context& context, std::span<const ReferenceLight> given) {
    lights_.clear();
    std::size_t used = 0;
    for (const ReferenceLight& source : given) {
        Light& light = lights_.emplace_back(source.light);
        light.cascades = {};
        light.cascade_count = static_cast<std::uint32_t>(source.cascades.size());
        if (source.cascades.empty()) continue;
        if (used == shadows_.size()) shadows_.emplace_back();
        Shadow& shadow = shadows_[used++];
        if (shadow.resolution != source.resolution || shadow.count != light.cascade_count) {
            shadow = {};
            DARKROOM_TRY_VALUE(shadow, make_shadow(context, source));
        }
        std::byte* to = shadow.buffer.memory.mapped;
        for (const std::vector<float>& cascade : source.cascades) {
            std::memcpy(to, cascade.data(), cascade.size() * sizeof(float));
            to += cascade.size() * sizeof(float);
        }
        light.cascades =
            reference_to(shadow.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        light.cascades.view = shadow.image.view;
    }
    shadows_.resize(used);
    return {};
}

Result<> FrameUpload::prepare(gpu::Context& context, const DevelopInput& input, const UploadLayers& layers) {
    if (!layers_) {
        DARKROOM_TRY_VALUE(layers_, make_layers(context, layers));
    }
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (layers_->buffers[i]) fill(layers[i], layers_->buffers[i]->memory.mapped);
    return prepare_lights(context, input.lights);
}

void FrameUpload::record(const gpu::Context& context, VkCommandBuffer commands) const {
    for (std::size_t i = 0; i < layers_->images.size(); ++i) {
        if (!layers_->images[i]) continue;
        const gpu::Image& image = *layers_->images[i];
        const VkBufferImageCopy copy = whole({image.info.extent.width, image.info.extent.height});
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        context.vk.CmdCopyBufferToImage(commands, layers_->buffers[i]->handle, image.handle,
                                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    }
    for (const Shadow& shadow : shadows_) {
        const VkBufferImageCopy copy_of_all{.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, shadow.count},
                                            .imageExtent = {shadow.resolution, shadow.resolution, 1}};
        gpu::transition(context, commands, shadow.image, VK_IMAGE_LAYOUT_UNDEFINED,
                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        context.vk.CmdCopyBufferToImage(commands, shadow.buffer.handle, shadow.image.handle,
                                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy_of_all);
    }
}

Frame FrameUpload::frame(const DevelopInput& input) const {
    Frame frame{.camera = input.camera,
                .lights = lights_,
                .time = input.time,
                .delta_time = input.delta_time,
                .frame_index = input.frame_index};
    frame.camera.depth = DepthKind::Planar;
    ImageRef* const slots[] = {&frame.color,    &frame.depth,        &frame.normals,  &frame.velocity,
                               &frame.reactive, &frame.transparency, &frame.exposure, &frame.ui};
    for (std::size_t i = 0; i < layers_->images.size(); ++i)
        if (layers_->images[i])
            *slots[i] =
                reference_to(*layers_->images[i], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
    return frame;
}

}  // namespace darkroom
