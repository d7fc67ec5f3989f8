// SPDX-License-Identifier: MIT
#include "frame_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "core/thread/parallel.hpp"
#include "gpu/device/context.hpp"
#include "gpu/resource/barriers.hpp"
#include "image/frame/sequence.hpp"
#include "programs/darkroom/run/jitter.hpp"

namespace app {

using darkroom::Result;

FrameSource::FrameSource(darkroom::Device& device, std::vector<darkroom::NumberedFile> files, const Desc& desc)
    : device_(device), files_(std::move(files)), desc_(desc) {}

FrameSource::~FrameSource() {
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
    }
    changed_.notify_all();
}

Result<std::unique_ptr<FrameSource>> FrameSource::create(darkroom::Device& device,
                                                         std::vector<darkroom::NumberedFile> files, const Desc& desc) {
    std::unique_ptr<FrameSource> out(new FrameSource(device, std::move(files), desc));
    DARKROOM_TRY_VALUE(std::shared_ptr<Decoded> first, out->decode(0));
    out->shown_ = first;
    out->kept_.push_front(std::move(first));
    out->warnings_ = out->shown_->file.warnings;
    if (out->files_.size() > 1) out->start();
    return out;
}

void FrameSource::start() {
    thread_ = darkroom::start_thread([this] { work(); });
    if (!thread_) warnings_.emplace_back("no further thread can be started: the window waits while frames are read");
}

// Whatever a file makes a decoder do, the thread that reads goes on.
Result<std::shared_ptr<FrameSource::Decoded>> FrameSource::decode(std::size_t number) const try {
    auto out = std::make_shared<Decoded>();
    out->number = number;
    out->stamp = darkroom::stamp_of(files_[number].path);
    DARKROOM_TRY_VALUE(darkroom::FrameFile file, read_frame(files_[number], desc_.options));
    out->file = std::move(file);
    out->lights = take_lights(out->file);
    out->input = develop_input(out->file, out->lights);
    if (!out->file.frame_index)
        out->input.frame_index = static_cast<std::uint64_t>(std::max(0LL, files_[number].number));
    if (desc_.frames_per_second) {
        out->input.time = static_cast<double>(out->input.frame_index) / *desc_.frames_per_second;
        out->input.delta_time = 1 / *desc_.frames_per_second;
    }
    return out;
} catch (const std::exception& exception) {
    return darkroom::machine_error(
        fmt::format("{}: cannot be read: {}", darkroom::printable(files_[number].path.string()), exception.what()));
}

std::vector<std::filesystem::path> FrameSource::files() const {
    std::vector<std::filesystem::path> out;
    for (const darkroom::NumberedFile& file : files_) out.push_back(file.path);
    return out;
}

std::shared_ptr<FrameSource::Decoded> FrameSource::find(std::size_t number) const {
    const auto found = std::ranges::find(kept_, number, [](const auto& kept) { return kept->number; });
    return found == kept_.end() ? nullptr : *found;
}

// What is wanted, then what comes after it while there is nothing else to do.
void FrameSource::work() {
    std::unique_lock lock(mutex_);
    while (!is_ending_) {
        // What is looked at stays while others are read ahead.
        if (const auto shown = std::ranges::find(kept_, wanted_, &Decoded::number); shown != kept_.end())
            kept_.splice(kept_.begin(), kept_, shown);
        const auto is_known = [&](std::size_t number) { return find(number) != nullptr || failed_.contains(number); };
        std::size_t number = wanted_, ahead = 0;
        while (ahead <= max_ahead && is_known(number)) number = (wanted_ + ++ahead) % files_.size();
        if (ahead > max_ahead) {
            changed_.wait(lock);
            continue;
        }
        lock.unlock();
        const darkroom::FileStamp stamp = darkroom::stamp_of(files_[number].path);
        Result<std::shared_ptr<Decoded>> made = decode(number);
        lock.lock();
        keep(number, stamp, std::move(made));
        changed_.notify_all();
    }
}

void FrameSource::keep(std::size_t number, const darkroom::FileStamp& stamp, Result<std::shared_ptr<Decoded>> made) {
    if (made) {
        kept_.push_front(std::move(*made));
        if (kept_.size() > max_kept) kept_.pop_back();
    } else {
        failed_[number] = {stamp, made.error().text};
    }
}

void FrameSource::read_here(std::size_t number) {
    const darkroom::FileStamp stamp = darkroom::stamp_of(files_[number].path);
    if (find(number) == nullptr && !failed_.contains(number)) keep(number, stamp, decode(number));
}

// One that is gone stays on the screen: who writes a file may replace it.
void FrameSource::look_again() {
    const std::lock_guard lock(mutex_);
    const auto is_another = [&](std::size_t number, const darkroom::FileStamp& was) {
        const darkroom::FileStamp now = darkroom::stamp_of(files_[number].path);
        return now != was && now != darkroom::FileStamp{};
    };
    const std::size_t forgotten =
        std::erase_if(failed_, [&](const auto& failed) { return is_another(failed.first, failed.second.stamp); }) +
        std::erase_if(kept_, [&](const auto& kept) { return is_another(kept->number, kept->stamp); });
    if (forgotten == 0) return;
    if (!thread_ && files_.size() == 1) start();
    changed_.notify_all();
}

std::optional<VkExtent2D> FrameSource::extent() const { return shown_->input.extent; }

std::vector<std::string> FrameSource::warnings() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> out = warnings_;
    for (const auto& [number, failed] : failed_) out.push_back(failed.why);
    return out;
}

bool FrameSource::is_up_to_date() const {
    const std::lock_guard lock(mutex_);
    return find(wanted_) == shown_ || failed_.contains(wanted_);
}

bool FrameSource::is_another(const LiveMoment& moment) const {
    const std::lock_guard lock(mutex_);
    const std::shared_ptr<Decoded> found = find(moment.number);
    return found != nullptr && found != shown_;
}

// One that is on its way may be there when this has returned.
bool FrameSource::must_wait(const LiveMoment& moment, VkExtent2D) const {
    if (is_new_ || moment.scale != scale_) return true;
    const std::lock_guard lock(mutex_);
    const std::size_t number = std::min(moment.number, files_.size() - 1);
    return find(number) != shown_ && !failed_.contains(number);
}

Result<> FrameSource::prepare(const LiveMoment& moment, VkExtent2D) {
    const double scale_before = std::exchange(scale_, moment.scale);
    bool is_another = is_new_ || scale_ != scale_before;
    {
        const std::lock_guard lock(mutex_);
        const std::size_t number = std::min(moment.number, files_.size() - 1);
        if (!thread_) read_here(number);
        if (wanted_ != number) {
            wanted_ = number;
            changed_.notify_all();
        }
        const std::shared_ptr<Decoded> found = find(wanted_);
        if (found != nullptr && found != shown_) {
            is_cut_ = found->number != shown_->number + 1;
            shown_ = found;
            is_another = true;
        }
    }
    if (!is_another) return {};
    is_new_ = true;
    small_.reset();
    if (scale_ < 1) small_.emplace(shown_->input, scaled(shown_->input.extent, scale_));
    upload_.reset();
    return upload_.prepare(device_.context(), input(), small_ ? small_->layers() : layers_of(shown_->input));
}

// Images are left where every recording may find them, and leave them.
Result<> FrameSource::record(VkCommandBuffer commands) {
    frame_.camera.is_cut = false;
    if (!std::exchange(is_new_, false)) return {};
    const darkroom::gpu::Context& context = device_.context();
    upload_.record(context, commands);
    frame_ = upload_.frame(input());
    frame_.camera.is_cut = is_cut_;
    lights_.assign(frame_.lights.begin(), frame_.lights.end());
    std::vector<VkImageMemoryBarrier2> changes;
    const auto settle = [&](darkroom::ImageRef& image, VkImageAspectFlags aspect) {
        if (!image.is_given()) return;
        changes.push_back(darkroom::gpu::image_barrier(
            image.image, {aspect, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS},
            {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, image.layout},
            {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
             image.final_layout}));
        image.layout = image.final_layout;
    };
    for (darkroom::ImageRef* const image : {&frame_.color, &frame_.depth, &frame_.normals, &frame_.velocity,
                                            &frame_.reactive, &frame_.transparency, &frame_.exposure})
        settle(*image, VK_IMAGE_ASPECT_COLOR_BIT);
    for (darkroom::Light& light : lights_) settle(light.cascades, VK_IMAGE_ASPECT_DEPTH_BIT);
    darkroom::gpu::record_barriers(context.vk, commands, changes);
    frame_.lights = lights_;
    return {};
}

darkroom::Frame FrameSource::frame() const { return frame_; }

darkroom::CompileDesc FrameSource::compile_desc(VkExtent2D most) const {
    darkroom::CompileDesc desc = darkroom::compile_desc_for(device_, shown_->input, {});
    desc.max_extent = most;
    return desc;
}

std::string FrameSource::shown_frame(std::size_t number) const {
    return number < files_.size() ? darkroom::printable(files_[number].path.filename().string()) : std::string();
}

}  // namespace app
