// SPDX-License-Identifier: MIT
#include <darkroom/ui_constants.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effect.hpp>

#include "core/try.hpp"

namespace darkroom {

namespace {

Result<> set_by_alias(Composer& composer, std::string_view alias, std::span<const double> values) {
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle entry = composer.entry(i);
        const ParamTable& table = composer.info(entry)->parameters;
        for (const ParamInfo& row : table.rows) {
            if (row.also != alias) continue;
            std::array<std::uint32_t, 2> words{};
            for (std::size_t k = 0; k < values.size(); ++k)
                words[k] = std::isfinite(values[k]) ? std::bit_cast<std::uint32_t>(static_cast<float>(
                                                          std::clamp(values[k], row.range.min, row.range.max)))
                                                    : table.defaults[row.word + k];
            return composer.set(entry, row.name, std::span(words).first(values.size()));
        }
    }
    return user_error(fmt::format("ui constants: no entry of the stack has the parameter '{}'", alias));
}

}  // namespace

Result<> set_ui_constants(Composer& composer, const DarkroomUiConstants& given, std::uint32_t height) {
    const auto number = [](float value) { return double{value}; };
    const std::array offset{number(given.ui_offset_x), number(given.ui_offset_y)};
    const struct {
        std::string_view alias;
        double value;
    } numbers[] = {{"r_ui_warp", number(given.warp_strength)},
                   {"r_ui_chromatic", number(given.chromatic_strength) * height / 1080},
                   {"r_ui_echo", number(given.echo_strength)},
                   {"r_ui_echo_scale", 1 / number(given.echo_scale)},
                   {"r_ui_additive", number(given.ui_additive)},
                   {"scr_sbaralpha", number(given.ui_opacity)},
                   {"contrast", number(given.contrast)},
                   {"gamma", number(given.gamma)}};
    for (const auto& [alias, value] : numbers) DARKROOM_TRY(set_by_alias(composer, alias, {&value, 1}));
    return set_by_alias(composer, "r_ui_offset", offset);
}

}  // namespace darkroom
