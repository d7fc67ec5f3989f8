// SPDX-License-Identifier: MIT
#include "panels/show/light_histogram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "panels/widgets/plot.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

constexpr std::size_t head = 6;

/// The stops that are shown: those that occur, by fours, and eight about middle grey.
struct ShownStops {
    float least = -8, most = 8;
    /// From 0 at the left to 1.
    [[nodiscard]] float place(float stops) const { return (stops - least) / (most - least); }
};

float end_of(const LightHistogram& histogram, std::size_t bin) {
    return histogram.first + histogram.step * static_cast<float>(bin);
}

ShownStops range_of(const LightHistogram& histogram) {
    ShownStops out;
    for (std::size_t bin = 0; bin < histogram.shares.size(); ++bin) {
        if (histogram.shares[bin] <= 0) continue;
        out.least = std::min(out.least, 4 * std::floor(end_of(histogram, bin) / 4));
        out.most = std::max(out.most, 4 * std::ceil(end_of(histogram, bin + 1) / 4));
    }
    return out;
}

void draw_bins(const Plot& plot, const LightHistogram& histogram, const ShownStops& range) {
    const float most = std::max(*std::ranges::max_element(histogram.shares), 1e-6f);
    const auto fill = [&](float left, float right, float top, ImU32 color) {
        if (right > left) plot.fill(left, 0, right, top, color);
    };
    const float low = range.place(histogram.low), high = range.place(histogram.high);
    const ImU32 counted = ImGui::GetColorU32(ImGuiCol_Text, 0.85f), other = ImGui::GetColorU32(ImGuiCol_Text, 0.30f);
    for (std::size_t bin = 0; bin < histogram.shares.size(); ++bin) {
        // What is rare is raised, so that a lamp is seen.
        const float top = 0.95f * std::sqrt(histogram.shares[bin] / most);
        const float left = range.place(end_of(histogram, bin)), right = range.place(end_of(histogram, bin + 1));
        const float from = std::clamp(low, left, right), to = std::clamp(high, from, right);
        fill(left, from, top, other);
        fill(from, to, top, counted);
        fill(to, right, top, other);
    }
}

/// Stops under the plot, as many as there is room for.
void draw_scale(const Plot& plot, const ShownStops& range) {
    const float em = ImGui::GetFontSize(), a_stop = (plot.max.x - plot.min.x) / (range.most - range.least);
    const float apart = std::max(std::ceil(2 * em / a_stop / 4) * 4, 4.0f);
    for (float stops = std::ceil(range.least / apart) * apart; stops <= range.most; stops += apart) {
        const std::string text = stops == 0 ? "0" : fmt::format("{:+.0f}", stops);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        const float left = std::clamp(plot.at(range.place(stops), 0).x - size.x / 2, plot.min.x, plot.max.x - size.x);
        plot.list->AddText({left, plot.max.y}, ImGui::GetColorU32(ImGuiCol_TextDisabled), text.c_str());
    }
    ImGui::Dummy({1, em});
}

}  // namespace

std::optional<LightHistogram> light_histogram_of(std::span<const float> numbers) {
    if (numbers.size() <= head || !(numbers[1] > 0)) return {};
    return LightHistogram{.first = numbers[0],
                          .step = numbers[1],
                          .low = numbers[2],
                          .high = numbers[3],
                          .metered = numbers[4],
                          .added = numbers[5],
                          .shares = numbers.subspan(head)};
}

void draw_light_histogram(const LightHistogram& histogram) {
    const ShownStops range = range_of(histogram);
    const Plot plot = begin_plot("light", {ImGui::GetContentRegionAvail().x, 6 * ImGui::GetFontSize()});
    plot.fill(range.place(histogram.low), 0, range.place(histogram.high), 1,
              faded(ImGui::ColorConvertFloat4ToU32(accent_color), 0.22f));
    plot.vertical(range.place(0), ImGui::GetColorU32(ImGuiCol_Text, 0.35f));
    draw_bins(plot, histogram, range);
    const ImVec2 foot = plot.at(range.place(histogram.metered), 0);
    plot.list->AddLine(foot, {foot.x, plot.min.y}, ImGui::ColorConvertFloat4ToU32(accent_color),
                       ImGui::GetFontSize() / 8);
    end_plot(plot);
    if (plot.is_hovered) {
        const float stops = range.least + plot.mouse.x * (range.most - range.least);
        const auto bin = static_cast<std::size_t>(std::clamp((stops - histogram.first) / histogram.step, 0.0f,
                                                             static_cast<float>(histogram.shares.size() - 1)));
        ImGui::SetTooltip("%+.2f stops from middle grey: %.2f %%", static_cast<double>(stops),
                          100 * static_cast<double>(histogram.shares[bin]));
    }
    draw_scale(plot, range);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(
        fmt::format("Metered {:+.2f} stops ({:+.1f} to {:+.1f})", histogram.metered, histogram.low, histogram.high)
            .c_str());
    ImGui::TextUnformatted(
        fmt::format("Exposed by {:+.2f} stops, times {:.3g}", histogram.added, std::exp2(histogram.added)).c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
}

}  // namespace darkroom::panels
