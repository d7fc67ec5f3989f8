// SPDX-License-Identifier: MIT
// What keys name in a look: "bloom_intensity", "bloom#2.intensity", "blurred.opacity".
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <darkroom/effect.hpp>

#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"

namespace darkroom {

namespace {

const ParamInfo* find_state_row(std::string_view name) {
    for (const ParamInfo& row : entry_rows.rows)
        if (row.name == name) return &row;
    return nullptr;
}

class Finder {
  public:
    explicit Finder(Look& look) : look_(look) {}

    Result<LookTarget> find(std::string_view key, const std::string& shown) const {
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
            return LookTarget{entry, is_toggle ? find_state_row("enabled") : row, is_toggle, nullptr};
        }
        return user_error(fmt::format("{}: no effect has this parameter{}", shown, suggestion(key, all_keys())));
    }

  private:
    Result<LookTarget> find_in_entry(std::string_view name, std::string_view member, const std::string& shown) const {
        LookEntry* const entry = find_entry(look_, name);
        if (entry == nullptr) return unheld(shown, name);
        if (const ParamInfo* const row = find_state_row(member)) return LookTarget{entry, row, true, nullptr};
        if (const ParamInfo* const row = entry->effect->parameters.find(member))
            return LookTarget{entry, row, false, nullptr};
        std::vector<std::string> members;
        for (const WireInfo& wire : wires) {
            if (!wire.is_reference) continue;
            if (wire.key == member) return LookTarget{.entry = entry, .wire = &wire};
            members.emplace_back(wire.key);
        }
        for (const ParamInfo& row : entry_rows.rows) members.emplace_back(row.name);
        for (const ParamInfo& row : entry->effect->parameters.rows) members.emplace_back(row.name);
        return user_error(fmt::format("{}: '{}' has no parameter '{}'{}", shown, printable(name), printable(member),
                                      alternatives(member, members, "it has")));
    }

    Failure unheld(const std::string& shown, std::string_view name) const {
        const std::vector<std::string> names = entry_names(look_);
        if (names.empty()) return user_error(fmt::format("{}: {} has no entries", shown, look_.shown_name));
        return user_error(fmt::format("{}: {} has no entry '{}'{}", shown, look_.shown_name, printable(name),
                                      alternatives(name, names, "it has")));
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
};

}  // namespace

// Names are typed at a command line ("blurred.radius"), so they hold no dot, no '#', no blank.
bool is_look_name(std::string_view text) {
    constexpr std::size_t longest = 64;
    const auto is_part = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    };
    return !text.empty() && text.size() <= longest && std::all_of(text.begin(), text.end(), is_part);
}

Result<LookTarget> find_target(Look& look, std::string_view key, const std::string& shown) {
    return Finder(look).find(key, shown);
}

}  // namespace darkroom
