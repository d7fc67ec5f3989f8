// SPDX-License-Identifier: MIT
// Edits that change which pulses and layers a look has.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text/param_text.hpp"
#include "edit/follow/moved_values.hpp"
#include "looks/look_parts.hpp"

namespace darkroom::edit {

namespace {

constexpr std::array numbers{Kind::Float, Kind::Int, Kind::Vec2, Kind::Vec3, Kind::Vec4, Kind::Rgb};

/// As a file may name it (files/looks/read/read_modulation.cpp).
bool is_movable(const ParamInfo& row, bool is_state, bool is_layer) {
    if (is_state) return is_layer && (row.name == "enabled" || row.name == "opacity");
    return is_layer ? row.kind != Kind::Resource : std::ranges::count(numbers, row.kind) > 0;
}

struct Target {
    LookEntry* entry = nullptr;
    std::string name;
    const ParamInfo* row = nullptr;
    bool is_state = false;
};

Result<Target> movable_at(Look& look, std::string_view entry, std::string_view parameter, bool is_layer) {
    const std::string key = fmt::format("{}.{}", entry, parameter), shown = printable(key);
    DARKROOM_TRY_VALUE(const LookTarget found, find_target(look, key, shown));
    if (found.row == nullptr || !is_movable(*found.row, found.is_state, is_layer))
        return user_error(is_layer ? fmt::format("{}: it is fixed when the stack is compiled, and cannot move", shown)
                                   : fmt::format("{}: a pulse adds to parameters made of numbers", shown));
    return Target{found.entry, entry_names(look)[static_cast<std::size_t>(found.entry - look.entries.data())],
                  found.row, found.is_state};
}

Result<> check_name(std::string_view what, std::string_view name) {
    if (is_look_name(name)) return {};
    return user_error(
        fmt::format("{} = \"{}\": expected a name of letters, digits, '_' and '-'", what, printable(name)));
}

Result<> check_room(std::string_view what, std::size_t count, std::size_t most) {
    if (count < most) return {};
    return user_error(fmt::format("{} entries of {}: allowed are {}", count + 1, what, most));
}

Result<> check_new_layer(const Look& look, std::string_view name) {
    DARKROOM_TRY(check_name("name", name));
    DARKROOM_TRY(check_room("layer", look.layers.size(), max_layers));
    if (std::ranges::count(look.layers, name, &LookLayer::name) == 0) return {};
    return user_error(fmt::format("two layers are named '{}'", name));
}

LookLayer::Value present_value(const Target& target) {
    const StateWords state = state_words(target.entry->state);
    const std::span<const std::uint32_t> words =
        target.is_state ? std::span<const std::uint32_t>(state) : std::span<const std::uint32_t>(target.entry->words);
    const auto own = words.subspan(target.row->word, target.row->words);
    return {target.name, std::string(target.row->name), {own.begin(), own.end()}};
}

}  // namespace

std::vector<Movable> movable_values(const Look& look, bool is_layer) {
    std::vector<Movable> out;
    const std::vector<std::string> names = entry_names(look);
    for (const LookEntry* const entry : ordered(look)) {
        if (entry->is_of_ui && !look.ui) continue;
        const std::string& name = names[static_cast<std::size_t>(entry - look.entries.data())];
        for (const ParamInfo& row : entry->effect->parameters.rows)
            if (is_movable(row, false, is_layer)) out.push_back({name, &row});
        for (const ParamInfo& row : entry_rows.rows)
            if (is_movable(row, true, is_layer)) out.push_back({name, &row});
    }
    return out;
}

Result<std::size_t> add_pulse(Look& look, std::string_view event, std::string_view entry, std::string_view parameter) {
    DARKROOM_TRY(check_name("event", event));
    DARKROOM_TRY(check_room("pulse", look.pulses.size(), max_pulses));
    DARKROOM_TRY_VALUE(const Target target, movable_at(look, entry, parameter, false));
    if (target.row->is_amount) wake(*target.entry);
    // Enough to be seen, of parameters that reach from 0 to 1 and of those that reach to a thousand.
    const auto amount = static_cast<float>(std::min(1.0, (target.row->range.max - target.row->range.min) / 2));
    look.pulses.push_back({.event = std::string(event),
                           .entry = target.name,
                           .parameter = std::string(target.row->name),
                           .amount = {amount, amount, amount, amount},
                           .state = {}});
    return look.pulses.size() - 1;
}

Result<std::size_t> add_layer(Look& look, std::string_view name, std::string_view entry, std::string_view parameter) {
    DARKROOM_TRY(check_new_layer(look, name));
    look.layers.push_back(
        {.name = std::string(name), .file = {}, .state = {.weight = 1}, .distance = {}, .values = {}});
    Result<> done = add_layer_value(look, look.layers.size() - 1, entry, parameter);
    if (done) return look.layers.size() - 1;
    look.layers.pop_back();
    return failure(std::move(done));
}

Result<std::size_t> add_layer_of(Look& look, std::string_view name, const std::string& file,
                                 const LookOptions& options) {
    DARKROOM_TRY(check_new_layer(look, name));
    DARKROOM_TRY_VALUE(std::vector<LookLayer::Value> values, layer_values(look, file, options));
    if (values.empty()) return user_error(fmt::format("{}: it is this look; allowed is another one", printable(file)));
    look.layers.push_back(
        {.name = std::string(name), .file = file, .state = {.weight = 1}, .distance = {}, .values = std::move(values)});
    return look.layers.size() - 1;
}

Result<> set_layer_distance(Look& look, std::size_t layer, bool is_on) {
    if (layer >= look.layers.size()) return user_error("the layer was removed");
    std::optional<LayerDistance>& distance = look.layers[layer].distance;
    if (distance.has_value() != is_on) distance = is_on ? std::optional(LayerDistance{}) : std::nullopt;
    return {};
}

Result<> add_layer_value(Look& look, std::size_t layer, std::string_view entry, std::string_view parameter) {
    if (layer >= look.layers.size()) return user_error("the layer was removed");
    if (!look.layers[layer].file.empty())
        return user_error(fmt::format("{}: its values come from {}: edit that look", look.layers[layer].name,
                                      printable(look.layers[layer].file)));
    DARKROOM_TRY_VALUE(const Target target, movable_at(look, entry, parameter, true));
    std::vector<LookLayer::Value>& values = look.layers[layer].values;
    if (std::ranges::any_of(values, [&](const LookLayer::Value& value) {
            return value.entry == target.name && value.parameter == target.row->name;
        }))
        return user_error(fmt::format("{}: the layer {} has it already",
                                      printable(fmt::format("{}.{}", entry, parameter)), look.layers[layer].name));
    LookLayer::Value value = present_value(target);
    if (target.row->is_amount) wake(*target.entry);
    values.push_back(std::move(value));
    return {};
}

Result<> remove_layer_value(Look& look, std::size_t layer, std::size_t value) {
    const std::vector<MovedValue> all = values_of(look, {true, layer});
    if (value >= all.size() || all[value].table != "values") return user_error("the layer has no such value");
    std::vector<LookLayer::Value>& values = look.layers[layer].values;
    if (values.size() == 1)
        return user_error(
            fmt::format("{}: it is the layer's only value, and a layer needs one", look.layers[layer].name));
    std::erase_if(values, [&](const LookLayer::Value& own) {
        return own.entry == all[value].entry && own.parameter == all[value].row.name;
    });
    return {};
}

Result<> remove_mover(Look& look, Mover mover) {
    const std::size_t count = mover.is_layer ? look.layers.size() : look.pulses.size();
    if (mover.number >= count) return user_error("the pulse or layer was removed");
    const auto number = static_cast<std::ptrdiff_t>(mover.number);
    if (mover.is_layer)
        look.layers.erase(look.layers.begin() + number);
    else
        look.pulses.erase(look.pulses.begin() + number);
    return {};
}

}  // namespace darkroom::edit
