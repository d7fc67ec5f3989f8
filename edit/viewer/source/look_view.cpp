// SPDX-License-Identifier: MIT
#include "look_view.hpp"

#include <algorithm>
#include <utility>

#include "gpu/device/context.hpp"
#include "plan/frame_inputs.hpp"

namespace app {

using darkroom::CompileDesc;
using darkroom::Result;

namespace {

constexpr VkFormat code_format = VK_FORMAT_R8G8B8A8_UNORM, light_format = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat watched_format = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr std::uint32_t watch_id = 1;

VkExtent2D extent_of(const darkroom::PlanImage& image, std::uint32_t mip_level) {
    return {std::max(image.extent.width >> mip_level, 1U), std::max(image.extent.height >> mip_level, 1U)};
}

/// After so many frames of one size the plan is made for it: it takes the least memory, and gives the same bits as a
/// picture that is made once.
constexpr std::uint32_t frames_to_settle = 20;

VkExtent2D max_of(VkExtent2D a, VkExtent2D b) { return {std::max(a.width, b.width), std::max(a.height, b.height)}; }
VkExtent2D min_of(VkExtent2D a, VkExtent2D b) { return {std::min(a.width, b.width), std::min(a.height, b.height)}; }
bool is_equal(VkExtent2D a, VkExtent2D b) { return a.width == b.width && a.height == b.height; }

bool is_same(const CompileDesc& a, const CompileDesc& b) {
    return darkroom::plan::bring_the_same(a, b) && a.watches == b.watches;
}

}  // namespace

LookView::LookView(darkroom::Device& device, Desc desc)
    : device_(device),
      desc_(std::move(desc)),
      composer_(device, {.frames_in_flight = desc_.frames_in_flight, .has_timers = true}) {
    shown_.entries.clear();
}

Result<> LookView::show(const darkroom::Look& look) {
    keeps_what_is_off_ = desc_.keeps_what_is_off;
    return follow(look);
}

Result<> LookView::follow(const darkroom::Look& look) {
    DARKROOM_TRY_VALUE(const darkroom::Followed followed,
                       darkroom::follow(shown_, look, composer_,
                                        {.keeps_what_is_off = keeps_what_is_off_, .keeps = desc_.timeline.entries()}));
    shown_ = look;
    desc_.timeline.follow(look);
    is_of_look_ = false;
    return followed.needs_compile && is_compiled_ ? compile(compiled_) : Result<>();
}

Result<> LookView::fit(const LiveSource& source, VkExtent2D extent, VkFormat ui, bool is_kept) {
    CompileDesc wanted = source.compile_desc({});
    // A source that was read again knows its formats when it is prepared.
    if (wanted.color.format == VK_FORMAT_UNDEFINED) return {};
    // What is off parts the kernels of what is on, and with them go bits.
    if (is_kept && std::exchange(keeps_what_is_off_, false)) DARKROOM_TRY(follow(darkroom::Look(shown_)));
    wanted.kernels = desc_.kernels;
    wanted.fuse = desc_.fuse;
    if (desc_.makes_light) {
        wanted.target.format = light_format;
        wanted.target_domain = darkroom::Domain::SceneLinear;
    }
    wanted.target.usage |=
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (ui != VK_FORMAT_UNDEFINED) wanted.ui = {ui, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    wanted.watches = watches_;
    const VkExtent2D had = compiled_.max_extent;
    const bool fits = extent.width <= had.width && extent.height <= had.height;
    frames_alike_ = is_equal(extent, last_extent_) ? frames_alike_ + 1 : 0;
    last_extent_ = extent;
    const bool is_waiting = !is_kept && frames_alike_ < frames_to_settle;
    const bool is_settled = is_equal(extent, had) || (fits && is_waiting);
    is_settling_ = !is_equal(extent, had);
    if (is_compiled_ && is_settled && is_same(wanted, compiled_)) return {};
    // While sizes come and go a plan only grows.
    wanted.max_extent = is_waiting ? max_of(extent, had) : extent;
    return compile(wanted);
}

Result<> LookView::compile(const CompileDesc& desc) {
    compiled_ = desc;
    if (desc_.enlarges) compiled_.target_extent = desc.max_extent;
    if (is_compiled_) {
        const VkExtent2D asked = desc.max_extent;
        least_pending_ = composer_.pending().is_pending ? min_of(least_pending_, asked) : asked;
        return composer_.compile_later(compiled_);
    }
    DARKROOM_TRY(composer_.compile(compiled_));
    is_compiled_ = true;
    return {};
}

// A plan that is on its way may be taken by the very next record.
VkExtent2D LookView::most() const {
    const darkroom::Plan* const plan = composer_.current_plan();
    if (plan == nullptr) return {};
    return composer_.pending().is_pending ? min_of(plan->extent, least_pending_) : plan->extent;
}

bool LookView::must_wait(VkExtent2D extent) const {
    return picture_.handle != VK_NULL_HANDLE &&
           (picture_.info.extent.width != extent.width || picture_.info.extent.height != extent.height);
}

Result<> LookView::resize(VkExtent2D extent) {
    if (picture_.handle != VK_NULL_HANDLE && !must_wait(extent)) return {};
    DARKROOM_TRY_VALUE(picture_,
                       darkroom::gpu::Image::create(device_.context(), {.name = "picture",
                                                                        .format = compiled_.target.format,
                                                                        .extent = {extent.width, extent.height, 1},
                                                                        .usage = compiled_.target.usage}));
    is_drawn_ = is_of_look_ = false;
    return {};
}

Result<> LookView::record(VkCommandBuffer commands, darkroom::Frame frame) {
    frame.target = reference();
    frame.target.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    frame.target.final_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    frame.target.final_stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    frame.target.final_access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    darkroom::Watched watched{.id = watch_id, .target = frame.target};
    if (watched_.handle != VK_NULL_HANDLE) {
        watched.target.image = watched_.handle;
        watched.target.view = watched_.mip_views[0];
        watched.target.format = watched_format;
        watched.target.extent = {watched_.info.extent.width, watched_.info.extent.height};
        frame.watched = {&watched, 1};
    }
    DARKROOM_TRY(desc_.timeline.advance(composer_, frame.time));
    Result<> done = composer_.record(commands, frame);
    is_drawn_ = is_drawn_ || done;
    is_of_look_ = done.has_value();
    if (done && desc_.makes_light) transfer_ = darkroom::window::PaneTransfer::SceneLinear;
    return done;
}

bool LookView::is_current() const {
    const darkroom::Plan* const plan = composer_.current_plan();
    return is_of_look_ && !is_coming() && plan != nullptr && std::ranges::none_of(plan->images, [](const auto& image) {
               return image.kind == darkroom::PlanImage::Kind::History;
           });
}

bool LookView::must_wait_to_watch(const darkroom::PlanImage* image, std::uint32_t mip_level) const {
    if (watched_.handle == VK_NULL_HANDLE) return false;
    return image == nullptr ||
           !is_equal(extent_of(*image, mip_level), {watched_.info.extent.width, watched_.info.extent.height});
}

Result<> LookView::watch(const darkroom::PlanImage* image, std::uint32_t mip_level) {
    watches_.clear();
    if (image == nullptr) {
        watched_ = {};
        return {};
    }
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    watches_.push_back(
        {.id = watch_id, .image = image->name, .mip_level = mip_level, .target = {watched_format, usage}});
    if (watched_.handle != VK_NULL_HANDLE && !must_wait_to_watch(image, mip_level)) return {};
    const VkExtent2D extent = extent_of(*image, mip_level);
    DARKROOM_TRY_VALUE(
        watched_,
        darkroom::gpu::Image::create(
            device_.context(),
            {.name = "watched", .format = watched_format, .extent = {extent.width, extent.height, 1}, .usage = usage}));
    return {};
}

darkroom::WatchState LookView::watch_state() const { return composer_.watch_state(watch_id); }

darkroom::ImageRef LookView::watched() const {
    const darkroom::WatchState state = watch_state();
    const bool is_shown = state == darkroom::WatchState::Shown || state == darkroom::WatchState::InputShown;
    if (!is_shown || watched_.handle == VK_NULL_HANDLE) return {};
    darkroom::ImageRef out = reference();
    out.image = watched_.handle;
    out.view = watched_.mip_views[0];
    out.format = watched_format;
    out.extent = {watched_.info.extent.width, watched_.info.extent.height};
    return out;
}

void LookView::copy(VkCommandBuffer commands, const darkroom::ImageRef& from) {
    change_layout(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const auto end_of = [](VkExtent2D of) {
        return VkOffset3D{static_cast<std::int32_t>(of.width), static_cast<std::int32_t>(of.height), 1};
    };
    const VkImageSubresourceLayers layer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    // The formats differ where pictures are light.
    const VkImageBlit whole{.srcSubresource = layer,
                            .srcOffsets = {{}, end_of(from.extent)},
                            .dstSubresource = layer,
                            .dstOffsets = {{}, end_of(extent())}};
    device_.context().vk.CmdBlitImage(commands, from.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, picture_.handle,
                                      VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole,
                                      is_equal(from.extent, extent()) ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
    change_layout(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    is_drawn_ = true;
    is_of_look_ = false;
    transfer_ = darkroom::window::PaneTransfer::Encoded;
}

void LookView::copy_to(VkCommandBuffer commands, const darkroom::gpu::Image& image) const {
    const darkroom::gpu::Context& context = device_.context();
    const auto end_of = [](const darkroom::gpu::Image& of) {
        return VkOffset3D{static_cast<std::int32_t>(of.info.extent.width),
                          static_cast<std::int32_t>(of.info.extent.height), 1};
    };
    const VkImageBlit whole{.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                            .srcOffsets = {{}, end_of(picture_)},
                            .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                            .dstOffsets = {{}, end_of(image)}};
    darkroom::gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_UNDEFINED,
                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    change_layout(commands, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    context.vk.CmdBlitImage(commands, picture_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image.handle,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole, VK_FILTER_LINEAR);
    change_layout(commands, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void LookView::change_layout(VkCommandBuffer commands, VkImageLayout from, VkImageLayout to) const {
    darkroom::gpu::transition(device_.context(), commands, picture_, from, to);
}

darkroom::ImageRef LookView::picture() const { return is_drawn_ ? reference() : darkroom::ImageRef{}; }

darkroom::ImageRef LookView::reference() const {
    return {.image = picture_.handle,
            .view = picture_.mip_views.empty() ? VK_NULL_HANDLE : picture_.mip_views[0],
            .format = picture_.info.format,
            .extent = {picture_.info.extent.width, picture_.info.extent.height},
            .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
            .last_stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            .last_access = VK_ACCESS_2_MEMORY_READ_BIT};
}

Result<> LookView::planned() const {
    const darkroom::PendingCompile pending = composer_.pending();
    return pending.error ? Result<>(failure(*pending.error)) : Result<>();
}

}  // namespace app
