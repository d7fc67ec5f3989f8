// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "image/table/resource_file.hpp"
#include "info_documents.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/look_parts.hpp"
#include "scene/read/scene_file.hpp"
#include "toml/toml_text.hpp"

namespace app::info {

using darkroom::Result;

namespace {

void add_values(Json& out, const darkroom::LookEntry& entry) {
    for (const darkroom::ParamInfo& row : entry.effect->parameters.rows) {
        const std::string value = darkroom::value_text(entry, row);
        if (value != darkroom::format(row, entry.effect->parameters.defaults))
            out[std::string(row.name)] = Json::value_or_text(value);
    }
}

Json wires_of(const darkroom::LookEntry& entry) {
    Json out = Json::object();
    for (const darkroom::WireInfo& wire : darkroom::wires)
        if (wire.member != &darkroom::LookEntry::name && !(entry.*wire.member).empty())
            out[std::string(wire.key)] = entry.*wire.member;
    return out;
}

Json look_of(const darkroom::Look& look) {
    Json out{{"form", look.is_flat ? "[post_process]" : "[[stack]]"}};
    if (look.is_flat) {
        out["order"] = darkroom::order_names[static_cast<std::size_t>(look.order)];
        out["enabled"] = look.is_enabled;
    }
    out["entries"] = entries_of(look);
    return out;
}

}  // namespace

Json entries_of(const darkroom::Look& look) {
    const std::vector<std::string> names = darkroom::entry_names(look);
    Json out = Json::array();
    for (const darkroom::LookEntry* const entry : darkroom::ordered(look)) {
        const darkroom::EffectInfo& effect = *entry->effect;
        Json values = Json::object();
        add_values(values, *entry);
        if (entry->state.opacity != 1) values["opacity"] = entry->state.opacity;
        const darkroom::EntryState plain;
        if (entry->state.blend != plain.blend)
            values["blend"] = Json::value_or_text(
                darkroom::format(*darkroom::entry_rows.find("blend"), darkroom::state_words(entry->state)));
        const bool is_on =
            entry->state.enabled.on != 0 && (effect.is_identity == nullptr || !effect.is_identity(entry->words.data()));
        if (look.is_flat && !is_on && values.empty()) continue;
        Json row{{"entry", names[static_cast<std::size_t>(entry - look.entries.data())]},
                 {"effect", effect.name},
                 {"is_on", is_on},
                 {"values", std::move(values)}};
        if (!entry->effect_file.empty()) row["file"] = entry->effect_file;
        if (Json wires = wires_of(*entry); !wires.empty()) row["wires"] = std::move(wires);
        out.push_back(std::move(row));
    }
    return out;
}

Result<Json> toml(const std::filesystem::path& path, bool allows_custom_effects,
                  darkroom::scene::NamedFiles named_files) {
    DARKROOM_TRY_VALUE(const std::string text, darkroom::scene::reading::read_scene_text(path));
    const std::string shown = path.string();
    DARKROOM_TRY_VALUE(const ::toml::table file, darkroom::parse_toml(text, shown));
    const bool is_scene = darkroom::scene::reading::is_scene(file), has_look = darkroom::scene::reading::has_look(file);
    if (!is_scene && !has_look)
        return darkroom::user_error(fmt::format(
            "{}: is neither a scene nor a look: it has no table [entities], [post_process] or [[stack]], nor any other "
            "of theirs",
            darkroom::printable(shown)));
    Json out{{"kind", is_scene ? "scene" : "look"}};
    if (is_scene) {
        DARKROOM_TRY_VALUE(const Json found, scene(text, path, named_files));
        out.update(found);
    }
    if (!has_look) return out;
    std::vector<std::string> warnings;
    DARKROOM_TRY_VALUE(const darkroom::Look look, darkroom::parse_look(text, shown,
                                                                       {.warnings = &warnings,
                                                                        .is_scene = is_scene,
                                                                        .allows_custom_effects = allows_custom_effects,
                                                                        .load_resource = darkroom::load_resource_file,
                                                                        .folder = path.parent_path()}));
    if (is_scene)
        out["look"] = look_of(look);
    else
        out.update(look_of(look));
    for (std::string& warning : warnings) out["warnings"].push_back(std::move(warning));
    return out;
}

}  // namespace app::info
