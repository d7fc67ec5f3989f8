// SPDX-License-Identifier: MIT
#include "develop/inspect/prober.hpp"

#include <algorithm>
#include <cmath>

#include "core/assert.hpp"
#include "develop/upload.hpp"
#include "gpu/device/context.hpp"

namespace darkroom {

namespace {

constexpr ImageUse view_use{VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};

/// Of `rgba`, the pixels that are not finite; `entry` is left to the caller.
std::optional<NonFiniteBirth> non_finite(std::span<const float> rgba, VkExtent2D extent, VkOffset2D from) {
    std::optional<NonFiniteBirth> out;
    std::int64_t nearest = 0;
    for (std::uint32_t i = 0; i < rgba.size() / 4; ++i) {
        if (std::ranges::all_of(rgba.subspan(std::size_t{i} * 4, 4), [](float v) { return std::isfinite(v); }))
            continue;
        const VkOffset2D at{static_cast<std::int32_t>(i % extent.width), static_cast<std::int32_t>(i / extent.width)};
        const std::int64_t x = at.x - from.x, y = at.y - from.y, distance = x * x + y * y;
        if (!out || distance < nearest) {
            nearest = distance;
            out = NonFiniteBirth{.at = at, .pixels = out ? out->pixels : 0};
        }
        ++out->pixels;
    }
    return out;
}

}  // namespace

struct Prober::State {
    State(Device& on, const DevelopDesc& develop, std::uint32_t max_pixels)
        : device(on),
          desc(develop),
          inspector(on, {.frames_in_flight = 1, .max_pixels = max_pixels, .view = view_use}) {}

    /// Uploads, records and waits; `view`, if it is given, is read back.
    Result<Inspection> run(const Composer& composer, const DevelopInput& input, std::span<const VkOffset2D> pixels,
                           std::span<const InspectorView> views, const Readback* view) {
        gpu::Context& context = device.context();
        const UploadLayers layers = layers_of(input);
        upload.reset();
        DARKROOM_TRY(upload.prepare(context, input, layers));
        const Frame frame = upload.frame(input);
        DARKROOM_TRY(inspector.update(composer, compile_desc_for(device, input, desc), frame));
        DARKROOM_TRY(inspector.wait());
        Result<std::uint64_t> number = 0;
        auto done = gpu::submit_and_wait(context, "probing a picture", [&](VkCommandBuffer commands) {
            upload.record(context, commands);
            number = inspector.record(commands, composer, frame, pixels, views);
            if (number && view != nullptr) view->record(commands);
        });
        if (!number) return failure(number.error());
        if (!done) return failure(std::move(done));
        std::optional<Inspection> result = inspector.result(*number);
        DARKROOM_ASSERT(result.has_value());
        return std::move(*result);
    }

    Device& device;
    DevelopDesc desc;
    FrameUpload upload;
    Inspector inspector;
};

Prober::Prober(Device& device, const DevelopDesc& desc, std::uint32_t max_pixels)
    : state_(std::make_unique<State>(device, desc, max_pixels)) {}
Prober::Prober(Prober&&) noexcept = default;
Prober& Prober::operator=(Prober&&) noexcept = default;
Prober::~Prober() = default;

/// Each is a watch for every value, and all of them together another one.
std::size_t Prober::max_pixels(const Composer& composer) {
    const std::size_t most = max_watches / (composer.size() + 1);
    return most > 1 ? most - 1 : 0;
}

Result<Inspection> Prober::probe(const Composer& composer, const DevelopInput& input,
                                 std::span<const VkOffset2D> pixels) {
    return state_->run(composer, input, pixels, {}, nullptr);
}

Result<std::optional<NonFiniteBirth>> Prober::find_birth(const Composer& composer, const DevelopInput& input,
                                                         VkOffset2D from) {
    gpu::Context& context = state_->device.context();
    DARKROOM_TRY_VALUE(auto image,
                       gpu::Image::create(context, {.name = "a probed picture",
                                                    .format = view_use.format,
                                                    .extent = {input.extent.width, input.extent.height, 1},
                                                    .usage = view_use.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
    constexpr VkImageLayout layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    DARKROOM_TRY_VALUE(auto readback, Readback::create(context, reference_to(image, layout, layout)));
    for (std::size_t value = 0; value <= composer.size(); ++value) {
        state_->inspector.abandon();
        const InspectorView view{.entry = value == 0 ? scene_color : composer.entry(value - 1),
                                 .target = reference_to(image, VK_IMAGE_LAYOUT_UNDEFINED, layout)};
        DARKROOM_TRY(state_->run(composer, input, {}, {&view, 1}, &readback));
        auto found = non_finite(readback.floats(4), input.extent, from);
        if (!found) continue;
        if (value > 0) found->entry = value - 1;
        return found;
    }
    return std::optional<NonFiniteBirth>{};
}

}  // namespace darkroom
