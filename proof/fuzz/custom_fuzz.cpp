// SPDX-License-Identifier: MIT
// Effects of users: a description is refused with its line, or makes an effect
// that a stack takes and plans. What the GLSL behind it says is the compiler's
// matter.

#include <fmt/format.h>

#include <algorithm>
#include <darkroom/composer.hpp>
#include <darkroom/custom_effect.hpp>

#include "fuzz/target.hpp"

namespace darkroom::fuzz::custom_fuzz {
namespace {

std::string run(std::string_view input) {
    const Result<CustomEffect> effect = CustomEffect::parse(input, "a.glsl");
    if (!effect)
        return effect.error().text.starts_with("a.glsl:") ? wrong_error(effect.error())
                                                          : "an error names no place: " + effect.error().text;
    const EffectInfo& info = effect->info();
    if (info.parameters.defaults.size() != info.parameters.words()) return "there are other defaults than words";
    Composer composer(Device::assumed());
    // Twice, since their names meet in one kernel.
    for (int i = 0; i < 2; ++i) composer.add(info, nullptr, {.second = info.has_second() ? scene_color : Handle{}});
    const Result<Plan> plan = composer.plan({.max_extent = {64, 48},
                                             .depth = {VK_FORMAT_D32_SFLOAT},
                                             .normals = {VK_FORMAT_R16G16B16A16_SFLOAT},
                                             .velocity = {VK_FORMAT_R16G16_SFLOAT}});
    if (!plan) return wrong_error(plan.error());
    return plan->passes.empty() ? "nothing is planned" : std::string();
}

/// What stands between ```glsl and ``` of a page.
std::vector<std::string> seeds() {
    std::vector<std::string> out;
    for (const std::string& page : files("docs/*custom_effects.md"))
        for (std::size_t at = page.find("```glsl\n"); at != std::string::npos; at = page.find("```glsl\n", at)) {
            at += 8;
            const std::string code = page.substr(at, page.find("```", at) - at);
            out.push_back(code);
            if (code.find("@effect") == std::string::npos) out.push_back("// @effect made: Is made.\n" + code);
        }
    out.emplace_back(
        "// @effect all: Has all kinds.\n// @param float a = 1 in [0, 2] m log "
        "amount: One.\n"
        "// @param int n = 3 in [1, 8]: Two.\n// @param rgb c = 1, 0, 0 in [0, "
        "4]: Three.\n"
        "// @param choice k = one | two: Four.\n// @param toggle t = on: "
        "Five.\n// @param vec2 v = 0, 1 in [-1, 1]: Six.\n"
        "// @image half: 1/2 rgba16f\n// @history kept: 1 r11g11b10f\n// @table "
        "w: 3x1 r32f = 0.25, 0.5,\n//     0.25\n"
        "// @buffer counts: 64 uint\n// @value most: 1\n// @pre_roll 10\n// "
        "@needs depth\n// @accepts scene_linear\n"
        "// @pass first: picture kept_previous w -> half\nvec4 all_first(Pixel "
        "pixel, All parameters) { return vec4(0); }\n"
        "// @compute count 8x8: half -> counts most\nvoid all_count(All "
        "parameters) { }\n"
        "// @pass keep: half -> kept\nvec4 all_keep(Pixel pixel, All parameters) "
        "{ return vec4(0); }\n"
        "// @end kept most\nvec4 all(vec4 color, Pixel pixel, All parameters) { "
        "return color; }\n");
    return out;
}

const Registration custom({.name = "custom", .run = run, .seeds = seeds});

}  // namespace
}  // namespace darkroom::fuzz::custom_fuzz
