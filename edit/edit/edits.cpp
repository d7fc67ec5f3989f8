// SPDX-License-Identifier: MIT
#include "edit/edits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/text/param_text.hpp"
#include "edit/effect_uses.hpp"
#include "looks/apply/look_resources.hpp"

namespace darkroom::edit {

namespace {

using Words = std::span<const std::uint32_t>;

Result<LookEntry*> entry_at(Look& look, std::string_view name) {
    if (LookEntry* const entry = find_entry(look, name)) return entry;
    const std::vector<std::string> names = entry_names(look);
    return user_error(
        fmt::format("{}: {} has no such entry, it has {}", printable(name), look.shown_name, fmt::join(names, ", ")));
}

/// Has somebody set more of it than its switch, or written it into the file?
bool is_set(const Look& look, const LookEntry& entry) {
    return entry.words != flat_entry(*entry.effect, look.order).words ||
           std::ranges::count(look.written, entry.effect, &WrittenValue::effect) > 0;
}

/// Makes a flat look the stack that it stands for. What is off keeps its place where a hand or a file has set it, and
/// each entry is wired as its effect needs.
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

/// The entry of this name in a look that was flat and is a stack now; it has a place even if it is off.
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

/// The entry of this name, whose value will be set: one of the interface is there with the whole of it.
Result<LookTarget> target_of(Look& look, std::string_view entry, std::string_view member) {
    if (const LookEntry* const found = find_entry(look, entry); found != nullptr && found->is_of_ui && !look.ui)
        add_ui(look);
    const std::string key = fmt::format("{}.{}", entry, member);
    return find_target(look, key, printable(key));
}

Result<> set_words(Look& look, LookTarget target, Words words, const std::string& shown) {
    const ParamInfo& row = *target.row;
    LookEntry& entry = *target.entry;
    if (row.kind == Kind::Resource) return user_error(fmt::format("{}: takes the name of a file", shown));
    DARKROOM_TRY(check_words(row, words, shown));
    std::ranges::copy(words, entry.words.begin() + row.word);
    if (const std::string conflict = conflict_of(entry); !conflict.empty()) return user_error(conflict);
    if (row.is_amount && look.is_flat && !entry.is_of_ui) entry.state.enabled = std::bit_cast<float>(words[0]) != 0;
    return {};
}

}  // namespace

Result<> set_value(Look& look, std::string_view entry, std::string_view parameter, Words words) {
    DARKROOM_TRY_VALUE(const LookTarget target, target_of(look, entry, parameter));
    const std::string shown = fmt::format("{}.{}", printable(entry), printable(parameter));
    if (target.row == nullptr || target.is_state)
        return user_error(fmt::format("{}: the effect has no such parameter", shown));
    return set_words(look, target, words, shown);
}

Result<> reset_value(Look& look, std::string_view entry, std::string_view parameter) {
    DARKROOM_TRY_VALUE(const LookTarget target, target_of(look, entry, parameter));
    if (target.row == nullptr || target.is_state)
        return user_error(
            fmt::format("{}.{}: the effect has no such parameter", printable(entry), printable(parameter)));
    const ParamInfo& row = *target.row;
    if (row.kind == Kind::Resource) return set_file(look, entry, parameter, {}, {});
    return set_value(look, entry, parameter, target.entry->effect->parameters.defaults.subspan(row.word, row.words));
}

Result<> reset_entry(Look& look, std::string_view entry) {
    DARKROOM_TRY_VALUE(LookEntry* const found, entry_at(look, entry));
    const std::span<const std::uint32_t> defaults = found->effect->parameters.defaults;
    found->words.assign(defaults.begin(), defaults.end());
    std::erase_if(found->resources,
                  [&](const LookResource& one) { return found->effect->parameters.find(one.parameter) != nullptr; });
    return {};
}

Result<> set_state(Look& look, std::string_view entry, std::string_view row, Words words) {
    if (row != "enabled") DARKROOM_TRY(restructured(look, entry));
    DARKROOM_TRY_VALUE(const LookTarget target, target_of(look, entry, row));
    const std::string shown = fmt::format("{}.{}", printable(entry), printable(row));
    if (!target.is_state) return user_error(fmt::format("{}: an entry has no such key", shown));
    DARKROOM_TRY(check_words(*target.row, words, shown));
    StateWords state = state_words(target.entry->state);
    std::ranges::copy(words, state.begin() + target.row->word);
    target.entry->state = std::bit_cast<EntryState>(state);
    return {};
}

Result<> set_wire(Look& look, std::string_view entry, std::string_view wire, const std::string& name,
                  const LookOptions& options) {
    DARKROOM_TRY_VALUE(LookEntry* const found, restructured(look, entry));
    const auto* const end = std::ranges::find(wires, wire, &WireInfo::key);
    const std::string shown = fmt::format("{}.{} = \"{}\"", printable(entry), printable(wire), printable(name));
    if (end == wires.end())
        return user_error(fmt::format("{}: allowed are name, input, source, second, mask, output", shown));
    std::string_view text = name;
    if (end->is_reference && is_file_name(text)) return ResourceFiles(options.folder, options).put(*found, *end, name);
    if (end->is_reference && text.ends_with(previous_suffix)) text.remove_suffix(previous_suffix.size());
    if (!text.empty() && !is_look_name(text))
        return user_error(fmt::format("{}: expected a name of letters, digits, '_' and '-'", shown));
    if (end->is_reference) return ResourceFiles(options.folder, options).put(*found, *end, name);
    (found)->*end->member = name;
    return {};
}

Result<> set_file(Look& look, std::string_view entry, std::string_view parameter, const std::string& file,
                  const LookOptions& options) {
    DARKROOM_TRY_VALUE(const LookTarget target, target_of(look, entry, parameter));
    const std::string shown = fmt::format("{}.{}", printable(entry), printable(parameter));
    if (target.row == nullptr || target.is_state || target.row->kind != Kind::Resource)
        return user_error(fmt::format("{}: takes no file", shown));
    Result<> done = ResourceFiles(options.folder, options).put(*target.entry, *target.row, file);
    if (!done) return user_error(fmt::format("{}: {}", shown, done.error().text));
    if (target.row->is_amount && look.is_flat && !target.entry->is_of_ui) target.entry->state.enabled = !file.empty();
    return {};
}

void take_look(Look& look, Look other, const std::filesystem::path& from, const std::filesystem::path& to) {
    const auto rename = [&](std::string& file) {
        if (file.empty() || std::filesystem::path(file).is_absolute()) return;
        std::error_code error;
        const std::filesystem::path named = std::filesystem::proximate(from / file, to.empty() ? "." : to, error);
        file = (error ? from / file : named).generic_string();
    };
    const std::vector<std::string> names = entry_names(look), other_names = entry_names(other);
    for (std::size_t i = 0; i < other.entries.size(); ++i) {
        LookEntry& entry = other.entries[i];
        for (LookResource& resource : entry.resources) {
            for (std::string* const wire : {&entry.input, &entry.source, &entry.second, &entry.mask})
                if (*wire == resource.file) rename(*wire);
            rename(resource.file);
        }
        rename(entry.effect_file);
        const auto same = std::ranges::find(names, other_names[i]);
        entry.id = same == names.end() ? 0 : look.entries[static_cast<std::size_t>(same - names.begin())].id;
    }
    for (LookLayer& layer : other.layers) rename(layer.file);
    if (other.ui) {
        rename(other.ui->document);
        for (std::string& script : other.ui->controllers) rename(script);
    }
    other.shown_name = look.shown_name;
    look = std::move(other);
}

// Edits that change which entries a look has, and in which order; and what comes back from a Composer.

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

ComposerValues::ComposerValues(const Composer& composer) {
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle handle = composer.entry(i);
        const EntryDesc& desc = *composer.desc(handle);
        const auto words = composer.words(handle);
        entries_[desc.name] = {{words.begin(), words.end()}, desc.enabled, desc.opacity};
    }
}

Result<> ComposerValues::take_changes(Look& look, const Composer& now) const {
    if (!look.is_enabled) return {};
    for (const std::string& name : entry_names(look)) {
        const auto handle = now.find(name);
        const auto before = entries_.find(name);
        LookEntry* const entry = handle && before != entries_.end() ? find_entry(look, name) : nullptr;
        if (entry == nullptr || now.info(*handle) != entry->effect) continue;
        const Entry& was = before->second;
        const EntryDesc& desc = *now.desc(*handle);
        const auto words = now.words(*handle);
        for (const ParamInfo& row : entry->effect->parameters.rows) {
            const auto is = words.subspan(row.word, row.words);
            if (row.kind != Kind::Resource &&
                !std::ranges::equal(is, std::span(was.words).subspan(row.word, row.words)))
                std::ranges::copy(is, entry->words.begin() + row.word);
        }
        if (desc.enabled != was.is_enabled) entry->state.enabled = desc.enabled;
        const auto opacity = std::bit_cast<std::uint32_t>(desc.opacity);
        if (desc.opacity != was.opacity) DARKROOM_TRY(set_state(look, name, "opacity", {&opacity, 1}));
    }
    return {};
}

}  // namespace darkroom::edit
