// SPDX-License-Identifier: MIT
#include <darkroom/look.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <darkroom/effect.hpp>
#include <functional>
#include <map>

#include "core/text/param_text.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/look_parts.hpp"

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

namespace {

/// Noise that is laid over the finished picture, interface included.
bool is_noise(const LookEntry& entry) { return entry.effect->is_last_step && entry.effect->makes == nullptr; }

}  // namespace

std::vector<const LookEntry*> ordered(const Look& look) {
    std::vector<const LookEntry*> out;
    for (const LookEntry& entry : look.entries)
        if (!look.is_flat || flat_rank(*entry.effect, look.order) >= 0) out.push_back(&entry);
    const auto rank = [&](const LookEntry* entry) { return flat_rank(*entry->effect, look.order); };
    if (look.is_flat) {
        std::ranges::stable_sort(out, {}, rank);
        return out;
    }
    const auto ui = std::stable_partition(out.begin(), out.end(), std::not_fn(&LookEntry::is_of_ui));
    std::ranges::stable_sort(ui, out.end(), {}, rank);
    auto place = ui;
    while (place != out.begin() && is_noise(**(place - 1))) --place;
    std::rotate(place, ui, out.end());
    return out;
}

namespace {

void write_row(std::string& out, std::string_view key, std::string_view value) {
    out += fmt::format("{} = {}\n", key, value);
}

void write_values(std::string& out, const LookEntry& entry) {
    const EffectInfo& effect = *entry.effect;
    out += fmt::format("{} = {}\n", flat_key(effect.name, "enabled"), entry.state.enabled.on != 0);
    for (const ParamInfo& row : effect.parameters.rows)
        write_row(out, flat_key(effect.name, row.name), value_text(entry, row));
}

void write_ui(std::string& out, const Look& look) {
    if (!look.ui) return;
    out += "\n[ui]\n";
    if (!look.ui->document.empty()) write_row(out, "document", toml_string(look.ui->document));
    if (!look.ui->controllers.empty()) write_row(out, "controllers", list_text(look.ui->controllers));
    if (!look.ui->game.empty()) write_row(out, "game", game_text(look.ui->game));
    for (const LookEntry* const entry : ordered(look))
        if (entry->is_of_ui) write_values(out, *entry);
}

void write_flat(std::string& out, const Look& look) {
    out += "\n[post_process]\n";
    out += fmt::format("enabled = {}\norder = \"{}\"\n", look.is_enabled,
                       order_names[static_cast<std::size_t>(look.order)]);
    for (const LookEntry* const entry : ordered(look))
        if (!entry->is_of_ui) write_values(out, *entry);
}

void write_stack(std::string& out, const Look& look) {
    for (const LookEntry& entry : look.entries) {
        if (entry.is_of_ui) continue;
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
        look.entries.back().is_of_ui = effect->flat.is_of_ui;
    }
    return look;
}

void add_ui(Look& look) {
    if (!look.ui) look.ui.emplace();
    for (LookEntry& entry : default_look().entries) {
        if (!entry.is_of_ui) continue;
        const auto found = std::ranges::find_if(
            look.entries, [&](const LookEntry& own) { return own.is_of_ui && own.effect == entry.effect; });
        if (found == look.entries.end()) look.entries.push_back(std::move(entry));
    }
    for (LookEntry& entry : look.entries)
        if (entry.is_of_ui) entry.state.enabled = true;
}

std::string write_look(const Look& look) {
    std::string out = fmt::format("format = {}\n", Look::format);
    if (look.is_flat)
        write_flat(out, look);
    else if (look.entries.empty())
        out += "stack = []\n";
    else
        write_stack(out, look);
    write_ui(out, look);
    write_modulation(out, look);
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
