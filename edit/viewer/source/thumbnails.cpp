// SPDX-License-Identifier: MIT
#include "thumbnails.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/caught.hpp"
#include "core/thread/parallel.hpp"
#include "develop/developer.hpp"
#include "edit/edits.hpp"
#include "gpu/device/context.hpp"
#include "programs/darkroom/run/frames.hpp"
#include "programs/darkroom/run/jitter.hpp"
#include "small_frame.hpp"

namespace app {

using darkroom::EffectInfo;
using darkroom::Look;
using darkroom::Result;

namespace {

/// As wide as a line of the menu has room for, on a screen of twice the usual scale.
constexpr double max_width = 160;
constexpr std::size_t columns = 8;

/// With an amount that shows what it does, where its default is to do nothing. What reads a second picture gets the
/// scene for it: an entry that was just added names none.
Result<Look> with_effect(const Look& look, const EffectInfo& effect) {
    Look out = look;
    const Result<std::string> name = darkroom::edit::add_effect(out, effect);
    // What is there already, and once only, is shown as it is.
    if (!name) return effect.flat.is_of_ui() ? Result<Look>(out) : failure(name.error());
    darkroom::LookEntry* const entry = find_entry(out, *name);
    if (entry != nullptr && effect.has_second() && entry->second.empty()) entry->second = "scene";
    if (entry == nullptr || effect.is_identity == nullptr || !effect.is_identity(entry->words.data())) return out;
    for (const darkroom::ParamInfo& row : effect.parameters.rows)
        if (row.is_amount && row.kind == darkroom::Kind::Float)
            entry->words[row.word] = std::bit_cast<std::uint32_t>(static_cast<float>(std::min(1.0, row.range.max / 2)));
    return out;
}

}  // namespace

struct Thumbnails::Small {
    Small(const darkroom::Frame& frame, darkroom::FrameLayers layers, VkExtent2D extent)
        : file(frame_file(frame, std::move(layers))),
          lights(take_lights(file)),
          whole(develop_input(file, lights)),
          small(whole, extent),
          input(small.input()) {
        input.ui = {};
    }
    darkroom::FrameFile file;
    std::vector<darkroom::ReferenceLight> lights;
    darkroom::DevelopInput whole;
    SmallFrame small;
    darkroom::DevelopInput input;
};

Thumbnails::Thumbnails(darkroom::Device& device, const darkroom::Frame& frame, Desc desc, darkroom::FrameReadback read)
    : device_(device), frame_(frame), desc_(std::move(desc)), frame_read_(std::move(read)) {
    const VkExtent2D whole = frame.color.used_region().extent;
    extent_ = scaled(whole, std::min(1.0, max_width / whole.width));
    // What the frame refers to goes; what a file stores of it stays.
    frame_.lights = {};
    frame_.camera = as_stored(frame.camera);
}

Result<std::unique_ptr<Thumbnails>> Thumbnails::create(darkroom::Device& device, const darkroom::Frame& frame,
                                                       Desc desc) {
    namespace gpu = darkroom::gpu;
    DARKROOM_TRY_VALUE(darkroom::FrameReadback read, darkroom::FrameReadback::create(device.context(), frame));
    std::unique_ptr<Thumbnails> out(new Thumbnails(device, frame, std::move(desc), std::move(read)));
    const std::size_t count = darkroom::all_effects().size() + out->desc_.other_looks;
    const auto rows = static_cast<std::uint32_t>((count + columns - 1) / columns);
    const VkExtent3D extent{out->extent_.width * static_cast<std::uint32_t>(columns), out->extent_.height * rows, 1};
    DARKROOM_TRY_VALUE(out->atlas_, gpu::Image::create(device.context(), {.name = "thumbnails",
                                                                          .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                                          .extent = extent,
                                                                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                                                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
    const VkDeviceSize bytes = VkDeviceSize{4} * out->extent_.width * out->extent_.height * count;
    DARKROOM_TRY_VALUE(out->staging_, gpu::Buffer::create(device.context(), bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                          gpu::Memory::Kind::Upload, "thumbnails"));
    return out;
}

Thumbnails::~Thumbnails() { stop(); }

// On a thread of its own nobody else would catch what is thrown.
Result<> Thumbnails::begin() {
    thread_ = darkroom::start_thread([this] {
        try {
            make_all(stop_.get_token());
        } catch (...) {
            const darkroom::Failure thrown = darkroom::caught("pictures of effects");
            const std::lock_guard lock(mutex_);
            error_ = thrown.value().text;
        }
    });
    if (thread_) return {};
    return darkroom::machine_error("no further thread can be started: effects are offered without pictures");
}

void Thumbnails::stop() { stop_.request_stop(); }

std::optional<darkroom::Error> Thumbnails::take_error() {
    const std::lock_guard lock(mutex_);
    if (error_.empty()) return {};
    return darkroom::Error{darkroom::Fault::Machine, std::exchange(error_, {})};
}

float Thumbnails::aspect() const { return static_cast<float>(extent_.width) / static_cast<float>(extent_.height); }

VkOffset2D Thumbnails::corner_of(std::size_t cell) const {
    return {static_cast<std::int32_t>(cell % columns * extent_.width),
            static_cast<std::int32_t>(cell / columns * extent_.height)};
}

Thumbnails::Shown Thumbnails::of(const Subject& subject) {
    const std::lock_guard lock(mutex_);
    if (const auto found = cells_.find(subject); found != cells_.end())
        return {.pane = found->second.is_shown ? &found->second.pane : nullptr, .error = found->second.error};
    Cell& cell = cells_[subject];
    cell.number = cells_.size() - 1;
    cell.pane.view.image = {.image = atlas_.handle,
                            .view = atlas_.mip_views[0],
                            .format = atlas_.info.format,
                            .extent = {atlas_.info.extent.width, atlas_.info.extent.height},
                            .region = {corner_of(cell.number), extent_},
                            .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    wanted_.push_back(subject);
    changed_.notify_all();
    return {};
}

bool Thumbnails::has_new() const {
    const std::lock_guard lock(mutex_);
    return has_failed_ || !made_.empty();
}

void Thumbnails::record(VkCommandBuffer commands) {
    const std::lock_guard lock(mutex_);
    has_failed_ = false;
    if (made_.empty()) return;
    const darkroom::gpu::Context& context = device_.context();
    darkroom::gpu::transition(context, commands, atlas_,
                              is_drawn_ ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED,
                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    is_drawn_ = true;
    for (; !made_.empty(); made_.pop_front()) {
        const auto& [subject, bytes] = made_.front();
        Cell& cell = cells_.at(subject);
        const VkDeviceSize offset = cell.number * VkDeviceSize{4} * extent_.width * extent_.height;
        std::memcpy(staging_.memory.mapped + offset, bytes.data(), bytes.size());
        const VkOffset2D corner = corner_of(cell.number);
        const VkBufferImageCopy copy{.bufferOffset = offset,
                                     .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageOffset = {corner.x, corner.y, 0},
                                     .imageExtent = {extent_.width, extent_.height, 1}};
        context.vk.CmdCopyBufferToImage(commands, staging_.handle, atlas_.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                        1, &copy);
        cell.is_shown = true;
    }
    darkroom::gpu::transition(context, commands, atlas_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                              VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void Thumbnails::make_all(const std::stop_token& token) {
    const Small small(frame_, frame_read_.layers(), extent_);
    // Kernels of their own are those of every look; joined ones would be made anew for each effect.
    const darkroom::DevelopDesc desc{.fuse = false};
    darkroom::Composer composer(device_);
    darkroom::Developer developer(device_, desc);
    Look shown{};
    while (!token.stop_requested()) {
        Subject subject;
        {
            std::unique_lock lock(mutex_);
            if (!changed_.wait(lock, token, [&] { return !wanted_.empty(); })) return;
            subject = wanted_.front();
            wanted_.pop_front();
        }
        const EffectInfo* const* const effect = std::get_if<const EffectInfo*>(&subject);
        const auto make = [&]() -> Result<darkroom::DevelopedPicture> {
            DARKROOM_TRY_VALUE(Look with, effect != nullptr ? with_effect(desc_.look, **effect)
                                                            : desc_.read(std::get<std::filesystem::path>(subject)));
            DARKROOM_TRY(darkroom::follow(shown, with, composer));
            shown = std::move(with);
            DARKROOM_TRY(composer.compile(darkroom::compile_desc_for(device_, small.input, desc)));
            Result<darkroom::DevelopedPicture> made = developer.develop(composer, small.input);
            if (made && (made->extent.width != extent_.width || made->extent.height != extent_.height))
                return darkroom::user_error(fmt::format("its picture has {}x{} pixels where the frame has {}x{}",
                                                        made->extent.width, made->extent.height, extent_.width,
                                                        extent_.height));
            return made;
        };
        Result<darkroom::DevelopedPicture> picture = make();
        const std::lock_guard lock(mutex_);
        if (picture) {
            made_.emplace_back(subject, std::move(picture->bytes));
            continue;
        }
        has_failed_ = true;
        cells_.at(subject).error = picture.error().text;
        if (effect != nullptr) error_ = fmt::format("the picture of {}: {}", (*effect)->name, picture.error().text);
    }
}

}  // namespace app
