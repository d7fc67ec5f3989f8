// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "apps/darkroom/run/frames.hpp"
#include "core/srgb.hpp"
#include "core/text/param_text.hpp"
#include "gpu/device/context.hpp"
#include "image/picture/write.hpp"
#include "viewer_state.hpp"

namespace app {

using darkroom::Result;
using darkroom::window::PresentFrame;

namespace {

constexpr std::chrono::milliseconds between_looks{200};

std::string shown(const std::filesystem::path& path) { return darkroom::printable(path.string()); }

}  // namespace

void Viewer::reload() {
    const Clock::time_point now = Clock::now();
    if (now - last_look_at_files_ < between_looks) return;
    last_look_at_files_ = now;
    interface_->reload_changed();
    const Result<bool> is_new = document_->reload_if_changed();
    if (!is_new) screen_.tell_error("reload", is_new.error().text);
    if (!document_->is_broken()) screen_.clear_error("reload");
    if (is_new && *is_new) tell(fmt::format("read {} again", document_->file().filename().string()));
    reload_source();
}

void Viewer::watch_source() {
    source_files_ = {};
    if (scene_ != nullptr)
        for (const std::filesystem::path& file : source_->files()) source_files_.add(file);
}

// The new one is made beside the frames, which go on with the old one.
void Viewer::reload_source() {
    if (!coming_.valid()) {
        if (!source_files_.take_change()) return;
        coming_ = std::async(std::launch::async, [this, desc = job_.scene_desc] {
            return SceneSource::create(*device_, job_.scene, desc);
        });
        return;
    }
    if (coming_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    Result<std::unique_ptr<SceneSource>> made = coming_.get();
    if (!made) return screen_.tell_error("scene", made.error().text);
    if (Result<> done = presenter_->wait(); !done) return settle("scene", done);
    take_scene(std::move(*made));
    watch_source();
    screen_.clear_error("scene");
    screen_.clear_error("source");
    tell(fmt::format("read {} again", job_.scene.filename().string()));
}

void Viewer::follow_document() {
    if (followed_ == document_->version()) return;
    followed_ = document_->version();
    for (const Side side : {Side::Look, Side::Saved}) {
        const auto& view = views_[static_cast<std::size_t>(side)];
        if (view) settle("look", view->show(look_of(side)));
    }
    const darkroom::LookUi ui = document_->look().ui.value_or(darkroom::LookUi{});
    if (ui.document != interface_files_.first || ui.controllers != interface_files_.second)
        settle("interface", start_interface());
    interface_->set_game(ui.game);
}

std::filesystem::path Viewer::free_name(const std::string& stem, const std::string& extension) {
    for (int number = 1; number < 10000; ++number) {
        std::filesystem::path path = fmt::format("{}-{:04}{}", stem, number, extension);
        if (!std::filesystem::exists(path)) return path;
    }
    return stem + extension;
}

// Copies are recorded behind what made the picture, and written to files once the frame has finished.
void Viewer::store_picture(const PresentFrame& frame) {
    if (is_fixed() && shown_frames_ + 1 == *job_.frames_to_show) {
        wanted_.picture = job_.screenshot;
        wanted_.window = job_.window_screenshot;
    }
    darkroom::gpu::Context& context = device_->context();
    const LookView& view = *views_[static_cast<std::size_t>(is_off() ? Side::Off : Side::Look)];
    // Where there is none yet, the next frame is stored.
    if (!wanted_.picture.empty() && view.picture().is_given()) {
        Result<darkroom::Readback> read = darkroom::Readback::create(context, view.picture());
        if (!read) return screen_.tell_error("store", read.error().text);
        read->record(frame.commands);
        stores_.push_back({.frame = frame.number,
                           .path = std::move(wanted_.picture),
                           .picture = std::move(*read),
                           .transfer = view.transfer(),
                           .has_floats = is_high_range()});
        wanted_.picture.clear();
    }
    if (!wanted_.frame.empty()) {
        const darkroom::Frame of = source_->frame();
        Result<darkroom::FrameReadback> read = darkroom::FrameReadback::create(context, of);
        if (!read) return screen_.tell_error("store", read.error().text);
        read->record(frame.commands);
        Store& store = stores_.emplace_back(
            Store{.frame = frame.number, .path = std::move(wanted_.frame), .layers = std::move(*read), .of = of});
        store.of.camera = as_stored(of.camera);
        store.of.time = scene_ != nullptr ? time_ : of.time;
        store.of.delta_time = scene_ != nullptr ? delta_time_ : of.delta_time;
        store.of.frame_index = scene_ != nullptr ? frame_index_ : of.frame_index;
    }
    wanted_.frame.clear();
}

// With all that lies over the picture, so behind that.
void Viewer::store_window(const PresentFrame& frame) {
    if (wanted_.window.empty()) return;
    const std::filesystem::path path = std::exchange(wanted_.window, {});
    if (is_high_range())
        return screen_.tell_error("store",
                                  "a window of high range is no picture for files; --range standard makes one");
    if (!presenter_->can_copy())
        return screen_.tell_error("store", "the window's pictures cannot be read on this device");
    const darkroom::ImageRef image{.image = frame.image,
                                   .view = frame.view,
                                   .format = presenter_->format(),
                                   .extent = frame.extent,
                                   .layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    Result<darkroom::Readback> read = darkroom::Readback::create(device_->context(), image);
    if (!read) return screen_.tell_error("store", read.error().text);
    read->record(frame.commands);
    stores_.push_back({.frame = frame.number, .path = path, .picture = std::move(*read)});
}

void Viewer::finish_stores(bool waits) {
    while (!stores_.empty() && presenter_->is_finished(stores_.front().frame)) {
        Store store = std::move(stores_.front());
        stores_.pop_front();
        // Read here: the images may go. Written beside the frames.
        std::function<Result<>()> write;
        if (store.picture && store.has_floats) {
            write = [pixels = store.picture->floats(4), extent = store.picture->extent(), path = store.path,
                     is_light = store.transfer == darkroom::window::PaneTransfer::SceneLinear]() mutable {
                for (std::size_t i = 0; is_light && i < pixels.size(); ++i)
                    if (i % 4 != 3) pixels[i] = darkroom::srgb_encode(std::clamp(pixels[i], 0.0F, 1.0F));
                return app::write(path, {.extent = extent, .pixels = std::move(pixels)}, {});
            };
        } else if (store.picture) {
            write = [bytes = store.picture->bytes(), extent = store.picture->extent(), path = store.path] {
                return app::write(path, {.extent = extent, .bytes = bytes}, {});
            };
        } else {
            write = [frame = std::make_shared<darkroom::FrameFile>(frame_file(store.of, store.layers->layers())),
                     path = store.path] { return darkroom::write_frame(path, *frame); };
        }
        writing_.push_back(std::async(std::launch::async, [write = std::move(write), path = store.path] {
            const Result<> done = write();
            return std::pair(done ? "stored " + shown(path) : done.error().text, !done);
        }));
    }
    while (!writing_.empty() &&
           (waits || writing_.front().wait_for(std::chrono::seconds(0)) == std::future_status::ready)) {
        const auto [line, is_error] = writing_.front().get();
        writing_.pop_front();
        is_error ? screen_.tell_error("store", line) : tell(line);
        if (waits && is_error) failed_ = line;
    }
}

}  // namespace app
