// SPDX-License-Identifier: MIT
#include "panels/widgets/file_browser.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cfloat>
#include <cstdlib>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/imgui_versions.hpp"
#include "panels/widgets/text_field.hpp"

namespace darkroom::panels {

namespace {

constexpr const char* popup = "files";

bool is_path(const std::string& typed) { return typed.find('/') != std::string::npos; }

}  // namespace

void FileBrowser::open(FileRequest request) {
    request_ = std::move(request);
    is_open_ = is_new_ = true;
    shows_all_ = is_replacing_ = false;
    name_.clear();
    std::error_code error;
    std::filesystem::path start = std::filesystem::absolute(request_.start, error);
    if (error || request_.start.empty()) start = std::filesystem::current_path(error);
    if (!std::filesystem::is_directory(start, error)) {
        if (request_.is_saving) name_ = start.filename().string();
        start = start.parent_path();
    }
    enter(start);
}

void FileBrowser::enter(const std::filesystem::path& folder) {
    folder_ = folder.lexically_normal();
    entries_.clear();
    problem_.clear();
    filter_.clear();
    present_ = 0;
    is_cut_short_ = false;
    wants_focus_ = true;
    std::error_code error;
    std::filesystem::directory_iterator file(folder_, error);
    for (; !error && file != std::filesystem::directory_iterator(); file.increment(error)) {
        const std::string name = file->path().filename().string();
        if (name.starts_with('.')) continue;
        if (entries_.size() == max_entries) {
            is_cut_short_ = true;
            break;
        }
        std::error_code unknown;
        entries_.push_back({printable(name), file->path(), file->is_directory(unknown)});
    }
    if (error) problem_ = fmt::format("{}: {}", printable(folder_.string()), error.message());
    std::ranges::sort(entries_, {},
                      [](const Entry& entry) { return std::tuple(!entry.is_folder, lower(entry.shown), entry.shown); });
}

std::vector<std::size_t> FileBrowser::visible() const {
    std::vector<std::size_t> out;
    const std::string wanted = is_path(filter_) ? "" : lower(filter_);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const Entry& entry = entries_[i];
        const bool is_of_kind = entry.is_folder || shows_all_ || request_.extensions.empty() ||
                                std::ranges::count(request_.extensions, lower(entry.path.extension().string())) > 0;
        if (is_of_kind && lower(entry.shown).find(wanted) != std::string::npos) out.push_back(i);
    }
    return out;
}

void FileBrowser::take(const std::filesystem::path& file) {
    is_open_ = false;
    // It may ask for another file.
    const FileRequest request = std::exchange(request_, {});
    if (request.then) request.then(file);
}

// A file that is chosen in order to save over it is named first, and asked about.
void FileBrowser::choose(std::size_t index) {
    const Entry entry = entries_[index];
    if (entry.is_folder)
        enter(entry.path);
    else if (request_.is_saving)
        name_ = entry.path.filename().string();
    else
        take(entry.path);
}

std::filesystem::path FileBrowser::typed(const std::string& name) const {
    const char* const home = std::getenv("HOME");
    if (name.starts_with("~/") && home != nullptr) return home + name.substr(1);
    return folder_ / name;
}

void FileBrowser::accept() {
    std::error_code error;
    if (!request_.is_saving && is_path(filter_)) {
        const std::filesystem::path file = typed(filter_);
        if (std::filesystem::is_directory(file, error)) return enter(file);
        if (std::filesystem::exists(file, error)) return take(file);
        problem_ = fmt::format("{}: there is no such file", printable(file.string()));
        return;
    }
    if (!request_.is_saving) {
        const std::vector<std::size_t> seen = visible();
        if (present_ < seen.size()) choose(seen[present_]);
        return;
    }
    if (name_.empty()) return;
    std::filesystem::path file = typed(name_);
    if (!file.has_extension() && !request_.extensions.empty()) file += request_.extensions.front();
    if (std::filesystem::is_directory(file, error)) return enter(file);
    if (std::filesystem::exists(file, error) && !is_replacing_) {
        is_replacing_ = true;
        return;
    }
    take(file);
}

void FileBrowser::press_keys(const std::vector<std::size_t>& seen) {
    const auto move = [&](std::ptrdiff_t by) {
        const auto last = static_cast<std::ptrdiff_t>(seen.size()) - 1;
        present_ = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(present_) + by, 0,
                                                                       std::max<std::ptrdiff_t>(last, 0)));
        follows_ = true;
    };
    if (is_pressed(ImGuiKey_DownArrow)) move(1);
    if (is_pressed(ImGuiKey_UpArrow)) move(-1);
    if (is_pressed(ImGuiKey_PageDown)) move(10);
    if (is_pressed(ImGuiKey_PageUp)) move(-10);
    // A press goes one folder on, however long it is.
    if (is_pressed(ImGuiKey_Enter, false) || is_pressed(keypad_enter, false)) accept();
}

void FileBrowser::draw_head() {
    if (icon_button("##up", Icon::Up, "Goes to the folder above (Backspace).")) enter(folder_.parent_path());
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(printable(folder_.string()).c_str());
    ImGui::PopTextWrapPos();
    // Asked for before the field takes its last letter away.
    if (is_pressed(ImGuiKey_Backspace) && filter_.empty() && !request_.is_saving) enter(folder_.parent_path());
    if (std::exchange(wants_focus_, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (text_field(request_.is_saving ? "##name" : "##filter", request_.is_saving ? "Name" : "Filter, or a path",
                   request_.is_saving ? name_ : filter_)) {
        present_ = 0;
        is_replacing_ = false;
        problem_.clear();
    }
}

void FileBrowser::draw_list(float height) {
    ImGui::BeginChild("list", {0, height}, true);
    const std::vector<std::size_t> seen = visible();
    present_ = std::min(present_, seen.empty() ? 0 : seen.size() - 1);
    std::size_t chosen = entries_.size();
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(seen.size()));
    // What the keyboard goes to may lie outside of what is drawn.
    if (follows_) {
        const float row = ImGui::GetTextLineHeightWithSpacing();
        ImGui::SetScrollY(static_cast<float>(present_) * row - (height - row) / 2);
        follows_ = false;
    }
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const std::size_t index = seen[static_cast<std::size_t>(i)];
            ImGui::PushID(static_cast<int>(index));
            const std::string label = entries_[index].shown + (entries_[index].is_folder ? "/" : "");
            const bool is_present = static_cast<std::size_t>(i) == present_ && !request_.is_saving;
            if (ImGui::Selectable("##file", is_present, ImGuiSelectableFlags_AllowDoubleClick)) {
                present_ = static_cast<std::size_t>(i);
                const bool names_it = request_.is_saving && !entries_[index].is_folder;
                if (names_it || ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) chosen = index;
            }
            ImGui::SameLine(0, 0);
            ImGui::TextUnformatted(label.c_str());
            ImGui::PopID();
        }
    if (seen.empty() && problem_.empty()) ImGui::TextDisabled("No such file here");
    ImGui::EndChild();
    press_keys(seen);
    if (is_open_ && chosen < entries_.size()) choose(chosen);
}

void FileBrowser::draw_foot() {
    const std::string note = !problem_.empty() ? problem_
                             : is_replacing_   ? fmt::format("{} is there already", printable(name_))
                             : is_cut_short_   ? fmt::format("The first {} files", max_entries)
                                               : std::string();
    ImGui::AlignTextToFramePadding();
    if (!note.empty())
        ImGui::TextUnformatted(note.c_str());
    else if (!request_.extensions.empty() && !request_.is_saving)
        ImGui::Checkbox("All files", &shows_all_);
    else
        ImGui::TextUnformatted("");
    const char* const verb = is_replacing_ ? "Replace" : request_.is_saving ? "Save" : "Open";
    const ImGuiStyle& style = ImGui::GetStyle();
    const float width = ImGui::CalcTextSize("Replace").x + 2 * style.FramePadding.x;
    ImGui::SameLine(ImGui::GetContentRegionMax().x - 2 * width - style.ItemSpacing.x);
    if (ImGui::Button(verb, {width, 0})) accept();
    ImGui::SameLine();
    if (ImGui::Button("Cancel", {width, 0}) || is_pressed(ImGuiKey_Escape)) is_open_ = false;
}

void FileBrowser::draw() {
    if (!is_open_) return;
    if (is_new_) ImGui::OpenPopup(popup);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({std::min(44 * em, display.x * 0.9f), std::min(32 * em, display.y * 0.85f)});
    constexpr ImGuiWindowFlags flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar;
    if (!ImGui::BeginPopupModal(popup, nullptr, flags)) {
        is_open_ = false;
        return;
    }
    ImGui::TextUnformatted(request_.title.c_str());
    draw_head();
    draw_list(ImGui::GetContentRegionAvail().y - ImGui::GetFrameHeightWithSpacing());
    if (is_open_) draw_foot();
    is_new_ = false;
    if (!is_open_) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace darkroom::panels
