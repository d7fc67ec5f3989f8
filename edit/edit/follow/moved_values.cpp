// SPDX-License-Identifier: MIT
#include "edit/follow/moved_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"

namespace darkroom::edit {

namespace {

using Words = std::span<const std::uint32_t>;

template <class State>
auto words_of(const State& state) {
    return std::bit_cast<std::array<std::uint32_t, sizeof(State) / 4>>(state);
}

std::vector<std::uint32_t> part_of(Words words, const ParamInfo& row) {
    const Words own = words.subspan(row.word, row.words);
    return {own.begin(), own.end()};
}

ParamInfo alone(ParamInfo row) {
    row.word = 0;
    return row;
}

template <class State>
void add_rows(std::vector<MovedValue>& out, const ParamTable& table, const State& state, const char* where) {
    for (const ParamInfo& row : table.rows)
        out.push_back({alone(row), part_of(words_of(state), row), part_of(table.defaults, row), {}, where});
}

/// Sets the row of this number; else takes as many off it as there are.
template <class State>
bool set_row(const ParamTable& table, State& state, std::size_t& number, Words words) {
    if (number >= table.rows.size()) {
        number -= table.rows.size();
        return false;
    }
    auto own = words_of(state);
    std::ranges::copy(words, own.begin() + table.rows[number].word);
    state = std::bit_cast<State>(own);
    return true;
}

struct Moved {
    const ParamInfo* row = nullptr;
    std::vector<std::uint32_t> words;  ///< without what moves it
};

Moved moved(const Look& look, std::string_view entry, std::string_view parameter) {
    const std::vector<std::string> names = entry_names(look);
    const auto at = static_cast<std::size_t>(std::ranges::find(names, entry) - names.begin());
    if (at == names.size()) return {};
    const LookEntry& of = look.entries[at];
    if (const ParamInfo* const row = entry_rows.find(parameter)) return {row, part_of(state_words(of.state), *row)};
    const ParamInfo* const row = of.effect->parameters.find(parameter);
    return row == nullptr ? Moved{} : Moved{row, part_of(of.words, *row)};
}

/// What a pulse adds: as far as the parameter's own interval reaches, up or down, and as far as a file may say.
ParamInfo amount_row(const Look& look, const LookPulse& pulse) {
    constexpr std::array kinds{Kind::Float, Kind::Vec2, Kind::Vec3, Kind::Vec4};
    const ParamInfo* const of = moved(look, pulse.entry, pulse.parameter).row;
    const std::uint32_t count = of == nullptr ? 1 : std::clamp(of->words, 1U, 4U);
    const double width = of == nullptr ? 1 : std::min(of->range.max - of->range.min, max_amount);
    return {.name = "amount",
            .doc = "What is added while the envelope is 1.",
            .unit = of == nullptr ? Unit{} : of->unit,
            .range = {-width, width},
            .kind = kinds[count - 1],
            .words = count};
}

bool is_there(const Look& look, Mover mover) {
    return mover.number < (mover.is_layer ? look.layers.size() : look.pulses.size());
}

}  // namespace

std::vector<MovedValue> values_of(const Look& look, Mover mover) {
    std::vector<MovedValue> out;
    if (!is_there(look, mover)) return out;
    if (!mover.is_layer) {
        const LookPulse& pulse = look.pulses[mover.number];
        const ParamInfo amount = amount_row(look, pulse);
        out.push_back(
            {amount, part_of(words_of(pulse.amount), amount), std::vector<std::uint32_t>(amount.words), {}, {}});
        add_rows(out, pulse_rows, pulse.state, "");
        return out;
    }
    const LookLayer& layer = look.layers[mover.number];
    add_rows(out, layer_rows, layer.state, "");
    if (layer.distance) add_rows(out, distance_rows, *layer.distance, "distance");
    if (!layer.file.empty()) return out;
    for (const LookLayer::Value& value : layer.values)
        if (Moved of = moved(look, value.entry, value.parameter); of.row != nullptr)
            out.push_back({alone(*of.row), value.words, std::move(of.words), value.entry, "values"});
    return out;
}

std::string name_of(const Look& look, Mover mover) {
    if (!is_there(look, mover)) return {};
    if (mover.is_layer) return look.layers[mover.number].name;
    const LookPulse& pulse = look.pulses[mover.number];
    return fmt::format("{}: {}.{}", pulse.event, pulse.entry, pulse.parameter);
}

Result<> set_moved(Look& look, Mover mover, std::size_t value, Words words) {
    const std::vector<MovedValue> values = values_of(look, mover);
    if (value >= values.size()) return user_error("the pulse or layer was removed");
    const MovedValue& wanted = values[value];
    const std::string shown = fmt::format("{}, {}", name_of(look, mover), wanted.row.name);
    DARKROOM_TRY(check_words(wanted.row, words, shown));
    if (!mover.is_layer) {
        LookPulse& pulse = look.pulses[mover.number];
        if (value == 0)
            for (std::size_t i = 0; i < pulse.amount.size(); ++i)
                pulse.amount[i] = std::bit_cast<float>(words[std::min(i, words.size() - 1)]);
        else
            set_row(pulse_rows, pulse.state, --value, words);
        return {};
    }
    LookLayer& layer = look.layers[mover.number];
    if (set_row(layer_rows, layer.state, value, words)) return {};
    if (layer.distance && set_row(distance_rows, *layer.distance, value, words)) {
        if (layer.distance->near < layer.distance->far) return {};
        return user_error(fmt::format("{}: near = {} and far = {}: allowed is near < far", shown, layer.distance->near,
                                      layer.distance->far));
    }
    for (LookLayer::Value& own : layer.values)
        if (own.entry == wanted.entry && own.parameter == wanted.row.name) own.words.assign(words.begin(), words.end());
    return {};
}

}  // namespace darkroom::edit
