// SPDX-License-Identifier: MIT
#include "edit_panels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <array>

#include "formats/file_format.hpp"
#include "panels/show/plan_picture.hpp"
#include "panels/widgets/fitting_text.hpp"
#include "panels/widgets/slider.hpp"
#include "panels/widgets/theme.hpp"
#include "viewer/panels/areas.hpp"

namespace app {

namespace {

using darkroom::window::PaneChannels;
using darkroom::window::PaneTransfer;

constexpr darkroom::ParamInfo exposure_row{.name = "exposure", .unit = {"stops"}, .range = {-8, 8}};
constexpr std::array sides{"look", "saved", "off", "file"};
constexpr std::array channels{"RGB", "red", "green", "blue", "alpha", "luminance"};

/// `width`: in heights of the font.
template <class Value, std::size_t Count>
void combo(const char* name, Value& value, const std::array<const char*, Count>& names, float width) {
    int chosen = static_cast<int>(value);
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * width);
    if (ImGui::Combo(name, &chosen, names.data(), static_cast<int>(names.size()))) value = static_cast<Value>(chosen);
}

std::string number_text(float value) { return fmt::format("{:.5g}", value); }

}  // namespace

PanelAreas EditPanels::layout(VkExtent2D window, float scale, bool has_timeline) const {
    return lay_out(
        sizes_,
        {.window = window, .scale = scale, .has_timeline = has_timeline, .is_over = is_over_, .view_rows = view_rows_});
}

const darkroom::PlanImage* EditPanels::watched(const darkroom::Plan* plan) const {
    if (tab_ != Tab::Images || plan == nullptr) return nullptr;
    const auto found = std::ranges::find(plan->images, image_, &darkroom::PlanImage::name);
    return found == plan->images.end() ? nullptr : &*found;
}

void EditPanels::draw(const Input& input, PictureView& picture) {
    const bool has_timeline = input.source.frames() > 0;
    room_ = {.window = input.window,
             .scale = input.scale,
             .has_timeline = has_timeline,
             .is_over = is_over_,
             .view_rows = view_rows_};
    const PanelAreas area = lay_out(sizes_, room_);
    look_.set_plan(input.composer.current_plan(), input.composer.pending().is_pending);
    times_.add(input.composer.times(), input.composer.record_microseconds());
    begin_area("##bar", area.bar, ImGuiWindowFlags_NoScrollbar);
    draw_bar();
    ImGui::End();
    if (sizes_.has_stack) {
        begin_panel("Stack", area.stack, sizes_.has_stack);
        look_.draw_stack();
        end_panel("Stack");
    }
    if (sizes_.has_entry) {
        begin_panel("Parameters", area.entry, sizes_.has_entry);
        look_.draw_entry();
        end_panel("Parameters");
    }
    begin_area("##view", area.view_bar, ImGuiWindowFlags_NoScrollbar);
    draw_view_bar(picture);
    ImGui::End();
    if (has_timeline) {
        begin_area("##timeline", area.timeline, ImGuiWindowFlags_NoScrollbar);
        draw_timeline(input);
        ImGui::End();
    }
    if (sizes_.has_below) {
        begin_area("##below", area.below);
        draw_below(input, picture);
        end_panel("Below");
    } else {
        tab_ = Tab::Plan;
    }
    if (sizes_.has_status) {
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * input.scale, 3 * input.scale});
        ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
        begin_area("##status", area.status, ImGuiWindowFlags_NoScrollbar);
        ImGui::PopStyleVar(2);
        draw_status(input, picture);
        ImGui::End();
    }
    draw_splitters(area);
    const auto [x, y] = area.picture.offset;
    const ImVec2 corner{static_cast<float>(x), static_cast<float>(y)};
    look_.note_place("panel/Picture", {corner,
                                       {corner.x + static_cast<float>(area.picture.extent.width),
                                        corner.y + static_cast<float>(area.picture.extent.height)}});
    VkRect2D strip = area.picture;
    if (is_over_)
        strip = {
            {area.view_bar.offset.x, area.view_bar.offset.y + static_cast<std::int32_t>(area.view_bar.extent.height)},
            {area.view_bar.extent.width, area.picture.extent.height}};
    const float height = look_.messages().height(static_cast<float>(strip.extent.width));
    if (height > 0) {
        strip.extent.height = std::min(strip.extent.height, static_cast<std::uint32_t>(height + 16 * input.scale));
        begin_area("##messages", strip);
        look_.draw_messages();
        ImGui::End();
    }
    look_.draw_popups();
}

void EditPanels::draw_view_bar(PictureView& picture) {
    darkroom::window::Pane& pane = picture.pane();
    const float em = ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
    Flow flow;
    flow.next(checkbox_width("A/B"));
    ImGui::Checkbox("A/B", &is_comparing_);
    look_.note_place("view/compare");
    tip("Compares two of these: this look, the saved look, no effects, another file. Drag the divider.");
    flow.next(9.6F * em + gap);
    ImGui::BeginDisabled(!is_comparing_);
    const bool had_other = left_ == Side::Other || right_ == Side::Other;
    combo("##left", left_, sides, 4.8F);
    look_.note_place("view/left");
    ImGui::SameLine(0, gap);
    combo("##right", right_, sides, 4.8F);
    look_.note_place("view/right");
    const bool has_other = left_ == Side::Other || right_ == Side::Other;
    if (has_other && !had_other) choose_other();
    if (has_other) {
        flow.next(checkbox_width("File..."));
        if (ImGui::Button("File...")) choose_other();
        look_.note_place("view/other");
        tip("Chooses the look, or the picture, to compare with.");
    }
    ImGui::EndDisabled();
    flow.next(6 * em);
    ImGui::SetNextItemWidth(6 * em);
    double stops = pane.exposure;
    if (darkroom::panels::draw_slider("##exposure", exposure_row, 0, stops).is_changed)
        pane.exposure = static_cast<float>(std::clamp(stops, exposure_row.range.min, exposure_row.range.max));
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) pane.exposure = 0;
    tip("Brightens what is shown here, and nothing else. A double click sets it to 0.");
    flow.next(5.5F * em);
    combo("##channels", pane.channels, channels, 5.5F);
    flow.next(checkbox_width("False colours"));
    ImGui::Checkbox("False colours", &pane.is_false_color);
    look_.note_place("view/false_colors");
    tip("Shows levels as colours; the scopes have the legend.");
    flow.next(checkbox_width("Clipping"));
    ImGui::Checkbox("Clipping", &pane.is_clipping_marked);
    look_.note_place("view/clipping");
    tip("Stripes mark what is black (blue), white (red) or not a number (magenta).");
    flow.next(checkbox_width("Fit"));
    bool is_fitted = picture.zoom() == 0;
    if (ImGui::Checkbox("Fit", &is_fitted)) is_fitted ? picture.fit() : picture.set_zoom(1);
    look_.note_place("view/fit");
    tip("Fits the picture into the window, or shows it pixel by pixel. The wheel zooms if no camera uses it.");
    view_rows_ = flow.rows();
}

void EditPanels::choose_other() {
    std::vector<std::string> extensions = darkroom::picture_extensions();
    extensions.insert(extensions.begin(), ".toml");
    look_.files().open({.title = "A look, or a picture, to compare with",
                        .start = look_.folder(),
                        .extensions = std::move(extensions),
                        .then = [this](const std::filesystem::path& file) { wanted_other_ = file; }});
}

std::string EditPanels::name_of(Side side) const {
    switch (side) {
        case Side::Saved:
            return "as saved";
        case Side::Off:
            return "without effects";
        case Side::Other:
            return other_;
        default:
            return "this look";
    }
}

void EditPanels::draw_status(const Input& input, const PictureView& picture) {
    const darkroom::Plan* const plan = input.composer.current_plan();
    const darkroom::panels::TimingHistory::Statistics gpu = times_.of_frames();
    std::vector<std::string> parts;
    parts.push_back(input.frames_a_second > 0 ? fmt::format("{:.3g} frames/s", input.frames_a_second) : "at rest");
    if (!times_.frames().empty()) parts.push_back(fmt::format("GPU {:.2f} ms", static_cast<double>(gpu.median)));
    parts.push_back(fmt::format("{}x{}{}", input.extent.width, input.extent.height,
                                input.lines == 1 ? "" : fmt::format(" from {:.0f} % of its lines", 100 * input.lines)));
    if (picture.zoom() > 0) parts.push_back(fmt::format("{:.0f} %", static_cast<double>(picture.zoom() * 100)));
    if (!input.camera.empty()) parts.emplace_back(input.camera);
    if (input.is_paused) parts.emplace_back("paused");
    if (input.composer.pending().is_pending)
        parts.emplace_back("planning...");
    else if (plan != nullptr)
        parts.push_back(fmt::format("{} pass{}", plan->passes.size(), plan->passes.size() == 1 ? "" : "es"));
    const darkroom::panels::Messages& messages = look_.messages();
    const auto counted = [](std::size_t count, const char* one) {
        return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
    };
    const std::size_t errors = messages.count(darkroom::Severity::Error);
    const std::size_t warnings = messages.count(darkroom::Severity::Warning);
    ImGui::TextUnformatted(fmt::format("{}", fmt::join(parts, "   ")).c_str());
    ImGui::SameLine(0, 2 * ImGui::GetFontSize());
    std::string said;
    if (errors > 0) said += counted(errors, "error") + "   ";
    if (warnings > 0) said += counted(warnings, "warning") + "   ";
    said += input.last_line;
    if (errors + warnings > 0) ImGui::PushStyleColor(ImGuiCol_Text, darkroom::panels::accent_color);
    const float room = std::max(ImGui::GetContentRegionAvail().x, 1.0F);
    ImGui::TextUnformatted(darkroom::panels::fitting(said, room, darkroom::panels::KeptPart::Start).c_str());
    if (errors + warnings > 0) ImGui::PopStyleColor();
    look_.note_place("status/said");
    if (ImGui::IsItemClicked()) is_messages_wanted_ = true;
    tip("The newest message. A click lists them all.");
}

void EditPanels::draw_below(const Input& input, PictureView& picture) {
    if (!ImGui::BeginTabBar("##tabs")) return;
    const auto tab = [&](const char* name, Tab which, const auto& draw) {
        const bool is_wanted = which == Tab::Messages && std::exchange(is_messages_wanted_, false);
        const bool is_open = ImGui::BeginTabItem(name, nullptr, is_wanted ? ImGuiTabItemFlags_SetSelected : 0);
        look_.note_place(fmt::format("tab/{}", name));
        if (!is_open) return;
        tab_ = which;
        ImGui::BeginChild(name);
        draw();
        ImGui::EndChild();
        ImGui::EndTabItem();
    };
    const darkroom::Plan* const plan = input.composer.current_plan();
    tab("Plan", Tab::Plan, [&] {
        if (plan != nullptr) darkroom::panels::draw_plan_picture(*plan);
    });
    tab("Times", Tab::Times, [&] { timings_.draw(times_); });
    tab("Scopes", Tab::Scopes, [&] {
        const bool has_legend = picture.pane().is_false_color;
        const float legend = has_legend ? 16 * ImGui::GetFontSize() : 0;
        ImGui::BeginChild("##scopes", {-legend, 0});
        scopes_.draw();
        ImGui::EndChild();
        if (!has_legend) return;
        ImGui::SameLine();
        ImGui::BeginChild("##legend");
        if (picture.pane().view.transfer == PaneTransfer::SceneLinear)
            darkroom::panels::draw_legend(darkroom::panels::stop_bands);
        else
            darkroom::panels::draw_legend(darkroom::panels::code_bands);
        ImGui::EndChild();
    });
    tab("Images", Tab::Images, [&] { draw_images(input); });
    tab("Pixel", Tab::Pixel, [&] { draw_pixel(input); });
    tab("Messages", Tab::Messages, [&] { look_.draw_history(); });
    if (ImGui::TabItemButton("x", ImGuiTabItemFlags_Trailing)) sizes_.has_below = false;
    look_.note_place("close/Below");
    tip("Closes this panel. View brings it back.");
    ImGui::EndTabBar();
}

void EditPanels::draw_images(const Input& input) {
    const darkroom::Plan* const plan = input.composer.current_plan();
    if (plan == nullptr) return;
    ImGui::BeginChild("##list", {20 * ImGui::GetFontSize(), 0});
    if (ImGui::Selectable("the finished picture", image_.empty())) image_.clear();
    for (const darkroom::PlanImage& image : plan->images) {
        // One texel that stands in for what is not there.
        if (image.name.starts_with("neutral") && image.extent.width == 1 && image.extent.height == 1) continue;
        for (std::uint32_t level = 0; level < image.mip_levels; ++level) {
            const std::string name = image.mip_levels > 1 ? fmt::format("{}, level {}", image.name, level) : image.name;
            const std::string row = fmt::format("{}  {}x{}", name, std::max(image.extent.width >> level, 1U),
                                                std::max(image.extent.height >> level, 1U));
            if (ImGui::Selectable(row.c_str(), image.name == image_ && level == level_)) {
                const bool is_motion = image.name.ends_with("velocity") || image.name.ends_with("motion");
                if (is_motion != (image_view_.transfer == PaneTransfer::Motion))
                    image_view_ = {.transfer = is_motion ? PaneTransfer::Motion : PaneTransfer::SceneLinear,
                                   .high = is_motion ? 8.0F : 1.0F};
                image_ = image.name;
                level_ = level;
            }
            look_.note_place(fmt::format("image/{}/{}", image.name, level));
        }
    }
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("##how");
    if (image_.empty()) {
        ImGui::TextWrapped("Choose an image: it is shown in place of the picture.");
    } else {
        using darkroom::WatchState;
        if (input.watch_state == WatchState::NotWritten)
            ImGui::TextWrapped("No pass writes it in this frame.");
        else if (input.watch_state == WatchState::NotInPlan)
            ImGui::TextWrapped("Coming with the next plan ...");
        darkroom::window::PaneView& view = image_view_;
        const auto choice = [&](const char* name, PaneTransfer transfer, float high) {
            if (ImGui::RadioButton(name, view.transfer == transfer) && view.transfer != transfer) {
                view.transfer = transfer;
                view.low = 0;
                view.high = high;
            }
            look_.note_place(fmt::format("image/{}", name));
        };
        choice("as light", PaneTransfer::SceneLinear, 1);
        ImGui::SameLine();
        choice("as numbers", PaneTransfer::Raw, 1);
        ImGui::SameLine();
        choice("as motion", PaneTransfer::Motion, 8);
        if (view.transfer == PaneTransfer::Raw)
            ImGui::DragFloatRange2("black, white", &view.low, &view.high, 0.01F, -1e6F, 1e6F, "%.3f", "%.3f");
        if (view.transfer == PaneTransfer::Motion)
            ImGui::DragFloat("pixels: full", &view.high, 0.1F, 0.01F, 1e4F, "%.2f");
        ImGui::TextWrapped("Exposure and channels are above the picture.");
    }
    ImGui::EndChild();
}

void EditPanels::draw_pixel(const Input& input) {
    if (!pixel_)
        return ImGui::TextWrapped("Click into the picture: what every effect makes of that pixel is shown here.");
    if (input.inspection == nullptr || input.inspection->pixels.empty())
        return ImGui::Text("%d, %d: wait for the plan ...", pixel_->x, pixel_->y);
    const darkroom::InspectedPixel& pixel = input.inspection->pixels.front();
    constexpr ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingFixedFit;
    if (!ImGui::BeginTable("##values", 7, flags)) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    const std::string place = fmt::format("{}, {}", pixel.at.x, pixel.at.y);
    for (const char* const name : {place.c_str(), "red", "green", "blue", "alpha", "change", ""})
        ImGui::TableSetupColumn(name);
    ImGui::TableHeadersRow();
    const auto row = [](const std::string& name, const darkroom::PixelValue& value) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(name.c_str());
        for (const float number : value) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(number_text(number).c_str());
        }
        ImGui::TableNextColumn();
    };
    row("the frame", pixel.scene);
    for (std::size_t i = 0; i < pixel.entries.size(); ++i) {
        const darkroom::InspectedEntry& entry = pixel.entries[i];
        const bool is_on = entry.presence == darkroom::EntryPresence::On;
        if (!is_on) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        row(entry.name, entry.after);
        if (is_on) ImGui::TextUnformatted(fmt::format("{:.4g}", entry.change).c_str());
        ImGui::TableNextColumn();
        if (!is_on) {
            ImGui::TextUnformatted(entry.why.empty() ? "off" : entry.why.c_str());
            ImGui::PopStyleColor();
        } else if (pixel.born == i) {
            ImGui::TextColored(darkroom::panels::accent_color, "not finite from here on");
        }
    }
    ImGui::EndTable();
    look_.note_place("pixel/values");
}

}  // namespace app
