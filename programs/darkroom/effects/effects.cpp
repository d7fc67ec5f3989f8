// SPDX-License-Identifier: MIT
#include "effect_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <darkroom/custom_effect.hpp>
#include <darkroom/effect.hpp>
#include <memory>
#include <optional>

#include "core/text/param_text.hpp"
#include "plan/frame_inputs.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

using darkroom::EffectInfo;

struct Options {
    std::string name;
    bool is_json = false;
};

int print_json(std::span<const EffectInfo* const> effects) {
    Json out = Json::array();
    for (const EffectInfo* const effect : effects) out.push_back(effect_json(*effect));
    fmt::print("{}\n", out.dump(2));
    return exit_ok;
}

int list() {
    for (const darkroom::EffectInfo* const effect : darkroom::all_effects()) {
        const bool is_flat = effect->flat.documented >= 0 || effect->flat.scene_linear >= 0;
        const char* const place = !is_flat ? "stack only" : effect->flat.starts_on ? "on" : "off";
        fmt::print("{:<21} {:<10}  {}\n", effect->name, place, effect->doc);
    }
    return exit_ok;
}

int show(const Options& options) {
    const std::string& name = options.name;
    std::optional<darkroom::CustomEffect> custom;
    if (name.ends_with(".glsl")) {
        auto loaded = darkroom::CustomEffect::load(name);
        if (!loaded) return fail(loaded.error());
        custom = std::move(*loaded);
    }
    const EffectInfo* const effect = custom ? &custom->info() : darkroom::find_effect(name);
    if (effect == nullptr) {
        std::vector<std::string> names;
        for (const darkroom::EffectInfo* const known : darkroom::all_effects()) names.emplace_back(known->name);
        return fail_user(fmt::format("effects: no effect '{}'{}", darkroom::printable(name),
                                     darkroom::alternatives(name, names, "there are")));
    }
    if (options.is_json) return print_json({&effect, 1});
    const std::string page = fmt::format("{}.md", effect->name);
    const auto found = std::find_if(effect->files.begin(), effect->files.end(),
                                    [&](const darkroom::EffectFile& file) { return file.name == page; });
    if (found == effect->files.end())
        fmt::print("# {}\n\n{}\n", effect->name, effect->doc);
    else
        fmt::print("{}", found->text);
    if (effect->flat.toggle_key != 0) fmt::print("\nA viewer switches it by F{}.\n", effect->flat.toggle_key);
    fmt::print("\n## Parameters\n\n{}", darkroom::documentation(effect->parameters, effect->name));
    return exit_ok;
}

}  // namespace

static Command add_effects(CommandFlags program) {
    const CommandFlags command = program.add_command("effects", "Lists the effects, or shows the page of one");
    command.examples(
        "darkroom effects\n"
        "darkroom effects tonemap\n"
        "darkroom effects tonemap --json");
    const auto options = std::make_shared<Options>();
    std::vector<std::string_view> names;
    for (const EffectInfo* const effect : darkroom::all_effects()) names.push_back(effect->name);
    command.add_option("NAME", options->name, "An effect, or the file of one (.glsl); its page is shown")
        .option_text(fmt::format("{}", fmt::join(names, "|")));
    command.add_flag("--json", options->is_json, "For programs: parameters, flags and what effects need");
    return {command, [options] {
                if (!options->name.empty()) return show(*options);
                return options->is_json ? print_json(darkroom::all_effects()) : list();
            }};
}

CommandRow effects_command() {
    return {.names = {"effects"}, .place = 60, .add = [](const CommandHost& host) {
                return std::vector{add_effects(host.program)};
            }};
}

namespace {

std::string_view type_of(darkroom::Kind kind) {
    switch (kind) {
        case darkroom::Kind::Float:
            return "float";
        case darkroom::Kind::Int:
            return "int";
        case darkroom::Kind::Toggle:
            return "bool";
        case darkroom::Kind::Choice:
            return "choice";
        case darkroom::Kind::Vec2:
            return "vec2";
        case darkroom::Kind::Vec3:
            return "vec3";
        case darkroom::Kind::Vec4:
            return "vec4";
        case darkroom::Kind::Rgb:
            return "rgb";
        case darkroom::Kind::Curve:
            return "curve";
        case darkroom::Kind::Resource:
            return "resource";
    }
    return "";
}

Json json_of(const EffectInfo& effect, const darkroom::ParamInfo& row) {
    const std::string key = darkroom::flat_key(effect.name, row.name);
    Json out{{"name", row.name},
             {"key", key},
             {"flag", darkroom::flag_name(key)},
             {"type", type_of(row.kind)},
             {"doc", row.doc},
             {"default", Json::value_or_text(darkroom::format(row, effect.parameters.defaults))},
             {"switches_effect", row.is_amount || row.switched_word < effect.parameters.words()},
             {"at_compile", row.is_at_compile}};
    if (row.kind == darkroom::Kind::Choice)
        out["choices"] = row.choices;
    else if (row.kind != darkroom::Kind::Toggle && row.kind != darkroom::Kind::Resource)
        out.update({{"min", row.range.min}, {"max", row.range.max}, {"unit", row.unit.symbol}});
    return out;
}

}  // namespace

Json effect_json(const EffectInfo& effect) {
    Json needs = Json::array(), rows = Json::array();
    for (const darkroom::plan::FrameInput& input : darkroom::plan::frame_inputs)
        if (effect.needs.contains(input.image)) needs.push_back(input.name);
    if (effect.needs.perspective) needs.push_back("perspective");
    if (effect.has_second()) needs.push_back("second");
    for (const darkroom::ParamInfo& row : effect.parameters.rows) rows.push_back(json_of(effect, row));
    const bool is_flat = effect.flat.documented >= 0 || effect.flat.scene_linear >= 0;
    return {{"name", effect.name},
            {"doc", effect.doc},
            {"is_flat", is_flat},
            {"starts_on", is_flat && effect.flat.starts_on},
            {"flag", darkroom::flag_name(darkroom::flat_key(effect.name, "enabled"))},
            {"toggle_key", effect.flat.toggle_key},
            {"needs", std::move(needs)},
            {"parameters", std::move(rows)}};
}

}  // namespace app
