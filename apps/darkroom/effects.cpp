// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/effects.hpp>
#include <memory>

#include "commands.hpp"
#include "core/param_text.hpp"
#include "report.hpp"

namespace app {

namespace {

int list() {
    for (const darkroom::EffectInfo* const effect : darkroom::all_effects()) {
        const bool is_flat = effect->flat.documented >= 0 || effect->flat.scene_linear >= 0;
        const char* const place = !is_flat ? "stack only" : effect->flat.starts_on ? "on" : "off";
        fmt::print("{:<21} {:<10}  {}\n", effect->name, place, effect->doc);
    }
    return exit_ok;
}

int show(const std::string& name) {
    const darkroom::EffectInfo* const effect = darkroom::find_effect(name);
    if (effect == nullptr) {
        std::vector<std::string> names;
        for (const darkroom::EffectInfo* const known : darkroom::all_effects()) names.emplace_back(known->name);
        return fail_user(fmt::format("effects: no effect '{}': there are {}{}", darkroom::printable(name),
                                     fmt::join(names, ", "), darkroom::suggestion(name, names)));
    }
    const std::string page = fmt::format("{}.md", effect->name);
    const auto found = std::find_if(effect->files.begin(), effect->files.end(),
                                    [&](const darkroom::EffectFile& file) { return file.name == page; });
    if (found == effect->files.end())
        fmt::print("# {}\n\n{}\n", effect->name, effect->doc);
    else
        fmt::print("{}", found->text);
    fmt::print("\n## Parameters\n\n{}", darkroom::documentation(effect->parameters, effect->name));
    return exit_ok;
}

}  // namespace

Command add_effects(CLI::App& program) {
    CLI::App* const command = program.add_subcommand("effects", "Lists the effects, or shows the page of one");
    const auto name = std::make_shared<std::string>();
    command->add_option("NAME", *name, "An effect; its page is shown");
    return {command, [name] { return name->empty() ? list() : show(*name); }};
}

}  // namespace app
