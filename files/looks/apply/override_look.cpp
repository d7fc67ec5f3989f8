// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/look.hpp>
#include <iterator>

#include "core/caught.hpp"
#include "core/text/param_text.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/look_parts.hpp"

namespace darkroom {

namespace {

class Overrider {
  public:
    Overrider(Look& look, const LookOptions& options) : look_(look), files_({}, options) {}

    Result<> run(std::span<const LookOverride> overrides) {
        for (const LookOverride& one : overrides) DARKROOM_TRY(set(one));
        // A toggle that was typed counts, whatever an amount implies.
        for (const auto& [entry, on] : toggles_) {
            entry->state.enabled = on;
            entry->is_asked_for = on.on != 0;
        }
        for (const LookEntry& entry : look_.entries)
            if (const std::string conflict = conflict_of(entry); !conflict.empty()) return user_error(conflict);
        return {};
    }

  private:
    Result<> set(const LookOverride& one) {
        const std::string shown = printable(one.shown.empty() ? one.key : one.shown);
        DARKROOM_TRY_VALUE(const LookTarget target, find_target(look_, one.key, shown));
        const auto& [entry, row, is_state, wire] = target;
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
            DARKROOM_TRY(assign(*row, entry->words, *value, shown));
            const bool is_positive = std::bit_cast<float>(entry->words[row->word]) > 0;
            if (row->is_amount && !entry->is_of_ui) {
                entry->state.enabled = std::bit_cast<float>(entry->words[row->word]) != 0;
                entry->is_asked_for = entry->state.enabled.on != 0;
            }
            if (row->switched_word < entry->words.size() && is_positive) {
                entry->words[row->switched_word] = 1;
                entry->state.enabled = entry->is_asked_for = true;
            }
            return {};
        }
        StateWords words = state_words(entry->state);
        DARKROOM_TRY(assign(*row, words, *value, shown));
        entry->state = std::bit_cast<EntryState>(words);
        if (row->kind == Kind::Toggle) toggles_.emplace_back(entry, entry->state.enabled);
        return {};
    }

    Look& look_;
    ResourceFiles files_;
    std::vector<std::pair<LookEntry*, Toggle>> toggles_;
};

struct GivenValue {
    const LookEntry* entry = nullptr;
    std::string shown;
    bool says_what_is_on = false;
};

bool says_what_is_on(const ParamInfo* row) { return row == nullptr || row->is_amount; }

std::vector<GivenValue> given_by_file(Look& look) {
    std::vector<GivenValue> out;
    for (const WrittenValue& value : look.written)
        out.push_back(
            {find_entry(look, value.effect->name),
             fmt::format("{}:{}: {}", look.shown_name, value.place, flat_key(value.effect->name, value.parameter)),
             says_what_is_on(value.effect->parameters.find(value.parameter))});
    return out;
}

std::vector<GivenValue> given_by_hand(Look& look, std::span<const LookOverride> typed) {
    std::vector<GivenValue> out;
    for (const LookOverride& one : typed)
        if (const Result<LookTarget> target = find_target(look, one.key, one.shown))
            out.push_back({target->entry, printable(one.shown),
                           target->is_state || (target->row != nullptr && says_what_is_on(target->row))});
    return out;
}

std::string switch_of(const Look& look, std::string_view value, std::string_view name) {
    if (value.starts_with("--")) return fmt::format("--set {}.enabled=true", name);
    return look.is_flat ? flat_key(name, "enabled") + " = true" : fmt::format("{}.enabled = true", name);
}

void tell_of_idle_values(const Look& look, std::span<const GivenValue> values, std::vector<std::string>& out) {
    const std::vector<std::string> names = entry_names(look);
    for (std::size_t i = 0; i < look.entries.size(); ++i) {
        const LookEntry& entry = look.entries[i];
        if (entry.state.enabled.on != 0 || is_moved(look, names[i])) continue;
        const auto first = std::ranges::find(values, &entry, &GivenValue::entry);
        const bool is_meant = std::ranges::any_of(
            values, [&](const GivenValue& value) { return value.entry == &entry && value.says_what_is_on; });
        if (first != values.end() && !is_meant)
            out.push_back(fmt::format("{} changes nothing: {} is off; {} switches it on", first->shown, names[i],
                                      switch_of(look, first->shown, names[i])));
    }
}

}  // namespace

std::vector<std::string> values_without_effect(const Look& look, std::span<const LookOverride> typed) {
    std::vector<std::string> out;
    if (!look.is_enabled) return out;
    Look own = look;
    const std::vector<GivenValue> by_hand = given_by_hand(own, typed);
    std::vector<GivenValue> by_file = given_by_file(own);
    std::ranges::copy_if(by_hand, std::back_inserter(by_file), &GivenValue::says_what_is_on);
    tell_of_idle_values(own, by_hand, out);
    tell_of_idle_values(own, by_file, out);
    return out;
}

Result<> override_look(Look& look, std::span<const LookOverride> overrides, const LookOptions& options) try {
    return Overrider(look, options).run(overrides);
} catch (...) {
    return caught("override_look");
}

}  // namespace darkroom
