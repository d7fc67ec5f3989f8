// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <darkroom/look.hpp>
#include <map>

#include "core/param_text.hpp"
#include "looks/look_parts.hpp"

namespace darkroom {

namespace {

// What is left of a flat table that is switched off: the effects that take the picture from one domain to the next.
bool is_domain_change(const EffectInfo& effect) {
    if (effect.makes == nullptr) return false;
    const void* const defaults = effect.parameters.defaults.data();
    for (const Domain before : {Domain::SceneLinear, Domain::DisplayLinear})
        if (effect.accepts.contains(before) && effect.makes(before, defaults) != before) return true;
    return false;
}

// An effect of the flat table that moves coordinates would part the kernel even while it is off, and every frame would
// pay for what nobody asked for.
bool is_in_the_way(const Look& look, const LookEntry& entry) {
    const EffectInfo& effect = *entry.effect;
    if (!look.is_flat || effect.touch != Touch::Warp) return false;
    return entry.state.enabled.on == 0 || (effect.is_identity != nullptr && effect.is_identity(entry.words.data()));
}

}  // namespace

Result<> apply(const Look& look, Composer& composer) {
    const std::vector<std::string> names = entry_names(look);
    std::map<std::string, Handle, std::less<>> outputs{{std::string(scene_name), scene_color}};
    for (const LookEntry* const entry : ordered(look)) {
        const std::size_t index = static_cast<std::size_t>(entry - look.entries.data());
        const bool is_kept = look.is_enabled || is_domain_change(*entry->effect);
        if ((look.is_flat && !is_kept) || is_in_the_way(look, *entry)) continue;
        const auto wire = [&](const std::string& name) {
            const auto found = outputs.find(name);
            return found == outputs.end() ? Handle{} : found->second;
        };
        for (const WireInfo& end : wires) {
            const std::string& name = entry->*end.member;
            if (end.is_reference && !name.empty() && !outputs.contains(name))
                return user_error(fmt::format("{}: {}: {} = \"{}\": no entry before it has this output",
                                              look.shown_name, names[index], end.key, printable(name)));
        }
        const EntryDesc desc{.input = wire(entry->input),
                             .source = look.is_flat ? scene_color : wire(entry->source),
                             .second = wire(entry->second),
                             .mask = wire(entry->mask),
                             .name = names[index],
                             .output = entry->output,
                             .enabled = look.is_enabled ? entry->state.enabled.on != 0 : true,
                             .opacity = entry->state.opacity,
                             .blend = entry->state.blend};
        const void* const words = look.is_enabled ? entry->words.data() : nullptr;
        const Handle handle = composer.add(*entry->effect, words, desc);
        if (!entry->output.empty()) outputs[entry->output] = handle;
    }
    return {};
}

}  // namespace darkroom
