// SPDX-License-Identifier: MIT
#include "viewer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "apps/darkroom/flags/device_flags.hpp"
#include "apps/darkroom/flags/look_flags.hpp"
#include "apps/darkroom/run/report.hpp"
#include "core/text/param_text.hpp"
#include "gpu/device/context.hpp"
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

VkExtent2D least_of(VkExtent2D a, VkExtent2D b) { return {std::min(a.width, b.width), std::min(a.height, b.height)}; }

}  // namespace

Viewer::~Viewer() {
    if (presenter_) (void)presenter_->wait();
}

int Viewer::exit_code(int code) const { return device_ ? finish(*device_, code) : code; }

Result<> Viewer::run() {
    if (Result<> done = open(); !done) return done;
    while (!is_leaving_) {
        Result<> done = turn();
        if (!done && is_device_lost(done.error())) done = make_anew(done.error());
        if (!done) return done;
        if (window_->is_closing()) leave();
        if (is_fixed() && shown_frames_ >= *job_.frames_to_show) break;
    }
    if (Result<> done = presenter_->wait(); !done) return done;
    write_config();
    if (journal_) journal_->end();
    finish_stores(true);
    return failed_.empty() ? Result<>() : darkroom::user_error(failed_);
}

Result<> Viewer::open() {
    Result<darkroom::window::Window> window = darkroom::window::Window::create(job_.window);
    if (!window) return failure(std::move(window));
    window_.emplace(std::move(*window));
    if (Result<> done = open_device(); !done) return done;
    document_.emplace(std::move(*job_.document));
    screen_ = Screen(job_.is_edit ? &*document_ : nullptr);
    is_post_on_ = !job_.is_off;
    is_paused_ = job_.is_paused;
    draw_ = job_.scene_desc.render.draw;
    time_ = previous_time_ = job_.time.value_or(scene_ != nullptr ? scene_->scene().time : 0);
    previous_time_ = std::max(0.0, time_ - job_.step);
    camera_.emplace(job_.is_edit ? CameraRig::Kind::Orbit : CameraRig::Kind::Walk, job_.orbit);
    tell_warnings();
    screen_.messages().set_folder(document_->options().folder);
    if (Result<> done = open_views(); !done) return done;
    if (EditPanels* const panels = screen_.editor())
        panels->look().set_thumbnails([this](const darkroom::EffectInfo& effect) { return thumbnail_of(effect); });
    if (!job_.is_edit && !is_fixed() && scene_ != nullptr) tell("click to look around with the mouse, Esc frees it");
    return {};
}

bool Viewer::is_high_range() const { return presenter_ && !presenter_->color().is_standard_code(); }

Result<> Viewer::start_interface() {
    darkroom::Look look = document_->look();
    if (look.ui) interface_files_ = {look.ui->document, look.ui->controllers};
    resolve_ui(look, document_->file().parent_path());
    if (Result<> done =
            interface_->start(look, job_.timeline, views_[static_cast<std::size_t>(Side::Look)]->composer());
        !done)
        return done;
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
    auto made = std::make_unique<LookView>(*device_, LookView::Desc{.frames_in_flight = frames_in_flight,
                                                                    .kernels = job_.kernels,
                                                                    .fuse = job_.fuse,
                                                                    .makes_light = is_high_range(),
                                                                    .keeps = job_.timeline.entries()});
    if (Result<> done = made->show(look_of(side)); !done) return failure(std::move(done));
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
    const Result<std::optional<PresentFrame>> frame = presenter_->begin(window_->extent());
    if (!frame) return failure(frame.error());
    if (!*frame) {
        is_resting_ = has_rested_ = true;
        return {};
    }
    const Result<> shown = show(**frame);
    // What was begun is ended: nothing else gives the window's image back.
    if (Result<> done = presenter_->end(); !done) return done;
    return shown;
}

void Viewer::move_time(double passed) {
    previous_time_ = time_;
    delta_time_ = is_fixed() ? job_.step : std::min(passed, longest_frame);
    if (is_paused_) return;
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
    LiveMoment out{.time = time_, .previous_time = previous_time_, .draw = draw_, .divisor = divisor_};
    if (scene_ != nullptr) out.orbit = camera_->orbit(scene_->snapshot());
    out.previous_orbit = last_orbit_;
    out.is_post_off = !is_post_on_ && !is_off() && !screen_.is_comparing();
    out.draw.exposure = darkroom::exposure_of(document_->look());
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
        camera_->move(*window_,
                      {.delta_time = delta_time_,
                       .picture = wanted,
                       .has_keys = !gui_->wants_keys(),
                       .has_mouse = !gui_->wants_mouse() && !screen_.picture().is_busy(),
                       .ground = ground_ ? &*ground_ : nullptr},
                      scene_->snapshot());
    }
    // The first frame, too, has what the game says and controllers set.
    const bool is_menu_open = screen_.has_console() || gui_->has_popup();
    settle("interface", interface_->advance(time_, camera_->head(), is_menu_open));
    divisor_ = choose_divisor();
    has_rested_ = has_developed_ = false;
    if (Result<> done = prepare(frame, wanted); !done) return done;
    for (std::size_t side = 0; side < side_count; ++side)
        if (views_[side]) settle(fmt::format("plan {}", side), views_[side]->planned());
    tell_source_warnings();
    store_picture(frame);
    show_thumbnails(frame);
    if (Result<> done = gui_->begin(window_->scale()); !done) return done;
    if (gui_->has_typed('?')) obey(KeyAction::KeySheet, 0);
    draw_screen(frame);
    if (Result<> done = gui_->draw(frame); !done) return done;
    store_window(frame);
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
                  .divisor = divisor_,
                  .window = frame.extent,
                  .scale = window_->scale(),
                  .passed = is_fixed() ? delta_time_ : passed_,
                  .is_counted = is_fixed(),
                  .number = number,
                  .playback = playback_,
                  .is_paused = is_paused_,
                  .inspection = inspection_ ? &*inspection_ : nullptr,
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

std::array<bool, side_count> Viewer::shown_sides() const {
    std::array<bool, side_count> out{};
    out[static_cast<std::size_t>(is_off() ? Side::Off : Side::Look)] = true;
    if (screen_.is_comparing())
        for (const Side side : {screen_.left(), screen_.right()})
            if (side != Side::Other || !other_picture_) out[static_cast<std::size_t>(side)] = true;
    return out;
}

// What the frame shows is made in the same commands, before it.
Result<> Viewer::prepare(const PresentFrame& frame, VkExtent2D extent) {
    const Result<LookView*> look = view(Side::Look);
    if (!look) return failure(look.error());
    const bool is_first = (*look)->most().width == 0;
    // Every side asks for the room that is wanted, and frames are as large as all that are shown can take by now.
    const VkExtent2D wanted = extent;
    const std::array<bool, side_count> is_shown = shown_sides();
    for (std::size_t side = 0; side < side_count; ++side) {
        if (!is_shown[side] || !views_[side] || views_[side]->most().width == 0) continue;
        settle(fmt::format("fit {}", side),
               views_[side]->fit(*source_, wanted, interface_->format(), !wanted_.pictures.empty()));
        extent = least_of(extent, views_[side]->most());
    }
    full_extent_ = extent;
    extent = {(extent.width + divisor_ - 1) / divisor_, (extent.height + divisor_ - 1) / divisor_};
    const LiveMoment now = moment();
    bool must_wait = source_->must_wait(now, extent) || interface_->must_wait(full_extent_, extent);
    for (const auto& any : views_) must_wait = must_wait || (any && any->must_wait(extent));
    if (EditPanels* const panels = screen_.panels(); panels != nullptr && !is_first)
        must_wait = must_wait || (*look)->must_wait_to_watch(panels->watched((*look)->composer().current_plan()),
                                                             panels->watched_level());
    if (must_wait)
        if (Result<> done = presenter_->wait(); !done) return done;
    if (!is_first)
        if (Result<> done = watch(); !done) return done;
    if (Result<> done = source_->prepare(now, extent); !done) return done;
    last_orbit_ = scene_ != nullptr ? std::optional(now.orbit) : std::nullopt;
    if (is_first)
        if (Result<> done = (*look)->fit(*source_, extent, interface_->format()); !done) return done;
    return record(frame, extent);
}

Result<> Viewer::record(const PresentFrame& frame, VkExtent2D extent) {
    if (Result<> done = source_->record(frame.commands); !done) return done;
    if (other_picture_) other_picture_->record(*device_, frame.commands);
    const Result<LookView*> look = view(Side::Look);
    if (!look) return failure(look.error());
    for (const auto& any : views_)
        if (any)
            if (Result<> done = any->resize(extent); !done) return done;
    if (const std::optional<darkroom::ImageRef> display = source_->display_picture()) {
        (*look)->copy(frame.commands, *display);
        return {};
    }
    darkroom::Frame input = source_->frame();
    if (scene_ != nullptr) {
        input.time = time_;
        input.delta_time = delta_time_;
        input.frame_index = frame_index_;
        input.camera.is_cut = is_cut_;
    }
    const bool is_kept = is_picture_kept();
    if (interface_->is_given()) {
        const Result<darkroom::ImageRef> ui =
            interface_->record(frame.commands, frame.slot, full_extent_, extent, window_->scale());
        if (!ui) return failure(ui.error());
        input.ui = *ui;
    }
    if (Result<> done = job_.timeline.advance((*look)->composer(), input.time); !done) return done;
    const std::array<bool, side_count> is_shown = shown_sides();
    for (std::size_t side = 0; side < side_count; ++side)
        if (is_shown[side] && !(is_kept && views_[side] && views_[side]->is_current()))
            if (Result<> done = record_look(frame.commands, static_cast<Side>(side), input); !done) return done;
    is_cut_ = false;
    developed_version_ = document_->version();
    return inspect(frame.commands, input);
}

Result<> Viewer::record_look(VkCommandBuffer commands, Side side, const darkroom::Frame& frame) {
    const Result<LookView*> found = view(side);
    if (!found) return failure(found.error());
    LookView& of = **found;
    const VkExtent2D extent = frame.color.used_region().extent;
    if (of.most().width == 0)
        if (Result<> done = of.fit(*source_, full_extent_, interface_->format()); !done) return done;
    if (Result<> done = of.resize(extent); !done) return done;
    if (is_fixed()) of.composer().wait_for_kernels();
    has_developed_ = true;
    // A plan that does not fit yet is on its way: the picture stays what it was.
    const Result<> recorded = of.record(commands, frame);
    if (recorded || !of.is_coming()) settle(fmt::format("frame {}", static_cast<int>(side)), recorded);
    return {};
}

int run_viewer(ViewerJob job) {
    Viewer viewer(std::move(job));
    const Result<> done = viewer.run();
    return viewer.exit_code(done ? exit_ok : fail(done.error()));
}

}  // namespace app
