// SPDX-License-Identifier: MIT
#pragma once
// The commands. Each adds itself to the program, and returns what runs it once the arguments are parsed.

#include <darkroom/look.hpp>
#include <darkroom/result.hpp>
#include <functional>
#include <span>
#include <vector>

#include "apps/darkroom/flags/flags.hpp"

namespace app {

/// Returns the exit code.
using Run = std::function<int()>;

struct Command {
    CommandFlags flags;
    Run run;
    /// Of render and develop: what is wrong with flags and look, found before a scene or a frame is read.
    std::function<darkroom::Result<>()> check = {};
};

// `named`: effects of files, whose parameters are flags, too.
[[nodiscard]] Command add_render(CommandFlags program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_develop(CommandFlags program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_probe(CommandFlags program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_plan(CommandFlags program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_bake(CommandFlags program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_effects(CommandFlags program);
[[nodiscard]] Command add_devices(CommandFlags program);
[[nodiscard]] Command add_compare(CommandFlags program);
[[nodiscard]] Command add_capture(CommandFlags program);
[[nodiscard]] Command add_judge(CommandFlags program);
struct VerifyFlags;
/// Verifies what the flags ask for. Returns the exit code.
using Verify = std::function<int(const VerifyFlags&)>;
[[nodiscard]] Command add_verify(CommandFlags program, const Verify& verify);
[[nodiscard]] Command add_info(CommandFlags program);
/// One for each command below it.
[[nodiscard]] std::vector<Command> add_lut(CommandFlags program, std::span<const darkroom::LookEntry> named);
/// One for each command below it.
[[nodiscard]] std::vector<Command> add_farm(CommandFlags program, std::span<const darkroom::LookEntry> named);
[[nodiscard]] Command add_new(CommandFlags program);
[[nodiscard]] Command add_api(CommandFlags program);
[[nodiscard]] Command add_help(CommandFlags program);
[[nodiscard]] Command add_completion(CommandFlags program);
[[nodiscard]] Command add_man(CommandFlags program);
struct ViewFlags;
/// Shows what the flags ask for. Returns the exit code.
using View = std::function<int(const ViewFlags&)>;
/// play and edit.
[[nodiscard]] std::vector<Command> add_view(CommandFlags program, std::span<const darkroom::LookEntry> named,
                                            const View& view);

}  // namespace app
