// SPDX-License-Identifier: MIT
#include "compose/developer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "gpu/context.hpp"
#include "gpu/resources.hpp"

namespace darkroom {

namespace {

constexpr VkFormat color_format = VK_FORMAT_R32G32B32A32_SFLOAT;

/// A layer of the frame: what it is made of and where it goes.
struct Layer {
    const char* name = "";
    std::span<const float> values;
    std::uint32_t given = 0;  ///< numbers a pixel in `values`
    std::uint32_t kept = 0;   ///< numbers a pixel in the image; three-component formats are rarely sampled
    VkFormat format = VK_FORMAT_UNDEFINED;
};

std::array<Layer, 4> layers_of(const DevelopInput& input) {
    return {{{"color", input.color, 4, 4, color_format},
             {"depth", input.depth, 1, 1, VK_FORMAT_R32_SFLOAT},
             {"normals", input.normals, 3, 4, VK_FORMAT_R32G32B32A32_SFLOAT},
             {"velocity", input.velocity, 2, 2, VK_FORMAT_R32G32_SFLOAT}}};
}

VkImageUsageFlags shader_usage(const gpu::Context& context, VkFormat format) {
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    if (context.supports(format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    return usage;
}

VkImageUsageFlags target_usage(const gpu::Context& context, VkFormat format) {
    VkImageUsageFlags usage = 0;
    if (context.supports(format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    if (context.supports(format, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT)) usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    return usage;
}

VkBufferImageCopy whole(VkExtent2D extent) {
    return {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, .imageExtent = {extent.width, extent.height, 1}};
}

/// Images of one size, and the buffers that fill and read them.
struct Images {
    VkExtent2D extent{};
    std::array<std::optional<gpu::Image>, 4> layers;
    std::array<std::optional<gpu::Buffer>, 4> uploads;
    gpu::Image target;
    gpu::Buffer readback;
};

ImageRef reference_to(const gpu::Image& image, VkImageLayout before, VkImageLayout after) {
    return {.image = image.handle,
            .view = image.mip_views[0],
            .format = image.info.format,
            .extent = {image.info.extent.width, image.info.extent.height},
            .layout = before,
            .last_access = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
            .final_layout = after};
}

}  // namespace

CompileDesc compile_desc_for(Device& device, const DevelopInput& input, const DevelopDesc& desc) {
    const gpu::Context& context = device.context();
    const bool is_bytes = desc.target == DevelopTarget::Encoded8;
    const VkFormat target = is_bytes ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_R32G32B32A32_SFLOAT;
    const std::array<Layer, 4> layers = layers_of(input);
    const auto format = [&](std::size_t i) {
        return layers[i].values.empty() ? VK_FORMAT_UNDEFINED : layers[i].format;
    };
    return {.max_extent = input.extent,
            .color = color_format,
            .depth = format(1),
            .normals = format(2),
            .velocity = format(3),
            .target = target,
            .color_usage = shader_usage(context, color_format),
            .target_usage = target_usage(context, target),
            .target_domain = desc.target == DevelopTarget::SceneLinear ? Domain::SceneLinear : Domain::Encoded,
            .encodes_target = desc.target != DevelopTarget::SceneLinear,
            .kernels = desc.kernels,
            .fuse = desc.fuse};
}

Result<> check_extent(Device& device, VkExtent2D extent) {
    const std::uint32_t limit = device.context().traits.max_image_dimension;
    const auto [width, height] = extent;
    if (width > 0 && height > 0 && width <= limit && height <= limit) return {};
    return user_error(
        fmt::format("size {}x{}: {} allows 1x1 to {}x{}", width, height, device.info().name, limit, limit));
}

struct Developer::State {
    Device* device = nullptr;
    DevelopDesc desc;
    std::optional<CompileDesc> compiled;
    const Composer* compiled_composer = nullptr;
    Plan plan;
    std::optional<Images> images;

    gpu::Context& context() const { return device->context(); }

    Result<> check(const DevelopInput& input) const {
        if (Result<> done = check_extent(*device, input.extent); !done) return done;
        const auto [width, height] = input.extent;
        for (const Layer& layer : layers_of(input)) {
            const std::size_t wanted = std::size_t{width} * height * layer.given;
            const bool is_required = layer.given == 4;
            if (layer.values.size() != wanted && (is_required || !layer.values.empty()))
                return user_error(fmt::format("{}: {} numbers, {}x{} pixels need {}", layer.name, layer.values.size(),
                                              width, height, wanted));
        }
        return {};
    }

    Result<> compile(Composer& composer, const DevelopInput& input) {
        const CompileDesc wanted = compile_desc_for(*device, input, desc);
        const bool is_same =
            compiled && compiled_composer == &composer && compiled->max_extent.width == wanted.max_extent.width &&
            compiled->max_extent.height == wanted.max_extent.height && compiled->depth == wanted.depth &&
            compiled->normals == wanted.normals && compiled->velocity == wanted.velocity;
        if (is_same) return {};
        compiled.reset();
        images.reset();
        Result<Plan> made = composer.compile(wanted);
        if (!made) return failure(std::move(made));
        plan = std::move(*made);
        composer.wait_for_kernels();
        if (Result<> done = make_images(wanted, input); !done) return done;
        compiled = wanted;
        compiled_composer = &composer;
        return {};
    }

    Result<> make_images(const CompileDesc& wanted, const DevelopInput& input) {
        Images made{.extent = input.extent};
        const VkExtent3D extent{input.extent.width, input.extent.height, 1};
        const VkDeviceSize pixels = VkDeviceSize{extent.width} * extent.height;
        const std::array<Layer, 4> layers = layers_of(input);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const Layer& layer = layers[i];
            if (layer.values.empty()) continue;
            auto image = gpu::Image::create(
                context(), {.name = layer.name,
                            .format = layer.format,
                            .extent = extent,
                            .usage = shader_usage(context(), layer.format) | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
            if (!image) return failure(std::move(image));
            auto buffer = gpu::Buffer::create(context(), pixels * layer.kept * sizeof(float),
                                              VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Memory::Kind::Upload, layer.name);
            if (!buffer) return failure(std::move(buffer));
            made.layers[i] = std::move(*image);
            made.uploads[i] = std::move(*buffer);
        }
        auto target = gpu::Image::create(context(), {.name = "target",
                                                     .format = wanted.target,
                                                     .extent = extent,
                                                     .usage = wanted.target_usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
        if (!target) return failure(std::move(target));
        const VkDeviceSize texel = desc.target == DevelopTarget::Encoded8 ? 4 : 16;
        auto readback = gpu::Buffer::create(context(), pixels * texel, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                            gpu::Memory::Kind::Readback, "developed picture");
        if (!readback) return failure(std::move(readback));
        made.target = std::move(*target);
        made.readback = std::move(*readback);
        images = std::move(made);
        return {};
    }

    void fill(const DevelopInput& input) {
        const std::array<Layer, 4> layers = layers_of(input);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const Layer& layer = layers[i];
            if (layer.values.empty()) continue;
            std::byte* out = images->uploads[i]->memory.mapped;
            if (layer.given == layer.kept) {
                std::memcpy(out, layer.values.data(), layer.values.size_bytes());
                continue;
            }
            for (std::size_t at = 0; at < layer.values.size(); at += layer.given, out += layer.kept * sizeof(float)) {
                std::array<float, 4> texel{0, 0, 0, 1};
                std::copy_n(layer.values.begin() + static_cast<std::ptrdiff_t>(at), layer.given, texel.begin());
                std::memcpy(out, texel.data(), layer.kept * sizeof(float));
            }
        }
    }

    Result<> run(Composer& composer, const DevelopInput& input) {
        Result<> recorded{};
        const Result<> submitted =
            gpu::submit_and_wait(context(), "developing a picture",
                                 [&](VkCommandBuffer commands) { recorded = record(composer, input, commands); });
        if (!recorded) return recorded;
        return submitted;
    }

    Result<> record(Composer& composer, const DevelopInput& input, VkCommandBuffer commands) {
        const VkBufferImageCopy copy = whole(input.extent);
        Frame frame{.camera = input.camera, .time = input.time, .frame_index = input.frame_index};
        ImageRef* const slots[] = {&frame.color, &frame.depth, &frame.normals, &frame.velocity};
        for (std::size_t i = 0; i < images->layers.size(); ++i) {
            if (!images->layers[i]) continue;
            const gpu::Image& image = *images->layers[i];
            gpu::transition(context(), commands, image, VK_IMAGE_LAYOUT_UNDEFINED,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
            context().vk.CmdCopyBufferToImage(commands, images->uploads[i]->handle, image.handle,
                                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
            *slots[i] = reference_to(image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
        }
        frame.target = reference_to(images->target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        if (Result<> recorded = composer.record(commands, frame); !recorded) return recorded;
        context().vk.CmdCopyImageToBuffer(commands, images->target.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                          images->readback.handle, 1, &copy);
        const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                       .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                       .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                       .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                       .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
        const VkDependencyInfo dependency{
            .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
        context().vk.CmdPipelineBarrier2(commands, &dependency);
        return {};
    }

    DevelopedPicture read() const {
        DevelopedPicture out{.extent = images->extent};
        const std::size_t numbers = std::size_t{out.extent.width} * out.extent.height * 4;
        const std::byte* const mapped = images->readback.memory.mapped;
        if (desc.target == DevelopTarget::Encoded8) {
            out.bytes.resize(numbers);
            std::memcpy(out.bytes.data(), mapped, numbers);
        } else {
            out.pixels.resize(numbers);
            std::memcpy(out.pixels.data(), mapped, numbers * sizeof(float));
        }
        return out;
    }
};

Developer::Developer(Device& device, const DevelopDesc& desc) : state_(std::make_unique<State>()) {
    state_->device = &device;
    state_->desc = desc;
}
Developer::Developer(Developer&&) noexcept = default;
Developer& Developer::operator=(Developer&&) noexcept = default;
Developer::~Developer() = default;

Result<DevelopedPicture> Developer::develop(Composer& composer, const DevelopInput& input) {
    if (Result<> done = state_->check(input); !done) return failure(std::move(done));
    if (Result<> done = state_->compile(composer, input); !done) return failure(std::move(done));
    state_->fill(input);
    if (Result<> done = state_->run(composer, input); !done) return failure(std::move(done));
    return state_->read();
}

const Plan& Developer::plan() const { return state_->plan; }

}  // namespace darkroom
