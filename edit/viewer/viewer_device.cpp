// SPDX-License-Identifier: MIT
// The device, what is made with it, and another one in its place.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/run/report.hpp"
#include "viewer_state.hpp"

namespace app {

using darkroom::Result;

// What a window of high range needs is asked for, and done without where it is not there.
Result<> Viewer::make_device() {
    std::vector<const char*> instance, device{darkroom::window::Presenter::device_extension};
    std::ranges::copy(window_->instance_extensions(), std::back_inserter(instance));
    const auto create = [&] {
        return darkroom::Device::create(
            {.select = job_.device, .log = log_sink(), .instance_extensions = instance, .device_extensions = device});
    };
    Result<darkroom::Device> made = darkroom::machine_error("");
    if (job_.range == darkroom::window::DynamicRange::High) {
        instance.push_back(VK_EXT_SWAPCHAIN_COLOR_SPACE_EXTENSION_NAME);
        device.push_back(VK_EXT_HDR_METADATA_EXTENSION_NAME);
        made = create();
        if (!made) {
            device.pop_back();
            made = create();
        }
        if (!made) instance.pop_back();
    }
    if (!made) made = create();
    if (!made) return failure(std::move(made));
    device_ = std::make_unique<darkroom::Device>(std::move(*made));
    return {};
}

Result<> Viewer::open_device() {
    DARKROOM_TRY(make_device());
    DARKROOM_TRY_VALUE(darkroom::window::Presenter presenter,
                       darkroom::window::Presenter::create(*device_, {.presentation = job_.presentation,
                                                                      .frames_in_flight = frames_in_flight,
                                                                      .range = job_.range,
                                                                      .peak_nits = job_.peak_nits,
                                                                      .make_surface = [this](VkInstance instance) {
                                                                          return window_->make_surface(instance);
                                                                      }}));
    presenter_.emplace(std::move(presenter));
    return make_source();
}

Result<> Viewer::open_views() {
    interface_ = std::make_unique<LiveInterface>(
        *device_, is_fixed(), frames_in_flight,
        [this](darkroom::Severity, std::string_view line) { print(std::string(line)); },
        has_config() ? config_file().parent_path() : std::filesystem::path());
    DARKROOM_TRY(view(Side::Look));
    DARKROOM_TRY(start_interface());
    DARKROOM_TRY_VALUE(
        gui_, Gui::create(device_->context(), *window_,
                          {.format = presenter_->format(), .color = presenter_->color(), .slots = frames_in_flight}));
    return {};
}

void Viewer::let_go_of_device() {
    // Both make what is the device's.
    if (coming_.valid()) coming_.wait();
    if (opening_.valid()) opening_.wait();
    coming_ = {};
    opening_ = {};
    thumbnails_.reset();
    thumbnails_frame_.reset();
    has_thumbnails_ = false;
    presenter_.reset();  // waits for what is under way
    gui_.reset();
    store_.forget();
    inspection_ = {};
    scale_.forget_device();
    other_picture_.reset();
    interface_.reset();
    for (auto& view : views_) view.reset();
    scene_ = nullptr;
    source_.reset();
    device_.reset();
}

Result<> Viewer::make_anew(const darkroom::Error& error) {
    // One that is lost again and again is broken.
    constexpr std::chrono::minutes lately{1};
    constexpr std::size_t max_lost = 3;
    const Clock::time_point now = Clock::now();
    while (!lost_at_.empty() && now - lost_at_.front() > lately) lost_at_.pop_front();
    lost_at_.push_back(now);
    if (is_fixed() || lost_at_.size() > max_lost) return failure(error);
    write_config();
    const Playback playback = playback_;
    const bool has_other_picture = other_picture_.has_value();
    let_go_of_device();
    DARKROOM_TRY(open_device());
    playback_ = playback;
    DARKROOM_TRY(open_views());
    if (has_other_picture) take_other(other_file_);
    tell(fmt::format("{}: the device was made anew", error.text));
    return {};
}

}  // namespace app
