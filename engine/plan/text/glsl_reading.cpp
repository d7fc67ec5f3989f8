// SPDX-License-Identifier: MIT
// Readings: maps compose, from the last to the first, into the place that an image is sampled at; taps add to that.

#include <fmt/format.h>

#include "plan/text/glsl.hpp"

namespace darkroom::plan {

namespace {

std::string call(const FusedStep& step, std::string_view first_argument) {
    return fmt::format("{0}{1}({2}place, {0}_parameters{1}())", step.info->name, place_suffix(step.place),
                       first_argument);
}

std::string enabled(const FusedStep& step) {
    return fmt::format("{}{}_enabled_ != 0u", step.info->name, place_suffix(step.place));
}

std::string statement(const FusedStep& step, const std::string& text) {
    return step.is_certain ? fmt::format("    {}\n", text) : fmt::format("    if ({}) {}\n", enabled(step), text);
}

}  // namespace

std::string reading_function(std::string_view name, std::string_view image, std::span<const FusedStep> steps,
                             std::string_view plain) {
    std::string maps, taps, parts, any;
    bool always_parts = false, is_always_read = plain.empty();
    for (const FusedStep& step : steps) {
        if (step.reads != image) continue;
        is_always_read |= step.is_certain;
        any += fmt::format("{}{}", any.empty() ? "" : " || ", enabled(step));
        if (step.info->touch == Touch::Tap) {
            taps += statement(step, fmt::format("color = {};", call(step, "color, ")));
            continue;
        }
        maps = statement(step, fmt::format("place = {};", call(step, ""))) + maps;
        if (!step.info->parts_channels) continue;
        always_parts |= step.is_certain;
        parts += fmt::format("{}{}", parts.empty() ? "" : " || ", enabled(step));
    }
    const auto sample = [&](char channel) {
        return fmt::format("sample_linear({}, barrel(place.uv, place.barrel.{}))", image, channel);
    };
    const std::string unread = is_always_read ? "" : fmt::format("    if (!({})) return {};\n", any, plain);
    std::string out = fmt::format(
        "vec4 {}(Pixel pixel) {{\n{}    Place place = Place(pixel.uv, vec3(0.0));\n{}    vec4 color = {};\n", name, unread,
        maps, sample('g'));
    if (!parts.empty())
        out += fmt::format("    {}{{\n        color.r = {}.r;\n        color.b = {}.b;\n    }}\n",
                           always_parts ? "" : fmt::format("if ({}) ", parts), sample('r'), sample('b'));
    return out + taps + "    return color;\n}\n";
}

}  // namespace darkroom::plan
