// SPDX-License-Identifier: MIT
// What a viewer shows: the scene or the frames that it began with, read again, and others in their place.
#include <fmt/format.h>

#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"
#include "programs/darkroom/render/scene_flags.hpp"
#include "viewer_state.hpp"

namespace app {

using darkroom::Result;

namespace {

/// On a thread of its own nobody else would catch what is thrown.
template <class Make>
auto caught(const std::filesystem::path& file, const Make& make) -> decltype(make()) {
    try {
        return make();
    } catch (const std::exception& exception) {
        return darkroom::machine_error(
            fmt::format("{}: cannot be read: {}", darkroom::printable(file.string()), exception.what()));
    }
}

}  // namespace

Result<> Viewer::make_source() {
    const auto read = darkroom::edit::Watch::Clock::now();
    if (!job_.scene.empty()) {
        SceneSource::Desc& desc = job_.scene_desc;
        desc.render.frames_in_flight = frames_in_flight;
        desc.render.extent = picture_extent();
        DARKROOM_TRY_VALUE(std::unique_ptr<SceneSource> made, SceneSource::create(*device_, job_.scene, desc));
        take_scene(std::move(made));
    } else {
        DARKROOM_TRY_VALUE(std::unique_ptr<FrameSource> made,
                           FrameSource::create(*device_, job_.frames, job_.frame_desc));
        take_frames(std::move(made));
    }
    watch_source(read);
    return {};
}

void Viewer::take_scene(std::unique_ptr<SceneSource> scene) {
    scene_ = scene.get();
    source_ = std::move(scene);
    playback_ = {};
    if (!job_.is_edit) ground_.emplace(scene_->scene(), scene_->assets());
    is_cut_ = true;
    follow_lens();
}

void Viewer::take_frames(std::unique_ptr<FrameSource> frames) {
    scene_ = nullptr;
    last_orbit_.reset();
    source_ = std::move(frames);
    playback_ = Playback(source_->frames(), job_.frame_desc.frames_per_second.value_or(1 / job_.step));
    is_cut_ = true;
    follow_lens();
}

/// Of the camera that is seen through.
darkroom::CameraLens Viewer::lens() const {
    return scene_ != nullptr ? lens_of(scene_->scene().camera) : darkroom::CameraLens();
}

// A scene's own look reads its camera by itself.
void Viewer::follow_lens() {
    if (document_) document_->follow_lens(document_->file() == job_.scene ? darkroom::CameraLens() : lens());
}

void Viewer::watch_source(darkroom::edit::Watch::Clock::time_point read) {
    source_files_ = {};
    if (scene_ != nullptr)
        for (const std::filesystem::path& file : source_->files()) source_files_.add(file, read);
}

// The new one is made beside the frames, which go on with the old one.
void Viewer::reload_source() {
    take_other_picture();
    source_->look_again();
    if (opening_.valid()) return take_opened();
    if (!coming_.valid()) {
        if (!opens_next_.empty()) return open_subject(std::exchange(opens_next_, {}));
        if (!source_files_.take_change()) return;
        reading_since_ = darkroom::edit::Watch::Clock::now();
        coming_ = start_beside([this, desc = job_.scene_desc, file = job_.scene] {
            return caught(file, [&] { return SceneSource::create(*device_, file, desc); });
        });
        return;
    }
    if (coming_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    Result<std::unique_ptr<SceneSource>> made = coming_.get();
    if (!made) return screen_.tell_error("scene", made.error().text);
    if (Result<> done = presenter_->wait(); !done) return settle("scene", done);
    source_warnings_.clear();
    take_scene(std::move(*made));
    watch_source(reading_since_);
    settle("scene", {});
    screen_.clear_error("source");
    tell(fmt::format("read {} again", job_.scene.filename().string()));
}

void Viewer::open_subject(const std::filesystem::path& file) {
    if (opening_.valid() || coming_.valid()) {
        opens_next_ = file;
        return tell(fmt::format("{} is read next", darkroom::printable(file.filename().string())));
    }
    reading_since_ = darkroom::edit::Watch::Clock::now();
    tell(fmt::format("reading {}", darkroom::printable(file.filename().string())));
    const bool is_scene = darkroom::scene::is_scene_path(file);
    opening_ = start_beside([this, file, is_scene, scene = job_.scene_desc, frame = job_.frame_desc] {
        return caught(file, [&]() -> Result<Opened> {
            Opened out{.file = file};
            if (is_scene) {
                SceneSource::Desc desc = scene;
                desc.render.frames_in_flight = frames_in_flight;
                DARKROOM_TRY_VALUE(out.scene, SceneSource::create(*device_, file, desc));
                return out;
            }
            out.files = {{.path = file, .number = darkroom::frame_number(file).value_or(0)}};
            DARKROOM_TRY_VALUE(out.frames, FrameSource::create(*device_, out.files, frame));
            return out;
        });
    });
}

void Viewer::take_other(const std::filesystem::path& file) {
    if (!is_picture_file(file)) return take_other_look(file);
    if (other_coming_.valid()) return;
    other_file_ = file;
    other_coming_ = start_beside([file] { return caught(file, [&] { return darkroom::read_comparable(file); }); });
}

void Viewer::take_other_picture() {
    if (!other_coming_.valid() || other_coming_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    Result<darkroom::ComparablePicture> read = other_coming_.get();
    settle("other look", read ? Result<>() : failure(read.error()));
    if (!read) return;
    const VkExtent2D extent{read->picture.width, read->picture.height};
    Result<> idle = presenter_->wait();
    Result<ComparedPicture> made =
        idle ? ComparedPicture::create(*device_, std::move(*read)) : Result<ComparedPicture>(failure(std::move(idle)));
    settle("other look", made ? Result<>() : failure(made.error()));
    if (!made) return;
    other_picture_ = std::move(*made);
    const std::string name = darkroom::printable(other_file_.filename().string());
    screen_.editor()->set_other(name);
    const bool is_as_large = extent.width == full_extent_.width && extent.height == full_extent_.height;
    tell(fmt::format("compares with {}{}", name,
                     is_as_large ? "" : fmt::format(", {}x{}", extent.width, extent.height)));
}

std::function<Result<darkroom::Look>(const std::filesystem::path& file)> Viewer::look_reader() const {
    return [options = job_.look_options, lens = lens()](const std::filesystem::path& file) {
        darkroom::LookOptions own = options;
        own.folder = file.parent_path();
        return darkroom::read_look(file, own, lens);
    };
}

void Viewer::take_other_look(const std::filesystem::path& look) {
    Result<darkroom::Look> read = look_reader()(look);
    settle("other look", read ? Result<>() : failure(read.error()));
    if (!read) return;
    if (other_picture_)
        if (Result<> done = presenter_->wait(); !done) return settle("other look", done);
    other_picture_.reset();
    other_look_ = std::move(*read);
    if (const auto& view = views_[static_cast<std::size_t>(Side::Other)]) settle("other look", view->show(other_look_));
    screen_.editor()->set_other(darkroom::printable(look.filename().string()));
    tell(fmt::format("compares with {}", darkroom::printable(look.filename().string())));
}

void Viewer::fire(const std::string& event) {
    std::size_t fired = 0;
    for (const auto& any : views_)
        if (any) fired = std::max(fired, any->composer().fire(event));
    std::string_view why;
    if (scene_ == nullptr)
        why = ": a stored frame has no time for them";
    else if (is_paused_)
        why = ": P lets the time run";
    tell(fmt::format("fired {}: {} pulse{}{}", event, fired, fired == 1 ? "" : "s", why));
}

void Viewer::take_opened() {
    if (opening_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    Result<Opened> opened = opening_.get();
    if (!opened) return screen_.tell_error("open", opened.error().text);
    if (Result<> done = presenter_->wait(); !done) return settle("open", done);
    screen_.clear_error("open");
    screen_.clear_error("source");
    screen_.clear_error("scene");
    source_warnings_.clear();
    job_.scene = opened->scene ? opened->file : std::filesystem::path();
    job_.frames = std::move(opened->files);
    camera_->reset();
    if (opened->scene) {
        time_ = previous_time_ = opened->scene->scene().time;
        take_scene(std::move(opened->scene));
    } else {
        take_frames(std::move(opened->frames));
    }
    watch_source(reading_since_);
    tell(fmt::format("opened {}", darkroom::printable(opened->file.filename().string())));
}

// The window is called by what it shows now.
void Viewer::name_window() {
    std::string name = source_->shown_frame(moment().number);
    if (name.empty())
        name = darkroom::printable((scene_ != nullptr ? job_.scene : source_->files().front()).filename().string());
    if (name == titled_) return;
    titled_ = name;
    window_->set_title(fmt::format("{} - Darkroom", name));
}

}  // namespace app
