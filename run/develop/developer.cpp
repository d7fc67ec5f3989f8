// SPDX-License-Identifier: MIT
#include "develop/developer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/assert.hpp"
#include "develop/upload.hpp"
#include "gpu/device/context.hpp"
#include "gpu/resource/resources.hpp"
#include "plan/frame_inputs.hpp"

namespace darkroom {

namespace {

bool has_cascades(const ReferenceLight& light) { return !light.cascades.empty(); }

VkImageUsageFlags target_usage(const gpu::Context& context, VkFormat format) {
    VkImageUsageFlags usage = 0;
    if (context.supports(format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    if (context.supports(format, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT)) usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    return usage;
}

/// All of a CompileDesc that follows from the target alone.
CompileDesc compile_desc_for(gpu::Context& context, const DevelopDesc& desc) {
    const bool is_bytes = desc.target == DevelopTarget::Encoded8;
    const VkFormat target = is_bytes ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_R32G32B32A32_SFLOAT;
    return {.target = {target, target_usage(context, target)},
            .target_extent = desc.target_extent,
            .target_color = desc.color,
            .target_domain = desc.target == DevelopTarget::SceneLinear ? Domain::SceneLinear : Domain::Encoded,
            .encodes_target = desc.target != DevelopTarget::SceneLinear,
            .kernels = desc.kernels,
            .fuse = desc.fuse};
}

CompileDesc compile_desc_for(gpu::Context& context, const DevelopInput& input, const UploadLayers& layers,
                             const DevelopDesc& desc) {
    const auto use = [&](std::size_t i) {
        if (!layers[i].is_given()) return ImageUse{};
        return ImageUse{layers[i].format, shader_usage(context, layers[i].format)};
    };
    CompileDesc out = compile_desc_for(context, desc);
    out.max_extent = input.extent;
    out.is_color_associated = input.is_color_associated;
    out.color = {layers[0].format, shader_usage(context, layers[0].format)};
    out.depth = use(1);
    out.is_depth_planar = out.depth.format != VK_FORMAT_UNDEFINED;
    out.normals = use(2);
    out.velocity = use(3);
    out.is_velocity_plain = true;
    out.reactive = use(4);
    out.transparency = use(5);
    out.exposure = use(6);
    out.ui = use(7);
    out.has_shadows = std::any_of(input.lights.begin(), input.lights.end(), has_cascades);
    return out;
}

/// Do two descriptions that one DevelopDesc made ask for the same?
bool is_same(const CompileDesc& a, const CompileDesc& b) {
    return a.max_extent.width == b.max_extent.width && a.max_extent.height == b.max_extent.height &&
           a.is_color_associated == b.is_color_associated && plan::bring_the_same(a, b);
}

}  // namespace

CompileDesc compile_desc_for(Device& device, const DevelopInput& input, const DevelopDesc& desc) {
    return compile_desc_for(device.context(), input, layers_of(input, desc.target_extent), desc);
}

CompileDesc compile_desc_for(gpu::Context& context, const DeviceFrame& input, const DevelopDesc& desc) {
    const Frame& frame = input.frame;
    CompileDesc out = compile_desc_for(context, desc);
    out.max_extent = frame.color.used_region().extent;
    out.color = {frame.color.format, input.color_usage};
    for (const plan::FrameInput& layer : plan::frame_inputs)
        if (layer.use != nullptr) out.*layer.use = {(frame.*layer.given).format, input.layer_usage};
    out.is_depth_planar = frame.depth.is_given() && frame.camera.depth == DepthKind::Planar;
    out.is_velocity_plain = frame.camera.velocity == VelocityKind{};
    out.ui = {frame.ui.format};
    if (!input.ui.empty()) out.ui = {VK_FORMAT_R8G8B8A8_UNORM, shader_usage(context, VK_FORMAT_R8G8B8A8_UNORM)};
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

namespace {

/// What one picture that is under way has for itself.
struct Slot {
    FrameUpload upload;
    gpu::Image target;
    std::optional<Readback> readback;
    gpu::Submission submission;
    std::optional<Result<DevelopedPicture>> picture;  ///< once it was waited for
};

}  // namespace

struct Developer::State {
    std::shared_ptr<gpu::Context> shared_context;
    DevelopDesc desc;
    std::optional<CompileDesc> compiled;
    const Composer* compiled_composer = nullptr;
    Plan plan;
    std::vector<Slot> slots;  ///< a ring
    std::uint32_t oldest = 0, in_flight = 0;
    std::vector<Light> lights;  ///< of the device frame that is being developed

    gpu::Context& context() const { return *shared_context; }
    Slot& next_slot() { return slots[(oldest + in_flight) % slots.size()]; }

    Result<> check(VkExtent2D extent, std::span<const UploadLayer> layers) const {
        DARKROOM_TRY(check_extent(context(), extent));
        for (const UploadLayer& layer : layers) {
            const auto [width, height] = layer.extent;
            const std::size_t pixels = std::size_t{width} * height;
            const bool is_required = layer.name == std::string_view("color");
            const auto is_wrong = [&](std::size_t count, std::size_t per_pixel) {
                return count > 0 && count != pixels * per_pixel;
            };
            if (is_wrong(layer.values.size(), layer.given) || (is_required && !layer.is_given()))
                return user_error(fmt::format("{}: {} numbers, {}x{} pixels need {}", layer.name, layer.values.size(),
                                              width, height, pixels * layer.given));
            if (is_wrong(layer.bytes.size(), layer.kept))
                return user_error(fmt::format("{}: {} bytes, {}x{} pixels need {}", layer.name, layer.bytes.size(),
                                              width, height, pixels * layer.kept));
            if (is_wrong(layer.codes.size(), layer.given))
                return user_error(fmt::format("{}: {} codes, {}x{} pixels need {}", layer.name, layer.codes.size(),
                                              width, height, pixels * layer.given));
            if (is_wrong(layer.halves.size(), layer.given_halves))
                return user_error(fmt::format("{}: {} halves, {}x{} pixels need {}", layer.name, layer.halves.size(),
                                              width, height, pixels * layer.given_halves));
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

    /// Plan and kernels, and room for what comes of them.
    Result<> compile(Composer& composer, const CompileDesc& wanted) {
        if (compiled && compiled_composer == &composer && is_same(*compiled, wanted)) return {};
        wait_for_all();
        compiled.reset();
        DARKROOM_TRY_VALUE(plan, composer.compile(wanted));
        composer.wait_for_kernels();
        for (Slot& slot : slots) {
            slot.upload.reset();
            slot.readback.reset();
        }
        compiled = wanted;
        compiled_composer = &composer;
        return {};
    }

    /// Of the picture: as the stack makes it, whose last entry may work at another size than the frame's.
    [[nodiscard]] VkExtent2D target_extent() const {
        if (desc.target_extent.width != 0) return desc.target_extent;
        const auto target = std::ranges::find_if(plan.images, [](const PlanImage& image) {
            return image.kind == PlanImage::Kind::Host && image.name == "target";
        });
        return target == plan.images.end() ? compiled->max_extent : target->extent;
    }

    /// Target and read-back of a picture as it was compiled.
    Result<> make_target(Slot& slot) const {
        if (slot.readback) return {};
        const auto [width, height] = target_extent();
        DARKROOM_TRY_VALUE(slot.target, gpu::Image::create(context(), {.name = "target",
                                                                       .format = compiled->target.format,
                                                                       .extent = {width, height, 1},
                                                                       .usage = compiled->target.usage |
                                                                                VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
        DARKROOM_TRY_VALUE(slot.readback,
                           Readback::create(context(), reference_to(slot.target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                                                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL)));
        return {};
    }

    /// `before`, the composer and the read-back in one submission.
    Result<> begin(Slot& slot, Composer& composer, Frame& frame, const RecordBefore& before,
                   const FrameReadback* layers) {
        DARKROOM_TRY(make_target(slot));
        frame.target = reference_to(slot.target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        Result<> recorded{};
        bool is_recorded = false;
        auto submission = gpu::Submission::begin(context(), "developing a picture", [&](VkCommandBuffer commands) {
            if (before) recorded = before(commands);
            if (!recorded) return;
            if (layers != nullptr) layers->record(commands);
            recorded = composer.record(commands, frame);
            is_recorded = recorded.has_value();
            if (recorded) slot.readback->record(commands);
        });
        if (!recorded) return recorded;
        if (!submission) {
            // Else the next recording would take the slot of one that still runs.
            if (is_recorded) static_cast<void>(composer.abandon());
            return failure(std::move(submission));
        }
        slot.submission = std::move(*submission);
        slot.picture.reset();
        ++in_flight;
        return {};
    }

    void wait(Slot& slot) const {
        if (slot.picture) return;
        const Result<> done = slot.submission.wait();
        slot.picture = done ? Result<DevelopedPicture>(picture(slot)) : failure(done.error());
    }

    void wait_for_all() {
        for (std::uint32_t i = 0; i < in_flight; ++i) wait(slots[(oldest + i) % slots.size()]);
    }

    Result<DevelopedPicture> finish() {
        DARKROOM_ASSERT(in_flight > 0);
        Slot& slot = slots[oldest];
        wait(slot);
        oldest = (oldest + 1) % static_cast<std::uint32_t>(slots.size());
        --in_flight;
        Result<DevelopedPicture> out = std::move(*slot.picture);
        slot.picture.reset();
        return out;
    }

    [[nodiscard]] DevelopedPicture picture(const Slot& slot) const {
        DevelopedPicture out{.extent = {slot.target.info.extent.width, slot.target.info.extent.height}};
        if (desc.target == DevelopTarget::Encoded8)
            out.bytes = slot.readback->bytes();
        else
            out.pixels = slot.readback->floats(4);
        return out;
    }
};

Developer::Developer(Device& device, const DevelopDesc& desc) : state_(std::make_unique<State>()) {
    state_->shared_context = device.shared_context();
    state_->desc = desc;
    state_->slots.resize(std::max(1U, desc.frames_in_flight));
}
Developer::Developer(Developer&&) noexcept = default;
Developer& Developer::operator=(Developer&&) noexcept = default;
Developer::~Developer() = default;

Result<> Developer::submit(Composer& composer, const DevelopInput& input) {
    State& state = *state_;
    DARKROOM_ASSERT(state.in_flight < state.slots.size());
    const UploadLayers layers = layers_of(input, state.desc.target_extent);
    DARKROOM_TRY(state.check(input.extent, layers));
    DARKROOM_TRY(state.check(input.lights));
    const CompileDesc wanted = compile_desc_for(state.context(), input, layers, state.desc);
    DARKROOM_TRY(state.compile(composer, wanted));
    Slot& slot = state.next_slot();
    DARKROOM_TRY(slot.upload.prepare(state.context(), input, layers));
    Frame frame = slot.upload.frame(input);
    const RecordBefore upload = [&](VkCommandBuffer commands) -> Result<> {
        slot.upload.record(state.context(), commands);
        return {};
    };
    return state.begin(slot, composer, frame, upload, nullptr);
}

Result<DevelopedPicture> Developer::finish() { return state_->finish(); }

std::uint32_t Developer::in_flight() const { return state_->in_flight; }

Result<DevelopedPicture> Developer::develop(Composer& composer, const DevelopInput& input) {
    DARKROOM_TRY(submit(composer, input));
    return finish();
}

Result<DevelopedPicture> Developer::develop(Composer& composer, const DeviceFrame& input, FrameLayers* layers) {
    State& state = *state_;
    Frame frame = input.frame;
    DARKROOM_ASSERT(frame.color.is_given());
    DARKROOM_TRY(check_extent(state.context(), frame.color.used_region().extent));
    const CompileDesc wanted = compile_desc_for(state.context(), input, state.desc);
    DARKROOM_TRY(state.compile(composer, wanted));
    std::optional<FrameReadback> readback;
    if (layers != nullptr) {
        DARKROOM_TRY_VALUE(readback, FrameReadback::create(state.context(), frame));
    }
    std::vector<ImageRef*> images{&frame.color};
    for (const plan::FrameInput& layer : plan::frame_inputs)
        if (layer.given != nullptr && layer.image != FrameImage::Ui) images.push_back(&(frame.*layer.given));
    state.lights.assign(frame.lights.begin(), frame.lights.end());
    for (Light& light : state.lights) images.push_back(&light.cascades);
    frame.lights = state.lights;
    for (ImageRef* const image : images) {
        if (image->final_layout == VK_IMAGE_LAYOUT_UNDEFINED) image->final_layout = image->layout;
        if (!readback) continue;
        image->last_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;  // the read-back's
        image->last_access = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    }
    Slot& slot = state.next_slot();
    RecordBefore before = input.record_before;
    if (!input.ui.empty()) {
        const DevelopInput interface { .extent = frame.color.used_region().extent, .ui = input.ui };
        const UploadLayers uploads = layers_of(interface, state.desc.target_extent);
        DARKROOM_TRY(state.check(interface.extent, std::span(uploads).last(1)));
        DARKROOM_TRY(slot.upload.prepare(state.context(), interface, uploads));
        frame.ui = slot.upload.frame(interface).ui;
        before = [&](VkCommandBuffer commands) -> Result<> {
            slot.upload.record(state.context(), commands);
            return input.record_before ? input.record_before(commands) : Result<>();
        };
    }
    DARKROOM_TRY(state.begin(slot, composer, frame, before, readback ? &*readback : nullptr));
    Result<DevelopedPicture> picture = state.finish();
    if (picture && readback) *layers = readback->layers();
    return picture;
}

const Plan& Developer::plan() const { return state_->plan; }

}  // namespace darkroom
