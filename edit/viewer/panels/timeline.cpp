// SPDX-License-Identifier: MIT
// The line below the picture of a sequence: which frame, how it plays, and between which ends.
#include <fmt/format.h>

#include <algorithm>

#include "panels/widgets/fitting_text.hpp"
#include "panels/widgets/theme.hpp"
#include "viewer/panels/areas.hpp"
#include "viewer/panels/edit_panels.hpp"

namespace app {

namespace {

/// What lies between the ends is marked on the slider that was drawn last.
void mark_range(const Playback& playback) {
    const ImVec2 least = ImGui::GetItemRectMin(), most = ImGui::GetItemRectMax();
    const auto last = static_cast<float>(std::max<std::size_t>(playback.frames() - 1, 1));
    const auto at = [&](std::size_t number) {
        return least.x + (most.x - least.x) * static_cast<float>(number) / last;
    };
    const float thickness = std::max(2.0F, ImGui::GetFontSize() / 6);
    ImGui::GetWindowDrawList()->AddRectFilled({at(playback.first()), most.y - thickness},
                                              {std::max(at(playback.last()), at(playback.first()) + 2), most.y},
                                              ImGui::GetColorU32(darkroom::panels::accent_color));
}

}  // namespace

void EditPanels::draw_timeline(const Input& input) {
    Playback& playback = input.playback;
    const float em = ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const auto button = [&](const char* name, const char* text, const char* place, float width = 0) {
        const bool is_pressed = ImGui::Button(name, {width, 0});
        look_.note_place(place);
        tip(text);
        ImGui::SameLine(0, gap);
        return is_pressed;
    };
    if (button(input.is_paused ? "Play" : "Pause", "Stops the time, and continues it (P).", "time/play", 4 * em))
        is_pause_wanted_ = true;
    if (button("<", "One frame back (comma).", "time/back")) playback.step(-1);
    if (button(">", "One frame on (full stop).", "time/forth")) playback.step(1);
    if (button("In", "Plays from this frame on.", "time/in")) playback.begin_here();
    if (button("Out", "Plays up to this frame.", "time/out")) playback.end_here();
    if (button("All", "Plays all frames.", "time/all")) playback.play_all();
    bool is_looping = playback.is_looping();
    if (ImGui::Checkbox("Loop", &is_looping)) playback.set_looping(is_looping);
    look_.note_place("time/loop");
    tip("Starts again after the last frame.");
    ImGui::SameLine(0, gap);
    auto rate = static_cast<float>(playback.rate());
    ImGui::SetNextItemWidth(4.5F * em);
    if (ImGui::DragFloat("##rate", &rate, 0.1F, 0.1F, 240, "%.4g fps", ImGuiSliderFlags_AlwaysClamp))
        playback.set_rate(static_cast<double>(rate));
    look_.note_place("time/rate");
    tip("Frames a second: drag, or double-click and type.");
    ImGui::SameLine(0, gap);

    int number = static_cast<int>(input.number);
    const std::string count = fmt::format("{} of {}", input.number + 1, input.source.frames());
    const std::string name = input.source.shown_frame(input.number);
    // The name has its place beside the slider, never under its thumb, and gives way first.
    const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(count.c_str()).x - 2 * gap;
    const float of_name = std::min(ImGui::CalcTextSize(name.c_str()).x, std::max(room - 8 * em, 0.0F));
    ImGui::SetNextItemWidth(std::max(room - of_name - (of_name > 0 ? gap : 0), 2 * em));
    if (ImGui::SliderInt("##frame", &number, 0, static_cast<int>(input.source.frames()) - 1, ""))
        playback.seek(static_cast<std::size_t>(std::clamp(number, 0, static_cast<int>(input.source.frames()) - 1)));
    mark_range(playback);
    look_.note_place("view/frame");
    tip(name.c_str());
    ImGui::SameLine(0, gap);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(count.c_str());
    if (of_name < 3 * em) return;
    ImGui::SameLine(0, gap);
    ImGui::TextUnformatted(darkroom::panels::fitting(name, of_name, darkroom::panels::KeptPart::End).c_str());
    tip(name.c_str());
}

}  // namespace app
