// SPDX-License-Identifier: MIT
#pragma once
// For tests only: random edits of any look. The same generator makes the same edits everywhere. Not part of the
// library.

#include <bit>
#include <cmath>
#include <darkroom/effects.hpp>
#include <random>

#include "edit/edits.hpp"
#include "edit/follow/moved_values.hpp"
#include "looks/look_parts.hpp"

namespace darkroom::edit::test {

inline std::uint32_t below(std::mt19937& random, std::size_t limit) {
    return static_cast<std::uint32_t>(random() % limit);
}

inline double random_number(std::mt19937& random, const Range& range) {
    const double share = static_cast<double>(random()) / 4294967296.0;
    switch (below(random, 5)) {
        case 0:
            return range.min;
        case 1:
            return range.max;
        case 2:  // numbers that people write
            return std::clamp(std::round(range.min + share * 10), range.min, range.max);
        default:
            return range.min + share * (range.max - range.min);
    }
}

/// A value that the row allows.
inline std::vector<std::uint32_t> random_words(std::mt19937& random, const ParamInfo& row) {
    const auto number = [&] {
        return std::bit_cast<std::uint32_t>(static_cast<float>(random_number(random, row.range)));
    };
    std::vector<std::uint32_t> out(row.words);
    switch (row.kind) {
        case Kind::Toggle:
            out[0] = below(random, 2);
            break;
        case Kind::Choice:
            out[0] = below(random, row.choices.size());
            break;
        case Kind::Int:
            out[0] =
                static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(random_number(random, row.range))));
            break;
        case Kind::Curve: {
            Curve curve{.count = 2 + below(random, 4)};
            for (std::uint32_t i = 0; i < curve.count; ++i) {
                curve.x[i] = static_cast<float>(i) / static_cast<float>(curve.count - 1);
                curve.y[i] = static_cast<float>(random_number(random, row.range));
            }
            const auto words = std::bit_cast<std::array<std::uint32_t, sizeof(Curve) / 4>>(curve);
            out.assign(words.begin(), words.end());
            break;
        }
        default:
            for (std::uint32_t& word : out) word = number();
    }
    return out;
}

/// An entry, and a row of its effect or its own; an edit of it.
struct RandomEdit {
    std::string entry, row;
    bool is_state = false;
    bool is_reset = false;
    std::vector<std::uint32_t> words{};
};

inline RandomEdit random_value_edit(std::mt19937& random, const Look& look) {
    const std::vector<std::string> names = entry_names(look);
    for (;;) {
        const std::uint32_t at = below(random, names.size());
        const LookEntry& entry = look.entries[at];
        // A look without the interface gets all of it by the first edit there, which is an edit of another kind.
        if (entry.is_of_ui && !look.ui) continue;
        RandomEdit out{.entry = names[at]};
        const auto rows = entry.effect->parameters.rows;
        if (rows.empty() || below(random, 4) == 0) {
            const bool has_all = !look.is_flat && !entry.is_of_ui;
            const ParamInfo& row = entry_rows.rows[has_all ? below(random, entry_rows.rows.size()) : 0];
            out.row = row.name;
            out.is_state = true;
            out.words = random_words(random, row);
            return out;
        }
        const ParamInfo& row = rows[below(random, rows.size())];
        if (row.kind == Kind::Resource) continue;
        out.row = row.name;
        out.is_reset = below(random, 6) == 0;
        out.words = random_words(random, row);
        return out;
    }
}

inline Result<> apply_edit(Look& look, const RandomEdit& edit) {
    if (edit.is_state) return set_state(look, edit.entry, edit.row, edit.words);
    if (edit.is_reset) return reset_value(look, edit.entry, edit.row);
    return set_value(look, edit.entry, edit.row, edit.words);
}

/// Adds and takes out pulses, layers and their values; may fail.
inline Result<> random_mover_edit(std::mt19937& random, Look& look) {
    const bool is_layer = below(random, 2) == 0;
    const std::vector<Movable> all = movable_values(look, is_layer);
    const std::size_t count = is_layer ? look.layers.size() : look.pulses.size();
    const auto done = [](const Result<std::size_t>& made) { return made ? Result<>{} : failure(made.error()); };
    constexpr std::array names{"hit", "jump", "night", "new"};
    const std::string name = names[below(random, names.size())];
    if (all.empty()) return {};
    const Movable& what = all[below(random, all.size())];
    const std::uint32_t act = below(random, 6);
    if (count == 0 || act < 2)
        return done(is_layer ? add_layer(look, name, what.entry, what.row->name)
                             : add_pulse(look, name, what.entry, what.row->name));
    const Mover mover{is_layer, below(random, count)};
    const std::size_t values = values_of(look, mover).size();
    if (act < 4) return remove_mover(look, mover);
    if (is_layer && below(random, 4) == 0)
        return set_layer_distance(look, mover.number, !look.layers[mover.number].distance.has_value());
    if (is_layer && below(random, 2) == 0)
        return act == 4 ? add_layer_value(look, mover.number, what.entry, what.row->name)
                        : remove_layer_value(look, mover.number, below(random, values));
    const std::uint32_t value = below(random, values);
    return set_moved(look, mover, value, random_words(random, values_of(look, mover)[value].row));
}

/// Moves, removes, copies, adds or wires something; may fail, as what a user asks for.
inline Result<> random_restructuring(std::mt19937& random, Look& look) {
    const std::vector<std::string> names = entry_names(look);
    const std::string entry = names.empty() ? std::string() : names[below(random, names.size())];
    const std::string before =
        names.empty() || below(random, 4) == 0 ? std::string() : names[below(random, names.size())];
    const auto done = [](const Result<std::string>& made) { return made ? Result<>{} : failure(made.error()); };
    switch (below(random, 9)) {
        case 7:
        case 8:
            return random_mover_edit(random, look);
        case 0:
        case 1:
            return move_entry(look, entry, before);
        case 2:
            return remove_entry(look, entry);
        case 3:
            return done(duplicate_entry(look, entry));
        case 4:
        case 5:
            return done(add_effect(look, *all_effects()[below(random, all_effects().size())], before));
        default: {
            constexpr std::array keys{"input", "source", "mask", "output", "name"};
            constexpr std::array texts{"scene", "", "made", "made.previous", "alpha"};
            const std::uint32_t key = below(random, keys.size());
            const std::string text = key < 3 ? texts[below(random, texts.size())] : (key == 3 ? "made" : "renamed");
            return set_wire(look, entry, keys[key], text, {});
        }
    }
}

}  // namespace darkroom::edit::test
