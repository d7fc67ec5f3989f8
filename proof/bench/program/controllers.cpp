// SPDX-License-Identifier: MIT
#include <array>
#include <darkroom/controllers.hpp>
#include <darkroom/describe.hpp>

#include "bench/chain/chains.hpp"
#include "bench/chain/recipe.hpp"

namespace darkroom::bench {

namespace {

struct Visor {
    float warp = -0.15f, chroma = 0.005f, echo = 0.1f;
};
constexpr auto visor_rows = describe(field<&Visor::warp>("How much it bends.", {-1, 1}).also_named("r_ui_warp"),
                                     field<&Visor::chroma>("How much it parts.", {0, 1}).also_named("r_ui_chromatic"),
                                     field<&Visor::echo>("How much it doubles.", {0, 1}).also_named("r_ui_echo"));
/// In place of the effects that have these variables, so that they need not be there.
const EffectInfo visor_effect{.name = "visor", .doc = "Has variables.", .parameters = visor_rows.table()};

struct Game {
    explicit Game(Device& device) : composer(device), console(composer) {
        for (const Step& step : flat_stack(true)) composer.add(*step.effect, nullptr);
        composer.add(visor_effect, nullptr);
    }
    Composer composer;
    Console console;
    std::optional<Controllers> controllers;
    GameTable table;
    int frame = 0;
};

/// 144 frames a second of the shipped controllers; a hit every third of a second, or none.
Result<Row> fight_row(Bed& bed, const std::string& name, bool is_fight) {
    const auto game = std::make_shared<Game>(bed.device);
    DARKROOM_TRY_VALUE(auto created, Controllers::create(game->console));
    game->controllers.emplace(std::move(created));
    for (const char* const script : {"combat", "visor"})
        DARKROOM_TRY(game->controllers->load(std::string(DARKROOM_SOURCE_FOLDER "/controllers/") + script + ".lua"));
    game->table = {{"health", 20.0}, {"has_quad", is_fight}, {"face_pain", false}};
    return Row{.name = name, .host = [game, is_fight] {
                   for (int i = 0; i < frames_of_a_row; ++i, ++game->frame) {
                       game->table.find("face_pain")->second = is_fight && game->frame % 48 < 5;
                       game->controllers->frame({.time = game->frame / 144.0, .game = &game->table});
                   }
               }};
}

}  // namespace

std::vector<Recipe> controller_recipes() {
    return {{"controllers at rest, 1000 frames",
             [](Bed& bed, const std::string& name) { return fight_row(bed, name, false); }},
            {"controllers in a fight, 1000 frames",
             [](Bed& bed, const std::string& name) { return fight_row(bed, name, true); }}};
}

}  // namespace darkroom::bench
