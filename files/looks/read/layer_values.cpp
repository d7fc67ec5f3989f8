// SPDX-License-Identifier: MIT
// A layer that is a look of its own: the values in which that look differs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

#include "core/try.hpp"
#include "looks/look_parts.hpp"

namespace darkroom {

namespace {

/// Has this entry no part in the picture, as its look has it?
bool is_idle(const LookEntry& entry) {
    const EffectInfo& effect = *entry.effect;
    return entry.state.enabled.on == 0 || (effect.is_identity != nullptr && effect.is_identity(entry.words.data()));
}

/// What the entry is in the layer's look, where it has a part in either picture.
void add_difference(LookEntry& entry, const std::string& name, Look& other, std::vector<LookLayer::Value>& values) {
    // A look that says nothing of the interface leaves it as it is.
    if (entry.is_of_ui && !other.ui) return;
    const auto add = [&](const ParamInfo& row, std::span<const std::uint32_t> words) {
        const auto own = words.subspan(row.word, row.words);
        values.push_back({name, std::string(row.name), {own.begin(), own.end()}});
    };
    const LookEntry* const there = find_entry(other, name);
    LookEntry layered = there == nullptr ? entry : *there;
    if (there == nullptr) layered.state.enabled = false;
    if (is_idle(entry) && is_idle(layered)) return;
    wake(is_idle(entry) ? entry : layered);
    const StateWords state = state_words(layered.state), base = state_words(entry.state);
    for (const ParamInfo& row : entry_rows.rows)
        if ((row.name == "enabled" || row.name == "opacity") && state[row.word] != base[row.word]) add(row, state);
    for (const ParamInfo& row : entry.effect->parameters.rows)
        if (row.kind != Kind::Resource) add(row, layered.words);
}

}  // namespace

Result<std::vector<LookLayer::Value>> layer_values(Look& look, const std::string& file, const LookOptions& options) {
    LookOptions own_options = options;
    own_options.allows_modulation = false;
    own_options.is_scene = false;
    own_options.folder.clear();
    DARKROOM_TRY_VALUE(Look other, read_look(options.folder / file, own_options));
    const std::vector<std::string> names = entry_names(look), others = entry_names(other);
    for (std::size_t i = 0; i < others.size(); ++i) {
        const LookEntry* const own = find_entry(look, others[i]);
        if (own != nullptr ? own->effect == other.entries[i].effect : is_idle(other.entries[i])) continue;
        return user_error(fmt::format("its entry '{}' ({}) is not in this look, which has {}", others[i],
                                      other.entries[i].effect->name, fmt::join(names, ", ")));
    }
    std::vector<LookLayer::Value> values;
    for (std::size_t i = 0; i < names.size(); ++i) add_difference(look.entries[i], names[i], other, values);
    return values;
}

}  // namespace darkroom
