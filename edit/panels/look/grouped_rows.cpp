// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <numbers>

#include "edit/edits.hpp"
#include "panels/look/entry_rows.hpp"
#include "panels/widgets/fitting_text.hpp"
#include "panels/widgets/icons.hpp"
#include "panels/widgets/slider.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

constexpr double degree = std::numbers::pi / 180;
/// Near those of a vectorscope (ITU-R BT.709), and 120 degrees apart.
constexpr std::array<double, 3> angles{105 * degree, 225 * degree, 345 * degree};

double mean_of(const std::array<double, 3>& rgb) { return (rgb[0] + rgb[1] + rgb[2]) / 3; }

std::array<double, 3> numbers_of(std::span<const std::uint32_t> words) {
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = double{std::bit_cast<float>(words[i])};
    return out;
}

void put(const ParamInfo& row, const std::array<double, 3>& rgb, std::span<std::uint32_t> words) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double number = std::clamp(std::round(rgb[i] * 1e4) / 1e4, row.range.min, row.range.max);
        words[i] = std::bit_cast<std::uint32_t>(static_cast<float>(number));
    }
}

void paint(ImVec2 middle, float radius, const std::array<double, 2>& place, bool is_held) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddCircleFilled(middle, radius, ImGui::GetColorU32(ImGuiCol_FrameBg), 64);
    constexpr int parts = 48;
    const float thickness = std::max(2.0F, std::round(radius / 14));
    for (int i = 0; i < parts; ++i) {
        const double angle = 2 * std::numbers::pi * (i + 0.5) / parts, half = std::numbers::pi / parts * 1.1;
        const std::array<double, 3> color = wheel_color({0.3 * std::cos(angle), 0.3 * std::sin(angle)}, 0.5);
        list.PathArcTo(middle, radius - thickness / 2, static_cast<float>(-angle - half),
                       static_cast<float>(-angle + half), 3);
        list.PathStroke(ImGui::ColorConvertFloat4ToU32({static_cast<float>(color[0]), static_cast<float>(color[1]),
                                                        static_cast<float>(color[2]), 1}),
                        ImDrawFlags_None, thickness);
    }
    const ImU32 line = ImGui::GetColorU32(ImGuiCol_Separator);
    list.AddLine({middle.x - radius + thickness, middle.y}, {middle.x + radius - thickness, middle.y}, line);
    list.AddLine({middle.x, middle.y - radius + thickness}, {middle.x, middle.y + radius - thickness}, line);
    const double length = std::hypot(place[0], place[1]), most = std::max(length, 1.0);
    const float reach = radius - 2 * thickness;
    const ImVec2 at{middle.x + reach * static_cast<float>(place[0] / most),
                    middle.y - reach * static_cast<float>(place[1] / most)};
    list.AddCircleFilled(at, radius * 0.09F, ImGui::GetColorU32(is_held ? accent_color : ImVec4{1, 1, 1, 1}));
    list.AddCircle(at, radius * 0.09F, IM_COL32(0, 0, 0, 255));
}

}  // namespace

std::array<double, 2> wheel_place(const std::array<double, 3>& rgb) {
    const double mean = mean_of(rgb);
    std::array<double, 2> out{};
    for (std::size_t i = 0; i < 3; ++i) {
        out[0] += 2.0 / 3 * (rgb[i] - mean) * std::cos(angles[i]);
        out[1] += 2.0 / 3 * (rgb[i] - mean) * std::sin(angles[i]);
    }
    return out;
}

std::array<double, 3> wheel_color(const std::array<double, 2>& place, double mean) {
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = mean + place[0] * std::cos(angles[i]) + place[1] * std::sin(angles[i]);
    return out;
}

double wheel_span(const ParamInfo& row, double usual) { return usual != 0 ? std::abs(usual) / 2 : row.range.max / 4; }

ValueEdit draw_wheel(const ParamInfo& row, std::span<std::uint32_t> words, std::span<const std::uint32_t> defaults,
                     float width) {
    const double usual = mean_of(numbers_of(defaults)), span = wheel_span(row, usual);
    const std::array<double, 3> rgb = numbers_of(words);
    const double mean = mean_of(rgb);
    std::array<double, 2> place = wheel_place(rgb);
    ValueEdit edit;
    ImGui::BeginGroup();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("##disc", {width, width});
    const float radius = width / 2;
    edit.is_begun = ImGui::IsItemActivated();
    const bool is_held = ImGui::IsItemActive();
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        edit.is_changed = place[0] != 0 || place[1] != 0;
        place = {};
    } else if (is_held && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1)) {
        const ImVec2 by = ImGui::GetIO().MouseDelta;
        const double scale = span / static_cast<double>(radius) * (ImGui::GetIO().KeyShift ? 0.1 : 1);
        place[0] += static_cast<double>(by.x) * scale;
        place[1] -= static_cast<double>(by.y) * scale;
        edit.is_changed = by.x != 0 || by.y != 0;
    }
    if (edit.is_changed) put(row, wheel_color(place, mean), words);
    paint({corner.x + radius, corner.y + radius}, radius, {place[0] / span, place[1] / span}, is_held);
    ImGui::SetNextItemWidth(width);
    double master = mean;
    const SliderEdit slid = draw_slider("##mean", row, usual, master);
    if (slid.is_changed) {
        edit.is_changed = true;
        put(row, wheel_color(place, master), words);
    }
    edit.is_begun |= slid.is_begun;
    ImGui::EndGroup();
    return edit;
}

namespace {

constexpr std::array<std::string_view, 3> channel_ends{"_red", "_green", "_blue"};
constexpr std::array<ImU32, 3> channel_colors{IM_COL32(230, 90, 90, 255), IM_COL32(96, 200, 110, 255),
                                              IM_COL32(100, 140, 250, 255)};
using Rows = std::span<const ParamInfo>;

/// What the names of three rows have in common before their channels; empty: they are no three channels.
std::string_view channels_at(Rows rows) {
    if (rows.size() < 3 || !rows[0].name.ends_with(channel_ends[0])) return {};
    const std::string_view base = rows[0].name.substr(0, rows[0].name.size() - channel_ends[0].size());
    for (std::size_t i = 0; i < 3; ++i)
        if (rows[i].kind != rows[0].kind || rows[i].name != fmt::format("{}{}", base, channel_ends[i])) return {};
    return base;
}
bool are_colors(Rows rows) {
    return rows.size() >= 3 && std::ranges::all_of(rows.first(3), [](auto& row) { return row.kind == Kind::Rgb; });
}

class Groups {
  public:
    Groups(PanelState& state, const LookEntry& entry, const std::string& name)
        : state_(state), entry_(entry), name_(name) {}

    void draw(const RowGroup& group) {
        ImGui::PushID(group.name.c_str());
        if (draw_head(group)) draw_rows(group);
        ImGui::PopID();
    }

  private:
    [[nodiscard]] RowLine line(const ParamInfo& row) const { return line_of(state_, entry_, name_, row); }

    /// The name, a mark where something in it is set, and a button that takes it back. False: it is folded.
    bool draw_head(const RowGroup& group) {
        const bool is_set = std::ranges::any_of(group.rows, [&](const ParamInfo* row) {
            const RowLine own = line(*row);
            return !std::ranges::equal(own.words, own.defaults);
        });
        const float side = ImGui::GetFrameHeight();
        const float width = ImGui::GetContentRegionAvail().x;
        const bool starts_open = group.kind != RowGroup::Kind::Channels;
        ImGui::SetNextItemOpen(starts_open, ImGuiCond_Once);
        const std::string label =
            fitting(shown_name(group.name), width - 3 * side, KeptPart::Start) + "###" + group.name;
        const bool is_open = ImGui::TreeNodeEx(
            label.c_str(), ImGuiTreeNodeFlags_Framed | ImGuiTreeNodeFlags_AllowItemOverlap |
                               ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_NoAutoOpenOnLog);
        state_.note(fmt::format("{}/{}", name_, group.name));
        if (!is_set) return is_open;
        ImGui::SameLine(ImGui::GetContentRegionMax().x - side);
        if (icon_button("##reset", Icon::Reset, "Sets this group to its defaults."))
            state_.edit(fmt::format("{} {} reset", name_, shown_name(group.name)),
                        [name = name_, rows = group.rows](Look& look) -> Result<> {
                            for (const ParamInfo* const row : rows)
                                DARKROOM_TRY(edit::reset_value(look, name, std::string(row->name)));
                            return {};
                        });
        state_.note(fmt::format("{}/{}.reset", name_, group.name));
        return is_open;
    }

    void draw_rows(const RowGroup& group) {
        if (group.kind == RowGroup::Kind::Curves) return draw_curves(group);
        std::span<const ParamInfo* const> rows = group.rows;
        if (group.kind == RowGroup::Kind::Wheels) {
            draw_wheels(rows.first(3));
            rows = rows.subspan(3);
        }
        std::vector<std::string> names;
        for (const ParamInfo* const row : rows) names.push_back(shown_name(row->name));
        const Columns columns = Columns::of(names);
        for (const ParamInfo* const row : rows) draw_parameter(state_, entry_, name_, *row, columns);
    }

    void draw_wheels(std::span<const ParamInfo* const> rows) {
        const float gap = ImGui::GetStyle().ItemSpacing.x;
        const float room = ImGui::GetContentRegionAvail().x;
        const float width = std::floor(std::clamp((room - 2 * gap) / 3, 1.0F, 12 * ImGui::GetFontSize()));
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (i > 0) ImGui::SameLine(0, gap);
            ImGui::BeginGroup();
            draw_one_wheel(line(*rows[i]), width);
            ImGui::EndGroup();
        }
    }

    void draw_one_wheel(const RowLine& own, float width) {
        ImGui::PushID(own.place.c_str());
        const std::string shown = shown_name(own.row->name);
        const bool is_set = !std::ranges::equal(own.words, own.defaults);
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        ImGui::InvisibleButton("##name", {width, ImGui::GetTextLineHeight()});
        const bool resets = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
        state_.note(own.place + ".name");
        explain(own);
        const float left = std::max(0.0F, (width - ImGui::CalcTextSize(shown.c_str()).x) / 2);
        ImGui::GetWindowDrawList()->AddText(
            {corner.x + left, corner.y}, is_set ? ImGui::GetColorU32(accent_color) : ImGui::GetColorU32(ImGuiCol_Text),
            shown.c_str());
        RowOutcome outcome{.words = {own.words.begin(), own.words.end()}};
        const ValueEdit edit = draw_wheel(*own.row, outcome.words, own.defaults, width);
        state_.note(own.place);
        explain(own);
        if (edit.is_begun) state_.document->end_merge();
        if (edit.is_changed) outcome.act = RowAct::Change;
        if (resets) outcome.act = RowAct::Reset;
        apply(state_, name_, own, outcome);
        ImGui::PopID();
    }

    /// One plot: that of all channels while they are alike, and each over the others.
    void draw_curves(const RowGroup& group) {
        ImGuiStorage& storage = *ImGui::GetStateStorage();
        const ImGuiID chosen_id = ImGui::GetID("channel");
        int chosen = storage.GetInt(chosen_id, 0);
        constexpr std::array names{"RGB", "Red", "Green", "Blue"};
        for (int i = 0; i < 4; ++i) {
            if (i > 0) ImGui::SameLine();
            if (ImGui::RadioButton(names[static_cast<std::size_t>(i)], chosen == i)) chosen = i;
            state_.note(fmt::format("{}/{}.{}", name_, group.name, names[static_cast<std::size_t>(i)]));
        }
        storage.SetInt(chosen_id, chosen);
        const std::array<RowLine, 3> lines{line(*group.rows[0]), line(*group.rows[1]), line(*group.rows[2])};
        if (chosen > 0) return draw_channel(lines, static_cast<std::size_t>(chosen) - 1);
        const bool is_alike =
            std::ranges::equal(lines[0].words, lines[1].words) && std::ranges::equal(lines[0].words, lines[2].words);
        std::vector<std::uint32_t> words(lines[1].words.begin(), lines[1].words.end());
        if (!is_alike) {
            ImGui::PushTextWrapPos(0);
            ImGui::TextDisabled("The channels differ: choose one above.");
            ImGui::PopTextWrapPos();
            if (ImGui::Button("Take green's for all")) set_all(group, words);
            return;
        }
        const ValueEdit edit = draw_curve(*group.rows[0], words, {.has_identity = true});
        state_.note(fmt::format("{}/{}", name_, group.name) + ".plot");
        explain(lines[0]);
        if (edit.is_begun) state_.document->end_merge();
        if (edit.is_changed) set_all(group, words);
    }

    void set_all(const RowGroup& group, const std::vector<std::uint32_t>& words) {
        state_.edit(
            fmt::format("{} {}", name_, shown_name(group.name)),
            [name = name_, rows = group.rows, words](Look& look) -> Result<> {
                for (const ParamInfo* const row : rows)
                    DARKROOM_TRY(edit::set_value(look, name, std::string(row->name), words));
                return {};
            },
            fmt::format("{}.{}", name_, group.name));
    }

    void draw_channel(const std::array<RowLine, 3>& lines, std::size_t channel) {
        const RowLine& own = lines[channel];
        std::vector<CurveShown::Other> behind;
        for (std::size_t i = 0; i < 3; ++i)
            if (i != channel)
                behind.push_back({lines[i].words, (channel_colors[i] & ~IM_COL32_A_MASK) | (90U << IM_COL32_A_SHIFT)});
        RowOutcome outcome{.words = {own.words.begin(), own.words.end()}};
        ImGui::PushID(own.place.c_str());
        const ValueEdit edit = draw_curve(*own.row, outcome.words,
                                          {.behind = behind, .color = channel_colors[channel], .has_identity = true});
        ImGui::PopID();
        state_.note(own.place);
        explain(own);
        if (edit.is_begun) state_.document->end_merge();
        if (edit.is_changed) outcome.act = RowAct::Change;
        apply(state_, name_, own, outcome);
    }

    PanelState& state_;
    const LookEntry& entry_;
    const std::string& name_;
};

}  // namespace

std::vector<RowGroup> groups_of(const EffectInfo& effect) {
    const Rows rows = effect.parameters.rows;
    RowGroup lines{.kind = RowGroup::Kind::Lines, .name = "basics"};
    std::vector<RowGroup> wheels, curves, channels;
    for (std::size_t i = 0; i < rows.size();) {
        const Rows rest = rows.subspan(i);
        RowGroup three;
        for (std::size_t k = 0; k < std::min<std::size_t>(3, rest.size()); ++k) three.rows.push_back(&rest[k]);
        if (const std::string_view base = channels_at(rest); !base.empty()) {
            three.name = base;
            three.kind = rest[0].kind == Kind::Curve ? RowGroup::Kind::Curves : RowGroup::Kind::Channels;
            (three.kind == RowGroup::Kind::Curves ? curves : channels).push_back(std::move(three));
            i += 3;
        } else if (are_colors(rest)) {
            three.name = fmt::format("{}, {}, {}", rest[0].name, rest[1].name, rest[2].name);
            three.kind = RowGroup::Kind::Wheels;
            wheels.push_back(std::move(three));
            i += 3;
        } else {
            const auto owns = [&](const RowGroup& group) {
                return std::ranges::any_of(group.rows, [&](const ParamInfo* color) {
                    return rest[0].name.starts_with(fmt::format("{}_", color->name));
                });
            };
            const auto owner = std::ranges::find_if(wheels, owns);
            (owner == wheels.end() ? lines : *owner).rows.push_back(&rest[0]);
            ++i;
        }
    }
    if (wheels.empty()) return {};
    std::vector<RowGroup> out;
    if (!lines.rows.empty()) out.push_back(std::move(lines));
    for (std::vector<RowGroup>* const more : {&wheels, &curves, &channels})
        std::ranges::move(*more, std::back_inserter(out));
    return out;
}

bool draw_grouped_rows(PanelState& state, const LookEntry& entry, const std::string& name) {
    const std::vector<RowGroup> groups = groups_of(*entry.effect);
    if (groups.empty()) return false;
    ImGui::Checkbox("Numbers", &state.shows_numbers);
    state.note(name + "/numbers");
    tooltip("Shows every value as a line of numbers, in place of wheels and curves.");
    if (state.shows_numbers) return false;
    Groups drawn(state, entry, name);
    for (const RowGroup& group : groups) drawn.draw(group);
    return true;
}

}  // namespace darkroom::panels
