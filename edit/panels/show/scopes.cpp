// SPDX-License-Identifier: MIT
#include "panels/show/scopes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/srgb.hpp"
#include "panels/widgets/plot.hpp"
#include "panels/widgets/theme.hpp"

namespace darkroom::panels {

namespace {

float luma(const std::array<float, 3>& rgb) { return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]; }

/// Encoded; nothing where a number is broken.
std::optional<std::array<float, 3>> color_at(const ScopePicture& picture, std::size_t pixel) {
    std::array<float, 3> color{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t place = pixel * 4 + i;
        color[i] = picture.bytes.empty() ? picture.floats[place] : static_cast<float>(picture.bytes[place]) / 255;
        if (!std::isfinite(color[i])) return std::nullopt;
        if (picture.is_linear)
            color[i] = static_cast<float>(srgb_encode(double{color[i]}));  // in float, white were not 1
    }
    return color;
}

/// The step of `count` that the value is nearest to, of which the first is 0 and the last 1.
std::size_t nearest(float value, std::size_t count) {
    return static_cast<std::size_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * static_cast<float>(count - 1)));
}

void count(Vectorscope& scope, const std::array<float, 3>& rgb) {
    const auto [cb, cr] = color_difference(rgb);
    std::uint32_t& cell =
        scope.counts[nearest(0.5f - cr, Vectorscope::size) * Vectorscope::size + nearest(cb + 0.5f, Vectorscope::size)];
    scope.most = std::max(scope.most, ++cell);
}

}  // namespace

std::array<float, 2> color_difference(const std::array<float, 3>& rgb) {
    const float y = luma(rgb);
    return {(rgb[2] - y) / 1.8556f, (rgb[0] - y) / 1.5748f};
}

ScopeData measure(const ScopePicture& picture) {
    ScopeData data;
    for (std::vector<std::uint32_t>& counts : data.waveform.counts) counts.resize(Waveform::columns * Waveform::levels);
    data.vectorscope.counts.resize(Vectorscope::size * Vectorscope::size);
    const std::size_t held = std::max(picture.bytes.size(), picture.floats.size()) / 4;
    const std::size_t pixels = std::min(std::size_t{picture.width} * picture.height, held);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const std::optional<std::array<float, 3>> rgb = color_at(picture, pixel);
        ++(rgb ? data.pixels : data.broken);
        if (!rgb) continue;
        const std::size_t column = pixel % picture.width * Waveform::columns / picture.width;
        const std::array<float, scope_channels> values{(*rgb)[0], (*rgb)[1], (*rgb)[2], luma(*rgb)};
        for (std::size_t i = 0; i < scope_channels; ++i) {
            ++data.histogram.counts[i][nearest(values[i], Histogram::bins)];
            data.histogram.black[i] += values[i] <= 0 ? 1U : 0U;
            data.histogram.white[i] += values[i] >= 1 ? 1U : 0U;
            std::uint32_t& cell =
                data.waveform.counts[i][nearest(values[i], Waveform::levels) * Waveform::columns + column];
            data.waveform.most = std::max(data.waveform.most, ++cell);
        }
        count(data.vectorscope, *rgb);
    }
    return data;
}

namespace {

/// As much of each channel as it says, in 0 to 1, added up like light, in colours that are legible on dark grey.
ImU32 light_of(float red, float green, float blue) {
    const auto code = [&](float of_red, float of_green, float of_blue) {
        const float sum = red * of_red + green * of_green + blue * of_blue;
        return static_cast<int>(std::lround(std::clamp(sum, 0.0f, 0.92f) * 255));
    };
    return IM_COL32(code(0.78f, 0.12f, 0.18f), code(0.18f, 0.62f, 0.30f), code(0.10f, 0.12f, 0.88f), 255);
}

double share(std::uint32_t count, std::uint32_t pixels) {
    return pixels == 0 ? 0 : 100.0 * static_cast<double>(count) / static_cast<double>(pixels);
}

/// What reaches the top: the highest count that is not clipped, or, where a few codes stick out, five times the mean of
/// those that occur, so that they do not flatten the others.
float highest(const Histogram& histogram) {
    std::uint32_t most = 1;
    double sum = 0, occurring = 1;
    for (const auto& counts : histogram.counts)
        for (std::size_t bin = 1; bin + 1 < counts.size(); ++bin) {
            most = std::max(most, counts[bin]);
            sum += counts[bin];
            occurring += counts[bin] > 0 ? 1 : 0;
        }
    return static_cast<float>(std::clamp(5 * sum / occurring, 1.0, static_cast<double>(most)));
}

void draw_bin(const Plot& plot, const Histogram& histogram, std::size_t bin, const auto& height) {
    const float left = static_cast<float>(bin) / Histogram::bins, right = static_cast<float>(bin + 1) / Histogram::bins;
    const std::array<float, 3> heights{height(histogram.counts[ScopeRed][bin]),
                                       height(histogram.counts[ScopeGreen][bin]),
                                       height(histogram.counts[ScopeBlue][bin])};
    std::array<float, 3> steps = heights;
    std::ranges::sort(steps);
    float bottom = 0;
    for (const float step : steps) {
        const auto part = [&](std::size_t i) { return heights[i] >= step ? 0.62f : 0.0f; };
        if (step > bottom) plot.fill(left, bottom, right, step, light_of(part(0), part(1), part(2)));
        bottom = step;
    }
}

void histogram_tooltip(const Histogram& histogram, float place) {
    const std::size_t bin =
        std::min(static_cast<std::size_t>(std::max(place, 0.0f) * Histogram::bins), Histogram::bins - 1);
    ImGui::SetTooltip("code %d, %.3f\nred %u, green %u, blue %u, luma %u", static_cast<int>(bin),
                      static_cast<double>(bin) / (Histogram::bins - 1), histogram.counts[ScopeRed][bin],
                      histogram.counts[ScopeGreen][bin], histogram.counts[ScopeBlue][bin],
                      histogram.counts[ScopeLuma][bin]);
}

/// Steps of brightness of a cell; few, so that neighbours in a column join.
constexpr int shades = 8;

/// What is rare is raised, so that a single pixel is seen.
int shade(std::uint32_t count, std::uint32_t most) {
    if (count == 0) return 0;
    const float part = std::sqrt(std::sqrt(static_cast<float>(count) / static_cast<float>(most)));
    return std::clamp(static_cast<int>(std::ceil(part * shades)), 2, shades);
}

/// More in one list are too much for indices of 16 bits, which hosts may have.
constexpr std::size_t max_runs = 12'000;

using Shades = std::array<int, 3>;

/// Calls `use(shades, first, end)` for each run of equal cells in a column, cells of `step` levels; black is left out.
void for_each_run(const auto& shade_of, std::size_t step, const auto& use) {
    Shades run{};
    std::size_t first = 0;
    for (std::size_t level = 0; level < Waveform::levels + step; level += step) {
        Shades shown{};
        for (std::size_t part = level; part < std::min(level + step, Waveform::levels); ++part)
            for (std::size_t channel = 0; channel < 3; ++channel)
                shown[channel] = std::max(shown[channel], shade_of(part, channel));
        if (shown == run) continue;
        if (run != Shades{}) use(run, first, std::min(level, Waveform::levels));
        run = shown;
        first = level;
    }
}

/// Of one part of a waveform, in a column.
auto shades_of(const Waveform& waveform, WaveformKind kind, std::size_t part, std::size_t column) {
    return [&waveform, kind, part, column](std::size_t level, std::size_t channel) {
        if (kind == WaveformKind::Parade && channel != part) return 0;
        const std::size_t source = kind == WaveformKind::Luma ? std::size_t{ScopeLuma} : channel;
        return shade(waveform.counts[source][level * Waveform::columns + column], waveform.most);
    };
}

/// Levels to a cell: as few as max_runs allows. Noise has more runs than a picture.
std::size_t cell_height(const Waveform& waveform, WaveformKind kind, std::size_t parts) {
    for (std::size_t step = 1;; step *= 2) {
        std::size_t runs = 0;
        for (std::size_t part = 0; part < parts; ++part)
            for (std::size_t column = 0; column < Waveform::columns; ++column)
                for_each_run(shades_of(waveform, kind, part, column), step,
                             [&](const Shades&, std::size_t, std::size_t) { ++runs; });
        if (runs <= max_runs) return step;
    }
}

}  // namespace

void draw_histogram(const ScopeData& data, bool is_logarithmic, ImVec2 size) {
    const Histogram& histogram = data.histogram;
    const float most = highest(histogram);
    const auto height = [&](std::uint32_t count) {
        const auto value = static_cast<float>(count);
        return std::min(is_logarithmic ? std::log1p(value) / std::log1p(most) : value / most, 1.0f) * 0.97f;
    };
    const Plot plot = begin_plot("histogram", size);
    for (const float x : {0.25f, 0.5f, 0.75f}) plot.vertical(x, grid_color());
    for (std::size_t bin = 0; bin < Histogram::bins; ++bin) draw_bin(plot, histogram, bin, height);
    std::array<ImVec2, Histogram::bins> luma;
    for (std::size_t bin = 0; bin < Histogram::bins; ++bin)
        luma[bin] =
            plot.at((static_cast<float>(bin) + 0.5f) / Histogram::bins, height(histogram.counts[ScopeLuma][bin]));
    plot.list->AddPolyline(luma.data(), static_cast<int>(luma.size()), ImGui::GetColorU32(ImGuiCol_Text), 0, 1);
    if (plot.is_hovered) plot.vertical(plot.mouse.x, ImGui::GetColorU32(ImGuiCol_Text, 0.5f));
    end_plot(plot);
    if (plot.is_hovered) histogram_tooltip(histogram, plot.mouse.x);
}

void draw_waveform(const Waveform& waveform, WaveformKind kind, ImVec2 size) {
    const Plot plot = begin_plot("waveform", size);
    for (const float level : {0.25f, 0.5f, 0.75f}) plot.horizontal(level, grid_color());
    const std::size_t parts = kind == WaveformKind::Parade ? 3 : 1;
    const std::size_t columns = waveform.counts[0].empty() ? 0 : Waveform::columns;
    const std::size_t step = columns > 0 ? cell_height(waveform, kind, parts) : 1;
    const auto level_height = 1.0f / static_cast<float>(Waveform::levels);
    for (std::size_t part = 0; part < parts; ++part)
        for (std::size_t column = 0; column < columns; ++column) {
            const auto left = static_cast<float>(part * columns + column), all = static_cast<float>(parts * columns);
            for_each_run(shades_of(waveform, kind, part, column), step,
                         [&](const Shades& shown, std::size_t first, std::size_t end) {
                             const auto light = [&](std::size_t i) { return static_cast<float>(shown[i]) / shades; };
                             plot.fill(left / all, static_cast<float>(first) * level_height, (left + 1) / all,
                                       static_cast<float>(end) * level_height, light_of(light(0), light(1), light(2)));
                         });
        }
    for (std::size_t part = 1; part < parts; ++part)
        plot.vertical(static_cast<float>(part) / static_cast<float>(parts), ImGui::GetColorU32(ImGuiCol_Border));
    if (plot.is_hovered) plot.horizontal(plot.mouse.y, ImGui::GetColorU32(ImGuiCol_Text, 0.5f));
    end_plot(plot);
    if (plot.is_hovered) ImGui::SetTooltip("level %.2f", static_cast<double>(plot.mouse.y));
}

void draw_vectorscope(const Vectorscope& scope, float size) {
    const Plot plot = begin_plot("vectorscope", {size, size});
    const float radius = (plot.max.x - plot.min.x) / 2;
    const ImVec2 middle = plot.at(0.5f, 0.5f);
    plot.list->AddCircle(middle, radius * 0.98f, grid_color());
    plot.horizontal(0.5f, grid_color());
    plot.vertical(0.5f, grid_color());
    // Skin tones lie about the I axis of NTSC, 123 degrees from +Cb.
    constexpr float skin = 123 * 3.14159265f / 180;
    plot.list->AddLine(middle, plot.at(0.5f + 0.49f * std::cos(skin), 0.5f + 0.49f * std::sin(skin)),
                       ImGui::GetColorU32(ImGuiCol_Text, 0.35f));
    constexpr float cell = 1.0f / static_cast<float>(Vectorscope::size);
    for (std::size_t place = 0; place < scope.counts.size(); ++place) {
        const int shown = shade(scope.counts[place], scope.most);
        if (shown == 0) continue;
        const float left = static_cast<float>(place % Vectorscope::size) * cell;
        const float top = 1 - static_cast<float>(place / Vectorscope::size) * cell;
        plot.fill(left, top - cell, left + cell, top,
                  ImGui::GetColorU32(ImGuiCol_Text, static_cast<float>(shown) / shades));
    }
    for (int corner = 1; corner < 7; ++corner) {
        const std::array<float, 3> rgb{(corner & 1) != 0 ? 0.75f : 0, (corner & 2) != 0 ? 0.75f : 0,
                                       (corner & 4) != 0 ? 0.75f : 0};
        const auto [cb, cr] = color_difference(rgb);
        const ImVec2 target = plot.at(0.5f + cb, 0.5f + cr);
        const float half = radius * 0.035f;
        plot.list->AddRect({target.x - half, target.y - half}, {target.x + half, target.y + half},
                           light_of(rgb[0], rgb[1], rgb[2]));
    }
    end_plot(plot);
    if (plot.is_hovered)
        ImGui::SetTooltip("Cb %.2f, Cr %.2f", static_cast<double>(plot.mouse.x - 0.5f),
                          static_cast<double>(plot.mouse.y - 0.5f));
}

void draw_legend(std::span<const FalseColorBand> bands) {
    const float side = ImGui::GetTextLineHeight();
    for (auto band = bands.rbegin(); band != bands.rend(); ++band) {
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const auto& [r, g, b] = band->color;
        const ImVec2 end{corner.x + side * 1.6f, corner.y + side};
        ImDrawList& list = *ImGui::GetWindowDrawList();
        if (band->is_grey)
            list.AddRect(corner, end, ImGui::GetColorU32(ImGuiCol_Border));
        else
            list.AddRectFilled(corner, end, ImGui::ColorConvertFloat4ToU32({r, g, b, 1}));
        ImGui::Dummy({side * 1.6f, side});
        ImGui::SameLine();
        ImGui::TextUnformatted(band->name.data(), band->name.data() + band->name.size());
    }
}

namespace {

void clipped_text(const ScopeData& data) {
    const auto most = [&](const std::array<std::uint32_t, scope_channels>& counts) {
        return share(*std::max_element(counts.begin(), counts.begin() + 3), data.pixels);
    };
    const double black = most(data.histogram.black), white = most(data.histogram.white);
    ImGui::TextDisabled("black %.1f %%", black);
    ImGui::SameLine();
    ImGui::TextColored(white > 0 ? accent_color : ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled), "white %.1f %%",
                       white);
    if (data.broken == 0) return;
    ImGui::SameLine();
    ImGui::TextColored(accent_color, "%u NaN or infinite", data.broken);
}

}  // namespace

// Each in a child, whose list of triangles is its own.
void ScopesPanel::draw_together(ImVec2 room) const {
    const float gap = ImGui::GetStyle().ItemSpacing.x, side = std::min(room.y, (room.x - 2 * gap) / 3);
    const ImVec2 size{std::max((room.x - side - 2 * gap) / 2, 1.0f), room.y};
    const auto part = [&](const char* name, ImVec2 of, const auto& draw) {
        ImGui::BeginChild(name, of, false, ImGuiWindowFlags_NoScrollbar);
        draw();
        ImGui::EndChild();
    };
    part("##waveform", size,
         [&] { draw_waveform(data_.waveform, is_luma_ ? WaveformKind::Luma : WaveformKind::Rgb, size); });
    ImGui::SameLine(0, gap);
    part("##histogram", size, [&] { draw_histogram(data_, is_logarithmic_, size); });
    ImGui::SameLine(0, gap);
    part("##vectorscope", {side, room.y}, [&] { draw_vectorscope(data_.vectorscope, side); });
}

void ScopesPanel::draw() {
    if (!ImGui::BeginTabBar("scopes")) return;
    const auto rest = [](float lines) {
        const ImVec2 all = ImGui::GetContentRegionAvail();
        return ImVec2{all.x, std::max(all.y - lines * ImGui::GetFrameHeightWithSpacing(), ImGui::GetFontSize() * 6)};
    };
    if (ImGui::BeginTabItem("Together")) {
        draw_together(rest(0));
        ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Histogram")) {
        draw_histogram(data_, is_logarithmic_, rest(1));
        ImGui::Checkbox("Log", &is_logarithmic_);
        ImGui::SameLine();
        clipped_text(data_);
        ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Waveform")) {
        draw_waveform(data_.waveform, is_luma_ ? WaveformKind::Luma : WaveformKind::Rgb, rest(1));
        ImGui::Checkbox("Luma", &is_luma_);
        ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Parade")) {
        draw_waveform(data_.waveform, WaveformKind::Parade, rest(0));
        ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Vectorscope")) {
        const ImVec2 all = rest(0);
        draw_vectorscope(data_.vectorscope, std::min(all.x, all.y));
        ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
}

}  // namespace darkroom::panels
