// SPDX-License-Identifier: MIT
#include "panel_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>

#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "toml/toml_text.hpp"

namespace app {

namespace {

constexpr float row_height = 38, status_height = 26, splitter_width = 5;
/// Of panels: below it their widgets have no room.
constexpr float least_side = 270, least_below = 120, least_picture = 120;
constexpr float least_column = 0.15F;
/// Narrower windows have stack and parameters in one column.
constexpr float least_window = 3 * 296;

VkRect2D rect(std::int64_t x, std::int64_t y, std::int64_t width, std::int64_t height) {
    return {{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
            {static_cast<std::uint32_t>(std::max<std::int64_t>(width, 1)),
             static_cast<std::uint32_t>(std::max<std::int64_t>(height, 1))}};
}

/// What a window has room for, in its pixels.
struct Room {
    explicit Room(VkExtent2D window, float scale)
        : scale_(scale), width(window.width), height(window.height), row(std::min(pixels(row_height), height)) {}
    [[nodiscard]] std::int64_t pixels(float at_one) const { return std::llround(at_one * scale_); }
    [[nodiscard]] bool is_narrow() const { return static_cast<float>(width) < least_window * scale_; }
    /// As wide as wanted, as long as the picture keeps its room.
    [[nodiscard]] std::int64_t side(float wanted, std::int64_t columns) const {
        const std::int64_t most = (width - pixels(least_picture)) / std::max<std::int64_t>(columns, 1);
        return std::clamp<std::int64_t>(pixels(wanted), 1, std::max<std::int64_t>(most, 1));
    }

  private:
    float scale_;

  public:
    std::int64_t width, height, row;
};

}  // namespace

PanelAreas lay_out(const PanelSizes& sizes, const PanelRoom& given) {
    const Room room(given.window, given.scale);
    const std::int64_t gap = room.pixels(splitter_width), row = room.row;
    const std::int64_t status = sizes.has_status ? std::min(room.pixels(status_height), room.height - row) : 0;
    const std::int64_t inner = room.height - row - status;
    const bool is_column = room.is_narrow() && sizes.has_stack && sizes.has_entry;
    const std::int64_t columns = is_column ? 1 : (sizes.has_stack ? 1 : 0) + (sizes.has_entry ? 1 : 0);
    const bool has_left = sizes.has_stack, has_right = sizes.has_entry && !is_column;
    const std::int64_t left = has_left ? room.side(sizes.stack, columns) : 0;
    const std::int64_t right = has_right ? room.side(sizes.entry, columns) : 0;
    const std::int64_t x = has_left ? left + gap : 0, end = room.width - (has_right ? right + gap : 0);
    const std::int64_t middle = end - x;
    const std::int64_t timeline = given.has_timeline ? row : 0;
    const std::int64_t view = std::min<std::int64_t>(row * std::max(given.view_rows, 1U), inner);
    const std::int64_t free = std::max<std::int64_t>(inner - view - timeline, 0);
    const std::int64_t usual = std::max(room.height * 3 / 10, room.pixels(200));
    // By itself it takes half of the height at most, since a picture is what one came for.
    const std::int64_t wanted = sizes.below > 0 ? room.pixels(sizes.below) : std::min(usual, free / 2);
    const std::int64_t below =
        sizes.has_below ? std::clamp<std::int64_t>(wanted, 1, std::max<std::int64_t>(free - gap, 1)) : 0;
    const std::int64_t picture = free - below - (sizes.has_below ? gap : 0);

    PanelAreas out{
        .bar = rect(0, 0, room.width, row),
        .view_bar = rect(x, row, middle, view),
        .picture = given.is_over ? rect(0, 0, room.width, room.height) : rect(x, row + view, middle, picture)};
    if (given.has_timeline) out.timeline = rect(x, row + view + picture, middle, timeline);
    if (sizes.has_status) out.status = rect(0, room.height - status, room.width, status);
    const auto line = [&](Splitter which) -> VkRect2D& { return out.splitters[static_cast<std::size_t>(which)]; };
    if (sizes.has_below) {
        out.below = rect(x, row + inner - below, middle, below);
        line(Splitter::Below) = rect(x, row + inner - below - gap, middle, gap);
    }
    const float part = std::clamp(sizes.column, least_column, 1 - least_column);
    const std::int64_t upper = is_column ? std::llround(part * static_cast<float>(inner)) : inner;
    if (has_left) {
        out.stack = rect(0, row, left, upper);
        line(Splitter::Stack) = rect(left, row, gap, inner);
    }
    if (is_column) {
        out.entry = rect(0, row + upper + gap, left, inner - upper - gap);
        line(Splitter::Column) = rect(0, row + upper, left, gap);
    } else if (has_right) {
        out.entry = rect(room.width - right, row, right, inner);
        line(Splitter::Entry) = rect(room.width - right - gap, row, gap, inner);
    }
    return out;
}

PanelSizes moved(const PanelSizes& sizes, Splitter splitter, float x, float y, const PanelRoom& room) {
    PanelSizes out = sizes;
    const float scale = room.scale, at_x = x / scale, at_y = y / scale;
    const float width = static_cast<float>(room.window.width) / scale;
    const float height = static_cast<float>(room.window.height) / scale;
    const auto within = [](float value, float least, float most) {
        return std::round(std::clamp(value, least, std::max(least, most)));
    };
    const float status = sizes.has_status ? status_height : 0;
    const bool has_two = sizes.has_stack && sizes.has_entry && !Room(room.window, scale).is_narrow();
    switch (splitter) {
        case Splitter::Stack:
            out.stack = within(at_x, least_side, width - least_picture - (has_two ? sizes.entry : 0));
            break;
        case Splitter::Entry:
            out.entry = within(width - at_x, least_side, width - least_picture - (has_two ? sizes.stack : 0));
            break;
        case Splitter::Below:
            out.below = within(height - status - at_y, least_below, height - status - 2 * row_height - least_picture);
            break;
        case Splitter::Column:
            out.column =
                std::clamp((at_y - row_height) / (height - row_height - status), least_column, 1 - least_column);
            break;
    }
    return out;
}

PanelSizes put_back(const PanelSizes& sizes, Splitter splitter) {
    constexpr PanelSizes usual;
    PanelSizes out = sizes;
    switch (splitter) {
        case Splitter::Stack:
            out.stack = usual.stack;
            break;
        case Splitter::Entry:
            out.entry = usual.entry;
            break;
        case Splitter::Below:
            out.below = usual.below;
            break;
        case Splitter::Column:
            out.column = usual.column;
            break;
    }
    return out;
}

using darkroom::Result;

namespace {

struct Size {
    const char* key;
    float PanelSizes::*member;
    float most;
};
constexpr float widest = 16384;
constexpr Size sizes[]{{"stack", &PanelSizes::stack, widest},
                       {"parameters", &PanelSizes::entry, widest},
                       {"lower", &PanelSizes::below, widest},
                       {"column", &PanelSizes::column, 1}};
struct Presence {
    const char* key;
    bool PanelSizes::*member;
};
constexpr Presence presences[]{{"has_stack", &PanelSizes::has_stack},
                               {"has_parameters", &PanelSizes::has_entry},
                               {"has_lower", &PanelSizes::has_below},
                               {"has_status", &PanelSizes::has_status}};

/// "1280x720"; nothing: it is none.
std::optional<VkExtent2D> window_of(std::string_view name) {
    VkExtent2D out;
    const char* const end = name.data() + name.size();
    const auto [at, error] = std::from_chars(name.data(), end, out.width);
    if (error != std::errc() || at == end || *at != 'x') return std::nullopt;
    const auto [last, second_error] = std::from_chars(at + 1, end, out.height);
    return second_error == std::errc() && last == end ? std::optional(out) : std::nullopt;
}

std::int64_t distance(std::pair<std::uint32_t, std::uint32_t> known, VkExtent2D window) {
    return std::abs(std::int64_t{known.first} - window.width) + std::abs(std::int64_t{known.second} - window.height);
}

/// What is missing or no size of a panel stays as it usually is.
PanelSizes sizes_of(const toml::table& given) {
    PanelSizes out;
    for (const Size& size : sizes) {
        const double value = given[size.key].value_or(-1.0);
        if (std::isfinite(value) && value >= 0 && value <= static_cast<double>(size.most))
            out.*size.member = static_cast<float>(value);
    }
    for (const Presence& presence : presences)
        out.*presence.member = given[presence.key].value_or(out.*presence.member);
    return out;
}

}  // namespace

Result<KnownPanels> KnownPanels::read(const std::filesystem::path& file) {
    KnownPanels out;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return out;
    const std::string shown = darkroom::printable(file.string());
    DARKROOM_TRY_VALUE(const std::vector<std::byte> bytes,
                       darkroom::read_file(file, {.max_size = darkroom::max_toml_bytes}));
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    DARKROOM_TRY_VALUE(const toml::table tables, darkroom::parse_toml(text, shown));
    for (const auto& [name, node] : tables)
        if (const std::optional<VkExtent2D> window = window_of(name.str()); window && node.is_table())
            out.set(*window, sizes_of(*node.as_table()));
    return out;
}

Result<> KnownPanels::write(const std::filesystem::path& file) const {
    std::string text =
        "# How the panels of `darkroom edit` lie in windows of each size; pixels of a display of scale 1.\n";
    const auto out = std::back_inserter(text);
    for (const auto& [window, known] : known_) {
        fmt::format_to(out, "\n[\"{}x{}\"]\n", window.first, window.second);
        for (const Size& size : sizes) fmt::format_to(out, "{} = {:.3f}\n", size.key, known.*size.member);
        for (const Presence& presence : presences)
            fmt::format_to(out, "{} = {}\n", presence.key, known.*presence.member);
    }
    return darkroom::write_file(file, std::as_bytes(std::span(text)));
}

PanelSizes KnownPanels::of(VkExtent2D window) const {
    const auto nearest =
        std::ranges::min_element(known_, {}, [window](const auto& known) { return distance(known.first, window); });
    return nearest == known_.end() ? PanelSizes{} : nearest->second;
}

void KnownPanels::set(VkExtent2D window, const PanelSizes& wanted) { known_[{window.width, window.height}] = wanted; }

}  // namespace app
