// SPDX-License-Identifier: MIT
// The smallest user of the installed console and controllers: those that ship run.

#include <cstdio>
#include <darkroom/controllers.hpp>
#include <darkroom/darkroom.hpp>

int main() {
    darkroom::Composer composer(darkroom::Device::assumed());
    for (const darkroom::EffectInfo* const effect : darkroom::all_effects()) composer.add(*effect, nullptr);
    darkroom::Console console(composer);
    auto controllers = darkroom::Controllers::create(console);
    for (const char* const file : {CONTROLLERS "/combat.lua", CONTROLLERS "/visor.lua"}) {
        const auto loaded = controllers ? controllers->load(file) : darkroom::failure(controllers.error());
        if (!loaded) {
            std::fprintf(stderr, "%s\n", loaded.error().text.c_str());
            return 1;
        }
    }
    controllers->frame({});
    std::printf("%zu variables, %zu controllers\n", console.names().size(), controllers->slots().size());
    return 0;
}
