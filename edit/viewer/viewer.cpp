// SPDX-License-Identifier: MIT
#include "viewer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/text/param_text.hpp"
#include "gpu/device/context.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/look_flags.hpp"
#include "programs/darkroom/run/report.hpp"
#include "programs/darkroom/run/shipped.hpp"
#include "viewer_state.hpp"

namespace app {

namespace render = darkroom::render;
using darkroom::Result;
using darkroom::window::PresentFrame;

namespace {

/// A longer frame was none: the machine slept, or a driver compiled.
constexpr double longest_frame = 0.25;

bool is_device_lost(const darkroom::Error& error) {
    return error.text.ends_with(darkroom::gpu::result_name(VK_ERROR_DEVICE_LOST));
}

}  // namespace

Viewer::~Viewer() {
    if (presenter_) (void)presenter_->wait();
}

int Viewer::exit_code(int code) const { return device_ ? finish(*device_, code) : code; }

Result<> Viewer::run() {
    DARKROOM_TRY(open());
    while (!is_leaving_) {
        Result<> done = turn();
        if (!done && is_device_lost(done.error())) done = make_anew(done.error());
        if (!done) return done;
        if (window_->is_closing()) leave();
        if (is_fixed() && shown_frames_ >= *job_.frames_to_show) break;
    }
    DARKROOM_TRY(presenter_->wait());
    write_config();
    if (journal_) journal_->end();
    finish_stores(true);
    return failed_.empty() ? Result<>() : darkroom::user_error(failed_);
}

Result<> Viewer::open() {
    DARKROOM_TRY_VALUE(darkroom::window::Window window, darkroom::window::Window::create(job_.window));
    window_.emplace(std::move(window));
    DARKROOM_TRY(open_device());
    document_.emplace(std::move(*job_.document));
    screen_ = Screen(job_.is_edit ? &*document_ : nullptr);
    is_post_on_ = !job_.is_off;
    is_paused_ = job_.is_paused;
    draw_ = job_.scene_desc.render.draw;
    if (job_.frame_time) scale_ = DrawScale(job_.frame_time);
    time_ = previous_time_ = job_.time.value_or(scene_ != nullptr ? scene_->scene().time : 0);
    previous_time_ = std::max(0.0, time_ - job_.step);
    camera_.emplace(job_.is_edit ? CameraRig::Kind::Orbit : CameraRig::Kind::Walk, job_.orbit);
    tell_warnings();
    screen_.messages().set_folder(document_->options().folder);
    DARKROOM_TRY(open_views());
    if (EditPanels* const panels = screen_.editor()) {
        panels->look().set_thumbnails([this](const darkroom::EffectInfo& effect) { return thumbnail_of(&effect); });
        panels->look().set_looks({.files = shipped_looks(),
                                  .read = [this](const std::filesystem::path& file) { return look_reader()(file); },
                                  .picture = [this](const std::filesystem::path& file) { return thumbnail_of(file); }});
        panels->look().set_numbers([this](std::string_view name) {
            const auto& view = views_[static_cast<std::size_t>(Side::Look)];
            return view ? view->composer().value(name).numbers : std::span<const float>();
        });
    }
    if (!job_.is_edit && !is_fixed() && scene_ != nullptr) tell("click to look around with the mouse, Esc frees it");
    return {};
}

bool Viewer::is_high_range() const { return presenter_ && !presenter_->color().is_standard_code(); }

Result<> Viewer::start_interface() {
    darkroom::Look look = document_->look();
    if (look.ui) interface_files_ = {look.ui->document, look.ui->controllers};
    resolve_ui(look, document_->file().parent_path());
    DARKROOM_TRY(interface_->start(look, job_.timeline, views_[static_cast<std::size_t>(Side::Look)]->composer()));
    return read_config();
}

darkroom::Look Viewer::look_of(Side side) const {
    if (side == Side::Off) return darkroom::switched_off(document_->look());
    if (side == Side::Other) return other_look_;
    return side == Side::Look ? document_->look() : document_->saved_look();
}

Result<LookView*> Viewer::view(Side side) {
    std::unique_ptr<LookView>& view = views_[static_cast<std::size_t>(side)];
    if (view) return view.get();
    // Nothing happens to a look that is switched off.
    const Timeline timeline = side == Side::Off ? Timeline() : job_.timeline;
    auto made = std::make_unique<LookView>(*device_, LookView::Desc{.frames_in_flight = frames_in_flight,
                                                                    .kernels = job_.kernels,
                                                                    .fuse = job_.fuse,
                                                                    .makes_light = is_high_range(),
                                                                    .keeps_what_is_off = !is_fixed(),
                                                                    .enlarges = job_.frame_time.has_value(),
                                                                    .timeline = timeline});
    DARKROOM_TRY(made->show(look_of(side)));
    view = std::move(made);
    return view.get();
}

VkExtent2D Viewer::picture_extent() const {
    if (source_ && source_->extent()) return *source_->extent();
    const VkExtent2D window = window_->extent();
    const VkRect2D area = screen_.picture_area(window, window_->scale(), source_ && source_->frames() > 0);
    return {std::max(area.extent.width, 1U), std::max(area.extent.height, 1U)};
}

Result<> Viewer::turn() {
    rest();
    recall_panels();
    obey_keys();
    obey_input();
    finish_stores(false);
    finish_seeing();
    reload();
    follow_document();
    write_journal();
    is_resting_ = !is_due();
    has_rested_ = has_rested_ || is_resting_;
    if (is_resting_) return {};
    DARKROOM_TRY_VALUE(const std::optional<PresentFrame> frame, presenter_->begin(window_->extent()));
    if (!frame) {
        is_resting_ = has_rested_ = true;
        return {};
    }
    const Result<> shown = show(*frame);
    // What was begun is ended: nothing else gives the window's image back.
    DARKROOM_TRY(presenter_->end());
    return shown;
}

void Viewer::move_time(double passed) {
    delta_time_ = is_fixed() ? job_.step : std::min(passed, longest_frame);
    // What stands still keeps its motion, so that a blur of it can be tuned.
    if (is_paused_) return;
    previous_time_ = time_;
    if (shown_frames_ > 0) ++frame_index_;
    // Of the frames that are counted the first is at the time that was asked for.
    if (is_fixed() && shown_frames_ == 0) {
        previous_time_ = std::max(0.0, time_ - job_.step);
        return;
    }
    time_ += delta_time_;
    if (!playback_.advance(delta_time_)) is_paused_ = true;
}

LiveMoment Viewer::moment() const {
    LiveMoment out{
        .time = time_,
        .previous_time = previous_time_,
        .draw = draw_,
        .jitter = jitter(),
        .aspect = static_cast<float>(full_extent_.width) / static_cast<float>(std::max(full_extent_.height, 1U)),
        .scale = scale_.scale()};
    if (scene_ != nullptr) out.orbit = camera_->orbit(scene_->snapshot());
    out.previous_orbit = last_orbit_;
    out.is_post_off = !is_post_on_ && !is_off() && !screen_.is_comparing();
    out.draw.exposure = darkroom::exposure_of(document_->look());
    out.draw.mip_bias = darkroom::Composer::mip_bias(static_cast<float>(1 / scale_.scale()));
    out.number = playback_.number();
    return out;
}

Result<> Viewer::show(const PresentFrame& frame) {
    frame_number_ = frame.number;
    const Clock::time_point now = Clock::now();
    passed_ = std::chrono::duration<double>(now - std::exchange(last_turn_, now)).count();
    move_time(passed_);
    name_window();
    const VkExtent2D wanted = picture_extent();
    if (scene_ != nullptr && shown_frames_ > 0) {
        if (job_.turns && !is_paused_) camera_->turn(static_cast<float>(20 * delta_time_), scene_->snapshot());
        const darkroom::scene::OrbitOverride before = camera_->orbit(scene_->snapshot());
        camera_->move(*window_,
                      {.delta_time = delta_time_,
                       .picture = wanted,
                       .has_keys = !gui_->wants_keys(),
                       .has_mouse = is_mouse_of_camera(),
                       .ground = ground_ ? &*ground_ : nullptr},
                      scene_->snapshot());
        is_led_ = !is_same_place(camera_->orbit(scene_->snapshot()), before);
    }
    // The first frame, too, has what the game says and controllers set.
    const bool is_menu_open = screen_.has_console() || gui_->has_popup();
    settle("interface", interface_->advance(time_, camera_->head(), is_menu_open));
    const DrawScale::Turn turn = draw_turn();
    DARKROOM_TRY(scale_.begin_timing(*device_, frame, turn, has_developed_));
    scale_.choose(turn);
    has_rested_ = has_developed_ = false;
    DARKROOM_TRY(prepare(frame, wanted));
    for (std::size_t side = 0; side < side_count; ++side)
        if (views_[side]) settle(fmt::format("plan {}", side), views_[side]->planned());
    tell_source_warnings();
    store_picture(frame);
    show_thumbnails(frame);
    DARKROOM_TRY(gui_->begin(window_->scale()));
    if (gui_->has_typed('?')) obey(KeyAction::KeySheet, 0);
    draw_screen(frame);
    DARKROOM_TRY(gui_->draw(frame));
    scale_.end_timing(frame, has_developed_);
    if (store_.wants_window()) tell_store(store_.record_window(*device_, *presenter_, frame));
    // Who waits for the window may press keys now.
    if (++shown_frames_ == 1) {
        tell("ready");
        offer_unsaved();
    }
    return read_scopes(frame);
}

void Viewer::draw_screen(const PresentFrame& frame) {
    LookView& look = *views_[static_cast<std::size_t>(Side::Look)];
    using darkroom::window::PaneView;
    const auto shown = [&](Side side) {
        if (side == Side::Other && other_picture_) return other_picture_->pane();
        const LookView* const view = views_[static_cast<std::size_t>(side)].get();
        return view != nullptr ? PaneView{.image = view->picture(), .transfer = view->transfer()} : PaneView{};
    };
    const PaneView left = shown(is_off() && !screen_.is_comparing() ? Side::Off : screen_.left());
    const PaneView right = screen_.is_comparing() ? shown(screen_.right()) : PaneView{};
    const std::size_t number = moment().number;
    screen_.draw({.source = *source_,
                  .view = look,
                  .picture = left.image,
                  .compared = right.image,
                  .watched = look.watched(),
                  .transfer = left.transfer,
                  .compared_transfer = right.transfer,
                  .extent = full_extent_,
                  .lines = scale_.scale(),
                  .window = frame.extent,
                  .scale = window_->scale(),
                  .passed = is_fixed() ? delta_time_ : passed_,
                  .is_counted = is_fixed(),
                  .number = number,
                  .playback = playback_,
                  .is_paused = is_paused_,
                  .inspection = inspection_.pixel(),
                  .camera = camera_word(),
                  .frames_a_second = frames_a_second(),
                  .console = interface_->console()});
    list_places();
    for (const std::string& command : screen_.take_commands()) run_command(command);
    if (const auto place = screen_.messages().take_chosen()) open_place(*place);
    EditPanels* const panels = screen_.panels();
    if (panels == nullptr) return;
    remember_panels();
    if (const auto file = panels->take_other()) take_other(*file);
    if (const auto event = panels->look().take_fired()) fire(*event);
    if (panels->take_fullscreen()) obey(KeyAction::Fullscreen, 0);
    if (panels->take_key_sheet()) obey(KeyAction::KeySheet, 0);
    if (const auto file = panels->take_opened()) open_subject(*file);
    if (panels->take_pause()) toggle_pause();
}

int run_viewer(ViewerJob job) {
    Viewer viewer(std::move(job));
    const Result<> done = viewer.run();
    return viewer.exit_code(done ? exit_ok : fail(done.error()));
}

}  // namespace app
