// SPDX-License-Identifier: MIT
// Looks: what is read is written so that it reads back the same, and strictness turns warnings into errors.

#include <fmt/format.h>

#include <algorithm>
#include <darkroom/look.hpp>

#include "edit/follow/compare.hpp"
#include "fuzz/target.hpp"

namespace darkroom::fuzz::look_fuzz {
namespace {

LookOptions options_of(std::vector<std::string>* warnings) {
    return {.is_strict = warnings == nullptr,
            .warnings = warnings,
            .load_resource = [](const std::filesystem::path&, FileUse use) -> Result<ResourceData> {
                if (use != FileUse::Table) return ResourceImage{.width = 1, .height = 1, .rgba = {0, 0.5f, 1, 1}};
                return ColorTable{.shaper_size = 2, .shaper = {0, 0, 0, 1, 1, 1}};
            },
            .reads_tables = false,
            .folder = "/nowhere"};
}

std::string run(std::string_view input) {
    std::vector<std::string> warnings;
    const Result<Look> look = parse_look(input, "a.toml", options_of(&warnings));
    for (const std::string& warning : warnings)
        if (std::string wrong = wrong_line(warning); !wrong.empty()) return wrong;
    const Result<Look> strict = parse_look(input, "a.toml", options_of(nullptr));
    if (strict.has_value() != (look.has_value() && warnings.empty()))
        return fmt::format("{} when read strictly, with {} warnings else", strict ? "accepted" : strict.error().text,
                           warnings.size());
    if (!look) return look.error().text.starts_with("a.toml:") ? wrong_error(look.error()) : "an error names no place";

    const std::string text = write_look(*look);
    const Result<Look> again = parse_look(text, "a.toml", options_of(nullptr));
    if (!again) return fmt::format("what is written is refused: {}\n{}", again.error().text, text);
    if (!edit::says_same(*again, *look)) return "what is written reads as another look:\n" + text;
    const std::string twice = write_look(*again);
    return twice == text ? std::string() : fmt::format("written twice:\n{}\n{}", text, twice);
}

std::vector<std::string> seeds() {
    std::vector<std::string> out = files("looks/*.toml");
    for (const char* const pattern : {"scenes/*.toml", "data/hostile/*.toml"})
        std::ranges::move(files(pattern), std::back_inserter(out));
    for (const LookOrder order : {LookOrder::Documented, LookOrder::SceneLinear})
        out.push_back(write_look(default_look(order)));
    out.emplace_back(
        "[[stack]]\neffect = \"gaussian_blur\"\nradius = 4\noutput = \"b\"\nscale = 0.5\nformat = \"rgba16f\"\n"
        "[[stack]]\neffect = \"blend\"\nsource = \"b.previous\"\nmask = \"m.png\"\nopacity = 0.5\nblend = \"add\"\n"
        "[[stack]]\neffect = \"lut\"\ntable = \"t.cube\"\n"
        "[[pulse]]\nevent = \"hit\"\nentry = \"blend\"\nparameter = \"opacity\"\namount = 1\nduration = 2\n"
        "[[layer]]\nname = \"night\"\nweight = 0.5\nvalues = { \"blend.opacity\" = 0.2 }\n");
    out.emplace_back(
        "[ui]\ndocument = \"a.svg\"\ncontrollers = [\"a.lua\"]\ngame = { health = 1, name = \"x\" }\nui_layers = 2\n");
    return out;
}

const Registration look({.name = "look", .run = run, .seeds = seeds, .longest = 16384});

}  // namespace
}  // namespace darkroom::fuzz::look_fuzz
