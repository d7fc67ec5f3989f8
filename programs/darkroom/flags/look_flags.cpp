// SPDX-License-Identifier: MIT
#include "look_flags.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <darkroom/effect.hpp>

#include "core/text/param_text.hpp"
#include "image/table/resource_file.hpp"
#include "looks/look_parts.hpp"
#include "programs/darkroom/effects/named_effects.hpp"
#include "programs/darkroom/help/help.hpp"
#include "programs/darkroom/run/report.hpp"
#include "programs/darkroom/run/ui_source.hpp"

namespace app {

using darkroom::Look;
using darkroom::LookOverride;
using darkroom::Result;
using darkroom::user_error;

bool is_scene_name(const std::filesystem::path& path) { return path.filename().string().ends_with(".scene.toml"); }

namespace {

// What a flag takes, as help and completions show it.
std::string shown_value(const darkroom::ParamInfo& row) {
    switch (row.kind) {
        case darkroom::Kind::Choice:
            return fmt::format("{}", fmt::join(row.choices, "|"));
        case darkroom::Kind::Toggle:
            return "on|off";
        case darkroom::Kind::Resource:
            return "FILE";
        case darkroom::Kind::Vec2:
            return "X,Y";
        case darkroom::Kind::Vec3:
            return "X,Y,Z";
        case darkroom::Kind::Vec4:
            return "X,Y,Z,W";
        case darkroom::Kind::Rgb:
            return "R,G,B";
        case darkroom::Kind::Curve:
            return "X:Y,...";
        default:
            return "N";
    }
}

// The values of a command stay as they are, so what is off needs no place among the passes, no images and no kernels.
// What changes the domain stays: an encoding that is off is not the same as none.
void drop_what_is_off(Look& look) {
    if (!look.is_flat || !look.is_enabled) return;
    // Controllers move the interface, also where it is at rest.
    const bool has_controllers = !interface_of(look).controllers.empty();
    std::erase_if(look.entries, [&](const darkroom::LookEntry& entry) {
        const darkroom::EffectInfo& effect = *entry.effect;
        if (darkroom::is_moved(look, effect.name) || (entry.is_of_ui && has_controllers)) return false;
        const bool is_identity = effect.is_identity != nullptr && effect.is_identity(entry.words.data());
        return effect.makes == nullptr && (entry.state.enabled.on == 0 || is_identity);
    });
}

}  // namespace

LookFlags::Value& LookFlags::add_value(std::string key, std::string flag) {
    return *values_.emplace_back(std::make_unique<Value>(Value{.key = std::move(key), .flag = std::move(flag)}));
}

void LookFlags::add_flag(CommandFlags command, const std::string& key, const std::string& value,
                         const std::string& help, const std::string& group) {
    // Of an effect of a file that has the name of another flag; --set reaches it still.
    if (command.has(darkroom::flag_name(key))) return;
    Value& to = add_value(key, darkroom::flag_name(key));
    to.option = command.add_option(to.flag, to.text, help).group(group).type_name("").option_text(value).last_counts();
}

void LookFlags::add_switch(CommandFlags command, const darkroom::EffectInfo& effect, const std::string& group) {
    const std::string on = darkroom::flag_name(effect.name), off = "--no-" + on.substr(2);
    // A parameter that bears its effect's name (--exposure 2) has the name to itself.
    const bool is_value = std::ranges::any_of(effect.parameters.rows, [&](const darkroom::ParamInfo& row) {
        return darkroom::flat_key(effect.name, row.name) == effect.name;
    });
    std::string names;
    if (!is_value && !command.has(on)) names = on;
    if (!command.has(off)) names += (names.empty() ? "!" : ",!") + off;
    if (names.empty()) return;
    Value& to = add_value(darkroom::flat_key(effect.name, "enabled"), names.starts_with('!') ? off : on);
    to.option = command.add_flag(names, to.text, "Switches it on or off").group(group).type_name("");
}

void LookFlags::add_effect(CommandFlags command, const darkroom::EffectInfo& effect) {
    const std::string title = effect_group(effect.name, effect.doc);
    add_switch(command, effect, title);
    add_flag(command, darkroom::flat_key(effect.name, "enabled"), "on|off", "The same", title);
    for (const darkroom::ParamInfo& row : effect.parameters.rows)
        add_flag(command, darkroom::flat_key(effect.name, row.name), shown_value(row),
                 fmt::format("{} {}, default {}", darkroom::full_doc(row), darkroom::interval(row),
                             darkroom::format(row, effect.parameters.defaults)),
                 title);
}

void LookFlags::add_to(CommandFlags command, bool has_look_flag, std::span<const darkroom::LookEntry> named) {
    command_ = command;
    const std::string group = "The look";
    if (has_look_flag)
        command.add_option("--look", file, "A look (TOML), a scene, or one that ships: night; default: the scene's")
            .names_look()
            .type_name("FILE")
            .group(group);
    command.add_option("--layer", layers_, "A look file, or one that ships, whose [post_process] is laid over the look")
        .names_look()
        .type_name("FILE")
        .repeated()
        .group(group);
    command.add_option("--ui", ui_file_, "The interface over the picture: an image with alpha, or an SVG document")
        .type_name("FILE")
        .group(group);
    command.add_option("--game", game_, "Value that a document's binding {{NAME}} shows: health=80")
        .type_name("NAME=VALUE")
        .repeated()
        .group(group);
    if (has_look_flag)
        command.add_option("--events", events, "Events that change the look: a file of [[event]]s (TOML)")
            .type_name("FILE")
            .group(group);
    command.add_option("--order", order_, "Order of the flat table").type_name("documented|scene_linear").group(group);
    command.add_option("--set", sets_, "Any parameter of an entry, by its name: bloom#2.intensity=0.3")
        .type_name("ENTRY.PARAM=VALUE")
        .repeated()
        .group(group);
    command.add_flag("--strict", is_strict_, "Unknown keys and values out of range in a look are errors").group(group);
    command.add_flag("--no-postprocess", is_off_, "Leaves the look's exposure, default tone mapping and encoding")
        .group(group);
    command
        .add_option("--effect", effect_files_,
                    "An effect of your own, as late in the look as it can be; it has flags, too")
        .type_name("FILE.glsl")
        .repeated()
        .group(group);
    command
        .add_flag(no_custom_effects, has_no_custom_effects_,
                  "Refuses a look that names the file of an effect: such files are code")
        .group(group);
    for (const darkroom::EffectInfo* const effect : darkroom::all_effects()) add_effect(command, *effect);
    for (const darkroom::LookEntry& entry : named) add_effect(command, *entry.effect);
}

Result<std::vector<LookOverride>> LookFlags::overrides() const {
    std::vector<const Value*> typed;
    for (const std::unique_ptr<Value>& value : values_)
        if (value->option.count() > 0) typed.push_back(value.get());
    // What was typed last counts, also among flags that say the same in two ways.
    std::ranges::sort(typed, {}, [&](const Value* value) { return command_->place(value->option); });
    std::vector<LookOverride> out;
    for (const Value* const value : typed) out.push_back({value->key, value->text, value->flag});
    for (const std::string& set : sets_) {
        const std::size_t equals = set.find('=');
        if (equals == std::string::npos || equals == 0)
            return user_error(fmt::format("--set {}: expected ENTRY.PARAM=VALUE", darkroom::printable(set)));
        const std::string key = set.substr(0, equals);
        out.push_back({key, set.substr(equals + 1), "--set " + key});
    }
    return out;
}

Result<> LookFlags::add_custom_effects(Look& look) const {
    for (const std::string& name : effect_files_) {
        if (has_no_custom_effects_)
            return user_error(fmt::format("--effect {}: {} refuses it", darkroom::printable(name), no_custom_effects));
        DARKROOM_TRY_VALUE(darkroom::LookEntry entry, darkroom::custom_entry(name));
        if (const Result<> shared = darkroom::share_effect(look, entry); !shared)
            return user_error(fmt::format("{}: {}", darkroom::printable(name), shared.error().text));
        look.entries.push_back(std::move(entry));
    }
    return {};
}

void resolve_ui(Look& look, const std::filesystem::path& folder) {
    if (!look.ui) return;
    if (!look.ui->document.empty()) look.ui->document = (folder / look.ui->document).string();
    for (std::string& script : look.ui->controllers) script = (folder / script).string();
}

Result<> LookFlags::set_ui(Look& look) const {
    if (!ui_file_.empty()) {
        darkroom::add_ui(look);
        look.ui->document = ui_file_;
    }
    for (const std::string& set : game_) {
        const std::size_t equals = set.find('=');
        if (equals == std::string::npos || equals == 0)
            return user_error(fmt::format("--game {}: expected NAME=VALUE", darkroom::printable(set)));
        if (!look.ui) return user_error("--game: there is no interface; --ui or a look's table [ui] brings one");
        const std::string name = set.substr(0, equals), value = set.substr(equals + 1);
        double number = 0;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
        const bool is_number = error == std::errc() && end == value.data() + value.size() && std::isfinite(number);
        if (is_number)
            look.ui->game.insert_or_assign(name, number);
        else
            look.ui->game.insert_or_assign(name, value);
    }
    return {};
}

Result<> LookFlags::lay_layers(Look& look) const {
    std::vector<std::string> warnings;
    darkroom::LookOptions how = options(&warnings);
    Result<> done;
    for (std::size_t i = 0; i < layers_.size() && done; ++i) {
        how.is_scene = is_scene_name(layers_[i]);
        done = darkroom::lay_over(look, layers_[i], how);
    }
    for (const std::string& warning : warnings) warn(warning);
    return done;
}

std::vector<std::filesystem::path> LookFlags::input_files() const {
    std::vector<std::filesystem::path> files = read_->all();
    files.insert(files.end(), layers_.begin(), layers_.end());
    for (const std::string& one : {file, events})
        if (!one.empty()) files.emplace_back(one);
    return files;
}

Result<> LookFlags::set_order(Look& look) const {
    if (order_.empty()) return {};
    if (!look.is_flat)
        return user_error(
            fmt::format("--order {}: {} has an explicit stack", darkroom::printable(order_), look.shown_name));
    if (order_ == "documented")
        darkroom::set_order(look, darkroom::LookOrder::Documented);
    else if (order_ == "scene_linear")
        darkroom::set_order(look, darkroom::LookOrder::SceneLinear);
    else
        return user_error(
            fmt::format("--order {}: allowed is documented or scene_linear", darkroom::printable(order_)));
    return {};
}

darkroom::LookOptions LookFlags::options(std::vector<std::string>* warnings) const {
    return {.is_strict = is_strict_,
            .warnings = warnings,
            .is_scene = file.empty() || is_scene_name(file),
            .allows_custom_effects = !has_no_custom_effects_,
            .load_resource = [read = read_](const std::filesystem::path& path, darkroom::FileUse use) {
                const bool is_new = read->add(path);
                std::vector<std::string> told;
                Result<darkroom::ResourceData> found = darkroom::load_resource_file(path, use, told);
                for (const std::string& line : told)
                    if (is_new) warn(line);
                return found;
            }};
}

bool LookFlags::change_anything() const {
    return !layers_.empty() || !ui_file_.empty() || !game_.empty() || !order_.empty() || !sets_.empty() ||
           !effect_files_.empty() ||
           std::ranges::any_of(values_, [](const auto& value) { return value->option.count() > 0; });
}

Result<> LookFlags::change(Look& look, bool keeps_what_is_off) const {
    DARKROOM_TRY(lay_layers(look));
    DARKROOM_TRY(set_ui(look));
    DARKROOM_TRY(set_order(look));
    // They have no place before it is known what is on, but values already.
    DARKROOM_TRY(add_custom_effects(look));
    DARKROOM_TRY_VALUE(const std::vector<LookOverride> values, overrides());
    DARKROOM_TRY(darkroom::override_look(look, values, options(nullptr)));
    if (!keeps_what_is_off)
        for (const std::string& text : darkroom::values_without_effect(look, values)) warn(text);
    const auto first = look.entries.end() - static_cast<std::ptrdiff_t>(effect_files_.size());
    const std::vector<darkroom::LookEntry> customs(first, look.entries.end());
    look.entries.erase(first, look.entries.end());
    if (!keeps_what_is_off) drop_what_is_off(look);
    for (const darkroom::LookEntry& entry : customs) DARKROOM_TRY(darkroom::place_entry(look, entry));
    return {};
}

Result<Look> LookFlags::look(const std::filesystem::path& scene, const darkroom::CameraLens& lens) const {
    return look(file.empty() ? scene : std::filesystem::path(file), darkroom::default_look(), lens);
}

Result<Look> LookFlags::look_of_frames() const { return look(file, darkroom::default_look_of_traced_light(), {}); }

Result<Look> LookFlags::look(const std::filesystem::path& path, const Look& without_path,
                             const darkroom::CameraLens& lens) const {
    std::vector<std::string> warnings;
    Result<Look> look = path.empty() ? Result<Look>(without_path) : darkroom::read_look(path, options(&warnings), lens);
    for (const std::string& warning : warnings) warn(warning);
    if (!look) return look;
    resolve_ui(*look, path.parent_path());
    DARKROOM_TRY(change(*look, !events.empty()));
    if (is_off_) *look = darkroom::switched_off(*look);
    return look;
}

}  // namespace app
