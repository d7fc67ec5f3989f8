// SPDX-License-Identifier: MIT
#include "edit/splice/restructure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/text/param_text.hpp"
#include "edit/effect_uses.hpp"

namespace darkroom::edit {

Result<LookEntry*> entry_at(Look& look, std::string_view name) {
    if (LookEntry* const entry = find_entry(look, name)) return entry;
    const std::vector<std::string> names = entry_names(look);
    return user_error(
        fmt::format("{}: {} has no such entry, it has {}", printable(name), look.shown_name, fmt::join(names, ", ")));
}

namespace {

/// Has somebody set more of it than its switch, or written it into the file?
bool is_set(const Look& look, const LookEntry& entry) {
    return entry.words != flat_entry(*entry.effect, look.order).words ||
           std::ranges::count(look.written, entry.effect, &WrittenValue::effect) > 0;
}

}  // namespace

void become_stack(Look& look) {
    std::vector<const EffectInfo*> off;
    for (LookEntry& entry : look.entries) {
        if (!look.is_enabled || entry.is_of_ui || entry.state.enabled.on != 0 || !is_set(look, entry)) continue;
        entry.state.enabled = true;
        off.push_back(entry.effect);
    }
    make_stack(look);
    for (LookEntry& entry : look.entries) {
        if (entry.is_of_ui) continue;
        if (std::ranges::count(off, entry.effect) > 0) entry.state.enabled = false;
        if (!uses_of(*entry.effect).reads_source) entry.source.clear();
    }
}

Result<LookEntry*> restructured(Look& look, std::string_view name) {
    DARKROOM_TRY_VALUE(auto* entry, entry_at(look, name));
    if (entry->is_of_ui)
        return user_error(fmt::format("{}: belongs to the interface: allowed are changes of its values and its switch",
                                      printable(name)));
    if (!look.is_flat) return entry;
    const EffectInfo* const effect = entry->effect;
    const Toggle was_enabled = std::exchange(entry->state.enabled, true);
    become_stack(look);
    const auto found = std::ranges::find(look.entries, effect, &LookEntry::effect);
    if (found == look.entries.end())
        return user_error(fmt::format("{}: the look is off; switch it on before its entries", printable(name)));
    found->state.enabled = was_enabled;
    return &*found;
}

}  // namespace darkroom::edit
