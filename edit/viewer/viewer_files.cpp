// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "core/text/param_text.hpp"
#include "edit/edits.hpp"
#include "programs/darkroom/run/frames.hpp"
#include "programs/darkroom/run/report.hpp"
#include "viewer_state.hpp"

namespace app {

using darkroom::Result;
using darkroom::window::PresentFrame;

namespace {

constexpr std::chrono::milliseconds between_looks{200};
constexpr const char* panels_file = "panels.toml";

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
    tell_warnings();
    if (is_new && *is_new)
        for (const std::filesystem::path& file : document_->changed_files())
            tell(fmt::format("read {} again", darkroom::printable(file.filename().string())));
    reload_source();
}

void Viewer::tell_warnings() {
    std::vector<darkroom::panels::Messages::Said> all;
    for (const std::string& warning : document_->warnings()) all.push_back({darkroom::Severity::Warning, warning});
    screen_.say("look's file", all);
}

void Viewer::tell_source_warnings() {
    std::vector<std::string> now = source_->warnings();
    if (now == source_warnings_) return;
    // A scene passes over what it does not know; a frame that is not shown is missing.
    const darkroom::Severity severity = scene_ != nullptr ? darkroom::Severity::Warning : darkroom::Severity::Error;
    std::vector<darkroom::panels::Messages::Said> all;
    for (const std::string& warning : now) all.push_back({severity, warning});
    screen_.say("source", all);
    source_warnings_ = std::move(now);
}

// The same command gives the same picture, whatever somebody has set; and what is edited is the look's own.
bool Viewer::has_config() const { return !job_.is_edit && !is_fixed() && !config_file().empty(); }

std::filesystem::path Viewer::config_folder() {
    const auto variable = [](const char* name) {
        const char* const value = std::getenv(name);
        return std::filesystem::path(value != nullptr ? value : "");
    };
    const std::filesystem::path own = variable("XDG_CONFIG_HOME"), home = variable("HOME");
    if (own.is_absolute()) return own / "darkroom";
    return home.is_absolute() ? home / ".config" / "darkroom" : std::filesystem::path();
}

std::filesystem::path Viewer::config_file() {
    const std::filesystem::path folder = config_folder();
    return folder.empty() ? folder : folder / "console.cfg";
}

bool Viewer::keeps_panels() const { return job_.is_edit && !is_fixed() && !config_folder().empty(); }

// At every size by themselves, so that a small window does not undo what was made in a large one.
void Viewer::recall_panels() {
    EditPanels* const panels = screen_.editor();
    const VkExtent2D window = window_->extent();
    if (panels == nullptr || window.width == 0) return;
    panels->set_over(window_->is_fullscreen());
    if (!keeps_panels() || (window.width == panels_of_.width && window.height == panels_of_.height)) return;
    if (!known_panels_) {
        Result<KnownPanels> known = KnownPanels::read(config_folder() / panels_file);
        settle("panels", known ? Result<>() : failure(known.error()));
        known_panels_ = known ? std::move(*known) : KnownPanels();
    }
    panels_of_ = window;
    panels->set_sizes(known_panels_->of(window));
}

void Viewer::remember_panels() {
    const EditPanels* const panels = screen_.editor();
    if (!known_panels_ || panels == nullptr || panels->is_sizing()) return;
    if (panels->sizes() == known_panels_->of(panels_of_)) return;
    known_panels_->set(panels_of_, panels->sizes());
    std::error_code error;
    std::filesystem::create_directories(config_folder(), error);
    settle("panels", known_panels_->write(config_folder() / panels_file));
}

Result<> Viewer::read_config() {
    darkroom::Console& console = *interface_->console();
    console.take_defaults();
    if (!has_config()) return {};
    const darkroom::edit::ComposerValues before(console.composer());
    settle("configuration", console.read_config(config_file()));
    return document_->edit("the configuration",
                           [&](darkroom::Look& look) { return before.take_changes(look, console.composer()); });
}

// Whoever takes them sees what they change, and can undo it.
void Viewer::offer_unsaved() {
    if (!job_.is_edit || is_fixed()) return;
    journal_.emplace(config_folder());
    const std::optional<std::string> text = journal_->left_behind(*document_);
    if (!text) return;
    const std::string name = document_->file().empty() ? "a look without a name" : shown(document_->file().filename());
    const auto take = [this, text = *text] {
        const Result<> taken = document_->take_unsaved(text);
        settle("unsaved edits", taken);
        if (taken) journal_->settle();
    };
    screen_.editor()->look().ask(
        fmt::format("The window closed before the edits of {} were saved. They are still there.", name),
        {{"Take them", take}, {"Throw them away", [this] { journal_->settle(); }}});
    tell(fmt::format("unsaved edits of {} are there", name));
}

void Viewer::write_journal() {
    if (journal_) settle("journal", journal_->follow(*document_));
}

void Viewer::write_config() {
    if (!has_config()) return;
    std::error_code error;
    std::filesystem::create_directories(config_file().parent_path(), error);
    if (const Result<> done = interface_->console()->write_config(config_file()); !done) warn(done.error().text);
}

void Viewer::follow_document() {
    if (document_->file() != saved_as_) {
        if (shown_frames_ > 0) tell(fmt::format("saved {}", shown(document_->file().filename())));
        saved_as_ = document_->file();
        screen_.messages().set_folder(document_->options().folder);
    }
    if (followed_ == document_->version()) return;
    followed_ = document_->version();
    for (const Side side : {Side::Look, Side::Saved}) {
        const auto& view = views_[static_cast<std::size_t>(side)];
        if (view) settle(fmt::format("look {}", static_cast<int>(side)), view->show(look_of(side)));
    }
    const darkroom::LookUi ui = document_->look().ui.value_or(darkroom::LookUi{});
    if (ui.document != interface_files_.first || ui.controllers != interface_files_.second)
        settle("interface", start_interface());
    interface_->set_game(ui.game);
}

// Copies are recorded behind what made the picture.
void Viewer::store_picture(const PresentFrame& frame) {
    if (is_fixed() && shown_frames_ + 1 == *job_.frames_to_show) store_.want(job_.screenshot, job_.window_screenshot);
    const LookView& view = *views_[static_cast<std::size_t>(is_off() ? Side::Off : Side::Look)];
    // Where there is none yet, the next frame is stored; and a picture that is kept is the finished one: a plan for a
    // larger one, or for the look before the last edit, has other bits.
    const bool is_coming = !is_fixed() && !source_->display_picture() && view.is_coming();
    if (store_.wants_picture() && view.picture().is_given() && !is_coming)
        tell_store(store_.record_picture(*device_, frame, view, is_high_range()));
    if (!store_.wants_frame()) return;
    const darkroom::Frame of = source_->frame();
    darkroom::Frame stored = of;
    stored.camera = as_stored(of.camera);
    if (scene_ != nullptr) {
        stored.time = time_;
        stored.delta_time = delta_time_;
        stored.frame_index = frame_index_;
    }
    tell_store(store_.record_frame(*device_, frame, of, stored));
}

void Viewer::tell_store(const Result<>& done) {
    if (!done) screen_.tell_error("store", done.error().text);
}

void Viewer::finish_stores(bool waits) {
    const auto start = [this](std::function<Store::Said()> work) { return start_beside(work); };
    for (const Store::Said& said : store_.finish(*presenter_, start, waits)) {
        said.is_error ? screen_.tell_error("store", said.line) : tell(said.line);
        if (waits && said.is_error) failed_ = said.line;
    }
}

}  // namespace app
