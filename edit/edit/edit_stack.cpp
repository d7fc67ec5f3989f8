// SPDX-License-Identifier: MIT
// Edits that change which entries a look has, and in which order; and what comes back from a Composer.
#include <fmt/format.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "edit/edits.hpp"
#include "edit/splice/restructure.hpp"

namespace darkroom::edit {

namespace {

/// Of an entry that was just made, until its document gives it a number.
constexpr std::uint64_t made_id = ~std::uint64_t{0};

std::string name_of_made(Look& look) {
    const auto made = std::ranges::find(look.entries, made_id, &LookEntry::id);
    made->id = 0;
    return entry_names(look)[static_cast<std::size_t>(made - look.entries.begin())];
}

/// Where an entry of the picture's chain goes: in front of another, or behind the last.
Result<std::ptrdiff_t> place_before(Look& look, std::string_view before) {
    if (before.empty()) {
        const auto last = std::find_if(look.entries.rbegin(), look.entries.rend(),
                                       [](const LookEntry& entry) { return !entry.is_of_ui; });
        return last.base() - look.entries.begin();
    }
    DARKROOM_TRY_VALUE(LookEntry* const other, restructured(look, before));
    return other - look.entries.data();
}

/// A name that no entry has, like this one.
std::string fresh_name(const Look& look, const std::string& like) {
    const std::vector<std::string> names = entry_names(look);
    std::string base = like.substr(0, 56);
    base.erase(base.find_last_not_of("0123456789") + 1);
    for (std::size_t number = 2;; ++number) {
        std::string name = fmt::format("{}{}{}", base, base.ends_with('_') ? "" : "_", number);
        if (std::ranges::count(names, name) == 0) return name;
    }
}

/// The place that a look has for this effect without being another: in a flat table, or the interface's.
LookEntry* own_place(Look& look, const EffectInfo& effect) {
    const auto found = std::ranges::find_if(look.entries, [&](const LookEntry& entry) {
        return entry.effect == &effect &&
               (entry.is_of_ui || (look.is_flat && look.is_enabled && flat_rank(effect, look.order) >= 0));
    });
    return found == look.entries.end() ? nullptr : &*found;
}

/// The entry of a look that adding this effect switches on; null: none.
LookEntry* sleeping(Look& look, const EffectInfo& effect) {
    LookEntry* const found = own_place(look, effect);
    return found == nullptr || found->state.enabled.on != 0 ? nullptr : found;
}

}  // namespace

Addition addition_of(const Look& look, const EffectInfo& effect) {
    Look copy = look;
    if (effect.flat.is_of_ui() && !copy.ui) add_ui(copy);
    const LookEntry* const own = own_place(copy, effect);
    if (own == nullptr) return {.kind = look.is_flat ? Addition::Kind::MakesStack : Addition::Kind::Inserts};
    const bool is_there = own->state.enabled.on != 0 && (!effect.flat.is_of_ui() || look.ui);
    return {.kind = is_there ? Addition::Kind::IsThere : Addition::Kind::SwitchesOn,
            .entry = entry_names(copy)[static_cast<std::size_t>(own - copy.entries.data())]};
}

Result<> move_entry(Look& look, std::string_view entry, std::string_view before) {
    DARKROOM_TRY_VALUE(auto* found, restructured(look, entry));
    const std::ptrdiff_t from = found - look.entries.data();
    DARKROOM_TRY_VALUE(const std::ptrdiff_t to, place_before(look, before));
    const auto first = look.entries.begin();
    if (from < to)
        std::rotate(first + from, first + from + 1, first + to);
    else
        std::rotate(first + to, first + from, first + from + 1);
    return {};
}

Result<> remove_entry(Look& look, std::string_view entry) {
    DARKROOM_TRY_VALUE(LookEntry* const found, entry_at(look, entry));
    if (look.is_flat || found->is_of_ui)
        (found)->state.enabled = false;
    else
        look.entries.erase(look.entries.begin() + (found - look.entries.data()));
    return {};
}

Result<std::string> duplicate_entry(Look& look, std::string_view entry) {
    DARKROOM_TRY_VALUE(LookEntry* const found, restructured(look, entry));
    LookEntry copy = *found;
    copy.id = made_id;
    copy.output.clear();
    if (!copy.name.empty()) copy.name = fresh_name(look, copy.name);
    look.entries.insert(look.entries.begin() + (found - look.entries.data()) + 1, std::move(copy));
    return name_of_made(look);
}

Result<std::string> add_effect(Look& look, const EffectInfo& effect, std::string_view before) {
    return add_entry(look, entry_of(effect), before);
}

Result<std::string> add_entry(Look& look, LookEntry entry, std::string_view before) {
    if (entry.effect->flat.is_of_ui()) {
        const bool is_new = !look.ui;
        if (is_new) add_ui(look);
        before = {};
        // It comes with all of its entries on.
        LookEntry* const own = own_place(look, *entry.effect);
        if (is_new && own != nullptr) return entry_names(look)[static_cast<std::size_t>(own - look.entries.data())];
    }
    if (LookEntry* const there = before.empty() ? sleeping(look, *entry.effect) : nullptr) {
        there->state.enabled = true;
        return entry_names(look)[static_cast<std::size_t>(there - look.entries.data())];
    }
    if (entry.effect->flat.is_of_ui())
        return user_error(fmt::format("{}: belongs to the interface, which has one already", entry.effect->name));
    entry.id = made_id;
    if (before.empty()) {
        if (look.is_flat) become_stack(look);
        DARKROOM_TRY(place_entry(look, std::move(entry)));
        return name_of_made(look);
    }
    DARKROOM_TRY(share_effect(look, entry));
    DARKROOM_TRY_VALUE(const std::ptrdiff_t place, place_before(look, before));
    look.entries.insert(look.entries.begin() + place, std::move(entry));
    return name_of_made(look);
}

Result<> take_values(Look& look, const Composer& composer) {
    if (!look.is_enabled) return {};
    const std::vector<std::string> names = entry_names(look);
    for (const std::string& name : names) {
        const auto handle = composer.find(name);
        LookEntry* const entry = handle ? find_entry(look, name) : nullptr;
        if (entry == nullptr || composer.info(*handle) != entry->effect) continue;
        const EntryDesc& desc = *composer.desc(*handle);
        for (const ParamInfo& row : entry->effect->parameters.rows)
            if (row.kind != Kind::Resource)
                std::ranges::copy(composer.words(*handle).subspan(row.word, row.words),
                                  entry->words.begin() + row.word);
        entry->state.enabled = desc.enabled;
        const auto opacity = std::bit_cast<std::uint32_t>(desc.opacity);
        if (desc.opacity == entry->state.opacity) continue;
        DARKROOM_TRY(set_state(look, name, "opacity", {&opacity, 1}));
    }
    return {};
}

}  // namespace darkroom::edit
