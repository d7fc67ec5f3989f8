// SPDX-License-Identifier: MIT
#include "verify/runner.hpp"

#include <algorithm>

namespace darkroom::verify {

namespace {

constexpr VkFormat target_format = VK_FORMAT_R32G32B32A32_SFLOAT;

/// Nothing is skipped and nothing added: the picture is what the subject's last step makes.
constexpr DevelopDesc as_it_is{.target = DevelopTarget::EncodedFloat};

/// The step of numbers of size 1: what is rounded may be cut off (Vulkan specification, "Fixed-Point Data Conversions"
/// and "Floating-Point Format Conversions").
double step_of(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R32_SFLOAT:
        case VK_FORMAT_R32G32_SFLOAT:
        case VK_FORMAT_R32G32B32A32_SFLOAT:
        case VK_FORMAT_R32_UINT:
            return 0;
        case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
            return 0x1p-5;
        case VK_FORMAT_R8_UNORM:
        case VK_FORMAT_R8G8_UNORM:
        case VK_FORMAT_R8G8B8A8_UNORM:
            return 0x1p-8;
        default:
            return 0x1p-10;
    }
}

/// Passes that write no image count pixels, by light in sixteenths of an eighth of a stop: half of one, to either side.
constexpr double half_a_count = 0.0015;

}  // namespace

Result<std::unique_ptr<DeviceScene>> DeviceScene::create(Device& device, VkExtent2D extent, VkExtent2D output) {
    auto out = std::make_unique<DeviceScene>();
    for (std::uint32_t number = 0; number < frame_count; ++number) out->frames_.emplace_back(extent, number, output);
    for (const SceneFrame& frame : out->frames_) {
        const DevelopInput input = frame.input();
        DARKROOM_TRY(out->uploads_.emplace_back().prepare(device.context(), input, layers_of(input)));
    }
    DARKROOM_TRY(gpu::submit_and_wait(device.context(), "uploading a scene", [&](VkCommandBuffer commands) {
        for (const FrameUpload& upload : out->uploads_) upload.record(device.context(), commands);
    }));
    return out;
}

Frame DeviceScene::frame(std::size_t number) const {
    Frame out = uploads_[number].frame(frames_[number].input());
    // They come back as record() of the upload left them, for the next reader.
    for (ImageRef* const image : {&out.color, &out.depth, &out.normals, &out.velocity, &out.reactive, &out.transparency,
                                  &out.exposure, &out.ui})
        image->final_layout = image->layout;
    return out;
}

Runner::Runner(Device& device, const DeviceScene& scene)
    : device_(device), scene_(scene), composer_(device, {.frames_in_flight = frame_count}) {}

Result<std::unique_ptr<Runner>> Runner::create(Device& device, const Subject& subject, const DeviceScene& scene,
                                               KernelStage stage) {
    std::unique_ptr<Runner> out(new Runner(device, scene));
    DARKROOM_TRY(out->prepare(subject, stage));
    return out;
}

Result<> Runner::prepare(const Subject& subject, KernelStage stage) {
    DARKROOM_TRY(fill(subject, composer_));
    DevelopDesc desc = as_it_is;
    desc.kernels = stage;
    desc.target_extent = scene_.frames().back().output();
    CompileDesc compile = compile_desc_for(device_, scene_.frames().back().input(), desc);
    compile.encodes_target = false;
    DARKROOM_TRY_VALUE(plan_, composer_.compile(compile));
    has_history_ = std::ranges::any_of(plan_.images,
                                       [](const PlanImage& image) { return image.kind == PlanImage::Kind::History; });
    for (const Step& step : subject.steps) has_history_ |= step.info->touch == Touch::History || step.info->pre_roll;
    const VkExtent2D output = scene_.frames().back().output();
    const VkExtent2D extent = output.width != 0      ? output
                              : plan_.passes.empty() ? plan_.extent
                                                     : plan_.passes.back().extent;
    DARKROOM_TRY_VALUE(target_, gpu::Image::create(device_.context(),
                                                   {.name = "target",
                                                    .format = target_format,
                                                    .extent = {extent.width, extent.height, 1},
                                                    .usage = compile.target.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
    DARKROOM_TRY_VALUE(readback_,
                       Readback::create(device_.context(), reference_to(target_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                                                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL)));
    return {};
}

Precision Runner::precision() const {
    Precision out{.image_step = 0, .passes = plan_.passes.size()};
    for (const PlanImage& image : plan_.images)
        if (image.kind != PlanImage::Kind::Host) out.image_step = std::max(out.image_step, step_of(image.format));
    for (const PlanPass& pass : plan_.passes)
        if (pass.writes.image == PlanImage::never) out.count_step = half_a_count;
    return out;
}

Result<> Runner::record(VkCommandBuffer commands, std::size_t number) {
    Frame frame = scene_.frame(number);
    std::vector<Light> lights(frame.lights.begin(), frame.lights.end());
    for (Light& light : lights) light.cascades.final_layout = light.cascades.layout;
    frame.lights = lights;
    frame.target = reference_to(target_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    DARKROOM_TRY(composer_.record(commands, frame));
    readback_->record(commands);
    return {};
}

Result<ReferenceImage> Runner::run() {
    for (std::size_t number = first_frame(); number < frame_count; ++number) {
        Result<> recorded{};
        const Result<> done =
            gpu::submit_and_wait(device_.context(), "verifying a kernel",
                                 [&](VkCommandBuffer commands) { recorded = record(commands, number); });
        if (!recorded) return failure(recorded.error());
        if (!done) return failure(done.error());
    }
    return read();
}

ReferenceImage Runner::read() const {
    const std::vector<float> numbers = readback_->floats(4);
    ReferenceImage out(target_.info.extent.width, target_.info.extent.height);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const float* const p = numbers.data() + i * 4;
        out.pixels[i] = {p[0], p[1], p[2], p[3]};
    }
    return out;
}

}  // namespace darkroom::verify
