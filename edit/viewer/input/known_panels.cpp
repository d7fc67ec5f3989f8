// SPDX-License-Identifier: MIT
#include "known_panels.hpp"

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
