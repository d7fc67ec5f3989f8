// SPDX-License-Identifier: MIT
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "edit/edits.hpp"
#include "programs/darkroom/run/report.hpp"
#include "viewer/input/open_place.hpp"
#include "viewer/viewer_state.hpp"

namespace app {

namespace render = darkroom::render;
using darkroom::Look;
using darkroom::Result;

namespace {

std::string_view on_off(bool is_on) { return is_on ? "on" : "off"; }

constexpr std::array debug_views{"none", "wireframe", "normals", "depth", "uv", "unlit", "metal-rough"};

}  // namespace

void Viewer::obey_keys() {
    if (!job_.is_edit && !is_fixed() && !gui_->wants_mouse() && window_->is_button_down(GLFW_MOUSE_BUTTON_LEFT))
        window_->capture_cursor(true);
    for (const darkroom::window::KeyPress& press : window_->pressed()) {
        const std::optional<KeyAction> action = action_of(press, job_.is_edit);
        // Who types into a field writes letters, copies, and takes back what was typed; F keys and Ctrl+S are ours
        // still.
        const bool is_typed = (gui_->wants_keys() || screen_.has_console()) && action != KeyAction::Console &&
                              action != KeyAction::Leave && action != KeyAction::Save && function_key(press.key) == 0;
        if (action && !is_typed) obey(*action, function_key(press.key));
    }
}

bool Viewer::is_mouse_of_camera() {
    const auto is_down = [this](int button) { return window_->is_button_down(button); };
    const bool was_down =
        std::exchange(is_button_down_, is_down(GLFW_MOUSE_BUTTON_LEFT) || is_down(GLFW_MOUSE_BUTTON_MIDDLE) ||
                                           is_down(GLFW_MOUSE_BUTTON_RIGHT));
    if (was_down && is_button_down_) return has_mouse_;
    const VkRect2D area = screen_.picture_area(window_->extent(), window_->scale(), source_->frames() > 0);
    const auto [x, y] = window_->mouse();
    const double right = x - area.offset.x, down = y - area.offset.y;
    const bool is_inside = right >= 0 && down >= 0 && right < area.extent.width && down < area.extent.height;
    has_mouse_ = is_inside && !gui_->has_popup() && !gui_->wants_mouse() && !screen_.picture().is_busy();
    return has_mouse_;
}

void Viewer::obey(KeyAction action, std::uint32_t number) {
    const auto flip = [&](bool& what, std::string_view shown) {
        what = !what;
        tell(fmt::format("{}: {}", shown, on_off(what)));
    };
    const bool has_scene = scene_ != nullptr;
    EditPanels* const edit = screen_.editor();
    switch (action) {
        case KeyAction::DebugView: {
            if (!has_scene) return tell("F1 debug view: a stored frame has none");
            const auto next = (static_cast<std::size_t>(draw_.debug) + 1) % debug_views.size();
            draw_.debug = static_cast<render::DebugView>(next);
            return tell(fmt::format("F1 debug view: {}", debug_views[next]));
        }
        case KeyAction::Shadows:
            return flip(draw_.has_shadows, "F4 shadows");
        case KeyAction::All:
            return flip(is_post_on_, "F6 post-processing");
        case KeyAction::Effect:
            return toggle_effects(number);
        case KeyAction::Fullscreen:
            return window_->set_fullscreen(!window_->is_fullscreen());
        case KeyAction::Screenshot:
            return store_.want_picture();
        case KeyAction::WindowScreenshot:
            return store_.want_window();
        case KeyAction::Capture:
            return store_.want_frame();
        case KeyAction::Console:
            screen_.toggle_console();
            return tell(fmt::format("console: {}", on_off(screen_.has_console())));
        case KeyAction::Panels:
            screen_.toggle_panels();
            return tell(fmt::format("Tab panels: {}", on_off(screen_.panels() != nullptr)));
        case KeyAction::Save: {
            if (edit == nullptr) return;
            edit->look().save();
            if (document_->file().empty()) return tell("the look has no name yet: choose one");
            if (!document_->is_changed()) tell(fmt::format("saved {}", document_->file().filename().string()));
            return;
        }
        case KeyAction::Undo:
            tell(document_->can_undo() ? fmt::format("undo: {}", document_->undo_name()) : "nothing to undo");
            return document_->undo();
        case KeyAction::Redo:
            tell(document_->can_redo() ? fmt::format("redo: {}", document_->redo_name()) : "nothing to redo");
            return document_->redo();
        case KeyAction::Pause:
            toggle_pause();
            return tell(fmt::format("P pause: {}", on_off(is_paused_)));
        case KeyAction::StepBack:
            return step_frame(-1);
        case KeyAction::StepForth:
            return step_frame(1);
        case KeyAction::ResetCamera:
        case KeyAction::FrameAll:
        case KeyAction::CameraKind:
            return obey_camera(action);
        case KeyAction::Compare:
            if (edit == nullptr) return;
            edit->toggle_compare();
            return tell(fmt::format("B compare: {}", on_off(edit->is_comparing())));
        case KeyAction::KeySheet:
            screen_.toggle_key_sheet();
            return tell(fmt::format("? keys: {}", on_off(screen_.has_key_sheet())));
        case KeyAction::Leave:
            if (screen_.has_key_sheet()) return obey(KeyAction::KeySheet, 0);
            if (window_->is_cursor_captured()) return window_->capture_cursor(false);
            if (screen_.has_console()) return screen_.toggle_console();
            if (gui_->has_popup() || gui_->wants_keys()) return;
            return leave();
    }
}

void Viewer::obey_camera(KeyAction action) {
    if (action == KeyAction::ResetCamera) {
        camera_->reset();
        return tell("Space: the scene's camera");
    }
    if (action == KeyAction::FrameAll) {
        if (scene_ == nullptr) return;
        const VkExtent2D extent = picture_extent();
        camera_->frame_all(scene_->snapshot(), static_cast<float>(extent.width) / static_cast<float>(extent.height));
        return tell("F: frame all");
    }
    const bool flies = camera_->kind() == CameraRig::Kind::Fly;
    camera_->set_kind(flies ? CameraRig::Kind::Orbit : CameraRig::Kind::Fly);
    tell(flies ? "V: the camera orbits" : "V: the camera flies");
}

// At its end a sequence begins anew.
void Viewer::toggle_pause() {
    is_paused_ = !is_paused_;
    if (!is_paused_ && playback_.is_at_end()) playback_.seek(playback_.first());
}

void Viewer::step_frame(long frames) {
    if (playback_.frames() == 0) return tell("no sequence is shown: there are no frames to step through");
    is_paused_ = true;
    playback_.step(frames);
    tell(fmt::format("frame {} of {}: {}", playback_.number() + 1, playback_.frames(),
                     source_->shown_frame(playback_.number())));
}

void Viewer::leave() {
    constexpr std::chrono::seconds to_think{4};
    const Clock::time_point now = Clock::now();
    const bool would_lose = job_.is_edit && document_->is_changed();
    if (!would_lose || now < sure_until_) {
        is_leaving_ = true;
        return;
    }
    window_->stay_open();
    sure_until_ = now + to_think;
    tell("Unsaved changes: press again to quit, Ctrl+S to save");
}

// All entries of the effects that have the key: on if any is off.
void Viewer::toggle_effects(std::uint32_t number) {
    const std::vector<std::string> names = darkroom::entry_names(document_->look());
    std::vector<std::string> chosen;
    bool is_any_on = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const darkroom::LookEntry& entry = document_->look().entries[i];
        if (entry.effect->flat.toggle_key != number) continue;
        chosen.push_back(names[i]);
        is_any_on = is_any_on || entry.state.enabled.on != 0;
    }
    if (chosen.empty()) return tell(fmt::format("F{}: the look has no such effect", number));
    const std::string what = fmt::format("F{} {}: {}", number, chosen.front(), on_off(!is_any_on));
    const Result<> done = document_->edit(what, [&](Look& look) -> Result<> {
        const std::uint32_t word = is_any_on ? 0 : 1;
        for (const std::string& name : chosen)
            DARKROOM_TRY(darkroom::edit::set_state(look, name, "enabled", {&word, 1}));
        return {};
    });
    settle("switch", done);
    if (done) tell(what);
}

std::string_view Viewer::camera_word() const {
    if (scene_ == nullptr) return {};
    if (camera_->kind() == CameraRig::Kind::Walk) return "walk";
    return camera_->kind() == CameraRig::Kind::Fly ? "fly" : "orbit";
}

void Viewer::open_place(const darkroom::panels::TextPlace& place) {
    const Result<bool> is_open = open_in_editor(place);
    settle("editor", is_open ? Result<>() : failure(is_open.error()));
    if (!is_open) return;
    if (*is_open) return tell(fmt::format("opened {}", editor_command("$VISUAL", place)));
    const std::string command = editor_command({}, place);
    ImGui::SetClipboardText(command.c_str());
    tell(fmt::format("$VISUAL names no editor; copied: {}", command));
}

void Viewer::tell(std::string line) {
    app::answer_unless_quiet(line);  // for who drives it by its standard input, too
    screen_.tell(std::move(line));
}

void Viewer::print(std::string line) {
    if (job_.obeys_input) answer(line);
    screen_.print(std::move(line));
}

// For programs that move the mouse: widgets and their corners in the window, and the mouse itself as the frame has it.
// Widgets are noted from the first question on, so the answer is of the frame after it.
void Viewer::list_places() {
    EditPanels* const panels = screen_.panels();
    if (!places_ || (panels != nullptr && panels->look().places().empty())) return;
    const std::string name = *std::exchange(places_, std::nullopt);
    const auto list = [&](std::string_view shown, ImVec2 least, ImVec2 most) {
        if (shown.starts_with(name))
            print(fmt::format("place {} {:.0f} {:.0f} {:.0f} {:.0f}", shown, least.x, least.y, most.x, most.y));
    };
    if (panels != nullptr)
        for (const auto& [shown, place] : panels->look().places()) list(shown, place.least, place.most);
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsMousePosValid()) list(io.MouseDown[0] ? "mouse/down" : "mouse/up", io.MousePos, io.MousePos);
}

void Viewer::obey_input() {
    if (!job_.obeys_input) return;
    const Result<std::vector<std::string>> lines = input_.take();
    if (!lines) return screen_.tell_error("input", lines.error().text);
    for (const std::string& line : *lines) run_command(line);
}

// The console sets values of the Composer; they are the document's, too, as one step.
void Viewer::run_command(const std::string& command) {
    darkroom::Console* const console = interface_->console();
    if (console == nullptr) return;
    screen_.print("> " + command);
    constexpr std::string_view places = "places";
    if (command.starts_with(places)) {
        places_ = command.substr(std::min(places.size() + 1, command.size()));
        return;
    }
    // For who measures: what was drawn so far.
    if (command == "frames") {
        const auto [width, height] = full_extent_;
        const VkExtent2D drawn = source_->frame().color.extent;
        return print(
            fmt::format("frames: {}, {}x{} from {}x{}", shown_frames_, width, height, drawn.width, drawn.height));
    }
    if (command == "messages") {
        const darkroom::panels::Messages& messages = screen_.messages();
        std::vector<std::string> lines;
        for (const auto& entry : messages.history())
            if (!entry.sources.empty())
                lines.push_back(fmt::format(
                    "{}: {}", entry.severity == darkroom::Severity::Warning ? "warning" : "error", entry.text));
        print(fmt::format("messages: {}", lines.size()));
        for (std::string& line : lines) print(std::move(line));
        return;
    }
    const darkroom::Composer& composer = console->composer();
    const darkroom::edit::ComposerValues before(composer);
    console->execute(command);
    settle("console", document_->edit(command, [&](Look& look) { return before.take_changes(look, composer); }));
}

}  // namespace app
