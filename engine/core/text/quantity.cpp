// SPDX-License-Identifier: MIT
#include "core/text/quantity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

/// `factor` of one `suffix` in `unit`; 0: a power of 2.
struct Suffix {
    std::string_view unit, name;
    double factor = 1;
};
constexpr double degrees_of_radian = 180 / std::numbers::pi;
constexpr std::array<Suffix, 19> suffixes{{{"x", "x"},
                                           {"x", "ev", 0},
                                           {"x", "stop", 0},
                                           {"x", "stops", 0},
                                           {"K", "K"},
                                           {"px", "px"},
                                           {"deg", "deg"},
                                           {"deg", "\xC2\xB0"},
                                           {"deg", "rad", degrees_of_radian},
                                           {"s", "s"},
                                           {"s", "ms", 1e-3},
                                           {"s", "min", 60},
                                           {"m", "m"},
                                           {"m", "cm", 1e-2},
                                           {"m", "mm", 1e-3},
                                           {"m", "km", 1e3},
                                           {"1/m", "/m"},
                                           {"cd/m2", "nits"},
                                           {"cd/m2", "cd/m2"}}};

std::string_view without_spaces(std::string_view text) {
    while (text.ends_with(' ')) text.remove_suffix(1);
    return text;
}

}  // namespace

std::optional<double> parse_quantity(std::string_view text, std::string_view unit) {
    if (const std::optional<double> number = parse_number(text)) return number;
    const std::string low = lower(text);
    for (const Suffix& suffix : suffixes) {
        if (suffix.unit != unit || !low.ends_with(lower(suffix.name))) continue;
        const std::optional<double> number =
            parse_number(without_spaces(text.substr(0, text.size() - suffix.name.size())));
        if (!number) continue;
        const double value = suffix.factor == 0 ? std::exp2(*number) : *number * suffix.factor;
        return std::isfinite(value) ? std::optional(value) : std::nullopt;
    }
    return std::nullopt;
}

std::string other_suffixes(std::string_view unit) {
    std::vector<std::string_view> names;
    for (const Suffix& suffix : suffixes)
        if (suffix.unit == unit && suffix.name != unit) names.push_back(suffix.name);
    if (names.size() < 2) return fmt::format("{}", fmt::join(names, ""));
    const std::string_view last = names.back();
    names.pop_back();
    return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

}  // namespace darkroom
