// SPDX-License-Identifier: MIT
#include "panels/panels.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "core/text/param_text.hpp"
#include "panels/panel_state.hpp"
#include "panels/widgets/fitting_text.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/imgui_versions.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

const std::vector<std::string> look_files{".toml"};

std::vector<std::string> extensions_of(FileKind kind) {
    switch (kind) {
        case FileKind::Table:
            return {".cube", ".3dl", ".spi1d", ".spi3d", ".csp", ".clf", ".ctf",
                    ".lut",  ".itx", ".cub",   ".png",   ".tif", ".exr"};
        case FileKind::Picture:
            return {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".exr", ".hdr", ".pfm"};
        case FileKind::Document:
            return {".svg", ".png"};
        case FileKind::Script:
            return {".lua"};
    }
    return {};
}

/// A button that can be pressed, or not now.
bool bar_button(PanelState& state, const char* name, Icon icon, const std::string& text, bool can_press) {
    ImGui::BeginDisabled(!can_press);
    const bool is_pressed = icon_button(name, icon, text.c_str(), !can_press);
    ImGui::EndDisabled();
    state.note(fmt::format("bar/{}", name));
    ImGui::SameLine(0, 0);
    return is_pressed;
}

std::string step_text(const char* verb, std::string_view step) {
    return step.empty() ? fmt::format("There is nothing to {}.", verb) : fmt::format("Can {}: {}.", verb, step);
}

}  // namespace

void PanelState::settle() {
    if (!pending) return;
    const Edit now = *std::exchange(pending, std::nullopt);
    const bool was_flat = look().is_flat;
    wanted.clear();
    wanted_part.reset();
    const bool is_done = messages.settle("edit", document->edit(now.what, now.change, now.merge));
    if (is_done && !wanted.empty()) select(wanted);
    if (is_done && wanted_part) {
        selected = 0;
        part = wanted_part;
    }
    if (was_flat && !look().is_flat) messages.note(fmt::format("{}: the flat table is a stack now", now.what));
}

void PanelState::select(std::string_view entry) {
    const std::vector<std::string> names = entry_names(look());
    const auto found = std::ranges::find(names, entry);
    selected = found == names.end() ? 0 : look().entries[static_cast<std::size_t>(found - names.begin())].id;
    scrolls_to_selected = true;
    part.reset();
}

void PanelState::note(std::string_view name) {
    if (places) (*places)[std::string(name)] = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
}

int PanelState::selected_index() const {
    const auto found = std::ranges::find(look().entries, selected, &LookEntry::id);
    return selected == 0 || found == look().entries.end() ? -1 : static_cast<int>(found - look().entries.begin());
}

void PanelState::browse(std::string title, FileKind kind, const std::string& present,
                        std::function<void(const std::string&)> then) {
    const std::filesystem::path folder = document->options().folder;
    files.open({.title = std::move(title),
                .start = present.empty() ? folder : folder / present,
                .extensions = extensions_of(kind),
                .then = [folder, then = std::move(then)](const std::filesystem::path& file) {
                    std::error_code error;
                    const std::filesystem::path relative =
                        std::filesystem::proximate(file, folder.empty() ? "." : folder, error);
                    then((error ? file : relative).generic_string());
                }});
}

std::string_view left_out(const Plan* plan, std::string_view entry) {
    if (plan == nullptr) return {};
    for (const std::string_view text : plan->left_out)
        if (text.starts_with(entry) && text.substr(entry.size()).starts_with(": "))
            return text.substr(entry.size() + 2);
    return {};
}

void draw_question(PanelState& state) {
    if (!state.question) return;
    constexpr const char* popup = "##question";
    const bool is_new = std::exchange(state.is_question_new, false);
    if (is_new) ImGui::OpenPopup(popup);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float width = std::min(32 * ImGui::GetFontSize(), display.x * 0.9f);
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({width, 0});
    constexpr ImGuiWindowFlags flags =
        ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoTitleBar;
    if (!ImGui::BeginPopupModal(popup, nullptr, flags)) {
        state.question.reset();
        return;
    }
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(state.question->text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    std::function<void()> chosen;
    bool is_done = is_pressed(ImGuiKey_Escape, false);
    for (std::size_t i = 0; i < state.question->answers.size(); ++i) {
        const auto& [label, act] = state.question->answers[i];
        if (ImGui::Button(label.c_str())) chosen = act;
        state.note(fmt::format("question/{}", i));
        ImGui::SameLine();
    }
    // The key that opened the question does not answer it.
    if (!is_new && is_pressed(ImGuiKey_Enter, false)) chosen = state.question->answers.front().second;
    is_done |= ImGui::Button("Cancel") || chosen != nullptr;
    state.note("question/cancel");
    if (is_done) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (!is_done) return;
    state.question.reset();
    if (chosen) chosen();
}

LookPanels::LookPanels(edit::LookDocument& document) : state_(std::make_unique<PanelState>()) { show(document); }
LookPanels::LookPanels(LookPanels&&) noexcept = default;
LookPanels& LookPanels::operator=(LookPanels&&) noexcept = default;
LookPanels::~LookPanels() = default;

void LookPanels::show(edit::LookDocument& document) {
    state_->document = &document;
    state_->plan = nullptr;
    state_->selected = 0;
    state_->part.reset();
    state_->renamed.clear();
}

void LookPanels::set_plan(const Plan* plan, bool is_compiling) {
    state_->plan = plan;
    state_->is_compiling = is_compiling;
}

void LookPanels::draw_bar() {
    PanelState& state = *state_;
    const edit::LookDocument& document = *state.document;
    ImGui::PushID("bar");
    if (bar_button(state, "undo", Icon::Undo, step_text("undo", document.undo_name()), document.can_undo())) undo();
    if (bar_button(state, "redo", Icon::Redo, step_text("redo", document.redo_name()), document.can_redo())) redo();
    const bool can_save = document.is_changed() || document.file().empty();
    if (bar_button(state, "save", Icon::Save, can_save ? "Saves the look (Ctrl+S)." : "There is nothing to save.",
                   can_save))
        save();
    if (bar_button(state, "save_as", Icon::SaveAs, "Saves the look under another name.", true)) save_as();
    if (bar_button(state, "revert", Icon::Reset, "Goes back to what the file says.", document.is_changed())) revert();
    ImGui::SameLine();
    const float radius = ImGui::GetFontSize() * 0.2f;
    const std::string file = document.file().empty() ? "not saved yet" : printable(document.file().string());
    const std::string name = document.file().empty() ? file : printable(document.file().filename().string());
    if (document.is_changed()) {
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddCircleFilled({corner.x + radius, corner.y + ImGui::GetFrameHeight() / 2}, radius,
                                                    ImGui::GetColorU32(accent_color));
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 4 * radius);
    }
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(fitting(name, ImGui::GetContentRegionAvail().x, KeptPart::End).c_str());
    std::string sentence =
        document.file().empty() ? "The look has no file yet." : fmt::format("The look is in {}.", file);
    if (document.is_changed()) sentence += " It has changed since it was saved.";
    tooltip(sentence.c_str());
    ImGui::PopID();
}

void LookPanels::draw_messages() {
    state_->messages.draw([this](std::string_view name) { state_->note(name); });
}
void LookPanels::draw_history() {
    state_->messages.draw_history([this](std::string_view name) { state_->note(name); });
}
void LookPanels::draw_stack() { draw_stack_panel(*state_); }
void LookPanels::draw_entry() { state_->part ? draw_part_panel(*state_) : draw_entry_panel(*state_); }
void LookPanels::draw_plan() { draw_plan_panel(state_->plan, state_->is_compiling); }
void LookPanels::draw_popups() {
    state_->files.draw();
    draw_question(*state_);
    state_->settle();
}

void LookPanels::undo() { state_->document->undo(); }
void LookPanels::redo() { state_->document->redo(); }

void LookPanels::save() {
    if (state_->document->file().empty())
        save_as();
    else
        state_->messages.settle("save", state_->document->save());
}

void LookPanels::save_as() {
    PanelState& state = *state_;
    // Of a scene it is the look alone that goes elsewhere.
    std::string start = state.document->file().string();
    constexpr std::string_view of_scene = ".scene.toml";
    if (start.ends_with(of_scene)) start.replace(start.size() - of_scene.size(), of_scene.size(), ".toml");
    state.files.open({.title = "Save the look as",
                      .start = start,
                      .extensions = look_files,
                      .is_saving = true,
                      .then = [&state](const std::filesystem::path& file) {
                          state.messages.settle("save", state.document->save_as(file));
                      }});
}

void LookPanels::revert() {
    state_->edit("revert", [saved = state_->document->saved_look()](Look& look) {
        look = saved;
        return Result<>();
    });
    state_->settle();
}

const std::filesystem::path& LookPanels::folder() const { return state_->document->options().folder; }
std::optional<std::string> LookPanels::take_fired() { return std::exchange(state_->fired, std::nullopt); }
void LookPanels::ask(std::string text, std::vector<std::pair<std::string, std::function<void()>>> answers) {
    state_->ask({.text = std::move(text), .answers = std::move(answers)});
}
Messages& LookPanels::messages() { return state_->messages; }
FileBrowser& LookPanels::files() { return state_->files; }

std::string LookPanels::selected() const {
    const int index = state_->selected_index();
    return index < 0 ? std::string() : entry_names(state_->look())[static_cast<std::size_t>(index)];
}

void LookPanels::select(std::string_view entry) { state_->select(entry); }

void LookPanels::set_thumbnails(ThumbnailOf thumbnails) { state_->thumbnails = std::move(thumbnails); }
void LookPanels::set_looks(OfferedLooks looks) {
    state_->looks = std::make_shared<const OfferedLooks>(std::move(looks));
}
void LookPanels::set_numbers(NumbersOf numbers) { state_->numbers = std::move(numbers); }
bool LookPanels::is_adding() const {
    const int passed = ImGui::GetFrameCount() - state_->adding_frame;
    return state_->adding_frame >= 0 && (passed == 0 || passed == 1);
}

void LookPanels::show_numbers(bool shows_numbers) { state_->shows_numbers = shows_numbers; }

const WidgetPlaces& LookPanels::places() {
    if (!state_->places) state_->places.emplace();
    return *state_->places;
}

void LookPanels::note_place(std::string_view name) { state_->note(name); }

void LookPanels::note_place(std::string_view name, const WidgetPlace& place) {
    if (state_->places) (*state_->places)[std::string(name)] = place;
}

}  // namespace darkroom::panels
