// SPDX-License-Identifier: MIT
#include "store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "core/srgb.hpp"
#include "core/text/param_text.hpp"
#include "image/picture/write.hpp"
#include "programs/darkroom/run/frames.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

using darkroom::Result;
using darkroom::window::PresentFrame;

namespace {

std::filesystem::path free_name(const std::string& stem, const std::string& extension) {
    for (int number = 1; number < 10000; ++number) {
        std::filesystem::path path = fmt::format("{}-{:04}{}", stem, number, extension);
        // The name is taken at once, so that no other picture gets it while this one is on its way.
        const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file < 0 && errno == EEXIST) continue;
        if (file >= 0) ::close(file);
        return path;
    }
    return stem + extension;
}

std::string printed(const std::filesystem::path& path) { return darkroom::printable(path.string()); }

}  // namespace

void Store::want_picture() { pictures_.push_back(free_name("darkroom", ".png")); }
void Store::want_window() {
    if (window_.empty()) window_ = free_name("darkroom-window", ".png");
}
void Store::want_frame() {
    if (frame_.empty()) frame_ = free_name("frame", ".exr");
}
void Store::want(const std::filesystem::path& picture, const std::filesystem::path& window) {
    if (!picture.empty()) pictures_ = {picture};
    window_ = window;
}

Result<> Store::record_picture(const darkroom::Device& device, const PresentFrame& frame, const LookView& view,
                               bool has_floats) {
    while (!pictures_.empty()) {
        std::filesystem::path path = std::move(pictures_.back());
        pictures_.pop_back();
        DARKROOM_TRY_VALUE(darkroom::Readback read, darkroom::Readback::create(device.context(), view.picture()));
        read.record(frame.commands);
        copies_.push_back({.frame = frame.number,
                           .path = std::move(path),
                           .picture = std::move(read),
                           .transfer = view.transfer(),
                           .has_floats = has_floats});
    }
    return {};
}

Result<> Store::record_frame(const darkroom::Device& device, const PresentFrame& frame, const darkroom::Frame& of,
                             const darkroom::Frame& as_stored) {
    const std::filesystem::path path = std::exchange(frame_, {});
    DARKROOM_TRY_VALUE(darkroom::FrameReadback read, darkroom::FrameReadback::create(device.context(), of));
    read.record(frame.commands);
    copies_.push_back({.frame = frame.number, .path = path, .layers = std::move(read), .of = as_stored});
    return {};
}

Result<> Store::record_window(const darkroom::Device& device, const darkroom::window::Presenter& presenter,
                              const PresentFrame& frame) {
    const std::filesystem::path path = std::exchange(window_, {});
    if (!presenter.color().is_standard_code())
        return darkroom::user_error(
            "a window of high range cannot be stored as a picture; --range standard makes one that can");
    if (!presenter.can_copy()) return darkroom::user_error("the window's pictures cannot be read on this device");
    const darkroom::ImageRef image{.image = frame.image,
                                   .view = frame.view,
                                   .format = presenter.format(),
                                   .extent = frame.extent,
                                   .layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    DARKROOM_TRY_VALUE(darkroom::Readback read, darkroom::Readback::create(device.context(), image));
    read.record(frame.commands);
    copies_.push_back({.frame = frame.number, .path = path, .picture = std::move(read)});
    return {};
}

std::vector<Store::Said> Store::finish(const darkroom::window::Presenter& presenter, const Start& start, bool waits) {
    while (!copies_.empty() && presenter.is_finished(copies_.front().frame)) {
        Copy copy = std::move(copies_.front());
        copies_.pop_front();
        // Read here: the images may go. Written beside the frames.
        std::function<Result<>()> write;
        if (copy.picture && copy.has_floats) {
            write = [pixels = copy.picture->floats(4), extent = copy.picture->extent(), path = copy.path,
                     is_light = copy.transfer == darkroom::window::PaneTransfer::SceneLinear]() mutable {
                for (std::size_t i = 0; is_light && i < pixels.size(); ++i)
                    if (i % 4 != 3) pixels[i] = darkroom::srgb_encode(std::clamp(pixels[i], 0.0F, 1.0F));
                return app::write(path, {.extent = extent, .pixels = std::move(pixels)}, {});
            };
        } else if (copy.picture) {
            write = [bytes = copy.picture->bytes(), extent = copy.picture->extent(), path = copy.path] {
                return app::write(path, {.extent = extent, .bytes = bytes}, {});
            };
        } else {
            write = [frame = std::make_shared<darkroom::FrameFile>(frame_file(copy.of, copy.layers->layers())),
                     path = copy.path] { return darkroom::write_frame(path, *frame); };
        }
        writing_.push_back(start([write = std::move(write), path = copy.path]() -> Said {
            try {
                const Result<> done = write();
                std::error_code error;
                if (!done && std::filesystem::is_empty(path, error) && !error) std::filesystem::remove(path, error);
                return {done ? "stored " + printed(path) : done.error().text, !done};
            } catch (const std::exception& exception) {
                return {fmt::format("{}: cannot be written: {}", printed(path), exception.what()), true};
            }
        }));
    }
    std::vector<Said> out;
    while (!writing_.empty() &&
           (waits || writing_.front().wait_for(std::chrono::seconds(0)) == std::future_status::ready)) {
        out.push_back(writing_.front().get());
        writing_.pop_front();
    }
    return out;
}

}  // namespace app
