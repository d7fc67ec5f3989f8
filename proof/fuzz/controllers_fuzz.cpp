// SPDX-License-Identifier: MIT
// Controllers: whatever a script does, it ends, holds a bounded memory, and
// leaves no value behind when it is unloaded.

#include <fmt/format.h>

#include <algorithm>

#include "fuzz/target.hpp"
#include "script/test_stack.hpp"

#include <darkroom/controllers.hpp>

namespace darkroom::fuzz::controllers_fuzz {
namespace {

constexpr std::size_t max_bytes = std::size_t{16} << 20;

std::vector<std::uint32_t> words_of(const Composer& composer, bool is_current) {
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle entry = composer.entry(i);
        if (is_current)
            std::ranges::copy(composer.current(entry), std::back_inserter(out));
        else
            std::ranges::copy(composer.words(entry), std::back_inserter(out));
    }
    return out;
}

std::string run(std::string_view input) {
    test::ConsoleBed bed;
    // Time is libFuzzer's matter: what is counted is the same everywhere.
    Result<Controllers> created =
        Controllers::create(*bed.console, {.instructions_per_frame = 20'000, .milliseconds_per_frame = 1e6});
    if (!created) return created.error().text;
    const GameTable game{{"health", 50.0}, {"name", std::string("x")}, {"is_hit", true}};
    if (const Result<> loaded = created->load_text("a", input); !loaded)
        if (std::string wrong = wrong_error(loaded.error()); !wrong.empty()) return wrong;
    for (int i = 0; i < 3; ++i) created->frame({.time = i / 60.0, .is_hud_visible = i != 1, .game = &game});
    if (created->bytes() > max_bytes) return fmt::format("scripts hold {} bytes", created->bytes());
    created->unload("a");
    if (!created->slots().empty()) return created->slots().front() + " is left";
    return words_of(bed.composer, true) == words_of(bed.composer, false) ? std::string() : "an override is left";
}

std::vector<std::string> seeds() {
    std::vector<std::string> out = files("controllers/*.lua");
    out.emplace_back(
        "engine.pre_roll(0.5)\nengine.on_frame('a', function(dt)\n  "
        "engine.cvar_set('warp.strength', game.health / 100)\n"
        "  print(engine.cvar_get('echo.scale'), "
        "tostring(game.name):rep(3))\nend)\nengine.exec('tone.gamma 2')\n");
    out.emplace_back(
        "local t = setmetatable({}, {__index = function(t, k) "
        "return k end})\nfor i = 1, 9 do t[i] = t[i] "
        "end\npcall(error, t)\nstring.format('%s %d %g', 'a', 3, "
        "2.5)\ntable.sort({3, 1}, function() end)");
    return out;
}

const Registration controllers({.name = "controllers", .run = run, .seeds = seeds});

}  // namespace
}  // namespace darkroom::fuzz::controllers_fuzz
