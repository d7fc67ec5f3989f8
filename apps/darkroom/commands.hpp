// SPDX-License-Identifier: MIT
#pragma once
// The commands. Each adds itself to the program, and returns what runs it once the arguments are parsed.

#include <CLI/CLI.hpp>
#include <darkroom/look.hpp>
#include <darkroom/result.hpp>
#include <functional>
#include <span>
#include <vector>

namespace app {

/// Returns the exit code.
using Run = std::function<int()>;

struct Command {
    CLI::App* app = nullptr;
    Run run;
    /// Of render and develop: what is wrong with flags and look, found before a scene or a frame is read.
    std::function<darkroom::Result<>()> check = {};
};

// `named`: effects of files, whose parameters are flags, too.
[[nodiscard]] Command add_render(CLI::App& program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_develop(CLI::App& program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_probe(CLI::App& program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_plan(CLI::App& program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_effects(CLI::App& program);
[[nodiscard]] Command add_devices(CLI::App& program);
[[nodiscard]] Command add_compare(CLI::App& program);
[[nodiscard]] Command add_info(CLI::App& program);
/// One for each command below it.
[[nodiscard]] std::vector<Command> add_lut(CLI::App& program, std::span<const darkroom::LookEntry> named);
/// One for each command below it.
[[nodiscard]] std::vector<Command> add_farm(CLI::App& program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_new(CLI::App& program);
[[nodiscard]] Command add_completion(CLI::App& program);
[[nodiscard]] Command add_man(CLI::App& program);
/// play and edit.
[[nodiscard]] std::vector<Command> add_viewer(CLI::App& program, std::span<const darkroom::LookEntry> named);

}  // namespace app
