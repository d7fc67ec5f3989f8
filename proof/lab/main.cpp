// SPDX-License-Identifier: MIT
// darkroom_lab: tools of whoever changes Darkroom, binds it to a language or makes temporal filters. Nobody installs
// it.
#include <CLI/CLI.hpp>

#include "lab/lab.hpp"
#include "programs/darkroom/flags/program.hpp"

int main(int argc, char** argv) {
    return app::run_program(argc, argv, [](auto program, auto, auto) {
        program.parser().name("darkroom_lab");
        program.parser().description("Tools of whoever changes Darkroom, binds it or makes temporal filters.");
        program.examples(
            "darkroom_lab api\n"
            "darkroom_lab capture scene.toml --frames 0-1 --size 64x36 --samples 4 -o captured\n"
            "darkroom_lab judge --truth captured --test captured/1x");
        return std::vector{app::add_api(program), app::add_capture(program), app::add_judge(program)};
    });
}
