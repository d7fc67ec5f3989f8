// SPDX-License-Identifier: MIT
// `// @param KIND NAME = DEFAULT in [LOWEST, HIGHEST] UNIT: Sentence.`: a row as describe() makes it of a struct.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text/param_text.hpp"
#include "custom/description.hpp"
#include "custom/words.hpp"
#include "plan/text/glsl_names.hpp"

namespace darkroom::custom {

namespace {

// Curves and resources are made by code: they have no default that fits a line.
constexpr Names<Kind, 8> kinds{{{"float", Kind::Float},
                                {"int", Kind::Int},
                                {"toggle", Kind::Toggle},
                                {"choice", Kind::Choice},
                                {"vec2", Kind::Vec2},
                                {"vec3", Kind::Vec3},
                                {"vec4", Kind::Vec4},
                                {"rgb", Kind::Rgb}}};
constexpr Names<Unit, 6> units{{{unit::pixels.symbol, unit::pixels},
                                {unit::nits.symbol, unit::nits},
                                {unit::metres.symbol, unit::metres},
                                {unit::per_metre.symbol, unit::per_metre},
                                {unit::degrees.symbol, unit::degrees},
                                {unit::seconds.symbol, unit::seconds}}};

std::uint32_t words_of(Kind kind) {
    switch (kind) {
        case Kind::Vec2:
            return 2;
        case Kind::Vec3:
        case Kind::Rgb:
            return 3;
        case Kind::Vec4:
            return 4;
        default:
            return 1;
    }
}

/// Reads "luma | red | green"; the default is the first.
Result<std::string_view> read_choices(Description& out, ParamInfo& row, std::string_view text) {
    std::vector<std::string_view>& names = out.choices.emplace_back();
    for (const std::string_view choice : split(text, '|')) {
        if (!plan::is_snake_name(choice))
            return user_error(fmt::format("{} = {}: a choice is lower-case letters, digits and single underscores",
                                          row.name, printable(choice)));
        if (std::ranges::find(names, choice) != names.end())
            return user_error(fmt::format("{} = {}: named twice", row.name, choice));
        names.push_back(out.keep(choice));
    }
    if (names.size() < 2)
        return user_error(fmt::format("{}: a choice has two names or more, as `luma | red`", row.name));
    row.choices = names;
    return names.front();
}

/// Reads "DEFAULT in [a, b] px log amount"; returns the default.
Result<std::string_view> read_interval_and_more(ParamInfo& row, std::string_view text) {
    const std::size_t in = text.find(" in "), open = text.find('['), close = text.find(']');
    if (in == std::string_view::npos || close == std::string_view::npos || open > close || open < in ||
        !trimmed(text.substr(in + 4, open - in - 4)).empty())
        return user_error(fmt::format("{}: no interval: expected `= DEFAULT in [LOWEST, HIGHEST]`", row.name));
    const std::vector<std::string_view> bounds = split(text.substr(open + 1, close - open - 1), ',');
    const auto low = parse_number(bounds.front()), high = parse_number(bounds.back());
    const std::string shown = printable(text.substr(open, close + 1 - open));
    if (bounds.size() != 2 || !low || !high)
        return user_error(fmt::format("{} in {}: expected two numbers", row.name, shown));
    if (!(*low < *high)) return user_error(fmt::format("{} in {}: the interval is empty", row.name, shown));
    row.range = {*low, *high};
    for (std::string_view rest = trimmed(text.substr(close + 1)); !rest.empty();) {
        const std::string_view word = next_word(rest);
        if (word == "log") {
            if (*low <= 0) return user_error(fmt::format("{} in {}: with log the lowest is above 0", row.name, shown));
            row.range.scale = Scale::Log;
        } else if (word == "amount") {
            row.is_amount = true;
        } else if (const auto found = named(units, word)) {
            row.unit = *found;
        } else {
            return user_error(
                fmt::format("{}: {}: allowed is a unit ({}), log, amount", row.name, printable(word), listed(units)));
        }
    }
    return trimmed(text.substr(0, in));
}

Result<> add(Description& out, const ParamInfo& row, std::string_view text) {
    std::string dense(text);
    std::erase(dense, ' ');
    const auto value = parse_text(row, dense);
    if (!value) return user_error(fmt::format("{} = {}: {}", row.name, printable(text), value.error().text));
    out.defaults.resize(out.defaults.size() + row.words);
    DARKROOM_TRY(assign(row, out.defaults, *value));
    out.rows.push_back(row);
    return {};
}

Result<> check_parameter_name(const Description& out, std::string_view name) {
    DARKROOM_TRY(check_name(name));
    // They belong to the stack entry, and a look could not tell them apart.
    static constexpr std::string_view entry_keys[] = {"effect", "enabled", "name",   "input",   "source", "scale",
                                                      "format", "second",  "output", "opacity", "blend",  "mask"};
    if (std::ranges::find(entry_keys, name) != std::end(entry_keys))
        return user_error(fmt::format("{}: a key of every stack entry", name));
    if (std::ranges::find(out.rows, name, &ParamInfo::name) != out.rows.end())
        return user_error(fmt::format("{}: described twice", name));
    if (out.rows.size() == max_parameters)
        return user_error(fmt::format("{}: a file has at most {} parameters", name, max_parameters));
    return {};
}

}  // namespace

Result<> read_parameter(Description& out, std::string_view text) {
    DARKROOM_TRY_VALUE(const auto halves, with_sentence(text));
    const std::size_t equals = halves.head.find('=');
    std::string_view head = halves.head.substr(0, equals);
    const std::string_view kind_name = next_word(head), name = next_word(head);
    const auto kind = named(kinds, kind_name);
    if (!kind) return user_error(fmt::format("@param {}: allowed is {}", printable(kind_name), listed(kinds)));
    DARKROOM_TRY(check_parameter_name(out, name));
    if (equals == std::string_view::npos || !head.empty())
        return user_error(fmt::format("{}: expected `@param {} {} = DEFAULT`", name, kind_name, name));

    ParamInfo row{.name = out.keep(name),
                  .doc = out.keep(halves.rest),
                  .kind = *kind,
                  .word = static_cast<std::uint32_t>(out.defaults.size()),
                  .words = words_of(*kind)};
    Result<std::string_view> value = trimmed(halves.head.substr(equals + 1));
    if (*kind == Kind::Choice)
        value = read_choices(out, row, *value);
    else if (*kind != Kind::Toggle)
        value = read_interval_and_more(row, *value);
    if (!value) return failure(value.error());
    if (value->empty())
        return user_error(fmt::format("{}: no default: expected `@param {} {} = DEFAULT`", name, kind_name, name));
    return add(out, row, *value);
}

}  // namespace darkroom::custom
