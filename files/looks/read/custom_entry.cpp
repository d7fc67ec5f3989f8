// SPDX-License-Identifier: MIT
// Effects of files as entries, and their place in a look that does not name them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <darkroom/custom_effect.hpp>
#include <darkroom/describe.hpp>
#include <darkroom/look.hpp>

#include "core/caught.hpp"
#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"

namespace darkroom {

namespace {

std::string names_of(Domains domains) {
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < detail::Enumerators<Domain>::count; ++i)
        if (domains.contains(static_cast<Domain>(i))) names.push_back(detail::Enumerators<Domain>::names[i]);
    return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

void make_stack(Look& look) {
    std::vector<LookEntry> entries;
    for (const LookEntry* const entry : ordered(look)) {
        const bool is_own = look.is_enabled || entry->effect->exposure != nullptr;
        if (!is_domain_change(*entry->effect) && (!is_own || entry->state.enabled.on == 0)) continue;
        entries.push_back(is_own ? *entry : entry_of(*entry->effect));
        if (!entry->is_of_ui && look.order == LookOrder::Documented) entries.back().source = scene_name;
        entries.back().is_of_ui = entry->is_of_ui;
    }
    look.entries = std::move(entries);
    look.is_flat = false;
    look.was_flat = true;
    look.is_enabled = true;
}

Result<> share_effect(const Look& look, LookEntry& entry) {
    const std::string_view name = entry.effect->name;
    const auto found = std::ranges::find(look.entries, name, [](const LookEntry& other) { return other.effect->name; });
    if (found == look.entries.end()) return {};
    if (!std::ranges::equal(found->effect->files, entry.effect->files, {}, &EffectFile::text, &EffectFile::text))
        return user_error(
            fmt::format("its effect '{}' has the name of another, that of {}", name, printable(found->effect_file)));
    entry.effect = found->effect;
    entry.effect_owner = found->effect_owner;
    return {};
}

Result<LookEntry> custom_entry(const std::filesystem::path& file) try {
    DARKROOM_TRY_VALUE(const CustomEffect effect, CustomEffect::load(file));
    LookEntry entry = entry_of(effect.info());
    entry.effect_file = file.string();
    return entry;
} catch (...) {
    return caught("custom_entry");
}

Result<> place_entry(Look& look, LookEntry entry) try {
    if (const Result<> shared = share_effect(look, entry); !shared)
        return user_error(fmt::format("{}: {}", printable(entry.effect_file), shared.error().text));
    if (look.is_flat) make_stack(look);
    const Domains accepts = entry.effect->accepts;
    Domain domain = Domain::SceneLinear;
    auto place = look.entries.end();
    bool is_found = accepts.contains(domain);
    if (is_found) place = look.entries.begin();
    for (auto other = look.entries.begin(); other != look.entries.end(); ++other) {
        const EffectInfo& effect = *other->effect;
        if (other->is_of_ui) continue;
        if (effect.makes != nullptr && other->state.enabled.on != 0)
            domain = effect.makes({.domain = domain}, other->words.data()).domain;
        if (!accepts.contains(domain)) continue;
        place = other + 1;
        is_found = true;
    }
    if (!is_found)
        return user_error(fmt::format("{}{}{} accepts {}, but no place of {} has such a picture",
                                      printable(entry.effect_file), entry.effect_file.empty() ? "" : ": ",
                                      entry.effect->name, names_of(accepts), look.shown_name));
    look.entries.insert(place, std::move(entry));
    return {};
} catch (...) {
    return caught("place_entry");
}

}  // namespace darkroom
