// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/effects.hpp>
#include <darkroom/look.hpp>

#include "core/param_text.hpp"
#include "looks/look_parts.hpp"
#include "looks/look_resources.hpp"

namespace darkroom {

namespace {

/// What a key names: a row of the entry's effect, one of the entry's own, or one of its wires.
struct Target {
    LookEntry* entry = nullptr;
    const ParamInfo* row = nullptr;
    bool is_state = false;
    const WireInfo* wire = nullptr;
};

const ParamInfo* find_state_row(std::string_view name) {
    for (const ParamInfo& row : entry_rows.rows)
        if (row.name == name) return &row;
    return nullptr;
}

class Overrider {
  public:
    Overrider(Look& look, const LookOptions& options) : look_(look), files_({}, options) {}

    Result<> run(std::span<const LookOverride> overrides) {
        for (const LookOverride& one : overrides)
            if (Result<> done = set(one); !done) return done;
        // A toggle that was typed counts, whatever an amount implies.
        for (const auto& [entry, on] : toggles_) entry->state.enabled = on;
        for (const LookEntry& entry : look_.entries)
            if (const std::string conflict = conflict_of(entry); !conflict.empty()) return user_error(conflict);
        return {};
    }

  private:
    Result<> set(const LookOverride& one) {
        const std::string shown = printable(one.shown.empty() ? one.key : one.shown);
        const Result<Target> target = find(one.key, shown);
        if (!target) return failure(target.error());
        const auto& [entry, row, is_state, wire] = *target;
        if (wire != nullptr) {
            const Result<> done = files_.put(*entry, *wire, one.text);
            return done ? done : user_error(fmt::format("{}: {}", shown, done.error().text));
        }
        if (!is_state && row->kind == Kind::Resource) {
            const Result<> done = files_.put(*entry, *row, one.text);
            if (!done) return user_error(fmt::format("{}: {}", shown, done.error().text));
            if (row->is_amount) entry->state.enabled = !one.text.empty();
            return {};
        }
        const Result<ParamValue> value = parse_text(*row, one.text);
        if (!value) return user_error(fmt::format("{}: {}", shown, value.error().text));
        if (!is_state) {
            if (Result<> done = assign(*row, entry->words, *value, shown); !done) return done;
            const bool is_positive = std::bit_cast<float>(entry->words[row->word]) > 0;
            if (row->is_amount) entry->state.enabled = std::bit_cast<float>(entry->words[row->word]) != 0;
            if (row->switched_word < entry->words.size() && is_positive) {
                entry->words[row->switched_word] = 1;
                entry->state.enabled = true;
            }
            return {};
        }
        StateWords words = state_words(entry->state);
        if (Result<> done = assign(*row, words, *value, shown); !done) return done;
        entry->state = std::bit_cast<EntryState>(words);
        if (row->kind == Kind::Toggle) toggles_.emplace_back(entry, entry->state.enabled);
        return {};
    }

    Result<Target> find(std::string_view key, const std::string& shown) const {
        const std::size_t dot = key.rfind('.');
        if (dot != std::string_view::npos) return find_in_entry(key.substr(0, dot), key.substr(dot + 1), shown);
        for (const EffectInfo* const effect : effects()) {
            const ParamInfo* row = nullptr;
            for (const ParamInfo& candidate : effect->parameters.rows)
                if (flat_key(effect->name, candidate.name) == key) row = &candidate;
            const bool is_toggle = row == nullptr && flat_key(effect->name, "enabled") == key;
            if (row == nullptr && !is_toggle) continue;
            LookEntry* const entry = find_entry(look_, effect->name);
            if (entry == nullptr) return unheld(shown, effect->name);
            return Target{entry, is_toggle ? find_state_row("enabled") : row, is_toggle, nullptr};
        }
        return user_error(fmt::format("{}: no effect has this parameter{}", shown, suggestion(key, all_keys())));
    }

    Result<Target> find_in_entry(std::string_view name, std::string_view member, const std::string& shown) const {
        LookEntry* const entry = find_entry(look_, name);
        if (entry == nullptr) return unheld(shown, name);
        if (const ParamInfo* const row = find_state_row(member)) return Target{entry, row, true, nullptr};
        if (const ParamInfo* const row = entry->effect->parameters.find(member))
            return Target{entry, row, false, nullptr};
        std::vector<std::string> members;
        for (const WireInfo& wire : wires) {
            if (!wire.is_reference) continue;
            if (wire.key == member) return Target{.entry = entry, .wire = &wire};
            members.emplace_back(wire.key);
        }
        for (const ParamInfo& row : entry_rows.rows) members.emplace_back(row.name);
        for (const ParamInfo& row : entry->effect->parameters.rows) members.emplace_back(row.name);
        return user_error(fmt::format("{}: '{}' has no parameter '{}', it has {}{}", shown, printable(name),
                                      printable(member), fmt::join(members, ", "), suggestion(member, members)));
    }

    Failure unheld(const std::string& shown, std::string_view name) const {
        const std::vector<std::string> names = entry_names(look_);
        if (names.empty()) return user_error(fmt::format("{}: {} has no entries", shown, look_.shown_name));
        return user_error(fmt::format("{}: {} has no entry '{}', it has {}{}", shown, look_.shown_name, printable(name),
                                      fmt::join(names, ", "), suggestion(name, names)));
    }

    /// Those that are built in, and those of files.
    std::vector<const EffectInfo*> effects() const {
        const std::span<const EffectInfo* const> known = all_effects();
        std::vector<const EffectInfo*> out(known.begin(), known.end());
        for (const LookEntry& entry : look_.entries)
            if (entry.effect_owner && std::ranges::find(out, entry.effect) == out.end()) out.push_back(entry.effect);
        return out;
    }

    std::vector<std::string> all_keys() const {
        std::vector<std::string> keys;
        for (const EffectInfo* const effect : effects()) {
            keys.push_back(flat_key(effect->name, "enabled"));
            for (const ParamInfo& row : effect->parameters.rows) keys.push_back(flat_key(effect->name, row.name));
        }
        return keys;
    }

    Look& look_;
    ResourceFiles files_;
    std::vector<std::pair<LookEntry*, Toggle>> toggles_;
};

}  // namespace

Result<> override_look(Look& look, std::span<const LookOverride> overrides, const LookOptions& options) {
    return Overrider(look, options).run(overrides);
}

}  // namespace darkroom
