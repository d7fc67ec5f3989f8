// SPDX-License-Identifier: MIT
#include "develop/developer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "core/assert.hpp"
#include "gpu/context.hpp"
#include "gpu/resources.hpp"
#include "plan/half.hpp"

namespace darkroom {

namespace {

/// A layer of the frame: what it is made of and where it goes.
struct Layer {
    const char* name = "";
    std::span<const float> values;
    std::uint32_t given = 0;  ///< numbers a pixel in `values`
    std::uint32_t kept = 0;   ///< numbers a pixel in the image; three-component formats are rarely sampled
    VkFormat format = VK_FORMAT_UNDEFINED;
    bool is_half = false;

    [[nodiscard]] VkDeviceSize texel() const { return VkDeviceSize{kept} * (is_half ? 2 : 4); }
};
using Layers = std::array<Layer, 4>;

bool has_cascades(const ReferenceLight& light) { return !light.cascades.empty(); }

bool is_all_half(std::span<const float> values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return exact_half(value).has_value(); });
}

Layers layers_of(const DevelopInput& input) {
    const auto layer = [](const char* name, std::span<const float> values, std::uint32_t given, std::uint32_t kept,
                          VkFormat half, VkFormat whole) -> Layer {
        const bool is_half = half != whole && is_all_half(values);
        return {name, values, given, kept, is_half ? half : whole, is_half};
    };
    constexpr VkFormat half4 = VK_FORMAT_R16G16B16A16_SFLOAT, float4 = VK_FORMAT_R32G32B32A32_SFLOAT;
    // Depth stays whole: a renderer's planar distance is, too.
    return {layer("color", input.color, 4, 4, half4, float4),
            layer("depth", input.depth, 1, 1, VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32_SFLOAT),
            layer("normals", input.normals, 3, 4, half4, float4),
            layer("velocity", input.velocity, 2, 2, VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R32G32_SFLOAT)};
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

/// All of a CompileDesc that follows from the target alone.
CompileDesc compile_desc_for(gpu::Context& context, const DevelopDesc& desc) {
    const bool is_bytes = desc.target == DevelopTarget::Encoded8;
    const VkFormat target = is_bytes ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_R32G32B32A32_SFLOAT;
    return {.target = {target, target_usage(context, target)},
            .target_domain = desc.target == DevelopTarget::SceneLinear ? Domain::SceneLinear : Domain::Encoded,
            .encodes_target = desc.target != DevelopTarget::SceneLinear,
            .kernels = desc.kernels,
            .fuse = desc.fuse};
}

CompileDesc compile_desc_for(gpu::Context& context, const DevelopInput& input, const Layers& layers,
                             const DevelopDesc& desc) {
    const auto use = [&](std::size_t i) {
        if (layers[i].values.empty()) return ImageUse{};
        return ImageUse{layers[i].format, shader_usage(context, layers[i].format)};
    };
    CompileDesc out = compile_desc_for(context, desc);
    out.max_extent = input.extent;
    out.color = {layers[0].format, shader_usage(context, layers[0].format)};
    out.depth = use(1);
    out.is_depth_planar = out.depth.format != VK_FORMAT_UNDEFINED;
    out.normals = use(2);
    out.velocity = use(3);
    out.is_velocity_plain = true;
    out.has_shadows = std::any_of(input.lights.begin(), input.lights.end(), has_cascades);
    return out;
}

/// Do two descriptions that one DevelopDesc made ask for the same?
bool is_same(const CompileDesc& a, const CompileDesc& b) {
    return a.max_extent.width == b.max_extent.width && a.max_extent.height == b.max_extent.height &&
           a.color == b.color && a.depth == b.depth && a.is_depth_planar == b.is_depth_planar &&
           a.is_velocity_plain == b.is_velocity_plain && a.normals == b.normals && a.velocity == b.velocity &&
           a.ui == b.ui && a.has_shadows == b.has_shadows;
}

/// The cascades of one light, an array, and the buffer that fills it.
struct ShadowUpload {
    gpu::Image image;
    gpu::Buffer buffer;
    std::uint32_t resolution = 0, count = 0;
};

/// Images of one size for pictures from main memory, and the buffers that fill them.
struct Uploads {
    std::array<std::optional<gpu::Image>, 4> images;
    std::array<std::optional<gpu::Buffer>, 4> buffers;
};

void fill(const Layer& layer, std::byte* out) {
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

CompileDesc compile_desc_for(Device& device, const DevelopInput& input, const DevelopDesc& desc) {
    return compile_desc_for(device.context(), input, layers_of(input), desc);
}

CompileDesc compile_desc_for(gpu::Context& context, const DeviceFrame& input, const DevelopDesc& desc) {
    const Frame& frame = input.frame;
    CompileDesc out = compile_desc_for(context, desc);
    out.max_extent = frame.color.used_region().extent;
    out.color = {frame.color.format, input.color_usage};
    out.depth = {frame.depth.format, input.layer_usage};
    out.is_depth_planar = frame.depth.is_given() && frame.camera.depth == DepthKind::Planar;
    out.normals = {frame.normals.format, input.layer_usage};
    out.velocity = {frame.velocity.format, input.layer_usage};
    out.is_velocity_plain = frame.camera.velocity == VelocityKind{};
    out.ui = {frame.ui.format};
    out.has_shadows = std::any_of(frame.lights.begin(), frame.lights.end(),
                                  [](const Light& light) { return light.cascades.is_given(); });
    return out;
}

CompileDesc compile_desc_for(Device& device, const DeviceFrame& input, const DevelopDesc& desc) {
    return compile_desc_for(device.context(), input, desc);
}

Result<> check_extent(const gpu::Context& context, VkExtent2D extent) {
    const std::uint32_t limit = context.traits.max_image_dimension;
    const auto [width, height] = extent;
    if (width > 0 && height > 0 && width <= limit && height <= limit) return {};
    return user_error(
        fmt::format("size {}x{}: {} allows 1x1 to {}x{}", width, height, context.info.name, limit, limit));
}

Result<> check_extent(Device& device, VkExtent2D extent) { return check_extent(device.context(), extent); }

struct Developer::State {
    std::shared_ptr<gpu::Context> shared_context;
    DevelopDesc desc;
    std::optional<CompileDesc> compiled;
    const Composer* compiled_composer = nullptr;
    Plan plan;
    std::optional<Uploads> uploads;
    std::vector<ShadowUpload> shadows;  ///< of the lights that have some
    std::vector<Light> lights;          ///< of the frame that is being developed
    gpu::Image target;
    std::optional<Readback> readback;

    gpu::Context& context() const { return *shared_context; }

    Result<> check(VkExtent2D extent, const Layers& layers) const {
        if (Result<> done = check_extent(context(), extent); !done) return done;
        const auto [width, height] = extent;
        for (const Layer& layer : layers) {
            const std::size_t wanted = std::size_t{width} * height * layer.given;
            const bool is_required = layer.given == 4;
            if (layer.values.size() != wanted && (is_required || !layer.values.empty()))
                return user_error(fmt::format("{}: {} numbers, {}x{} pixels need {}", layer.name, layer.values.size(),
                                              width, height, wanted));
        }
        return {};
    }

    Result<> check(std::span<const ReferenceLight> given) const {
        const std::uint32_t limit = context().traits.max_image_dimension;
        for (std::size_t i = 0; i < given.size(); ++i) {
            const ReferenceLight& light = given[i];
            if (light.cascades.size() > Light::max_cascades)
                return user_error(fmt::format("light {}: {} cascades, at most {} are allowed", i, light.cascades.size(),
                                              Light::max_cascades));
            if (has_cascades(light) && (light.resolution < 1 || light.resolution > limit))
                return user_error(fmt::format("light {}: cascades of {} texels a side: {} allows 1 to {}", i,
                                              light.resolution, context().info.name, limit));
            const std::size_t wanted = std::size_t{light.resolution} * light.resolution;
            for (const std::vector<float>& cascade : light.cascades)
                if (cascade.size() != wanted)
                    return user_error(fmt::format("light {}: a cascade of {} numbers, {}x{} texels need {}", i,
                                                  cascade.size(), light.resolution, light.resolution, wanted));
        }
        return {};
    }

    /// Plan, kernels, target and read-back.
    Result<> compile(Composer& composer, const CompileDesc& wanted) {
        if (compiled && compiled_composer == &composer && is_same(*compiled, wanted)) return {};
        compiled.reset();
        uploads.reset();
        Result<Plan> made = composer.compile(wanted);
        if (!made) return failure(std::move(made));
        plan = std::move(*made);
        composer.wait_for_kernels();
        auto image = gpu::Image::create(context(), {.name = "target",
                                                    .format = wanted.target.format,
                                                    .extent = {wanted.max_extent.width, wanted.max_extent.height, 1},
                                                    .usage = wanted.target.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
        if (!image) return failure(std::move(image));
        target = std::move(*image);
        auto read = Readback::create(context(), target_before_reading());
        if (!read) return failure(std::move(read));
        readback = std::move(*read);
        compiled = wanted;
        compiled_composer = &composer;
        return {};
    }

    [[nodiscard]] ImageRef target_before_reading() const {
        return reference_to(target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    }

    Result<> make_uploads(VkExtent2D extent, const Layers& layers) {
        if (uploads) return {};
        Uploads made;
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const Layer& layer = layers[i];
            if (layer.values.empty()) continue;
            auto image = gpu::Image::create(
                context(), {.name = layer.name,
                            .format = layer.format,
                            .extent = {extent.width, extent.height, 1},
                            .usage = shader_usage(context(), layer.format) | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
            if (!image) return failure(std::move(image));
            auto buffer = gpu::Buffer::create(context(), VkDeviceSize{extent.width} * extent.height * layer.texel(),
                                              VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Memory::Kind::Upload, layer.name);
            if (!buffer) return failure(std::move(buffer));
            made.images[i] = std::move(*image);
            made.buffers[i] = std::move(*buffer);
        }
        uploads = std::move(made);
        return {};
    }

    Result<ShadowUpload> make_shadow(const ReferenceLight& light) const {
        ShadowUpload made{.resolution = light.resolution, .count = static_cast<std::uint32_t>(light.cascades.size())};
        auto image =
            gpu::Image::create(context(), {.name = "shadows",
                                           .format = VK_FORMAT_D32_SFLOAT,
                                           .extent = {light.resolution, light.resolution, 1},
                                           .array_layers = std::max(made.count, 2U),  // a view of one would be no array
                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
        if (!image) return failure(std::move(image));
        const VkDeviceSize bytes = VkDeviceSize{light.resolution} * light.resolution * made.count * sizeof(float);
        auto buffer = gpu::Buffer::create(context(), bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Memory::Kind::Upload,
                                          "shadows");
        if (!buffer) return failure(std::move(buffer));
        made.image = std::move(*image);
        made.buffer = std::move(*buffer);
        return made;
    }

    /// Images and filled buffers for the cascades, and the lights that refer to them as record_uploads leaves them.
    Result<> prepare_lights(std::span<const ReferenceLight> given) {
        lights.clear();
        std::size_t used = 0;
        for (const ReferenceLight& source : given) {
            Light& light = lights.emplace_back(source.light);
            light.cascades = {};
            light.cascade_count = static_cast<std::uint32_t>(source.cascades.size());
            if (!has_cascades(source)) continue;
            if (used == shadows.size()) shadows.emplace_back();
            ShadowUpload& shadow = shadows[used++];
            if (shadow.resolution != source.resolution || shadow.count != light.cascade_count) {
                shadow = {};
                Result<ShadowUpload> made = make_shadow(source);
                if (!made) return failure(std::move(made));
                shadow = std::move(*made);
            }
            std::byte* to = shadow.buffer.memory.mapped;
            for (const std::vector<float>& cascade : source.cascades) {
                std::memcpy(to, cascade.data(), cascade.size() * sizeof(float));
                to += cascade.size() * sizeof(float);
            }
            light.cascades = reference_to(shadow.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
            light.cascades.view = shadow.image.view;
        }
        shadows.resize(used);
        return {};
    }

    void record_uploads(VkExtent2D extent, VkCommandBuffer commands) const {
        const VkBufferImageCopy copy = whole(extent);
        for (std::size_t i = 0; i < uploads->images.size(); ++i) {
            if (!uploads->images[i]) continue;
            const gpu::Image& image = *uploads->images[i];
            gpu::transition(context(), commands, image, VK_IMAGE_LAYOUT_UNDEFINED,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
            context().vk.CmdCopyBufferToImage(commands, uploads->buffers[i]->handle, image.handle,
                                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        }
        for (const ShadowUpload& shadow : shadows) {
            const VkBufferImageCopy copy_of_all{.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, shadow.count},
                                                .imageExtent = {shadow.resolution, shadow.resolution, 1}};
            gpu::transition(context(), commands, shadow.image, VK_IMAGE_LAYOUT_UNDEFINED,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
            context().vk.CmdCopyBufferToImage(commands, shadow.buffer.handle, shadow.image.handle,
                                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy_of_all);
        }
    }

    /// The frame's images as record_uploads leaves them.
    [[nodiscard]] Frame uploaded_frame(const DevelopInput& input) const {
        Frame frame{.camera = input.camera,
                    .lights = lights,
                    .time = input.time,
                    .delta_time = input.delta_time,
                    .frame_index = input.frame_index};
        frame.camera.depth = DepthKind::Planar;
        ImageRef* const slots[] = {&frame.color, &frame.depth, &frame.normals, &frame.velocity};
        for (std::size_t i = 0; i < uploads->images.size(); ++i)
            if (uploads->images[i])
                *slots[i] =
                    reference_to(*uploads->images[i], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
        return frame;
    }

    /// `before`, the composer and the read-back in one submission.
    Result<> run(Composer& composer, const Frame& frame, const RecordBefore& before, const FrameReadback* layers) {
        Result<> recorded{};
        Result<> submitted = gpu::submit_and_wait(context(), "developing a picture", [&](VkCommandBuffer commands) {
            if (before) recorded = before(commands);
            if (!recorded) return;
            if (layers != nullptr) layers->record(commands);
            recorded = composer.record(commands, frame);
            if (recorded) readback->record(commands);
        });
        return recorded ? submitted : recorded;
    }

    [[nodiscard]] DevelopedPicture picture() const {
        DevelopedPicture out{.extent = {target.info.extent.width, target.info.extent.height}};
        if (desc.target == DevelopTarget::Encoded8)
            out.bytes = readback->bytes();
        else
            out.pixels = readback->floats(4);
        return out;
    }
};

Developer::Developer(Device& device, const DevelopDesc& desc) : state_(std::make_unique<State>()) {
    state_->shared_context = device.shared_context();
    state_->desc = desc;
}
Developer::Developer(Developer&&) noexcept = default;
Developer& Developer::operator=(Developer&&) noexcept = default;
Developer::~Developer() = default;

Result<DevelopedPicture> Developer::develop(Composer& composer, const DevelopInput& input) {
    State& state = *state_;
    const Layers layers = layers_of(input);
    if (Result<> done = state.check(input.extent, layers); !done) return failure(std::move(done));
    if (Result<> done = state.check(input.lights); !done) return failure(std::move(done));
    const CompileDesc wanted = compile_desc_for(state.context(), input, layers, state.desc);
    if (Result<> done = state.compile(composer, wanted); !done) return failure(std::move(done));
    if (Result<> done = state.make_uploads(input.extent, layers); !done) return failure(std::move(done));
    if (Result<> done = state.prepare_lights(input.lights); !done) return failure(std::move(done));
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (state.uploads->buffers[i]) fill(layers[i], state.uploads->buffers[i]->memory.mapped);
    Frame frame = state.uploaded_frame(input);
    frame.target = reference_to(state.target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    const RecordBefore upload = [&](VkCommandBuffer commands) -> Result<> {
        state.record_uploads(input.extent, commands);
        return {};
    };
    if (Result<> done = state.run(composer, frame, upload, nullptr); !done) return failure(std::move(done));
    return state.picture();
}

Result<DevelopedPicture> Developer::develop(Composer& composer, const DeviceFrame& input, FrameLayers* layers) {
    State& state = *state_;
    Frame frame = input.frame;
    DARKROOM_ASSERT(frame.color.is_given());
    if (Result<> done = check_extent(state.context(), frame.color.used_region().extent); !done)
        return failure(std::move(done));
    const CompileDesc wanted = compile_desc_for(state.context(), input, state.desc);
    if (Result<> done = state.compile(composer, wanted); !done) return failure(std::move(done));
    frame.target = reference_to(state.target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    std::optional<FrameReadback> readback;
    if (layers != nullptr) {
        Result<FrameReadback> made = FrameReadback::create(state.context(), frame);
        if (!made) return failure(std::move(made));
        readback = std::move(*made);
    }
    std::vector<ImageRef*> images{&frame.color, &frame.depth, &frame.normals, &frame.velocity};
    state.lights.assign(frame.lights.begin(), frame.lights.end());
    for (Light& light : state.lights) images.push_back(&light.cascades);
    frame.lights = state.lights;
    for (ImageRef* const image : images) {
        if (image->final_layout == VK_IMAGE_LAYOUT_UNDEFINED) image->final_layout = image->layout;
        if (!readback) continue;
        image->last_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;  // the read-back's
        image->last_access = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    }
    Result<> done = state.run(composer, frame, input.record_before, readback ? &*readback : nullptr);
    if (!done) return failure(std::move(done));
    if (readback) *layers = readback->layers();
    return state.picture();
}

const Plan& Developer::plan() const { return state_->plan; }

}  // namespace darkroom
