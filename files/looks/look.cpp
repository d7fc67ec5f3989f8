// SPDX-License-Identifier: MIT
#include <darkroom/look.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <darkroom/effect.hpp>
#include <functional>
#include <map>

#include "core/assert.hpp"
#include "core/text/param_text.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/documented.hpp"
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

LookEntry flat_entry(const EffectInfo& effect, LookOrder order) {
    LookEntry entry = entry_of(effect);
    entry.state.enabled = effect.flat.starts_on;
    entry.is_of_ui = effect.flat.is_of_ui();
    if (order != LookOrder::Documented) return entry;
    for (const DocumentedValue& value : documented_values) {
        if (value.effect != effect.name) continue;
        if (value.parameter == "enabled") {
            entry.state.enabled = value.text == "true";
            continue;
        }
        const auto row = std::ranges::find(effect.parameters.rows, value.parameter, &ParamInfo::name);
        DARKROOM_ASSERT(row != effect.parameters.rows.end());
        const Result<ParamValue> parsed = parse_text(*row, value.text);
        DARKROOM_ASSERT(parsed && assign(*row, entry.words, *parsed, value.parameter));
    }
    return entry;
}

Look default_look(LookOrder order) {
    Look look{.order = order, .shown_name = "the default look"};
    for (const EffectInfo* const effect : all_effects())
        if (effect->flat.documented >= 0 || effect->flat.scene_linear >= 0)
            look.entries.push_back(flat_entry(*effect, order));
    return look;
}

Look default_look_of_traced_light() {
    Look look = default_look();
    for (LookEntry& entry : look.entries)
        if (entry.effect->is_in_traced_light) entry.state.enabled = false;
    return look;
}

void set_order(Look& look, LookOrder order) {
    for (LookEntry& entry : look.entries) {
        const LookEntry was = flat_entry(*entry.effect, look.order), is = flat_entry(*entry.effect, order);
        for (const ParamInfo& row : entry.effect->parameters.rows)
            if (std::equal(&entry.words[row.word], &entry.words[row.word] + row.words, &was.words[row.word]))
                std::copy_n(&is.words[row.word], row.words, &entry.words[row.word]);
        if (!entry.is_asked_for && entry.state.enabled.on == was.state.enabled.on)
            entry.state.enabled = is.state.enabled;
    }
    look.order = order;
}

Look switched_off(const Look& look) {
    Look off = default_look(look.order);
    off.is_enabled = false;
    off.shown_name = look.shown_name;
    for (LookEntry& entry : off.entries) {
        const auto found = std::ranges::find(look.entries, entry.effect, &LookEntry::effect);
        if (entry.effect->exposure != nullptr && found != look.entries.end()) {
            entry.words = found->words;
            entry.state.enabled = found->state.enabled;
        }
    }
    off.ui = look.ui;
    std::erase_if(off.entries, &LookEntry::is_of_ui);
    std::ranges::copy_if(look.entries, std::back_inserter(off.entries), &LookEntry::is_of_ui);
    return off;
}

float exposure_of(const Look& look) {
    for (const LookEntry& entry : look.entries)
        if (entry.effect->exposure != nullptr && entry.state.enabled.on != 0)
            return entry.effect->exposure(entry.words.data());
    return 1;
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
