// SPDX-License-Identifier: MIT
#include <darkroom/look.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <darkroom/effects.hpp>
#include <map>

#include "core/param_text.hpp"
#include "looks/look_parts.hpp"
#include "looks/look_resources.hpp"

namespace darkroom {

std::int32_t flat_rank(const EffectInfo& effect, LookOrder order) {
    return order == LookOrder::Documented ? effect.flat.documented : effect.flat.scene_linear;
}

std::string conflict_of(const LookEntry& entry) {
    if (entry.effect->conflict == nullptr) return {};
    const std::string text = entry.effect->conflict(entry.words.data());
    return text.empty() ? text : fmt::format("{}: {}", entry.effect->name, text);
}

LookEntry entry_of(const EffectInfo& effect) {
    const std::span<const std::uint32_t> defaults = effect.parameters.defaults;
    return {.effect = &effect, .words = {defaults.begin(), defaults.end()}, .effect_owner = effect.owner.lock()};
}

std::vector<const LookEntry*> ordered(const Look& look) {
    std::vector<const LookEntry*> out;
    for (const LookEntry& entry : look.entries)
        if (!look.is_flat || flat_rank(*entry.effect, look.order) >= 0) out.push_back(&entry);
    if (look.is_flat)
        std::stable_sort(out.begin(), out.end(), [&](const LookEntry* a, const LookEntry* b) {
            return flat_rank(*a->effect, look.order) < flat_rank(*b->effect, look.order);
        });
    return out;
}

namespace {

void write_row(std::string& out, std::string_view key, std::string_view value) {
    out += fmt::format("{} = {}\n", key, value);
}

void write_flat(std::string& out, const Look& look) {
    out += "\n[post_process]\n";
    out += fmt::format("enabled = {}\norder = \"{}\"\n", look.is_enabled,
                       order_names[static_cast<std::size_t>(look.order)]);
    for (const LookEntry* const entry : ordered(look)) {
        const EffectInfo& effect = *entry->effect;
        out += fmt::format("{} = {}\n", flat_key(effect.name, "enabled"), entry->state.enabled.on != 0);
        for (const ParamInfo& row : effect.parameters.rows)
            write_row(out, flat_key(effect.name, row.name), value_text(*entry, row));
    }
}

void write_stack(std::string& out, const Look& look) {
    for (const LookEntry& entry : look.entries) {
        const std::string_view effect = entry.effect_file.empty() ? entry.effect->name : entry.effect_file;
        out += fmt::format("\n[[stack]]\neffect = {}\n", toml_string(effect));
        for (const WireInfo& wire : wires)
            if (!(entry.*wire.member).empty()) write_row(out, wire.key, toml_string(entry.*wire.member));
        const StateWords state = state_words(entry.state);
        for (const ParamInfo& row : entry_rows.rows)
            if (!std::equal(&state[row.word], &state[row.word] + row.words, &entry_rows.defaults[row.word]))
                write_row(out, row.name, format(row, state));
        for (const ParamInfo& row : entry.effect->parameters.rows) write_row(out, row.name, value_text(entry, row));
    }
}

}  // namespace

Look default_look() {
    Look look{.shown_name = "the default look"};
    for (const EffectInfo* const effect : all_effects()) {
        if (effect->flat.documented < 0 && effect->flat.scene_linear < 0) continue;
        look.entries.push_back(entry_of(*effect));
        look.entries.back().state.enabled = effect->flat.starts_on;
    }
    return look;
}

std::string write_look(const Look& look) {
    std::string out = fmt::format("format = {}\n", Look::format);
    if (look.is_flat)
        write_flat(out, look);
    else if (look.entries.empty())
        out += "stack = []\n";
    else
        write_stack(out, look);
    return out;
}

std::vector<std::string> entry_names(const Look& look) {
    std::vector<std::string> names;
    std::map<const EffectInfo*, std::size_t> counts;
    for (const LookEntry& entry : look.entries) {
        const std::size_t count = ++counts[entry.effect];
        if (!entry.name.empty())
            names.push_back(entry.name);
        else if (count == 1)
            names.emplace_back(entry.effect->name);
        else
            names.push_back(fmt::format("{}#{}", entry.effect->name, count));
    }
    return names;
}

LookEntry* find_entry(Look& look, std::string_view name) {
    for (LookEntry& entry : look.entries)
        if (!entry.name.empty() && entry.name == name) return &entry;
    std::map<const EffectInfo*, std::size_t> counts;
    for (LookEntry& entry : look.entries) {
        const std::size_t count = ++counts[entry.effect];
        if (count == 1 && name == entry.effect->name) return &entry;
        if (name == fmt::format("{}#{}", entry.effect->name, count)) return &entry;
    }
    return nullptr;
}

}  // namespace darkroom
