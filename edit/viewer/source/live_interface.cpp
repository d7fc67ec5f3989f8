// SPDX-License-Identifier: MIT
#include "live_interface.hpp"

#include <algorithm>
#include <cstring>

#include "gpu/device/context.hpp"
#include "image/picture/ui_image.hpp"
#include "programs/darkroom/run/ui_source.hpp"

namespace app {

namespace gpu = darkroom::gpu;
using darkroom::Result;

namespace {

bool has_extent(const gpu::Image& image, VkExtent2D extent) {
    return image.info.extent.width == extent.width && image.info.extent.height == extent.height;
}

}  // namespace

LiveInterface::LiveInterface(darkroom::Device& device, bool is_headless, std::uint32_t slots, darkroom::LogSink print,
                             std::filesystem::path folder)
    : device_(device),
      is_headless_(is_headless),
      print_(std::move(print)),
      folder_(std::move(folder)),
      staging_(slots) {}

Result<> LiveInterface::start(const darkroom::Look& look, const Timeline& timeline, darkroom::Composer& composer) {
    controllers_.reset();
    document_.reset();
    shown_.reset();
    uploaded_.reset();
    inertia_.reset();
    failed_.clear();
    ui_ = interface_of(look);
    events_ = timeline.game();
    composer_ = &composer;
    console_ = std::make_unique<darkroom::Console>(composer, darkroom::ConsoleDesc{.print = print_, .folder = folder_});
    if (std::filesystem::path(ui_.document).extension() == ".svg") {
        DARKROOM_TRY_VALUE(document_, darkroom::HudDocument::load(ui_.document, {.is_headless = is_headless_}));
    }
    if (ui_.controllers.empty()) return {};
    const auto set_class = [this](std::string_view id, std::string_view name, bool is_on) {
        return document_ != nullptr && document_->set_class(id, name, is_on);
    };
    DARKROOM_TRY_VALUE(auto made, darkroom::Controllers::create(*console_, {.print = print_, .set_class = set_class}));
    controllers_.emplace(std::move(made));
    for (const std::string& file : ui_.controllers) DARKROOM_TRY(controllers_->load(file));
    return {};
}

Result<> LiveInterface::advance(double time, const HeadMotion& motion, bool is_menu_open) {
    if (composer_ == nullptr || (!is_given() && !controllers_)) return {};
    game_ = game_at(ui_.game, events_, time);
    // Its degrees grow to the right, a camera's to the left. A hand moves the view on top of what events do with it.
    const darkroom::Vec2 hand = inertia_.step(motion.delta_time, -motion.yaw, motion.is_on_ground, motion.velocity_up);
    const darkroom::Vec2 told = inertia_at(events_, time);
    DARKROOM_TRY(move_interface(*composer_, {hand.x + told.x, hand.y + told.y}));
    if (controllers_) controllers_->frame({.time = time, .is_hud_visible = !is_menu_open, .game = &game_});
    if (document_ != nullptr) {
        for (const auto& [name, value] : game_) document_->set(name, hud_value(value));
        told_error_ = document_->error();
        if (!document_->error().empty()) return darkroom::user_error(document_->error());
    }
    return failed_.empty() ? Result<>() : darkroom::user_error(failed_);
}

void LiveInterface::reload_changed() {
    if (controllers_) controllers_->reload_changed();
}

bool LiveInterface::must_wait(VkExtent2D extent, VkExtent2D of_frame) const {
    const auto is_other = [](const gpu::Image& image, VkExtent2D wanted) {
        return image.handle != VK_NULL_HANDLE && !has_extent(image, wanted);
    };
    return is_other(image_, extent) || is_other(scaled_, of_frame);
}

// Asking makes the document begin a drawing that is due.
bool LiveInterface::is_new() const {
    if (document_ == nullptr || recorded_extent_.width == 0) return false;
    const auto drawn = document_->picture(recorded_extent_.width, recorded_extent_.height, recorded_scale_);
    if (document_->error() != told_error_) return true;
    return drawn != nullptr && Bytes(drawn, &drawn->rgba) != uploaded_ && drawn->width == recorded_extent_.width &&
           drawn->height == recorded_extent_.height;
}

Result<LiveInterface::Bytes> LiveInterface::picture(VkExtent2D& extent, float scale) {
    if (document_ != nullptr) {
        const auto drawn = document_->picture(extent.width, extent.height, scale);
        if (drawn == nullptr) return Bytes();
        extent = {drawn->width, drawn->height};
        return Bytes(drawn, &drawn->rgba);
    }
    if (shown_ != nullptr && shown_extent_.width == extent.width && shown_extent_.height == extent.height)
        return shown_;
    std::vector<std::string> warnings;
    DARKROOM_TRY_VALUE(auto made, darkroom::read_ui_image(ui_.document, extent.width, extent.height, &warnings));
    if (shown_ == nullptr && print_)
        for (const std::string& warning : warnings) print_(darkroom::Severity::Warning, warning);
    shown_extent_ = extent;
    return shown_ = std::make_shared<const std::vector<std::uint8_t>>(std::move(made));
}

Result<> LiveInterface::resize(VkExtent2D extent) {
    if (image_.handle != VK_NULL_HANDLE && has_extent(image_, extent)) return {};
    DARKROOM_TRY_VALUE(image_, gpu::Image::create(device_.context(), {.name = "interface",
                                                                      .format = image_format,
                                                                      .extent = {extent.width, extent.height, 1},
                                                                      .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                                                               VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                                                               VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
    for (gpu::Buffer& buffer : staging_) {
        DARKROOM_TRY_VALUE(
            buffer, gpu::Buffer::create(device_.context(), VkDeviceSize{4} * extent.width * extent.height,
                                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Memory::Kind::Upload, "interface"));
    }
    layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
    uploaded_.reset();
    return {};
}

Result<> LiveInterface::scale_to(VkCommandBuffer commands, VkExtent2D of_frame) {
    if (scaled_.handle == VK_NULL_HANDLE || !has_extent(scaled_, of_frame)) {
        DARKROOM_TRY_VALUE(scaled_,
                           gpu::Image::create(device_.context(),
                                              {.name = "interface, scaled",
                                               .format = image_format,
                                               .extent = {of_frame.width, of_frame.height, 1},
                                               .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
    }
    const gpu::Context& context = device_.context();
    const auto end_of = [](const gpu::Image& of) {
        return VkOffset3D{static_cast<std::int32_t>(of.info.extent.width),
                          static_cast<std::int32_t>(of.info.extent.height), 1};
    };
    const VkImageSubresourceLayers layer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageBlit whole{.srcSubresource = layer,
                            .srcOffsets = {{}, end_of(image_)},
                            .dstSubresource = layer,
                            .dstOffsets = {{}, end_of(scaled_)}};
    gpu::transition(context, commands, image_, layout_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    gpu::transition(context, commands, scaled_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    context.vk.CmdBlitImage(commands, image_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, scaled_.handle,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole, VK_FILTER_LINEAR);
    gpu::transition(context, commands, image_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout_);
    gpu::transition(context, commands, scaled_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout_);
    return {};
}

darkroom::ImageRef LiveInterface::reference_to(const gpu::Image& image) const {
    return {.image = image.handle,
            .view = image.mip_views[0],
            .format = image_format,
            .extent = {image.info.extent.width, image.info.extent.height},
            .layout = layout_,
            .final_layout = layout_};
}

Result<darkroom::ImageRef> LiveInterface::record(VkCommandBuffer commands, std::uint32_t slot, VkExtent2D extent,
                                                 VkExtent2D of_frame, float scale) {
    DARKROOM_TRY(resize(extent));
    recorded_extent_ = extent;
    recorded_scale_ = scale;
    VkExtent2D drawn = extent;
    const Result<Bytes> read = picture(drawn, scale);
    if (!read) failed_ = read.error().text;
    const Bytes bytes = read ? *read : nullptr;
    const gpu::Context& context = device_.context();
    // A drawing of another size is of before a resize: the new one is under way.
    const bool fits = bytes != nullptr && drawn.width == extent.width && drawn.height == extent.height;
    const bool is_new = fits ? bytes != uploaded_ : layout_ == VK_IMAGE_LAYOUT_UNDEFINED;
    if (is_new) {
        gpu::transition(context, commands, image_, layout_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        if (fits) {
            std::memcpy(staging_[slot].memory.mapped, bytes->data(), bytes->size());
            const VkBufferImageCopy whole{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                          .imageExtent = {extent.width, extent.height, 1}};
            context.vk.CmdCopyBufferToImage(commands, staging_[slot].handle, image_.handle,
                                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole);
            uploaded_ = bytes;
        } else {
            const VkClearColorValue nothing{};
            const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            context.vk.CmdClearColorImage(commands, image_.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &nothing, 1,
                                          &whole);
        }
        layout_ = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        gpu::transition(context, commands, image_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout_);
    }
    if (has_extent(image_, of_frame)) return reference_to(image_);
    DARKROOM_TRY(scale_to(commands, of_frame));
    return reference_to(scaled_);
}

}  // namespace app
